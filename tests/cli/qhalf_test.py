#!/usr/bin/env python3
"""ndhull qhalf beside Qhull's: intersections without end, and where the summary goes."""

import shutil
import subprocess

import numpy
from program import PATIENCE, one_error_line, run, run_tests

QHALF = shutil.which("qhalf")
NOWHERE = -10.101  # qh_INFINITE


def theirs(options, stdin):
    done = subprocess.run([QHALF, *options.split()], input=stdin, capture_output=True, timeout=PATIENCE, check=True)
    return done.stdout.decode(), done.stderr.decode()


def ours(options, stdin):
    done = run("qhalf", options, stdin=stdin)
    return done.stdout, done.stderr


def rows_of(text, skip):
    return [[float(word) for word in line.split()] for line in text.splitlines()[skip:]]


def text_of(halfspaces):
    lines = [f"{halfspaces.shape[1]}", f"{len(halfspaces)}"]
    return ("\n".join(lines + [" ".join(repr(float(value)) for value in row) for row in halfspaces]) + "\n").encode()


def open_halfspaces(dimension, count, seed):
    """Halfspaces about the origin, none of which ends the region along the first axis."""
    normals = numpy.random.default_rng(seed).normal(size=(count, dimension))
    normals = normals[normals[:, 0] <= 0]
    return numpy.column_stack([normals, numpy.full(len(normals), -1.0)])


def places(text, skip=2):
    """Points, and how many of them are nowhere."""
    rows = numpy.array(rows_of(text, skip))
    is_open = (rows == NOWHERE).all(axis=1)
    return rows[~is_open], int(is_open.sum())


def same_rows(one, other):
    return sorted(map(tuple, map(sorted, one))) == sorted(map(tuple, map(sorted, other)))


def test_intersections_without_end_are_qhulls():
    if QHALF is None:
        return
    for dimension, count in ((2, 24), (3, 50), (4, 50), (5, 50), (6, 40)):
        for seed in range(3):
            halfspaces = open_halfspaces(dimension, count, seed)
            stdin = text_of(halfspaces)
            about = "H" + ",".join(["0"] * dimension)
            (one, one_open), (other, other_open) = (
                places(program(f"{about} Fp", stdin)[0]) for program in (ours, theirs)
            )
            assert one_open == other_open > 0 and len(one) == len(other), (dimension, seed, one_open, other_open)
            for point in one:
                nearest = numpy.abs(other - point).max(axis=1).min()
                assert nearest < 1e-9 * (1 + numpy.abs(point).max()), (dimension, seed, nearest)
            for name in ("Fv", "Fx", "i"):
                mine, qhulls = (rows_of(program(f"{about} {name}", stdin)[0], 1) for program in (ours, theirs))
                if name == "Fv":
                    mine, qhulls = ([row[1:] for row in rows] for rows in (mine, qhulls))
                assert same_rows(mine, qhulls), (dimension, seed, name)
            counts = [program(f"{about} Fs", stdin)[0].split()[:9] for program in (ours, theirs)]
            assert counts[0] == counts[1], (dimension, seed, counts)
            # Fn and FN belong to the points of the same run.
            vertices = [set(row[1:]) for row in rows_of(ours(f"{about} Fv", stdin)[0], 1)]
            for row, of_row in zip(rows_of(ours(f"{about} Fn", stdin)[0], 1), vertices, strict=True):
                assert all(len(of_row & vertices[int(other)]) >= dimension - 1 for other in row[1:])
            for halfspace, row in enumerate(rows_of(ours(f"{about} FN", stdin)[0], 1)):
                assert {int(at) for at in row[1:]} == {at for at, ids in enumerate(vertices) if halfspace in ids}


def test_a_point_through_which_infinity_is_seen_edge_on():
    # A half of a square tube: the facet of the dual through the origin is open, too.
    stdin = b"4 5\n1 0 0 -1\n0 1 0 -1\n0 0 1 -1\n-1 0 0 -1\n0 -1 0 -1\n"
    corners, nowhere = places(ours("H0,0,0 Fp Tv", stdin)[0])
    assert nowhere == 1 and sorted(map(tuple, corners)) == [(-1, -1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, 1)]
    said = run("qhalf", "Fp", stdin=stdin).stderr  # about a point that is found
    assert said.count("\n") == 1 and said.startswith("ndhull: warning: ") and "1 of 5" in said, said
    assert run("qhalf", "Fp Pp", stdin=stdin).stderr == ""
    assert "  Number of these at infinity: 1\n" in run("qhalf", "", stdin=stdin).stdout


def test_what_has_no_dual_hull_is_an_error():
    for stdin in (b"3\n2\n-1 0 0\n0 -1 0\n", b"4 3\n1 0 0 -1\n0 1 0 -1\n0 0 1 -1\n", b"3 4\n1 0 -1\n-1 0 -1\n1 0 -2\n-1 0 -3\n"):
        done = run("qhalf", "Fp", stdin=stdin, exit_code=1)
        one_error_line(done, "bad-halfspace")
        assert "unbounded along" in done.stderr and "in general position" in done.stderr, done.stderr
    done = run("qhalf", "Fp", stdin=b"2 2\n1 1\n-1 1\n", exit_code=1)
    one_error_line(done, "bad-halfspace")
    assert "is empty" in done.stderr and "inside all" in done.stderr, done.stderr


def test_the_summary_goes_where_qhulls_goes():
    if QHALF is None:
        return
    bounded = b"3 4\n1 0 -1\n-1 0 -1\n0 1 -1\n0 -1 -1\n"
    pyramid = b"4 5\n1 0 1 -1\n-1 0 1 -1\n0 1 1 -1\n0 -1 1 -1\n0 0 -1 -1\n"
    for stdin in (bounded, text_of(open_halfspaces(2, 12, 1)), pyramid):
        about = "H0,0,0" if stdin == pyramid else "H0,0"
        for options in ("", "s", "s Fx", "Fx", "s Tz", "s Fx Tz", "Ts", "Ts Fx"):
            mine, qhulls = ours(f"{options} {about} Pp", stdin), theirs(f"{options} {about} Pp", stdin)
            for one, other in zip(mine, qhulls, strict=True):
                lines = [[line for line in text.splitlines() if "Number of non-simplicial" in line] for text in (one, other)]
                assert lines[0] == lines[1], (options, lines)
                assert ("Number of halfspaces" in one) == ("Number of halfspaces" in other), (options, mine, qhulls)


def test_refusals_name_options_of_qhalf():
    stdin = b"3 4\n1 0 -1\n-1 0 -1\n0 1 -1\n0 -1 -1\n"
    for options in ("FF", "f", "G", "m", "FM", "d", "v", "Qu", "Qz", "QG0", "QV0", "QR3", "R1e-3", "TC2", "TA3", "T4", "TP1",
                    "zz", "W", "FS", "n"):  # fmt: skip
        done = run("qhalf", options, stdin=stdin, exit_code=1)
        one_error_line(done, "usage")
        assert "qhalf options: found" in done.stderr and "expected" in done.stderr, done.stderr
        remedy = done.stderr.split("; ", 1)[1]
        assert "qhull" not in remedy and "ndhull hull" not in remedy, remedy
        for name in ("n", "Fo", "Fa", "FS", "TFn", "Ts"):
            assert name not in remedy.replace(",", " ").split(), remedy


if __name__ == "__main__":
    run_tests(globals())
