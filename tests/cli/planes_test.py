#!/usr/bin/env python3
"""Written outer planes: no input point is above one, in exact arithmetic and when evaluated in doubles."""

import json
import shutil
import subprocess
from fractions import Fraction

import numpy
from program import DIAMONDS, fresh_folder, rbox, report_of, run, run_tests

# Name, what rbox makes, what is done with it.
SETS = [
    ("sphere", "1000 s D4 t1", lambda x: x),
    ("cube", "500 D5 t2", lambda x: x),
    ("lattice", "M3,4 64 D4", lambda x: x),
    ("cube corners", "c D6", lambda x: x),
    ("far away", "200 s D5 t3", lambda x: x + 1e6),
    ("far along one axis", "200 D4 t4", lambda x: x + [0, 1e9, 0, 0]),
    ("scaled axes", "300 s D5 t5", lambda x: x * [1e-8, 1, 1e8, 1e-3, 1e4]),
    ("scaled and far away", "200 s D4 t6", lambda x: x * [1e-3, 1, 1e3, 1] + [1e3, -1e5, 1e6, 7]),
    ("tiny", "100 s D3 t7", lambda x: x * 1e-150),
    ("huge", "100 s D3 t8", lambda x: x * 1e100),
    ("rounded to float32", "300 s D4 t9", lambda x: (x + 100).astype(numpy.float32)),
    ("slab", "200 D4 t10", lambda x: x * [1, 1, 1, 1e-13]),
    ("flat", "100 D3 t11", lambda x: numpy.column_stack([x, x.sum(axis=1)]) + 10),
]

MOST_PAIRS = 300_000_000


def point_sets(folder):
    for name, arguments, change in SETS:
        path = folder / (name.replace(" ", "_") + ".npy")
        points = change(rbox(arguments, path))
        numpy.save(path, points)
        yield name, path, points.astype(float)
    points = numpy.load(DIAMONDS).astype(float)
    yield "diamonds", DIAMONDS, points


def exact_value(plane, point):
    return sum(Fraction(a) * Fraction(x) for a, x in zip(plane[:-1], point)) + Fraction(plane[-1])


