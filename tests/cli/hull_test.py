#!/usr/bin/env python3
"""ndhull hull: report, exit codes, pipes and formats."""

import json
import shutil
import subprocess

import numpy
from program import (
    DIAMONDS,
    fresh_folder,
    one_error_line,
    rbox,
    report_of,
    run,
    run_tests,
)

KEYS = """ndhull input status options length_unit vertices facets simplicial_facets merged_facets simplices area
    volume outer_volume roundoff max_outer_offset min_inner_offset max_facet_width width_ratio max_outside_gauge
    interior_point points_outside seconds peak_memory_bytes reference statistics""".split()
OPTIONS = """width facets objective effort outside_width centrum_radius max_cosine width_cap
    max_facets max_seconds max_memory unit_cube triangulate threads seed points_sharded columns largest
    select min_area most_merged bounded outer_volume planes plane_kind equations vertices report
    facet_list curve format verify progress quiet""".split()
FACET_KEYS = """normal offset centred_offset outer_offset inner_offset area vertices neighbors simplices""".split()


def test_report_of_the_diamonds():
    report = report_of(DIAMONDS, "--unit-cube")
    missing = set(KEYS) - set(report)
    assert not missing, missing
    assert set(report["options"]) == set(OPTIONS), set(report["options"]) ^ set(OPTIONS)
    assert report["input"] == {"path": str(DIAMONDS), "points": 53940, "dimension": 7, "rank": 7}
    assert report["status"] == "complete" and report["length_unit"] == "unit-cube"
    assert (report["vertices"], report["facets"]) == (258, 19110)
    assert report["facets"] == report["simplicial_facets"] + report["merged_facets"]
    assert report["simplices"] >= report["facets"]
    assert report["area"] > 0 and report["volume"] > 0
    assert report["volume"] <= report["outer_volume"] < (1 + 1e-9) * report["volume"]
    assert 0 < report["roundoff"] < 1e-13
    assert report["width_ratio"] == report["max_facet_width"] / report["roundoff"]
    assert report["max_outer_offset"] >= 0 >= report["min_inner_offset"]
    assert report["points_outside"] == 0 and 0 <= report["max_outside_gauge"] < 1e-9
    points = numpy.load(DIAMONDS).astype(float)
    interior = report["interior_point"]
    assert all(points.min(axis=0) < interior) and all(interior < points.max(axis=0))
    seconds = report["seconds"]
    phases = ["read", "growth", "certify", "merge", "select", "outer_volume", "verify", "write", "total"]
    assert list(seconds) == phases and seconds["total"] >= sum(seconds[phase] for phase in phases[:-1]) * 0.99
    assert report["peak_memory_bytes"] > points.nbytes / 2
    assert "facet_list" not in report and "selected" not in report


def test_targets_and_merging():
    report = report_of(DIAMONDS, "--unit-cube", "--width", "8%", "--verify")
    assert report["max_facet_width"] <= 0.08 and report["points_outside"] == 0, report["max_facet_width"]
    assert report["width_ratio"] == report["max_facet_width"] / 0.08
    assert report["options"]["width"] == "8%" and report["chosen"]["slab_width"] > 0
    report = report_of(DIAMONDS, "--unit-cube", "--facets", "150", "--verify")
    assert report["facets"] <= 150 and report["max_facet_width"] < 0.066, report["max_facet_width"]
    report = report_of(DIAMONDS, "--unit-cube", "--outside-width", "0.01", "--centrum-radius", "0.01", "--verify")
    assert report["facets"] <= 150 and report["max_facet_width"] <= 0.075, (report["facets"], report["max_facet_width"])
    assert report["chosen"]["merges"] > 0 and abs(report["chosen"]["width_cap"] - 0.065) < 1e-6


def test_more_effort_gives_fewer_or_narrower_facets():
    words = ["hull", DIAMONDS, "--unit-cube"]
    quick, thorough = (report_of(*words[1:], "--width", "5%", "--effort", effort, "--verify")
                       for effort in ("quick", "thorough"))  # fmt: skip
    assert thorough["options"]["effort"] == "thorough" and quick["options"]["effort"] == "quick"
    assert thorough["facets"] < 0.9 * quick["facets"] and thorough["max_facet_width"] <= 0.05, thorough["facets"]
    quick, thorough = (report_of(*words[1:], "--facets", 150, "--effort", effort, "--verify")
                       for effort in ("quick", "thorough"))  # fmt: skip
    assert thorough["facets"] <= 150 and thorough["max_facet_width"] < quick["max_facet_width"]


