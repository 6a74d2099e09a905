#!/usr/bin/env python3
"""What pipes written for Qhull trip over: headers, the order of lines, names of facets, the way round polygons."""

import shutil
import subprocess

import numpy
from program import PATIENCE, fresh_folder, one_error_line, run, run_tests

QHULL, QHALF = shutil.which("qhull"), shutil.which("qhalf")
SQUARE = {(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)}


def theirs(program, options, stdin):
    done = subprocess.run([program, *options.split()], input=stdin, capture_output=True, timeout=PATIENCE, check=True)
    return done.stdout.decode()


def points(arguments):
    return run("rbox", arguments).stdout.encode()


def integers(text):
    return [[int(word) for word in line.split()] for line in text.splitlines()]


def test_headers_are_read_as_qhull_reads_them():
    # All on one line, points behind the count, a comment between: the first two integers are the header.
    for text in (b"2 4 0 0 1 0 0 1 1 1\n", b"2\n4 0 0\n1 0\n0 1 1 1\n", b"2 4 0 0\n1 0\n0 1\n1 1\n",
                 b"2 square\n# corners\n4\n0 0 1 0\n0 1\n1 1\n"):  # fmt: skip
        lines = run("qhull", "p", stdin=text).stdout.splitlines()
        assert lines[:2] == ["2", "4"], (text, lines)
        assert {tuple(map(float, line.split())) for line in lines[2:]} == SQUARE, (text, lines)
    # A count that is not true is no point.
    for text in (b"2 4\n0 0\n1 0\n0 1\n", b"2 1000\n" + b"0 0\n1 0\n0 1\n" * 33, b"3 4\n"):
        one_error_line(run("qhull", "Fx", stdin=text, exit_code=1), "wrong-count")
    # A table of decimals has no header, nor is this one for ndhull's own commands.
    assert run("qhull", "Fx", stdin=b"0.5 1\n2 4\n3 1\n").stdout.splitlines()[0] == "3"
    assert run("hull", "-", "--format", "Fx", stdin=b"2 4\n0 0\n1 0\n0 1\n").stdout.splitlines()[0] == "4"


def test_interior_points_may_stand_anyhow():
    box = b"4\n6\n0 0 1 -.5\n0 0 -1 -.5\n0 1 0 -.5\n0 -1 0 -.5\n1 0 0 -.5\n-1 0 0 -.5\n"
    wanted = run("qhalf", "Fp", stdin=b"3 1\n0 0 .1\n" + box).stdout
    for head in (b"3\n1\n0 0 .1\n", b"3 1 0 0 .1\n", b"3\n1 0\n0 .1\n"):
        assert run("qhalf", "Fp", stdin=head + box).stdout == wanted, head


def test_file_names_with_blanks_as_the_shell_hands_them_on():
    folder = fresh_folder("qhull pipes")
    (folder / "a cube").write_bytes(points("c"))
    for words in (("TI", folder / "a cube", "Fx", "TO", folder / "its corners"),
                  (f"TI '{folder}/a cube' Fx TO '{folder}/its corners'",)):  # fmt: skip
        (folder / "its corners").unlink(missing_ok=True)
        run("qhull", *words)
        assert (folder / "its corners").read_text() == run("qhull", "Fx", stdin=points("c")).stdout


def test_the_summary_stands_before_the_formats():
    lines = run("qhull", "Tz s Fx", stdin=points("c")).stdout.splitlines()
    assert "Convex hull of 8 points" in lines[1] and lines[-9:] == ["8", *map(str, range(8))], lines
    for options, has_area in (("Fx", False), ("Fa", True), ("FS", True), ("PA3 Fx", True), ("PF0.1 Fx", True)):
        text = run("qhull", f"Tz Pp s {options}", stdin=points("c")).stdout
        assert ("facet area:" in text) == has_area, (options, text)
    box = run("qhull", "FV n", stdin=points("c")).stdout.encode()
    lines = run("qhalf", "Tz s Fx", stdin=box).stdout.splitlines()
    assert "Halfspace intersection" in lines[1] and lines[-7:] == ["6", *map(str, range(6))], lines


