#!/usr/bin/env python3
"""ndhull extreme: the vertices against linear programs of SciPy's and the hull's, the chosen few, the refusals."""

import json

import numpy
from program import DIAMONDS, fresh_folder, one_error_line, rbox, run, run_tests


def extreme(*arguments, **keywords):
    return json.loads(run("extreme", *arguments, "--report", "-", **keywords).stdout)


try:
    from scipy.optimize import linprog
except ModuleNotFoundError:  # the exact programs of rays_test remain
    linprog = None


def is_vertex_by_linear_program(points, row):
    """Is there no combination of the other points that gives this one?"""
    others = numpy.delete(points, row, axis=0)
    equations = numpy.vstack([others.T, numpy.ones(len(others))])
    answer = linprog(numpy.zeros(len(others)), A_eq=equations, b_eq=numpy.append(points[row], 1.0), method="highs")
    return answer.status == 2


def test_agrees_with_independent_linear_programs():
    if linprog is None:
        print("skipped: no SciPy")
        return
    folder = fresh_folder("extreme_scipy")
    path, vertices = folder / "points.npy", folder / "vertices.npy"
    for shape in ((150, 6), (60, 12)):
        points = numpy.random.default_rng(shape[1]).normal(size=shape)
        points[shape[0] // 2 :] *= 0.6
        numpy.save(path, points)
        run("extreme", path, "--vertices", vertices, "--verify")
        expected = [row for row in range(len(points)) if is_vertex_by_linear_program(points, row)]
        assert numpy.load(vertices).tolist() == expected, shape


def test_agrees_with_the_hull_and_planes_part():
    folder = fresh_folder("extreme_hull")
    points, ours, hulls, planes = (folder / name for name in ("points.npy", "a.npy", "b.npy", "planes.npy"))
    rbox("2000 D6 t1", points)
    for path in (points, DIAMONDS):
        run("extreme", path, "--vertices", ours, "--planes", planes, "--verify")
        run("hull", path, "--vertices", hulls)
        x = numpy.load(path).astype(float)
        assert (x[numpy.load(ours)] == x[numpy.load(hulls)]).all()
        rows = numpy.load(planes)
        values = x @ rows[:, :-1].T + rows[:, -1]
        assert ((values > 0).sum(axis=0) == [(x == x[v]).all(axis=1).sum() for v in numpy.load(ours)]).all()
        assert (values[numpy.load(ours), range(len(rows))] > 0).all()


def test_keep():
    folder = fresh_folder("extreme_keep")
    path, chosen, distances = folder / "points.npy", folder / "chosen.npy", folder / "distances.npy"
    rbox("1000 D7 t1", path)
    report = extreme(path, "--keep", 40, "--vertices", chosen, "--distances", distances)
    kept = report["kept"]
    assert kept["count"] == 40 and kept["points"] == numpy.load(chosen).tolist()
    assert kept["distances"] == sorted(kept["distances"], reverse=True)
    found = numpy.load(distances)
    assert found.shape == (1000,) and kept["max_distance_at_least"] <= found.max() <= kept["max_distance"]
    assert found[numpy.load(chosen)].max() < 1e-12
    again = extreme(path, "--keep", 40, "--threads", 1)
    assert again["kept"] == kept
    text = run("extreme", path, "--keep", 5).stdout
    assert "every point is within" in text and "vertices" in text, text


def test_keep_proves_nothing_of_points_not_looked_at():
    folder = fresh_folder("extreme_limit")
    path, distances = folder / "points.npy", folder / "distances.npy"
    x = numpy.random.default_rng(1).normal(size=(30_000, 5))
    numpy.save(path, x / numpy.linalg.norm(x, axis=1)[:, None])
    limited = (path, "--keep", 2500, "--max-seconds", 0.05)
    report = extreme(*limited)
    kept = report["kept"]
    assert report["status"] == "time_limit" and (kept is None or kept["max_distance"] is kept["distances"] is None)
    assert "every point is within" not in run("extreme", *limited).stdout
    # Measured, it is known; of no points all are infinitely far.
    for seconds in (0.05, 1e-6):
        report = extreme(path, "--keep", 5, "--max-seconds", seconds, "--distances", distances)
        found = numpy.load(distances)
        assert found.shape == (30_000,)
        if report["kept"] is None:
            assert (found == numpy.inf).all()
        else:
            assert report["kept"]["max_distance"] == found.max() > 0.5


def test_bad_usage():
    folder = fresh_folder("extreme_bad")
    path = folder / "points.npy"
    numpy.save(path, numpy.eye(4))
    for words in (["--keep", "0"], ["--keep", "many"], ["--distances", "x.npy"], ["--max-seconds", "0"]):
        one_error_line(run("extreme", path, *words, exit_code=1), "usage")
    one_error_line(run("extreme", folder / "none.npy", exit_code=1), "file-missing")
    numpy.save(path, numpy.eye(4) * 1e-310)  # so small that no decision is clear
    one_error_line(run("extreme", path, exit_code=1), "out-of-range")


if __name__ == "__main__":
    run_tests(globals())
