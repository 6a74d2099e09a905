#!/usr/bin/env python3
"""ndhull qhull beside Qhull's own programs: the same facets, planes, areas and volumes, format by format."""

import shutil
import subprocess

import numpy
from program import PATIENCE, PROGRAM, fresh_folder, one_error_line, run, run_tests
from qhull_facets import Facets, numbers, rows_of

QHULL, QHALF = shutil.which("qhull"), shutil.which("qhalf")

# In general position, and with facets that are no simplices.
GENERAL = ["20 D2 t1", "200 s D2 t2", "50 D3 t1", "300 s D3 t2", "1000 D3 t3 O10", "100 D4 t1", "200 s D4 t2",
           "60 L20 D4 t4", "80 D5 t1", "100 s D5 t2", "60 x D5 t1", "40 D6 t1", "60 s D6 t2", "30 D7 t1", "40 s D7 t2",
           "20 D8 t1", "25 s D8 t2"]  # fmt: skip
MERGED = ["c D2", "c D3", "c D4", "c D5", "c D6", "c D7", "c D8", "d D3", "d D5", "d D8", "200 W0 D3 t1", "64 M1,0 D3",
          "c d G0.5 D4", "100 W0 c D4 t1", "27 M1,0,1 D3 c G10"]  # fmt: skip


def shell(command, stdin=b""):
    """Standard output of a pipe; every program in it must succeed."""
    done = subprocess.run(["bash", "-o", "pipefail", "-c", command], input=stdin, capture_output=True,
                          timeout=PATIENCE, check=False)  # fmt: skip
    assert done.returncode == 0, (command, done.returncode, done.stderr.decode()[:500])
    return done.stdout.decode()


def points_of(arguments):
    return run("rbox", arguments).stdout.encode()


def ours(options, stdin):
    return run("qhull", options, stdin=stdin).stdout


def theirs(options, stdin):
    return shell(f"{QHULL} {options}", stdin)


def largest_difference(ours_by_key, theirs_by_key):
    assert set(ours_by_key) == set(theirs_by_key)
    return max(numpy.abs(numpy.subtract(ours_by_key[key], theirs_by_key[key])).max() for key in ours_by_key)


def compare(arguments, options=""):
    stdin = points_of(arguments)
    one, other = Facets(ours, stdin, options), Facets(theirs, stdin, options)
    assert set(one.vertices) == set(other.vertices), (arguments, len(one.vertices), len(other.vertices))
    scale = max(1.0, max(abs(plane[-1]) for plane in other.planes.values()))
    planes = largest_difference(one.planes, other.planes) / scale
    assert planes <= 1e-12, (arguments, planes)
    areas = max(abs(one.areas[facet] / other.areas[facet] - 1) for facet in other.areas)
    assert areas <= 1e-10, (arguments, areas)
    assert one.neighbours == other.neighbours, arguments
    sizes = max(abs(one.size[k] / other.size[k] - 1) for k in (1, 2))
    assert sizes <= 1e-10, (arguments, sizes)
    assert one.extreme == other.extreme, arguments
    assert one.counts[:9] == other.counts[:9], (arguments, one.counts, other.counts)
    assert one.of_points == other.of_points, arguments
    assert numpy.abs(numpy.subtract(one.centre, other.centre)).max() <= 1e-12 * scale
    return planes, areas, sizes


def test_exact_hulls_have_qhulls_facets_planes_and_areas():
    if QHULL is None:
        return
    assert len(GENERAL) + len(MERGED) >= 30
    worst = numpy.zeros(3)
    for arguments in GENERAL + MERGED:
        worst = numpy.maximum(worst, compare(arguments))
    print("planes, areas, sizes differ by at most", worst)


def points_and_facets(text):
    """The coordinates and the vertex lists of o or Ft."""
    lines = text.splitlines()
    point_count, facet_count, _ = map(int, lines[1].split())
    points = numpy.array([numbers(line) for line in lines[2 : 2 + point_count]])
    facets = [[int(word) for word in line.split()][1:] for line in lines[2 + point_count :]]
    assert len(facets) == facet_count
    return points, facets


def orientation(points, facet, centre):
    return numpy.sign(numpy.linalg.det(points[facet] - centre))


def same_rows(one, other):
    one, other = (sorted(map(tuple, numpy.round(rows, 9) + 0.0)) for rows in (one, other))
    return one == other


