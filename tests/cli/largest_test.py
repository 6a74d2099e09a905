#!/usr/bin/env python3
"""ndhull largest: what it writes, what it refuses, and that it agrees with ndhull hull."""

import json

import numpy
from program import DIAMONDS, fresh_folder, one_error_line, rbox, report_of, run, run_tests


def largest(*arguments, **keywords):
    return json.loads(run("largest", *arguments, "--report", "-", **keywords).stdout)


def hull_areas(path, count):
    facets = report_of(path, "--facet-list")["facet_list"]
    return sorted((facet["area"] for facet in facets), reverse=True)[:count]


def test_default_is_the_whole_hull_where_that_can_be_built():
    folder = fresh_folder("largest_default")
    for name in ("500 s D5 t1", "200 D6 t2", "c D7"):
        path = folder / "points.npy"
        rbox(name, path)
        report = largest(path, "-n", 12)
        assert report["method"] == "hull" and report["status"] == "complete", name
        assert report["sample"] is None
        assert [facet["area"] for facet in report["largest"]] == hull_areas(path, 12), name
    report = largest(DIAMONDS, "-n", 20)
    assert report["method"] == "hull"
    assert [facet["area"] for facet in report["largest"]] == hull_areas(DIAMONDS, 20)


def test_rays_report_what_they_prove():
    folder = fresh_folder("largest_rays")
    path = folder / "points.npy"
    rbox("300 s D6 t1", path)
    report = largest(path, "-n", 15, "--method", "rays", "--rays", 3000, "--seed", 4, "--facet-list")
    sample = report["sample"]
    assert report["method"] == "rays" and report["status"] == "ray_limit"
    assert sample["rays"] == 3000 and sample["open_rays"] == 0 and sample["directions"] == "input"
    assert 0 < sample["unseen_share"] < 0.01 and 0 < sample["recall_estimate"] <= 1
    # At most 1 / x facets have a share of x, each missed with probability (1 - x)^rays.
    share = sample["unseen_share"]
    assert abs((1 - share) ** 3000 / share - 0.05) < 1e-9
    assert len(report["largest"]) == len(report["facet_list"]) == 15
    for short, full in zip(report["largest"], report["facet_list"]):
        assert short["area"] == full["area"] and short["origin"] in ("ray", "climb")
        assert (short["hits"] > 0) == (short["origin"] == "ray")
        assert short["share_interval"][0] <= short["share"] <= short["share_interval"][1]
        assert len(full["vertices"]) == 6 and full["outer_offset"] >= 0 >= full["inner_offset"]
    areas = hull_areas(path, 15)
    assert abs(report["largest_area"] - areas[0]) <= 1e-9 * areas[0]
    again = largest(path, "-n", 15, "--method", "rays", "--rays", 3000, "--seed", 4, "--threads", 1, "--facet-list")
    assert again["facet_list"] == report["facet_list"]


def test_planes_hold_and_bound():
    folder = fresh_folder("largest_planes")
    path, planes, vertices = folder / "points.npy", folder / "planes.npy", folder / "vertices.npy"
    numpy.save(path, numpy.random.default_rng(1).normal(size=(3000, 12)).astype(numpy.float32))
    options = ["-n", 5, "--rays", 30, "--planes", planes, "--vertices", vertices, "--verify"]
    report = largest(path, *options)
    assert report["selected"] == {"facets": 5, "bounded": False}
    assert report["verification"] == {"pairs": 15000, "above": 0}
    report = largest(path, *options, "--bounded")
    count = report["selected"]["facets"]
    assert report["selected"]["bounded"] and count >= 13
    assert {facet["origin"] for facet in report["largest"][5:]} == {"bound"}
    rows = numpy.load(planes)
    assert rows.shape == (count, 13)
    run("verify", path, planes)
    points = numpy.load(path).astype(float)
    assert (points @ rows[:, :-1].T + rows[:, -1]).max() <= 0
    ids = numpy.load(vertices)
    assert (numpy.diff(ids) > 0).all() and len(ids) <= 12 * count
    inner = folder / "inner.npy"
    run("largest", path, "-n", 5, "--rays", 30, "--planes", inner, "--plane-kind", "inner", "--quiet")
    assert (numpy.load(inner)[:, -1] >= rows[:5, -1]).all()