def check_outer(name, points, planes):
    """All points and planes, of too many planes spread over the list, in doubles; the highest points of some exactly."""
    planes = planes[:: len(points) * len(planes) // MOST_PAIRS + 1]
    highest = numpy.empty(len(planes), dtype=int)
    for rows in numpy.array_split(numpy.arange(len(planes)), len(planes) // 500 + 1):
        values = points @ planes[rows, :-1].T + planes[rows, -1]
        assert values.max() <= 0, (name, values.max())
        highest[rows] = values.argmax(axis=0)
    for row in range(0, len(planes), len(planes) // 200 + 1):
        assert exact_value(planes[row], points[highest[row]]) <= 0, (name, row)


def test_no_point_is_above_an_outer_plane():
    folder = fresh_folder("outer")
    for name, path, points in point_sets(folder):
        for options in ([], ["--unit-cube"]):
            planes_path = folder / "planes.npy"
            report = report_of(path, "--planes", planes_path, *options)
            planes = numpy.load(planes_path)
            assert planes.shape == (report["facets"], points.shape[1] + 1), name
            assert abs(numpy.linalg.norm(planes[:, :-1], axis=1) - 1).max() < 1e-14
            check_outer(name, points, planes)
            # They are not only safe but near: some points reach them but for roundoff.
            extent = numpy.ptp(points, axis=0).max() + abs(points).max()
            reach = (points @ planes[0, :-1] + planes[0, -1]).max()
            assert reach > -1e-12 * extent, (name, reach)
            run("verify", path, planes_path)


def test_equations_bound_flat_points_off_their_subspace():
    folder = fresh_folder("equations")
    rng = numpy.random.default_rng(5)
    for name, points in [
        ("shares", rng.dirichlet(numpy.ones(5), 200)),
        ("far", rng.normal(size=(60, 2)) @ rng.normal(size=(2, 5)) * 1e3 + 1e6),
        ("one point", numpy.full((3, 4), 0.1)),
    ]:
        path = folder / (name.replace(" ", "_") + ".npy")
        numpy.save(path, points)
        rank, dimension = report_of(path)["input"]["rank"], points.shape[1]
        assert rank < dimension
        off = points.mean(axis=0) + 1e-3 * numpy.abs(points).max() * rng.normal(size=(20, dimension))
        queries = folder / "off.npy"
        numpy.save(queries, numpy.vstack([off, points]))
        for command in (["hull"], ["largest", "-n", 3, "--bounded"]):
            for kind in ("outer", "mean", "inner"):
                planes_path = folder / "planes.npy"
                words = [command[0], path, *command[1:], "--planes", planes_path, "--plane-kind", kind, "--quiet"]
                run(*words, "--equations")
                planes = numpy.load(planes_path)
                facets = len(planes) - 2 * (dimension - rank)
                added = planes[facets:]
                assert (added[::2, :-1] == -added[1::2, :-1]).all()
                # Between the two planes of an equation there is the rounding of data and planes.
                gap = abs(added[::2, -1] + added[1::2, -1]).max()
                assert gap < 1e-13 * numpy.abs(points).max(), (name, kind, gap)
                values = points @ added[:, :-1].T + added[:, -1]
                assert kind != "outer" or values.max() <= 0, (name, kind)
                assert kind != "inner" or values.min() >= 0, (name, kind)
                if kind == "outer":
                    check_outer(name, points, planes)
                    run("verify", path, planes_path)
                    places = [line.split()[2] for line in run("contains", planes_path, queries).stdout.splitlines()]
                    assert places == ["outside"] * 20 + ["inside"] * len(points), (name, command)
                done = run(*words)
                if facets > 0:
                    assert (numpy.load(planes_path) == planes[:facets]).all()
                assert done.stderr.startswith("ndhull: warning: the points lie in") and "--equations" in done.stderr


def test_the_same_planes_in_every_format():
    folder = fresh_folder("formats")
    run("rbox", "200 s D4 t1", "-o", folder / "points.txt")
    for kind in ("outer", "mean", "inner"):
        for extension in ("npy", "ine", "txt"):
            run("hull", folder / "points.txt", "--planes", folder / f"planes.{extension}", "--plane-kind", kind)
        rows = numpy.load(folder / "planes.npy")
        text = (folder / "planes.txt").read_text().split()
        assert [int(word) for word in text[:2]] == [5, len(rows)]
        assert (numpy.array(text[2:], dtype=float).reshape(rows.shape) == rows).all()
        ine = (folder / "planes.ine").read_text().splitlines()
        assert ine[0] == "H-representation" and ine[2] == f"{len(rows)} 5 real" and ine[-1] == "end"
        numbers = numpy.array([line.split() for line in ine[3:-1]], dtype=float)
        assert (-numbers[:, 1:] == rows[:, :-1]).all() and (-numbers[:, 0] == rows[:, -1]).all()


def test_no_planes_are_read_again_and_leave_the_whole_space():
    folder = fresh_folder("none")
    run("rbox", "20 D3 t1", "-o", folder / "points.npy")
    numpy.save(folder / "one.npy", [[1.0, 2.0, 3.0]])
    for extension in ("npy", "ine", "txt", "csv", "tsv"):
        planes = folder / f"planes.{extension}"
        for words in (["points.npy", "--min-area", "1e9"], ["one.npy"]):
            run("hull", folder / words[0], *words[1:], "--planes", planes, "--quiet")
            done = run("contains", planes, folder / "one.npy")
            assert done.stdout == "-inf -1 inside\n" and "found no planes" in done.stderr, done
            run("contains", planes, folder / "one.npy", "-o", folder / "answers.npy")
            assert numpy.load(folder / "answers.npy").tolist() == [[-numpy.inf, -1, -1]]
            assert "nothing to check: no planes" in run("verify", folder / "points.npy", planes).stdout
            report = json.loads(run("intersect", planes, "--report", "-").stdout)
            assert report["status"] == "unbounded" and report["input"]["halfspaces"] == 0
            assert report["rank"] == 3 and report["inner_radius"] is None


def test_vertices_are_not_below_inner_planes():
    folder = fresh_folder("inner")
    for name, path, points in point_sets(folder):
        if name == "diamonds":
            continue
        report = report_of(path, "--planes", folder / "planes.npy", "--plane-kind", "inner", "--facet-list")
        for plane, facet in zip(numpy.load(folder / "planes.npy"), report["facet_list"]):
            values = points[facet["vertices"]] @ plane[:-1] + plane[-1]
            assert values.min() >= 0, (name, values.min())
            assert exact_value(plane, points[facet["vertices"][values.argmin()]]) >= 0, name


def test_lrs_finds_the_cube_again_from_its_outer_planes():
    """In exact arithmetic: the corners are moved by roundoff only."""
    if shutil.which("lrs") is None:
        print("skipped: lrs is not installed")
        return
    folder = fresh_folder("lrs")
    run("rbox", "c D3", "-o", folder / "cube.txt")
    run("hull", folder / "cube.txt", "--planes", folder / "cube.ine")
    lines = (folder / "cube.ine").read_text().replace("real", "rational").splitlines()
    lines[3:-1] = [" ".join(str(Fraction(float(word))) for word in line.split()) for line in lines[3:-1]]
    (folder / "rational.ine").write_text("\n".join(lines) + "\n")
    listing = subprocess.run(["lrs", folder / "rational.ine"], capture_output=True, text=True, check=True).stdout
    corners = [[float(Fraction(word)) for word in line.split()[1:]]
               for line in listing.splitlines() if line.startswith(" 1 ")]  # fmt: skip
    assert len(corners) == 8, listing
    assert abs(abs(numpy.array(corners)) - 0.5).max() < 1e-14, corners


if __name__ == "__main__":
    run_tests(globals())