def test_points_and_simplices_have_qhulls_form():
    if QHULL is None:
        return
    for arguments in ["30 D2 t1", "40 D3 t1", "c D3", "60 D4 t1", "c D4", "50 s D5 t1", "d D5"]:
        stdin = points_of(arguments)
        for name in ("o", "Ft"):
            (one, one_facets), (other, other_facets) = (
                points_and_facets(program(name, stdin)) for program in (ours, theirs)
            )
            assert ours(name, stdin).splitlines()[:2] == theirs(name, stdin).splitlines()[:2], (arguments, name)
            assert one.shape == other.shape
            input_count = int(stdin.split(b"\n")[1])
            assert (one[:input_count] == other[:input_count]).all()
            assert same_rows(one[input_count:], other[input_count:]), (arguments, name)
            if one.shape[1] == 2:
                continue
            # Simplices look the same way from inside, as sets of coordinates they are the same.
            if all(len(facet) == one.shape[1] for facet in one_facets + other_facets):
                signs = {orientation(points, facet, one[:input_count].mean(0))
                         for points, facets in ((one, one_facets), (other, other_facets)) for facet in facets}  # fmt: skip
                assert len(signs) == 1 and 0 not in signs, (arguments, name, signs)
        assert ours("p", stdin).splitlines()[1] == theirs("p", stdin).splitlines()[1]
        assert sorted(ours("p", stdin).splitlines()[2:]) == sorted(theirs("p", stdin).splitlines()[2:]), arguments
        assert ours("i", stdin).splitlines()[0] == theirs("i", stdin).splitlines()[0], arguments


def test_points_as_cdd_reads_them():
    stdin = points_of("6 c D3 t1")
    for options in ("FD p", "FD p Qi"):
        rows = ours(options, stdin).splitlines()
        if QHULL is not None:
            assert sorted(rows[1:]) == sorted(theirs(options, stdin).splitlines()[1:])
        text = "V-representation\n" + "\n".join(rows[1:]) + "\n"
        points = ours(options.removeprefix("FD "), stdin).splitlines()[2:]
        assert ours("o", text.encode()).splitlines()[2 : 2 + len(points)] == points


def by_facet(text_of_vertices, text, skip):
    keys = [frozenset(row[1:]) for row in rows_of(text_of_vertices, 1)]
    return dict(zip(keys, map(numbers, text.splitlines()[skip:]), strict=True))


def test_offsets_centrums_and_kept_points_are_qhulls():
    if QHULL is None:
        return
    for arguments in ["80 W0 c D3 t1", "c D4", "60 D5 t1", "200 W0 c D4 t1"]:
        stdin = points_of(arguments)
        for name, skip in (("Fo", 2), ("Fi", 2), ("FC", 2), ("FD n", 3)):
            one, other = (program(name, stdin) for program in (ours, theirs))
            if name == "FD n":
                assert one.splitlines()[1:3] == other.splitlines()[1:3] and one.splitlines()[-1] == "end"
                one, other = (text.replace("\nend", "") for text in (one, other))
            one, other = by_facet(ours("Fv", stdin), one, skip), by_facet(theirs("Fv", stdin), other, skip)
            if name == "FC" and "W0" in arguments:
                continue  # Qhull keeps the centrum that a facet had before its last vertices were merged
            assert largest_difference(one, other) < 1e-12, (arguments, name)
        for options in ("Qc", "Qi", "Qci"):
            kept = [{facet: set(map(int, row[1:])) for facet, row in
                     by_facet(program("Fv", stdin), program(f"{options} Fc", stdin), 1).items()}
                    for program in (ours, theirs)]  # fmt: skip
            if options == "Qc":
                assert kept[0] == kept[1], (arguments, options)
            assert set().union(*kept[0].values()) == set().union(*kept[1].values()), (arguments, options)
            counts = [program(f"{options} Fs", stdin).split()[8] for program in (ours, theirs)]
            assert counts[0] == counts[1], (arguments, options, counts)
            points = [sorted(program(f"{options} p", stdin).splitlines()[1:]) for program in (ours, theirs)]
            assert points[0] == points[1], (arguments, options)


