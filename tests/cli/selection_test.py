#!/usr/bin/env python3
"""ndhull hull --largest, --min-area, --most-merged, --bounded: what is written, and what is said of it."""

import json

import numpy
from program import DIAMONDS, PATIENCE, fresh_folder, one_error_line, rbox, report_of, run, run_tests


def all_facets(path, *options):
    return report_of(path, "--facet-list", *options)["facet_list"]


def rank_of(rows):
    return numpy.linalg.matrix_rank(numpy.array(rows))


def test_a_summary_is_text_like_the_other_formats():
    folder = fresh_folder("summary")
    rbox("100 s D3 t1", folder / "points.npy")
    for formats, areas in (("s", 0), ("FA", 1), ("n,s,FA", 1)):
        text = run("hull", folder / "points.npy", "--format", formats, "--quiet").stdout
        assert text.count("Number of vertices: 100") == 1 and text.count("Total facet area:") == areas, text


def test_every_output_has_the_selected_facets_and_no_others():
    folder = fresh_folder("outputs")
    rbox("300 s D4 t1", folder / "points.npy")
    whole = all_facets(folder / "points.npy")
    areas = numpy.array([facet["area"] for facet in whole])
    expected = sorted(numpy.argsort(-areas)[:7].tolist())
    report = report_of(folder / "points.npy", "--largest", 7, "--facet-list", "--planes", folder / "mean.npy",
                       "--plane-kind", "mean", "--vertices", folder / "v.npy")  # fmt: skip
    assert report["facets"] == len(whole) and report["selected"]["facets"] == 7
    assert report["options"]["largest"] == 7 and report["options"]["bounded"] is False
    ids = [facet.pop("id") for facet in report["facet_list"]]
    assert ids == expected, (ids, expected)
    assert report["facet_list"] == [whole[row] for row in expected]
    rows = [whole[row]["normal"] + [whole[row]["offset"]] for row in expected]
    assert numpy.load(folder / "mean.npy").tolist() == rows
    assert len(numpy.load(folder / "v.npy")) == report["vertices"] == 300
    lines = run("hull", folder / "points.npy", "--largest", 7, "--format", "n Fa Fs").stdout.splitlines()
    assert lines[:2] == ["5", "7"] and len(lines) == 2 + 7 + 1 + 7 + 2
    assert numpy.allclose(numpy.array([line.split() for line in lines[2:9]], dtype=float), rows, rtol=0, atol=1e-15)
    assert numpy.allclose([float(line) for line in lines[10:17]], areas[expected], rtol=1e-14)
    assert lines[17].split()[4] == str(len(whole)) and lines[17].split()[6] == "7", lines[17]


def test_options_are_intersected():
    whole = all_facets(DIAMONDS)
    area = numpy.array([facet["area"] for facet in whole])
    limit = float(numpy.sort(area)[-40])
    chosen = {name: {facet["id"] for facet in all_facets(DIAMONDS, *options)}
              for name, options in [("largest", ["--largest", 60]), ("area", ["--min-area", repr(limit)]),
                                    ("merged", ["--most-merged", 5000]),
                                    ("all", ["--largest", 60, "--min-area", repr(limit), "--most-merged", 5000])]
              }  # fmt: skip
    assert [len(chosen[name]) for name in ("largest", "area", "merged")] == [60, 40, 5000]
    assert chosen["area"] == set(numpy.nonzero(area >= limit)[0].tolist())
    assert chosen["all"] == chosen["largest"] & chosen["area"] & chosen["merged"]
    simplices = [facet["simplices"] for facet in whole]
    assert min(simplices[row] for row in chosen["merged"]) >= max(
        simplices[row] for row in range(len(whole)) if row not in chosen["merged"])  # fmt: skip


