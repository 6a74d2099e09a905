#!/usr/bin/env python3
"""ndhull intersect: statuses, formats, files, refusals, pipes; vertex counts of lrs where it is installed."""

import itertools
import json
import math
import os
import resource
import shutil
import signal
import subprocess
import time

import numpy

from program import PATIENCE, PROGRAM, fresh_folder, one_error_line, rbox, run, run_tests
from program import report_of as report_of_hull

FOLDER = fresh_folder("intersect")
LRS = shutil.which("lrs")


def qhull_text(rows):
    rows = numpy.asarray(rows, float)
    lines = [str(rows.shape[1]), str(len(rows))] + [" ".join(map(repr, map(float, row))) for row in rows]
    return ("\n".join(lines) + "\n").encode()


def cube(d):
    rows = []
    for k in range(d):
        for sign in (1, -1):
            rows.append([sign * (j == k) for j in range(d)] + [-1])
    return rows


def cross_polytope(d):
    return [list(signs) + [-1] for signs in itertools.product((1, -1), repeat=d)]


def birkhoff(n):
    """x_ij >= 0, rows and columns sum to 1, each equation as two halfspaces."""
    rows = []
    for i, j in itertools.product(range(n), repeat=2):
        rows.append([-(k == i * n + j) for k in range(n * n)] + [0])
    for i in range(n):
        for line in ([k // n == i for k in range(n * n)], [k % n == i for k in range(n * n)]):
            for sign in (1, -1):
                rows.append([sign * value for value in line] + [-sign])
    return rows


def report_of(rows, *arguments):
    return json.loads(run("intersect", "-", "--report", "-", *arguments, stdin=qhull_text(rows)).stdout)


def lrs_vertices(rows):
    """Rows of lrs's V-representation that are vertices."""
    ine = FOLDER / "polytope.ine"
    with open(ine, "w") as file:
        print(f"H-representation\nbegin\n{len(rows)} {len(rows[0])} integer", file=file)
        for row in rows:
            print(-row[-1], *(-value for value in row[:-1]), file=file)
        print("end", file=file)
    out = subprocess.run([LRS, ine], capture_output=True, text=True, timeout=120, check=True).stdout
    return sum(line.split()[:1] == ["1"] for line in out.split("begin")[1].split("end")[0].splitlines())


def test_vertex_counts():
    for name, rows, vertices, rank in [
        ("cube 5", cube(5), 32, 5),
        ("cube 9", cube(9), 512, 9),
        ("cross-polytope 4", cross_polytope(4), 8, 4),
        ("cross-polytope 9", cross_polytope(9), 18, 9),
        ("birkhoff 3", birkhoff(3), 6, 4),
        ("birkhoff 4", birkhoff(4), 24, 9),
    ]:
        report = report_of(rows)
        assert report["vertices"] == vertices, (name, report["vertices"])
        assert report["rank"] == rank, (name, report["rank"])
        flat = rank < len(rows[0]) - 1
        assert report["status"] == ("lower-dimensional" if flat else "bounded"), name
        assert len(report["equations"]) == len(rows[0]) - 1 - rank, name
        # lrs visits every basis: too many where 256 planes meet in a vertex.
        if LRS and name != "cross-polytope 9":
            assert lrs_vertices(rows) == vertices, name
    print("lrs agrees" if LRS else "lrs is not installed")


def test_report_of_a_cube():
    report = report_of(cube(3), "--vertex-list")
    assert math.isclose(report["volume"], 8, rel_tol=1e-12) and math.isclose(report["area"], 24, rel_tol=1e-12)
    assert math.isclose(report["inner_radius"], 1, rel_tol=1e-12)
    assert report["non_redundant"] == list(range(6)) and report["equalities"] == []
    assert len(report["vertex_list"]) == 8
    for vertex in report["vertex_list"]:
        assert len(vertex["halfspaces"]) == 3 and len(vertex["neighbors"]) == 3
        assert numpy.allclose(numpy.abs(vertex["point"]), 1, rtol=1e-14)


def test_statuses():
    unbounded = report_of([[1, 0, -1], [-1, 0, -1]])
    assert unbounded["status"] == "unbounded" and numpy.allclose(numpy.abs(unbounded["direction"]), [0, 1])
    assert unbounded["direction_margin"] <= 1e-15 and "vertices" not in unbounded
    rows = numpy.array([[1, 0, 1], [-1, 0, 1], [0, 1, 0]], float)
    empty = report_of(rows)
    assert empty["status"] == "empty"
    total = sum(term["weight"] * rows[term["halfspace"]] for term in empty["proof"]["combination"])
    assert numpy.allclose(total[:2], 0) and total[2] > 0.9
    half = report_of([[0, 3, -3]])
    assert half["status"] == "unbounded" and half["inner_radius"] is None


def test_what_a_limit_leaves_out_is_said():
    folder = fresh_folder("limit")
    numpy.save(folder / "rows.npy", cube(7))
    words = ["intersect", folder / "rows.npy", "--max-facets", 20]
    done = run(*words, "--vertices", folder / "v.npy")
    assert "limit       facet_limit" in done.stdout and len(numpy.load(folder / "v.npy")) < 128, done.stdout
    done = run(*words, "--vertices", "-")
    assert done.stderr.startswith("ndhull: warning: facet_limit: vertices are missing"), done.stderr
    report = json.loads(run(*words, "--report", "-", "--quiet").stdout)
    assert report["hull_status"] == "facet_limit" and report["options"]["max_seconds"] is None
    done = run("intersect", folder / "rows.npy", "--vertices", folder / "v.npy")
    assert "status      bounded" in done.stdout and done.stderr == "" and len(numpy.load(folder / "v.npy")) == 128


def rounded_cyclic_planes(folder):
    """660 planes; rounded, 330 that met in a vertex meet in thousands, most of which merge again."""
    t = numpy.arange(16.0)[:, None]
    numpy.save(folder / "curve.npy", t ** numpy.arange(1, 9))
    run("hull", folder / "curve.npy", "--planes", folder / "planes.npy", "--quiet")
    return folder / "planes.npy"


def children_seconds():
    """Processor time of all processes that were run and ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def test_a_limit_on_seconds_holds_where_many_vertices_merge():
    planes = rounded_cyclic_planes(fresh_folder("cyclic_limit"))
    limit = PATIENCE / 60
    words = ["intersect", planes, "--threads", 1, "--max-seconds", limit, "--report", "-", "--quiet"]
    before = children_seconds()
    report = json.loads(run(*words).stdout)
    assert report["hull_status"] == "time_limit" and report["vertices"] > 16, report["hull_status"]
    assert report["seconds"]["total"] >= limit, report["seconds"]
    # Of the one thread's own time: what a busy machine takes from it is not the program's.
    assert children_seconds() - before < 1.8 * limit, report["seconds"]


def test_ctrl_c_ends_where_many_vertices_merge():
    planes = rounded_cyclic_planes(fresh_folder("cyclic_interrupt"))
    words = [PROGRAM, "intersect", planes, "--threads", "1", "--report", "-", "--quiet"]
    with subprocess.Popen(words, stdout=subprocess.PIPE) as process:
        time.sleep(1.0)
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130 and json.loads(output)["hull_status"] == "interrupted"
    assert time.monotonic() - start < PATIENCE / 40


def test_formats_agree_with_each_other_and_qhalf():
    points = rbox("30 s D4 t1", FOLDER / "points.npy")
    run("hull", FOLDER / "points.npy", "--planes", FOLDER / "planes.txt")
    text = run("intersect", FOLDER / "planes.txt", "--format", "Fp Fv Fx Fn FN").stdout.split("\n")
    assert text[0] == "4" and int(text[1]) == 30
    vertices = numpy.array([list(map(float, line.split())) for line in text[2:32]])
    order = [numpy.argmin(numpy.linalg.norm(vertices - point, axis=1)) for point in points]
    assert sorted(order) == list(range(30)) and numpy.allclose(vertices[order], points, atol=1e-12)
    assert text[32] == "30"
    facets = [set(map(int, line.split()[1:])) for line in text[33:63]]
    planes = numpy.loadtxt(FOLDER / "planes.txt", skiprows=2)
    for vertex, ids in zip(vertices, facets):
        assert set(numpy.nonzero(planes[:, :4] @ vertex + planes[:, 4] > -1e-9)[0]) == ids
    assert int(text[63]) == len(planes)
    assert "ndhull: usage" in run("intersect", FOLDER / "planes.txt", "--format", "Fq", exit_code=1).stderr
    qhalf = shutil.which("qhalf")
    if qhalf:
        simple = qhull_text(cube(4))
        found = run("intersect", "-", "--format", "Fp,Fx", stdin=simple).stdout.split("\n")
        point = b"4 1\n0.1 0.2 0.1 0\n"
        other = subprocess.run([qhalf, "Fp", "Fx"], input=point + simple, capture_output=True, check=True)
        other = other.stdout.decode().split("\n")
        rows = lambda lines: sorted(tuple(round(float(value), 12) + 0.0 for value in line.split()) for line in lines)
        assert found[:2] == other[:2] and rows(found[2:18]) == rows(other[2:18])
        assert rows(found[18:]) == rows(other[18:])


def test_vertices_are_written_as_c_writes_them():
    # Short and long numbers, with and without an exponent.
    rows = [[1, 0, 0, -0.5], [-1, 0, 0, -2], [0, 1, 0, -1e-5], [0, -1, 0, -1e20], [0, 0, 3, -1], [0, 0, -1, -3]]
    lines = run("intersect", "-", "--format", "Fp", stdin=qhull_text(rows)).stdout.split("\n")[2:-1]
    assert len(lines) == 8
    for line in lines:
        assert line == "".join("%6.16g " % float(word) for word in line.split()), line


def test_interior_points():
    rows = qhull_text(cube(2))
    inside = run("intersect", "-", "--interior-point", "0.5, -0.5", "--report", "-", stdin=rows).stdout
    assert json.loads(inside)["interior_point"] == [0.5, -0.5]
    in_front = json.loads(run("intersect", "-", "--report", "-", stdin=b"2 1\n0.25 0.25\n" + rows).stdout)
    assert in_front["interior_point"] == [0.25, 0.25]
    # The first row of a table of 1-d halfspaces looks like the header of a point.
    table = json.loads(run("intersect", "-", "--report", "-", stdin=b"2 1\n-1 -3\n1 -5\n").stdout)
    assert table["status"] == "bounded" and table["volume"] == 2.5, table
    done = run("intersect", "-", "--interior-point", "0 1.5", exit_code=1, stdin=rows)
    one_error_line(done, "bad-halfspace")
    assert "halfspace 2 (counted from 0): found the interior point 0.5 above" in done.stderr
    one_error_line(run("intersect", "-", "--interior-point", "0 x", exit_code=1, stdin=rows), "usage")
    one_error_line(run("intersect", "-", "--interior-point", "0", exit_code=1, stdin=rows), "usage")


def test_vertices_that_do_not_exist_are_an_error():
    target = FOLDER / "none.npy"
    done = run("intersect", "-", "--vertices", target, exit_code=1, stdin=qhull_text([[1, 0, -1], [-1, 0, -1]]))
    one_error_line(done, "bad-halfspace")
    assert "unbounded along" in done.stderr and not target.exists()
    done = run("intersect", "-", "--format", "Fp", exit_code=1, stdin=qhull_text([[1, 0, 1], [-1, 0, 1]]))
    one_error_line(done, "bad-halfspace")
    assert "empty" in done.stderr


def test_errors_of_the_region_name_the_file():
    folder = fresh_folder("named")
    numpy.save(folder / "rows.npy", cube(3))
    done = run("intersect", folder / "rows.npy", "--interior-point", "2 0 0", exit_code=1)
    assert done.stderr.startswith(f"ndhull: bad-halfspace: {folder / 'rows.npy'}: halfspace"), done.stderr


def test_bad_halfspaces():
    one_error_line(run("intersect", "-", exit_code=1, stdin=qhull_text([[1, 0, 1], [0, 0, 1]])), "bad-halfspace")
    one_error_line(run("intersect", "-", exit_code=1, stdin=b"3\n1\n1 nan 1\n"), "not-finite")
    done = run("intersect", "-", "--vertices", "-", "--report", "-", exit_code=1, stdin=qhull_text(cube(2)))
    one_error_line(done, "usage")


def test_pipe_of_three():
    points = rbox("200 s D5 t1", FOLDER / "sphere.npy")
    run("hull", FOLDER / "sphere.npy", "--planes", FOLDER / "outer.npy")
    for name in ("corners.npy", "corners.csv", "corners.txt", "corners.ext"):
        run("intersect", FOLDER / "outer.npy", "--vertices", FOLDER / name)
        done = run("hull", FOLDER / name, "--report", "-")
        assert json.loads(done.stdout)["vertices"] == len(points), name
    corners = run("intersect", FOLDER / "outer.npy", "--vertices", "-").stdout
    run("hull", "-", "--planes", FOLDER / "again.ine", stdin=corners.encode())
    planes = numpy.load(FOLDER / "outer.npy")
    corners = numpy.load(FOLDER / "corners.npy")
    assert (planes[:, :5] @ corners.T + planes[:, 5:]).max() < 1e-13


# What rbox makes, and what is done with it: narrow, far away, nearly degenerate.
ROUND_TRIPS = [
    ("1000 s D4 t1", lambda x: x),
    ("M3,4 64 D4", lambda x: x),
    ("c D6", lambda x: x),
    ("200 s D5 t3", lambda x: x + 1e6),
    ("200 s D5 t3", lambda x: x + 1e10),
    ("200 D4 t4", lambda x: x + [0, 1e9, 0, 0]),
    ("300 s D5 t5", lambda x: x * [1e-8, 1, 1e8, 1e-3, 1e4]),
    ("200 s D4 t6", lambda x: x * [1e-3, 1, 1e3, 1] + [1e3, -1e5, 1e6, 7]),
    ("100 s D3 t7", lambda x: x * 1e-100),
    ("100 s D3 t8", lambda x: x * 1e100),
    ("200 D4 t10", lambda x: x * [1, 1, 1, 1e-13]),
    ("1000 L100000 s G1e-16 D4", lambda x: x),
    ("1000 W1e-13 D4", lambda x: x),
    ("400 s Z1 G1e-13 D4", lambda x: x),
    ("100 C1,1e-13 D4 s t", lambda x: x),
    ("500 W0 D5", lambda x: x),
]


def test_round_trips_keep_vertices_and_facets():
    for arguments, change in ROUND_TRIPS:
        numpy.save(FOLDER / "round.npy", change(rbox(arguments, FOLDER / "round.npy")))
        first = report_of_hull(FOLDER / "round.npy", "--planes", FOLDER / "round_planes.npy")
        run("intersect", FOLDER / "round_planes.npy", "--vertices", FOLDER / "round_corners.npy")
        second = report_of_hull(FOLDER / "round_corners.npy")
        counts = [(report["vertices"], report["facets"]) for report in (first, second)]
        assert counts[0] == counts[1], (arguments, counts)


def test_equations_and_rows_without_normals_of_cdd():
    """The rows of the file are named: x = 1/2 in the unit cube, between rows that hold everywhere."""
    folder = fresh_folder("equations")
    cube = ["1 0 0 0"] + [f"{b} " + " ".join(str(s if j == k else 0) for j in range(3))
                          for k in range(3) for b, s in ((0, 1), (1, -1))]  # fmt: skip
    rows = [*cube, "-1 2 0 0", "0 0 0 0"]
    path = folder / "slice.ine"
    head = f"begin\n{len(rows)} 4 integer\n"
    path.write_text("H-representation\nlinearity 2 8 9\n" + head + "\n".join(rows) + "\nend\n")
    report = json.loads(run("intersect", path, "--report", "-", "--vertex-list").stdout)
    assert report["status"] == "lower-dimensional" and report["rank"] == 2
    assert report["input"]["halfspaces"] == 9 and report["equalities"] == [7]
    assert report["non_redundant"] == [3, 4, 5, 6]
    corners = sorted(tuple(round(value, 9) for value in vertex["point"]) for vertex in report["vertex_list"])
    assert corners == [(0.5, y, z) for y in (0, 1) for z in (0, 1)]
    assert all(set(vertex["halfspaces"]) <= {3, 4, 5, 6} for vertex in report["vertex_list"])
    lines = run("intersect", path, "--format", "FN").stdout.splitlines()
    assert [len(line.split()) for line in lines] == [1, 1, 1, 1, 3, 3, 3, 3, 1, 1]
    numpy.save(folder / "queries.npy", [[0.5, 0.5, 0.5], [0.25, 0.5, 0.5], [0.5, 0.5, 2.0]])
    answers = [line.split() for line in run("contains", path, folder / "queries.npy").stdout.splitlines()]
    assert [answer[2] for answer in answers] == ["inside", "outside", "outside"]
    assert [(float(a), int(b)) for a, b, _ in answers[1:]] == [(0.25, 7), (1.0, 6)]
    assert "plane 6 distance 1" in run("verify", folder / "queries.npy", path, exit_code=2).stdout
    # Two equations that miss each other, and a row that holds nowhere: empty, by rows of the file.
    path.write_text("linearity 2 2 3\nbegin\n3 2 integer\n1 0\n-1 1\n-2 1\nend\n")
    report = json.loads(run("intersect", path, "--report", "-").stdout)
    weights = {term["halfspace"]: term["weight"] for term in report["proof"]["combination"]}
    assert report["status"] == "empty" and sorted(weights) == [1, 2]
    assert abs(weights[1] + weights[2]) < 1e-12 and abs(report["proof"]["gap"] - 0.5) < 1e-12
    for offset, line, weight in ((-3, "", 1), (3, "linearity 1 2\n", -1)):
        path.write_text(f"{line}begin\n2 2 integer\n1 -1\n{offset} 0\nend\n")
        proof = json.loads(run("intersect", path, "--report", "-").stdout)["proof"]
        assert proof["combination"] == [{"halfspace": 1, "weight": weight}] and proof["gap"] == 3
        numpy.save(folder / "one.npy", [[0.0]])
        one_error_line(run("contains", path, folder / "one.npy", exit_code=1), "bad-halfspace")
        one_error_line(run("verify", folder / "one.npy", path, exit_code=1), "bad-halfspace")
    path.write_text("begin\n1 3 integer\n1 0 0\nend\n")
    assert json.loads(run("intersect", path, "--report", "-").stdout)["status"] == "unbounded"


def test_a_report_of_a_file_whose_name_is_no_text():
    folder = fresh_folder("no_text")
    path = os.fsencode(folder) + b"/bad\xff.txt"
    with open(path, "wb") as file:
        file.write(b"1 -1\n-1 -1\n")
    done = subprocess.run([PROGRAM, "intersect", path, "--report", "-"], capture_output=True, check=True, timeout=PATIENCE)
    assert json.loads(done.stdout)["status"] == "bounded"


run_tests(globals())