def test_fp_names_the_nearest_vertex_of_the_facet():
    stdin = points_of("60 W0 c D3 t1")
    vertices = rows_of(ours("Fv", stdin), 1)
    points = numpy.array([numbers(line) for line in stdin.decode().splitlines()[2:]])
    lines = ours("Qc FP", stdin).splitlines()
    assert int(lines[0]) == len(lines) - 1 == 60
    for line in lines[1:]:
        vertex, point, name = map(int, line.split()[:3])
        facet = name - 1  # as FI calls it
        distances = numpy.linalg.norm(points[vertices[facet][1:]] - points[point], axis=1)
        assert vertex == vertices[facet][1:][distances.argmin()]
        assert abs(float(line.split()[3]) - distances.min()) < 1e-15


def test_fc_and_fp_keep_coplanar_points_without_being_asked():
    stdin = points_of("60 W0 c D3 t1")
    for output in ("Fc", "FP"):
        assert ours(output, stdin) == ours(f"Qc {output}", stdin)
        if QHULL is not None:
            assert ours(output, stdin).splitlines()[0] == theirs(output, stdin).splitlines()[0]


def test_selections_keep_qhulls_facets():
    if QHULL is None:
        return
    for arguments in ["60 D3 t1", "60 D5 t1", "100 s D4 t2"]:
        stdin = points_of(arguments)
        area = sorted(map(float, ours("Fa", stdin).splitlines()[1:]))[-12] * (1 - 1e-9)
        for options in ("PA7", f"PF{area!r}", "Pd0:0.2", "PD1:-.1d0", "Pd0:0.3D0:0.5", "Pd0:0.3 PA3", "Pd0:.99g PG",
                        "PD2:-.5 PA2 PG", "Pd0:.99999 Pg", "Pd0:.99999"):  # fmt: skip
            kept = [set(map(frozenset, (row[1:] for row in rows_of(program(f"{options} Pp Fv", stdin), 1))))
                    for program in (ours, theirs)]  # fmt: skip
            if options != "Pd0:.99999":
                assert kept[0], (arguments, options)
            assert kept[0] == kept[1], (arguments, options, len(kept[0]), len(kept[1]))


def test_scaled_input_is_what_is_printed():
    if QHULL is None:
        return
    for arguments, options in [("60 D4 t1 O3", "QbB"), ("60 D4 t1", "Qb0:-2B0:1 Qb3:0"), ("60 D4 t1", "Qb1:0B1:0"),
                               ("60 D3 t1 O3", "Qbb Qw"), ("60 D5 t1", "Qb0:0B0:0b2:0B2:0")]:  # fmt: skip
        compare(arguments, options)
        stdin = points_of(arguments)
        one, other = (numpy.array([numbers(line) for line in program(f"{options} p", stdin).splitlines()[2:]])
                      for program in (ours, theirs))  # fmt: skip
        assert abs(one - other).max() < 1e-14, (arguments, options)


def outer_planes_hold(points, text):
    """The planes behind FV's point in front, or alone: every point is below them."""
    rows = [numbers(line) for line in text.splitlines()]
    planes = numpy.array([row for row in rows if len(row) == points.shape[1] + 1])
    return len(planes), (points @ planes[:, :-1].T + planes[:, -1]).max()


def test_pipes_run_with_qhull_on_either_side():
    if QHULL is None:
        return
    folder = fresh_folder("pipes")
    recipe = "Qx W1e-1 C1e-2 PA40 FV Fo"
    for arguments in ["300 s D5 t1", "200 D4 t2", "100 s D6 t1"]:
        (folder / "points").write_bytes(points_of(arguments))
        points = numpy.array([numbers(line) for line in (folder / "points").read_text().splitlines()[2:]])
        planes = run("qhull", f"TI {folder}/points {recipe}").stdout
        count, excess = outer_planes_hold(points, planes)
        assert count == 40 and excess <= 1e-14, (arguments, count, excess)
        (folder / "planes").write_text(planes)
        regions = [run("qhalf", f"TI {folder}/planes Tv Fp").stdout, shell(f"{QHALF} TI {folder}/planes Fp")]
        corners = [numpy.array([numbers(line) for line in text.splitlines()[2:]]) for text in regions]
        # The same vertices, though Qhull prints one for each of its simplices.
        for one, other in (corners, corners[::-1]):
            nearest = max(numpy.linalg.norm(other - corner, axis=1).min() / (1 + abs(corner).max()) for corner in one)
            assert nearest < 1e-6, (arguments, nearest)
        # Qhull's approximate planes into ndhull.
        text = shell(f"{QHULL} TI {folder}/points Qx C1e-2 FV Fo | {PROGRAM} qhalf Tv FN Fp")
        assert len(text.splitlines()) > 40
    # ndhull alone, all the way round: the hull of the intersection contains the points.
    volumes = [float(shell(f"{command} FS").split()[-1]) for command in (
        f"{PROGRAM} rbox '300 s D5 t1' | {PROGRAM} qhull",
        f"{PROGRAM} rbox '300 s D5 t1' | {PROGRAM} qhull FV Fo C1e-2 | {PROGRAM} qhalf Fp | {PROGRAM} qhull")]  # fmt: skip
    assert volumes[0] < volumes[1] < 1.3 * volumes[0], volumes