def test_accuracy_options_that_contradict():
    for words in (["--width", "1", "--facets", "9"], ["--width", "1", "--centrum-radius", "1"],
                  ["--width-cap", "1"], ["--max-cosine", "nan"], ["--effort", "thorough"], ["--effort", "more", "--width", "1"],
                  ["--effort", "thorough", "--facets", "9", "--objective", "volume"], ["--triangulate", "--width", "5%"], ["--triangulate", "--facets", "50"], ["--width", "0"], ["--width", "5%%"], ["--outside-width", "-1"]):  # fmt: skip
        done = run("hull", DIAMONDS, *words, exit_code=1)
        assert done.stdout == "" and done.stderr.count("\n") == 1, (words, done.stderr)


def test_options_in_the_report_are_those_in_force():
    folder = fresh_folder("options")
    options = report_of(DIAMONDS, "--max-memory", "1.5G", "--max-seconds", "100.5", "--threads", "1", "--seed", "7",
                        "--triangulate", "--planes", folder / "p.npy", "--plane-kind", "mean", "--verify",
                        "--max-facets", "1000000", "--quiet")["options"]  # fmt: skip
    expected = {"max_memory": 1.5 * 2**30, "max_seconds": 100.5, "threads": 1, "seed": 7, "triangulate": True,
                "unit_cube": False, "planes": str(folder / "p.npy"), "plane_kind": "mean", "vertices": None,
                "verify": "floating", "max_facets": 1000000, "report": "-", "quiet": True}  # fmt: skip
    assert {name: options[name] for name in expected} == expected, options


def test_facet_list_agrees_with_the_report():
    folder = fresh_folder("facet_list")
    report = report_of(DIAMONDS, "--facet-list", "--planes", folder / "mean.npy", "--plane-kind", "mean")
    facets = report["facet_list"]
    assert len(facets) == report["facets"] and all(list(facet) == FACET_KEYS for facet in facets)
    assert abs(sum(facet["area"] for facet in facets) / report["area"] - 1) < 1e-12
    assert sum(facet["simplices"] for facet in facets) == report["simplices"]
    assert max(facet["outer_offset"] for facet in facets) == report["max_outer_offset"]
    assert min(facet["inner_offset"] for facet in facets) == report["min_inner_offset"]
    assert len({vertex for facet in facets for vertex in facet["vertices"]}) == report["vertices"]
    for row, facet in enumerate(facets):
        assert all(row in facets[neighbor]["neighbors"] for neighbor in facet["neighbors"]), row
    # The same doubles in JSON as in the binary file.
    rows = numpy.array([facet["normal"] + [facet["offset"]] for facet in facets])
    assert (rows == numpy.load(folder / "mean.npy")).all()


def test_flat_input_says_so():
    folder = fresh_folder("flat")
    box = rbox("50 D3 t1", folder / "box.npy")
    points = box @ numpy.arange(15.0).reshape(3, 5) ** 0.5 + 2.0
    numpy.save(folder / "flat.npy", points)
    summary = run("hull", folder / "flat.npy").stdout
    assert "rank      3" in summary and "subspace" in summary and "[input^3]" in summary, summary
    report = report_of(folder / "flat.npy", "--planes", folder / "planes.npy", "--verify", "exact")
    assert report["input"]["rank"] == 3 and len(report["subspace_equations"]) == 2
    for equation in report["subspace_equations"]:
        assert abs(points @ equation["normal"] + equation["offset"]).max() < 1e-13
    planes = numpy.load(folder / "planes.npy")
    assert (points @ planes[:, :-1].T + planes[:, -1]).max() <= 0
    numpy.save(folder / "equal.npy", numpy.ones((5, 4)))
    report = report_of(folder / "equal.npy", "--verify")
    assert report["input"]["rank"] == report["facets"] == 0 and report["width_ratio"] is None
    assert "rank      0" in run("hull", folder / "equal.npy").stdout