def test_open_selections_are_said_and_bounded_ones_hold_every_point():
    folder = fresh_folder("bounded")
    points = folder / "points.npy"
    rbox("1000 s D5 t1", points)
    for count in range(1, 7):
        done = run("hull", points, "--largest", count, "--report", folder / "report.json")
        report = report_of(points, "--largest", count, "--facet-list")
        selected = report["selected"]
        normals = numpy.array([facet["normal"] for facet in report["facet_list"]])
        direction = numpy.array(selected["open_direction"])
        assert selected["bounded"] is False and selected["added"] == 0
        assert abs(numpy.linalg.norm(direction) - 1) < 1e-12 and (normals @ direction).max() < 1e-12
        assert report["outer_volume"] is None and "do not bound" in report["outer_volume_reason"]
        assert done.stderr.startswith("ndhull: warning: ") and done.stderr.count("\n") == 1, done.stderr
        assert f"{direction[0]:.6g}, {direction[1]:.6g}, " in done.stderr and "--bounded" in done.stderr
        for extension in ("npy", "ine", "txt"):
            planes = folder / f"planes.{extension}"
            done = run("hull", points, "--largest", count, "--bounded", "--planes", planes)
            assert done.stderr == "", done.stderr
            assert "pass" in run("verify", points, planes).stdout
            assert '"bounded"' in run("intersect", planes, "--report", "-").stdout
        report = report_of(points, "--largest", count, "--bounded")
        selected = report["selected"]
        assert selected["bounded"] is True and selected["open_direction"] is None
        assert selected["facets"] == count + selected["added"] == len(numpy.load(folder / "planes.npy")) >= 6
        assert report["outer_volume"] > report["volume"] and "outer_volume_reason" not in report


def test_the_limit_on_seconds_is_for_the_outer_volume_too():
    folder = fresh_folder("outer_limit")
    run("generate", "gaussian", "-d", 9, "-n", 25, "--seed", 3, "-o", folder / "points.npy")
    for target in (["--width", "5%"], ["--largest", 1000], ["--largest", 400, "--bounded"]):
        report = report_of(folder / "points.npy", *target, "--outer-volume", "--max-seconds", 1, timeout=20)
        assert report["outer_volume"] is None and report["status"] == "complete", target
        assert "limit on seconds" in report["outer_volume_reason"], report["outer_volume_reason"]
        assert report["volume"] > 0


def test_the_limit_on_seconds_is_for_the_choice_too():
    folder = fresh_folder("choice_limit")
    points = folder / "points.npy"
    rbox("2000 s D5 t1", points)
    limit = PATIENCE / 150
    for target in (["--largest", 100, "--select", "volume"], ["--largest", 200, "--select", "distance"]):
        report = report_of(points, *target, "--max-seconds", limit, "--threads", 1)
        selected = report["selected"]
        assert report["status"] == "complete" and selected["cut_short"] is True, target
        assert selected["facets"] == target[1] and selected["bounded"] is True
        assert report["seconds"]["total"] < 3 * limit, report["seconds"]
    report = report_of(points, "--facets", 2000, "--objective", "volume", "--max-seconds", limit, "--threads", 1)
    assert report["status"] == "time_limit" and report["facets"] <= 2000 and report["points_outside"] == 0
    assert report["seconds"]["total"] < 3 * limit, report["seconds"]
    report = report_of(points, "--largest", 100)
    assert report["selected"]["cut_short"] is False


def test_the_outer_volume_is_that_of_the_intersection():
    folder = fresh_folder("volume")
    points = folder / "points.npy"
    rbox("400 s D5 t1", points)
    report = report_of(points, "--largest", 60, "--bounded", "--planes", folder / "planes.npy")
    again = run("intersect", folder / "planes.npy", "--report", folder / "report.json")
    volume = json.loads((folder / "report.json").read_text())["volume"]
    assert again.stderr == "" and abs(report["outer_volume"] / volume - 1) < 1e-9, (report["outer_volume"], volume)
    # Of an exact hull it is its own. What is too dear is said, and done when asked for.
    report = report_of(points)
    assert report["volume"] <= report["outer_volume"] < (1 + 1e-9) * report["volume"]
    report = report_of(points, "--largest", 2500)
    assert report["outer_volume"] is None and "more than about" in report["outer_volume_reason"]
    assert report["selected"]["bounded"]
    report = report_of(points, "--largest", 2500, "--outer-volume")
    assert report["volume"] < report["outer_volume"] < 2 * report["volume"]