def test_min_area_and_summary():
    folder = fresh_folder("largest_area")
    path = folder / "points.npy"
    rbox("100 s D4 t1", path)
    areas = hull_areas(path, 30)
    report = largest(path, "-n", 30, "--min-area", repr(areas[9]))
    assert report["facets"] == 10 and report["smallest_area"] == areas[9]
    text = run("largest", path, "-n", 3, "--method", "rays").stdout
    assert "unseen" in text and "95 % confidence" in text and "estimated recall" in text, text


def test_formats_are_those_of_the_selection_of_hull():
    folder = fresh_folder("largest_formats")
    path = folder / "points.txt"
    for name in ("60 s D4 t1", "50 D5 t2", "c D4"):
        rbox(name, path)

        def rows(command, option, form, path=path):
            lines = run(command, path, option, 6, "--format", form).stdout.splitlines()
            return sorted([float(word) for word in line.split()] for line in lines)

        for form in ("n", "Fo", "Fi", "FV", "Fx", "Fa", "FC", "p", "Fv"):
            one, other = rows("largest", "-n", form), rows("hull", "--largest", form)
            assert [len(row) for row in one] == [len(row) for row in other], (name, form)
            if form == "Fv":
                one, other = ({tuple(sorted(row)) for row in kind if len(row) > 1} for kind in (one, other))
                assert one == other, name
            elif name != "c D4":  # its facets are equally large, and any may be taken
                assert all(numpy.abs(numpy.subtract(a, b)).max() < 1e-12 for a, b in zip(one, other)), (name, form)
    # In one run all formats are of the same facets, the largest first.
    text = run("largest", path, "-n", 3, "--method", "rays", "--format", "Fa,n s").stdout
    assert text.startswith("3\n") and text.splitlines()[4:6] == ["5", "3"] and "areas " in text, text
    for form in ("Fn", "i", "FS", "zz", ""):
        one_error_line(run("largest", path, "--format", form, exit_code=1), "usage")
    for form in ("Zz", "Fn"):  # no command has the first, ndhull hull has the other
        done = run("largest", path, "--format", form, exit_code=1)
        assert f'"{form}"' in done.stderr and "expected some of n Fo Fi FV Fx Fv Fa FC p s; " in done.stderr, done.stderr
    one_error_line(run("largest", path, "--format", "n", "--report", "-", exit_code=1), "usage")


def test_limits_end_with_a_result():
    folder = fresh_folder("largest_limits")
    path = folder / "points.npy"
    numpy.save(path, numpy.random.default_rng(2).normal(size=(20000, 14)))
    report = largest(path, "-n", 10, "--max-seconds", 0.5)
    assert report["status"] == "time_limit" and report["facets"] == 10
    report = largest(path, "-n", 10, "--method", "hull", "--max-facets", 5000)
    assert report["status"] == "facet_limit" and report["facets"] == 10


def test_bad_usage():
    folder = fresh_folder("largest_bad")
    path = folder / "points.npy"
    numpy.save(path, numpy.eye(4))
    for words in (["-n", "0"], ["--method", "guess"], ["--min-area", "nan"], ["--rays", "-1"], ["--plane-kind", "mean"]):
        one_error_line(run("largest", path, *words, exit_code=1), "usage")
    numpy.save(path, numpy.random.default_rng(2).normal(size=(100, 70)))
    one_error_line(run("largest", path, exit_code=1), "dimension-too-high")
    one_error_line(run("largest", folder / "none.npy", exit_code=1), "file-missing")


if __name__ == "__main__":
    run_tests(globals())