def test_extents_beyond_single_precision_are_refused_where_facets_are_merged():
    path = fresh_folder("long") / "points.npy"
    numpy.save(path, numpy.random.default_rng(1).normal(size=(60, 4)) * 1e40)
    for words in (["--facets", "8"], ["--width", "5%"], ["--max-cosine", "0.9"]):
        one_error_line(run("hull", path, *words, exit_code=1), "out-of-range")
        assert report_of(path, *words, "--unit-cube", "--verify")["points_outside"] == 0
    assert report_of(path, "--outside-width", "5%", "--verify")["points_outside"] == 0


def test_coordinates_at_the_ends_of_the_range_of_doubles():
    path = fresh_folder("ends") / "points.npy"
    points = numpy.random.default_rng(1).normal(size=(60, 5))
    numpy.save(path, points)
    same = report_of(path, "--unit-cube")
    # Volumes are no doubles from 1e62 on and below 1e-62, areas from 1e77 on and below 1e-77.
    for exponent in (55, 65, 100, 200, 300, -55, -70, -100, -200, -290):
        numpy.save(path, points * 2.0 ** (exponent / 0.30103 // 1))
        scale = 5 * (exponent / 0.30103 // 1)
        for words in ([], ["--unit-cube"]):
            report = report_of(path, *words, "--verify", "--facet-list")
            if abs(exponent) < 60:
                assert abs(report["volume"] / (same["volume"] * 2.0**scale) - 1) < 1e-12, exponent
            else:
                assert report["volume"] is None and report["outer_volume"] is None, exponent
                assert "range of doubles" in report["volume_reason"] + report["outer_volume_reason"]
            if abs(exponent) < 75:
                assert report["area"] > 0 and "area_reason" not in report, exponent
                areas = [facet["area"] for facet in report["facet_list"]]
                assert abs(sum(areas) / report["area"] - 1) < 1e-12, exponent
            else:
                assert report["area"] is None and "range of doubles" in report["area_reason"], exponent
            # Planes, and so roundoff, differ in the last bits between the two units only.
            expected = same["roundoff"] * (1 if words else 2.0 ** (scale / 5))
            assert 0.1 * expected < report["roundoff"] < 20 * expected, (exponent, words, report["roundoff"])
        report = report_of(path, "--unit-cube", "--width", "5%", "--verify")
        assert report["max_facet_width"] <= 0.05 and report["facets"] > 60, exponent
        summary = run("hull", path).stdout
        assert ("volume    beyond the range of doubles" in summary) == (abs(exponent) > 60), summary


def test_coordinates_below_the_range_are_refused_with_a_word():
    path = fresh_folder("tiny") / "points.npy"
    numpy.save(path, numpy.random.default_rng(1).integers(-1000, 1000, (60, 5)) * 5e-324)
    for command in (["hull", path], ["hull", path, "--verify"], ["hull", path, "--unit-cube", "--verify"],
                    ["largest", path, "-n", 3], ["largest", path, "-n", 3, "--method", "rays"]):  # fmt: skip
        done = run(*command, exit_code=1)
        one_error_line(done, "out-of-range")
        assert "multiply the coordinates" in done.stderr, done.stderr
    numpy.save(path, numpy.random.default_rng(1).normal(size=(60, 4)) * 1e-200)
    for words in (["--facets", "8"], ["--width", "5%"], ["--max-cosine", "0.9"]):
        done = run("hull", path, *words, exit_code=1)
        one_error_line(done, "out-of-range")
        assert "multiply the coordinates" in done.stderr, done.stderr
        assert report_of(path, *words, "--unit-cube", "--verify")["points_outside"] == 0
    numpy.save(path, numpy.random.default_rng(1).uniform(-1.0, 1.0, size=(60, 4)) * 1.7e308)
    done = run("hull", path, "--unit-cube", exit_code=1)
    one_error_line(done, "out-of-range")
    assert "divide the coordinates" in done.stderr, done.stderr


def test_verify_in_all_its_spellings():
    path = fresh_folder("verify") / "points.npy"
    points = rbox("200 s D5 t1", path)
    for words, mode in [(["--verify", path], "floating"), ([path, "--verify"], "floating"),
                        ([path, "--verify", "exact"], "exact"), (["--verify", "exact", path], "exact"),
                        (["--verify=exact", path], "exact")]:  # fmt: skip
        report = report_of(*words)
        assert report["options"]["verify"] == mode == report["verification"]["mode"]
        assert report["verification"]["passed"] and report["verification"]["claims"]["outer"]["checks"] > 0
    planes = path.with_name("planes.npy")
    run("hull", path, "--planes", planes)
    assert "pass" in run("verify", path, planes).stdout
    rows = numpy.load(planes)
    rows[7, -1] += 1e-9
    numpy.save(planes, rows)
    assert "plane 7" in run("verify", path, planes, exit_code=2).stdout and points.shape == (200, 5)


def test_threads_do_not_change_the_bytes():
    folder = fresh_folder("threads")
    files = []
    for threads in (1, 2, 3):
        run("hull", DIAMONDS, "--planes", folder / f"{threads}.ine", "--threads", threads)
        files.append((folder / f"{threads}.ine").read_bytes())
    assert files[0] == files[1] == files[2]


def test_more_threads_than_cores_are_nothing_to_be_warned_of():
    for command in (["hull", "--quiet"], ["extreme", "--quiet"], ["largest", "-n", "5", "--quiet"]):
        done = run(*command, DIAMONDS, "--threads", 1024 if command[0] == "hull" else 100)
        assert done.stderr == "", done.stderr
    assert report_of(DIAMONDS, "--threads", 100)["options"]["threads"] == 100


def test_vertices_as_array_and_text():
    folder = fresh_folder("vertices")
    run("hull", DIAMONDS, "--vertices", folder / "v.npy")
    ids = numpy.load(folder / "v.npy")
    text = run("hull", DIAMONDS, "--vertices", "-").stdout.split()
    assert ids.tolist() == [int(word) for word in text[1:]] and int(text[0]) == len(ids) == 258


def test_pipes_and_formats():
    points = run("rbox", "100 D4").stdout.encode()
    lines = run("hull", "-", "--format", "Fs n", stdin=points).stdout.splitlines()
    assert lines[0].split()[:4] == ["10", "4", "100", "52"], lines[0]
    assert lines[2] == "5" and int(lines[3]) == 246 == len(lines) - 4
    reversed_order = run("hull", "-", "--format", "n,Fs", stdin=points).stdout.splitlines()
    assert reversed_order == lines[2:] + lines[:2]


def test_qhalf_reads_our_planes():
    if shutil.which("qhalf") is None:
        print("skipped: qhalf is not installed")
        return
    points = run("rbox", "30 D4").stdout
    planes = run("hull", "-", "--format", "n", stdin=points.encode()).stdout
    corners = subprocess.run(["qhalf", "H0", "Fp"], input=planes, capture_output=True, text=True, check=True)
    found = numpy.array([line.split() for line in corners.stdout.splitlines()[2:]], dtype=float)
    given = numpy.array([line.split() for line in points.splitlines()[2:]], dtype=float)
    ids = [int(word) for word in run("hull", "-", "--format", "Fx", stdin=points.encode()).stdout.split()[1:]]
    assert len(found) == len(ids)
    distances = numpy.linalg.norm(found[:, None] - given[ids], axis=2)
    assert distances.min(axis=0).max() < 1e-11 and distances.min(axis=1).max() < 1e-11


def test_progress_is_for_standard_error():
    path = fresh_folder("progress") / "points.npy"
    rbox("200 s D8 t1", path)
    done = run("hull", path, "--progress", "--report", "-")
    json.loads(done.stdout)
    for word in ("growth: ", "points left", "simplices", "furthest", " s, ", "B\n", "write: "):
        assert word in done.stderr, done.stderr
    assert run("hull", path, "--progress", "--quiet", "--report", "-").stderr == ""
    assert run("hull", path, "--report", "-").stderr == ""


def test_an_outer_volume_that_is_asked_for_is_printed_beside_files():
    folder = fresh_folder("outer_beside_files")
    rbox("60 s D4 t1", folder / "points.npy")
    words = ["hull", folder / "points.npy", "--width", "20%", "--planes", folder / "planes.txt"]
    assert "outer " not in run(*words).stdout
    assert "outer " in run(*words, "--outer-volume").stdout


def test_help_has_an_example_for_each_command():
    commands = ["hull", "generate", "rbox", "verify"]
    listing = run("--help").stdout
    for command in commands:
        assert command in listing and f"Example: ndhull {command if command != 'verify' else 'hull'}" in run(
            command, "--help").stdout  # fmt: skip
    assert run("help").stdout == listing and run("help", "hull").stdout == run("hull", "--help").stdout
    assert run("--version").stdout.startswith("ndhull ")


if __name__ == "__main__":
    run_tests(globals())