def test_planes_chosen_for_volume_enclose_less():
    path = fresh_folder("select") / "points.npy"
    for dimension, count in [(4, 200), (5, 100)]:
        rbox(f"{count} s D{dimension} t1", path)
        by_area = report_of(path, "--largest", 20, "--bounded")
        by_volume = report_of(path, "--largest", 20, "--select", "volume", "--planes", path.with_name("planes.npy"))
        assert by_area["options"]["select"] == "area" and by_volume["options"]["select"] == "volume"
        assert by_volume["selected"]["facets"] == 20 and by_volume["selected"]["bounded"]
        assert by_volume["volume"] < by_volume["outer_volume"] < 0.9 * by_area["outer_volume"]
        assert "pass" in run("verify", path, path.with_name("planes.npy")).stdout
    done = run("hull", path, "--largest", 5, "--select", "volume", exit_code=1)
    one_error_line(done, "usage")
    assert "at least 6" in done.stderr, done.stderr
    for words in (["--select", "volume"], ["--largest", "9", "--select", "weight"]):
        assert "--select" in run("hull", path, *words, exit_code=1).stderr


def test_a_selection_of_everything_and_of_nothing():
    folder = fresh_folder("extremes")
    path = folder / "points.npy"
    rbox("50 D3 t1", path)
    for options in (["--largest", 10**6], ["--min-area", 1e-12]):
        run("hull", path, *options, "--planes", folder / "some.npy")
        run("hull", path, "--planes", folder / "all.npy")
        assert (folder / "some.npy").read_bytes() == (folder / "all.npy").read_bytes()
    done = run("hull", path, "--min-area", 1e12, "--format", "n FV", "--report", folder / "report.json")
    lines = done.stdout.splitlines()
    assert lines[:3] == ["4", "0", "3 1"] and "nan" not in lines[3] and "0 facets selected" in done.stderr
    assert "selected  0 facets; not bounded" in run("hull", path, "--min-area", 1e12).stdout
    assert "1 of them" not in run("hull", path, "--largest", 3).stdout
    assert "of them to bound a region; bounded" in run("hull", path, "--largest", 3, "--bounded").stdout


def test_flat_points_are_bounded_in_their_subspace():
    path = fresh_folder("flat") / "points.npy"
    points = rbox("60 s D3 t1", path)
    numpy.save(path, points @ numpy.arange(15.0).reshape(3, 5) ** 0.5)
    report = report_of(path, "--largest", 3, "--bounded", "--facet-list")
    assert report["selected"]["bounded"] and rank_of([facet["normal"] for facet in report["facet_list"]]) == 3
    assert report["outer_volume"] > report["volume"]


def test_bounded_alone_and_bad_numbers_are_usage_errors():
    path = fresh_folder("usage") / "points.npy"
    rbox("20 D3", path)
    one_error_line(run("hull", path, "--bounded", exit_code=1), "usage")
    for words in (["--largest", "0"], ["--largest", "-3"], ["--min-area", "x"], ["--most-merged", "1.5"]):
        done = run("hull", path, *words, exit_code=1)
        assert words[0] in done.stderr, done.stderr


def test_view_draws_whole_hulls_only():
    folder = fresh_folder("view")
    rbox("40 s D4 t1", folder / "points.npy")
    run("hull", folder / "points.npy", "--largest", 5, "--bounded", "--report", folder / "report.json", "--facet-list")
    done = run("view", folder / "report.json", "-o", folder / "view.svg", exit_code=1)
    one_error_line(done, "usage")
    assert "without --largest" in done.stderr and not (folder / "view.svg").exists()
    run("hull", folder / "points.npy", "--largest", 9999, "--report", folder / "report.json", "--facet-list")
    run("view", folder / "report.json", "-o", folder / "view.svg")