def test_qhalf_is_qhulls_for_simple_and_degenerate_polytopes():
    if QHALF is None:
        return
    for arguments in ["c D3", "d D4", "40 s D3 t1", "60 s D4 t1", "40 D5 t1"]:
        stdin = ours("FV n", points_of(arguments)).encode()
        one, other = (
            {name: program(name) for name in ("Fp", "Fx", "Fs", "FN", "Fv")}
            for program in (
                lambda name, stdin=stdin: run("qhalf", name, stdin=stdin).stdout,
                lambda name, stdin=stdin: shell(f"{QHALF} {name}", stdin),
            )
        )
        assert sorted(one["Fx"].split()[1:]) == sorted(other["Fx"].split()[1:]), arguments
        points = [numpy.array([numbers(line) for line in text.splitlines()[2:]]) for text in (one["Fp"], other["Fp"])]
        assert max(numpy.linalg.norm(points[1] - corner, axis=1).min() for corner in points[0]) < 1e-11
        assert max(numpy.linalg.norm(points[0] - corner, axis=1).min() for corner in points[1]) < 1e-11
        if arguments in ("c D3", "60 s D4 t1", "40 D5 t1"):
            assert one["Fs"].split()[:8] == other["Fs"].split()[:8], (arguments, one["Fs"], other["Fs"])


def test_repeated_formats_are_printed_once():
    points = points_of("12 D3 t1")
    for options in ("Fx Fx", "n n", "Fx n Fx", "n p n p", "FS FS", "Fs Fs", "Fv i Fv", "o o", "FN FV FN FV", "FQ n FQ"):
        assert len(ours(options, points).splitlines()) == len(theirs(options, points).splitlines()), options
    for repeated, once in (("Fx Fx", "Fx"), ("FA n FA n", "FA n"), ("n Fx n p Fx", "n Fx p")):
        assert ours(repeated, points) == ours(once, points), repeated
    rows = shell(f"{QHULL} FV n", points).encode()
    for repeated, once in (("Fp Fp", "Fp"), ("Fv Fx Fv", "Fv Fx")):
        assert run("qhalf", repeated, stdin=rows).stdout == run("qhalf", once, stdin=rows).stdout


def test_halfspaces_of_polygons_go_round_as_qhulls_do():
    def from_zero(text):
        count, *ids = text.split()
        at = ids.index("0") if "0" in ids else 0
        assert int(count) == len(ids) > 3
        return ids[at:] + ids[:at]

    for arguments in ["12 D2 t1", "40 s D2 t2", "15 D2 t3", "9 D2 t4", "c D2", "25 D2 t5 O3"]:
        rows = shell(f"{QHULL} FV n", points_of(arguments)).encode()
        assert from_zero(run("qhalf", "Fx", stdin=rows).stdout) == from_zero(shell(f"{QHALF} Fx", rows)), arguments
    # A side that touches only a corner is redundant, and so is one outside.
    rows = b"3\n6\n-1 0 -1\n1 0 -1\n0 1 -1\n0 -1 -1\n1 1 -2\n1 2 -9\n"
    assert run("qhalf", "Fx", stdin=rows).stdout.split() in (["4", "0", "3", "1", "2"], ["5", "0", "3", "1", "4", "2"])


def test_qhalf_says_why_there_are_no_vertices():
    rows = b"3\n2\n-1 0 0\n0 -1 0\n"
    one_error_line(run("qhalf", "Fp", stdin=rows, exit_code=1), "bad-halfspace")
    one_error_line(run("qhalf", "H5,0 Fp", stdin=ours("n", points_of("c D2")).encode(), exit_code=1), "bad-halfspace")
    with_point = "2 1\n0.25 0\n" + ours("n", points_of("c D2"))
    assert run("qhalf", "H5,0 Fx", stdin=with_point.encode()).stdout == run("qhalf", "Fx", stdin=with_point.encode()).stdout
    one_error_line(run("qhalf", "Fd Fp", stdin=rows, exit_code=1), "bad-header")
    for options in ("FS", "QJ", "C0.1"):
        one_error_line(run("qhalf", options, stdin=rows, exit_code=1), "usage")
    cdd = ours("FD n", points_of("c D3")).encode()
    assert run("qhalf", "Fd Fx", stdin=cdd).stdout.split() == ["6", *"012345"]