def test_facets_that_are_not_printed_have_the_names_of_fi():
    stdin = points("c P0,0,0.5 P0.1,0.2,0.5 D3")
    names = [row[0] for row in integers(run("qhull", "FI", stdin=stdin).stdout)[1:]]
    assert sorted(names) == list(range(1, 7)), names
    lines = integers(run("qhull", "PA2 Pp FI Fn", stdin=stdin).stdout)
    printed, neighbours = {row[0] for row in lines[1:3]}, lines[4:]
    assert lines[0] == [2] and lines[3] == [2] and len(printed) == 2
    hidden = {-name for row in neighbours for name in row[1:] if name < 0}
    assert hidden and hidden <= set(names) - printed, (hidden, printed)
    # Coplanar points are those of some facet, printed or not.
    whole, some = (integers(run("qhull", options, stdin=stdin).stdout) for options in ("Qc FN", "Qc PD2:-0.9 Pp FN"))
    ours = integers(run("qhull", "Qc PD2:-0.9 Pp FI", stdin=stdin).stdout)[1:]
    for point in (0, 1):  # rbox puts them first
        (count, facet), (its_count, its) = whole[point + 1], some[point + 1]
        assert count == its_count == 1 and -its == names[facet] and [-its] not in ours, (whole[point + 1], some[point + 1])


def test_merged_polygons_go_once_round():
    # Each side of a polygon is the side of one other, the other way round.
    for arguments, options in (("60 s D3 t1", "C0.08"), ("200 s D3 t1", "C0.05"), ("100 s D3 t2", "A-0.95")):
        polygons = integers(run("qhull", f"{options} i", stdin=points(arguments)).stdout)[1:]
        sides = [(row[k], row[(k + 1) % len(row)]) for row in polygons for k in range(len(row))]
        assert len(set(sides)) == len(sides) and {(b, a) for a, b in sides} == set(sides), (arguments, polygons)
        assert max(map(len, polygons)) > 3
        off = run("qhull", f"{options} o", stdin=points(arguments)).stdout.splitlines()
        assert [list(map(int, line.split()[1:])) for line in off[-len(polygons) :]] == polygons
    edges = integers(run("qhull", "C0.08 i", stdin=points("20 s D2 t1")).stdout)[1:]
    assert all(len(edge) == 2 for edge in edges) and {a for a, _ in edges} == {b for _, b in edges}, edges


def test_halfspaces_at_vertices_are_oriented():
    for arguments in ("c D2", "d D3", "c D3", "c D4", "c D5", "20 s D3 t2", "12 r D2"):
        planes = run("qhull", "FV n", stdin=points(arguments)).stdout.encode()
        lines = planes.decode().splitlines()
        rows = numpy.array([list(map(float, line.split())) for line in lines[4:]])
        dimension = rows.shape[1] - 1
        normals = rows[:, :dimension]

        def signs(of_vertices, dimension=dimension, normals=normals):
            found = set()
            for ids in of_vertices:
                if len(ids) != dimension and dimension != 3:
                    continue  # in 4-d and up such vertices have no one way round
                for k in range(len(ids) - dimension + 1):
                    found.add(numpy.sign(numpy.linalg.det(normals[ids[k : k + dimension]])))
            return found

        mine = integers(run("qhalf", "i", stdin=planes).stdout)[1:]
        assert len(signs(mine)) == 1, (arguments, mine)
        if QHALF is not None and dimension < 4:
            qhulls = integers(theirs(QHALF, "i", planes))[1:]
            assert signs(qhulls) == signs(mine), (arguments, mine, qhulls)
            assert sorted(map(sorted, qhulls)) == sorted(map(sorted, mine))
        # Of a simple vertex the i-th neighbour is opposite the i-th halfspace.
        vertices, neighbours = (integers(run("qhalf", name, stdin=planes).stdout)[1:] for name in ("Fv", "Fn"))
        for (count, *ids), (others, *beside) in zip(vertices, neighbours, strict=True):
            if count != dimension or others != dimension:
                continue
            for halfspace, other in zip(ids, beside, strict=True):
                assert set(ids) - set(vertices[other][1:]) == {halfspace}, (arguments, ids, beside)


if __name__ == "__main__":
    run_tests(globals())