def test_distance_chooses_planes_that_stay_near_and_says_how_near():
    folder = fresh_folder("distance")
    points = folder / "points.npy"
    rbox("200 s D5 t1", points)
    by_area = report_of(points, "--largest", 20, "--bounded")["selected"]
    report = report_of(points, "--largest", 20, "--select", "distance", "--facet-list")
    chosen = report["selected"]
    assert chosen["facets"] == 20 and chosen["bounded"] and report["options"]["select"] == "distance"
    assert 0 < chosen["outer_distance"] < by_area["outer_distance"]
    # No vertex of what the planes enclose is further above a facet.
    run("hull", points, "--largest", 20, "--select", "distance", "--planes", folder / "planes.npy")
    run("intersect", folder / "planes.npy", "--vertices", folder / "corners.npy")
    corners = numpy.load(folder / "corners.npy")
    whole = all_facets(points)
    normals = numpy.array([facet["normal"] for facet in whole])
    offsets = numpy.array([facet["offset"] for facet in whole])
    highest = (corners @ normals.T + offsets).max()
    assert 0.3 * chosen["outer_distance"] < highest <= chosen["outer_distance"] * (1 + 1e-12)
    assert "nowhere further than" in run("hull", points, "--largest", 20, "--select", "distance").stdout
    assert report_of(points, "--largest", 3)["selected"]["outer_distance"] is None
    one_error_line(run("hull", points, "--largest", 4, "--select", "distance", exit_code=1), "usage")


def test_facets_that_bound_no_region_are_refused():
    folder = fresh_folder("few")
    rbox("30 s D4 t1", folder / "sphere.npy")
    rbox("c D3", folder / "cube.npy")
    for objective in ("width", "volume"):
        for number in (1, 2, 4):
            done = run("hull", folder / "sphere.npy", "--facets", number, "--objective", objective, exit_code=1)
            one_error_line(done, "usage")
            assert f"found {number}, expected at least 5" in done.stderr, done.stderr
        report = report_of(folder / "sphere.npy", "--facets", 5, "--objective", objective, "--verify")
        assert report["facets"] == 5 and report["outer_volume"] > report["volume"]
    # No five sides of a cube bound a region; five planes that are not its sides do.
    for number in (4, 5):
        assert report_of(folder / "cube.npy", "--facets", number, "--verify")["facets"] <= number
        report = report_of(folder / "cube.npy", "--facets", number, "--objective", "volume", "--verify")
        assert report["facets"] <= number and report["chosen"]["objective"] == "width"
    assert report_of(folder / "cube.npy", "--facets", 6, "--objective", "volume")["facets"] == 6
    # Of flat points the rank counts, and a point has no facets at all.
    (folder / "flat.csv").write_text("0,0,0\n1,0,0\n0,1,0\n1,1,0\n0.5,1.5,0\n")
    assert report_of(folder / "flat.csv", "--facets", 3)["facets"] == 3
    one_error_line(run("hull", folder / "flat.csv", "--facets", 2, exit_code=1), "usage")
    (folder / "point.csv").write_text("0,0,0\n0,0,0\n")
    assert report_of(folder / "point.csv", "--facets", 1)["facets"] == 0


def test_facets_for_volume_are_certified_planes_of_the_exact_hull():
    folder = fresh_folder("objective")
    points = folder / "points.npy"
    rbox("400 D5 t1", points)
    exact = report_of(points)
    volumes = {}
    for objective in ("width", "volume"):
        report = report_of(points, "--facets", 375, "--objective", objective, "--outer-volume", "--verify")
        assert report["facets"] <= 375 and report["options"]["objective"] == objective
        assert report["verification"]["passed"] and report["points_outside"] == 0
        volumes[objective] = report["outer_volume"] / exact["volume"] - 1
    assert volumes["volume"] <= 0.042 and volumes["volume"] < volumes["width"], volumes
    planes = folder / "planes.npy"
    run("hull", points, "--facets", 375, "--objective", "volume", "--planes", planes)
    assert "pass" in run("verify", points, planes).stdout and len(numpy.load(planes)) == 375
    one_error_line(run("hull", points, "--objective", "volume", exit_code=1), "usage")


def test_more_facets_than_are_looked_at_for_a_measure():
    folder = fresh_folder("selection_many")
    rbox("400 s D6 t1", folder / "points.npy")
    for measure in ("volume", "distance"):
        planes = folder / f"{measure}.npy"
        report = report_of(folder / "points.npy", "--largest", 20_500, "--select", measure, "--planes", planes)
        assert report["facets"] > 21_000 and len(numpy.load(planes)) == 20_500, (measure, report["facets"])
    assert report_of(folder / "points.npy", "--facets", 20_500, "--objective", "volume")["facets"] == 20_500


if __name__ == "__main__":
    run_tests(globals())