def test_refusals_are_one_line_and_write_nothing():
    folder = fresh_folder("refusals")
    points = points_of("10 D3 t1")
    for options in ("Z9", "d Qt", "Fp", "W", f"TO {folder}/x QR3", "TR3 s", "Pd7 n", "Qb9:0 n", "QJ1e-18 n", "Fz"):
        one_error_line(run("qhull", options, stdin=points, exit_code=1), "usage")
    assert not list(folder.iterdir())
    run("qhull", f"TO {folder}/x n Fx", stdin=points)
    assert (folder / "x").read_text() == ours("n Fx", points)


def test_hulls_summary_has_qhulls_lines():
    folder = fresh_folder("summary")
    for arguments in ("c D3", "40 D4 t1", "c d D4"):
        (folder / "points").write_bytes(points_of(arguments))
        mine = run("hull", folder / "points", "--format", "s FA").stdout.splitlines()
        qhulls = run("qhull", "s FA Tz", stdin=points_of(arguments)).stdout.splitlines()
        without_time = [[line for line in lines if not line.startswith(("  CPU", "Statistics"))] for lines in (mine, qhulls)]
        assert without_time[0] == without_time[1] and len(without_time[0]) > 8, (mine, qhulls)
        if QHULL is not None:
            for line in theirs("s FA Tz", points_of(arguments)).splitlines():
                if line.startswith(("Convex", "  Number of vertices", "  Number of facets", "  Number of non-simplicial")):
                    assert line in mine, (arguments, line, mine)
    text = run("hull", folder / "points", "--format", "Fx s FA").stdout  # one summary, where it was asked for
    assert text.count("Number of facets") == text.count("Total volume") == 1 and text.index("Convex") > 8


def test_summary_options_and_joggle():
    points = points_of("c D3")
    summary = ours("", points)
    assert "Number of facets: 6\n" in summary and "Number of vertices: 8\n" in summary
    assert "rbox c D3 | qhull" in summary and "non-simplicial facets: 6\n" in summary
    done = run("qhull", "s FA FO Ts Fx", stdin=points)
    assert done.stdout == ours("Fx", points) and "Total volume:       1\n" in done.stderr
    assert "centrum-radius 0\n" in done.stderr and "insertions" in done.stderr
    assert run("qhull", "s Tz n", stdin=points).stderr == ""
    for options in ("", "s", "Ts", "FO", "Ts s", "FA", "Tz s", "s n", "Ts n"):  # who says it, and where
        mine = run("qhull", options, stdin=points)
        other = subprocess.run([QHULL, *options.split()], input=points, capture_output=True, timeout=PATIENCE,
                               check=True)  # fmt: skip
        for text, qhulls in ((mine.stdout, other.stdout), (mine.stderr, other.stderr)):
            assert ("Number of vertices: 8\n" in text) == (b"Number of vertices: 8\n" in qhulls), options
    assert ours("FQ", points) == "rbox c D3 | qhull FQ\n"
    printed = run("qhull", "FQ p", stdin=points).stdout.encode()
    for text in (b"my points\n" + points, points + b"my points\n", printed):
        assert ours("Fx", text) == ours("Fx", points)
    assert ours("FQ", b"my points \n" + points) == "my points | qhull FQ\n"
    joggled = run("qhull", "QJ1e-6 TR50 s Fs Tv", stdin=points)
    assert "Input joggled by: 1e-06\n" in joggled.stderr and "precision errors: 0.0\n" in joggled.stderr
    counts, widths = (numbers(line) for line in joggled.stdout.splitlines())
    assert counts[4] == 12 and counts[8] == 0 and 1e-6 < widths[1] < 1.8e-6 and -1.8e-6 < widths[2] < -1e-6
    assert run("qhull", "TF20", stdin=points_of("100 D5 t1")).stderr.count("growth") >= 1


if __name__ == "__main__":
    run_tests(globals())
