#!/usr/bin/env python3
"""The commands of Qhull's manual page "Imprecision in Qhull": no point outside, no wide facet, identity pipes.

Qhull merges facets there that become wider than it can explain, or ends with an error; where a triangulation of points in
the plane is asked for, the points are lifted to a paraboloid, whose lower hull it is.
"""

import numpy

from program import PROGRAM, fresh_folder, report_of, run, run_tests

# rbox, qhull, is it lifted, and by how much the data themselves are rough: W1e-13 puts points that far from a face.
COMMANDS = [
    ("1000 W0", "Qb2:-1e-14B2:1e-14", False, 0),
    ("10000 W1e-13", "Q6", False, 1e-13),
    ("1000 L100000 s G1e-16 t1002074964", "Q10", False, 0),
    ("s 5000 W1e-13 D2 t1002151341", "Qt", True, 1e-13),
    ("s 1000 W1e-13 P0 D2 t996799242", "", True, 1e-13),
    ("1000 s Z1 G1e-13 t1002152123", "", False, 1e-13),
    ("1000 s Z1 G1e-13 t1002231668", "", False, 1e-13),
    ("1000 s W1e-13 c G2", "", False, 1e-13),
    *((f"1000 C1,1e-13 D4 s t{seed}", "", False, 1e-13) for seed in (1, 2, 3)),
    *((f"75 C1,1e-13 t{seed}", "", False, 1e-13) for seed in (1, 2, 3)),
    ("75 C1,1e-13 D2 t1", "Qt", True, 1e-13),
]
# A wide facet of Qhull's is one of more than a hundred of its roundoffs. Twenty of ours are less.
ROUNDOFFS = 20


def points_of(arguments, is_lifted):
    text = run("rbox", arguments).stdout
    if not is_lifted:
        return text.encode()
    rows = numpy.array([line.split() for line in text.splitlines()[2:]], dtype=float)
    rows = numpy.column_stack([rows, (rows**2).sum(1)])
    lines = [str(rows.shape[1]), str(len(rows)), *(" ".join(map(repr, map(float, row))) for row in rows)]
    return ("\n".join(lines) + "\n").encode()


def width_of(options, points):
    """Of the widest offsets, after the hull was checked."""
    done = run("qhull", f"{options} Tv Fs", stdin=points)
    assert done.stderr == "", done.stderr
    counts, offsets = done.stdout.splitlines()
    outer, inner = map(float, offsets.split()[1:])
    return int(counts.split()[4]), outer - inner


def test_every_command_of_the_manual_page_leaves_no_point_outside_and_no_wide_facet():
    for arguments, options, is_lifted, roughness in COMMANDS:
        points = points_of(arguments, is_lifted)
        facets, width = width_of(options, points)
        report = report_of("-", stdin=points)
        assert report["points_outside"] == 0 and report["status"] == "complete", arguments
        limit = max(roughness, ROUNDOFFS * report["roundoff"])
        assert 0 < width <= limit, (arguments, width, limit)
        if "Qb" not in options:
            assert facets == report["facets"] or options == "Qt", (arguments, facets, report["facets"])
            assert report["max_facet_width"] <= limit, (arguments, report["max_facet_width"], limit)
        print(f"{arguments} | {options}: {facets} facets, width {width:.2g}, roundoff {report['roundoff']:.2g}")


def test_the_lower_hull_of_lifted_points_is_their_triangulation():
    points = points_of("s 5000 W1e-13 D2 t1002151341", True)
    count, width = width_of("Qt", points)
    lower = run("qhull", "Qt PD2:0 i", stdin=points).stdout.splitlines()
    triangles = numpy.array([line.split() for line in lower[1:]], dtype=int)
    # All points are on the circle nearly: a triangulation of a convex polygon has n - 2 triangles.
    assert len(triangles) == 4998 and set(triangles.ravel()) == set(range(5000)), len(triangles)
    assert count == 2 * 4998 and width < 1e-13


def test_planes_of_exact_hulls_intersect_in_the_points():
    """The manual's identity pipes: qhull FV n | qhull H Fp."""
    folder = fresh_folder("identity")
    for arguments, tolerance in [("100 s", 1e-12), ("100 L1e5 t1", 1e-9), ("100 s O10", 1e-11), ("100 s D4", 1e-12),
                                 ("100 s O10 D4", 1e-11), ("100 s D5", 1e-12), ("100 s D5 O10", 1e-11)]:  # fmt: skip
        (folder / "points").write_bytes(points_of(arguments, False))
        (folder / "planes").write_text(run("qhull", f"TI {folder}/points FV n").stdout)
        text = run("qhalf", f"TI {folder}/planes Tv Fp").stdout
        corners = numpy.array([line.split() for line in text.splitlines()[2:]], dtype=float)
        vertices = run("qhull", f"TI {folder}/points p").stdout
        vertices = numpy.array([line.split() for line in vertices.splitlines()[2:]], dtype=float)
        assert corners.shape == vertices.shape, (PROGRAM, arguments, corners.shape, vertices.shape)
        distances = numpy.linalg.norm(corners[:, None] - vertices[None], axis=2)
        assert max(distances.min(0).max(), distances.min(1).max()) < tolerance, (arguments, distances.min(0).max())


if __name__ == "__main__":
    run_tests(globals())
