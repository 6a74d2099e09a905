#!/usr/bin/env python3
"""ndhull-bench runs, agrees with Qhull on what is agreed, and says in JSON what its table says.

smoke_test.py PROGRAM SCRATCH. Nothing here is timed.
"""

import csv
import json
import pathlib
import shutil
import subprocess
import sys

PROGRAM, SCRATCH = sys.argv[1], pathlib.Path(sys.argv[2])


def run(*arguments, exit_code=0):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=250, check=False)
    assert done.returncode == exit_code, (arguments, done.returncode, done.stdout, done.stderr)
    return done.stdout


def records_of(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def test_both_find_the_same_facets():
    # General position, and coplanar simplices to merge.
    for name, facets in [("2000 s D5 t1", 56576), ("c D8", 16)]:
        path = SCRATCH / "peers.jsonl"
        table = run("peers", "--only", name, "--rounds", "1", "--json", str(path), "--quiet")
        records = records_of(path)
        assert [(record["engine"], record["facets"]) for record in records] == [("ndhull", facets), ("qhull", facets)]
        row = next(line for line in table.splitlines() if line.startswith(name)).removeprefix(name).split()
        assert (row[2], row[6]) == (f"{facets:,}", f"{facets:,}"), table
        for record in records:
            assert record["end"] == "done" and record["peak_bytes"] > record["resident_bytes"] > 0, record
            assert 0 <= record["max_facet_width"] < 1e-10, record


def test_cgal_and_lrs_find_the_same_facets():
    path = SCRATCH / "engines.jsonl"
    table = run("sweep", "--families", "sphere", "--dimensions", "3,4", "--points", "40", "--engines",
                "ndhull,cgal,lrs,qhull", "--options", "exact", "--rounds", "1", "--json", str(path), "--quiet")  # fmt: skip
    records = records_of(path)
    assert len(records) == 8 and "lrs" in table, records
    for record in records:
        if record["engine"] == "lrs" and shutil.which("lrs") is None:
            assert record["end"] == "failed" and "lrslib" in record["reason"], record
            continue
        same = next(other for other in records if other["input"] == record["input"])
        assert record["end"] == "done" and record["facets"] == same["facets"], record
    run("sweep", "--engines", "ndhull,other", exit_code=1)


def test_threads_stand_beside_processes():
    table = run("threads", "--only", "300 s D8", "--rounds", "1", "--threads", "2")
    row = next(line for line in table.splitlines() if line.startswith("300 s D8 t1")).removeprefix("300 s D8 t1").split()
    alone, threads, speed_up = (float(cell) for cell in row[:3])
    assert abs(alone / threads - speed_up) < 0.02 * speed_up, table
    assert run("threads", "--only", "300 s D8", "--max-seconds", "0.0001", exit_code=3).find("300 s D8") < 0


def test_a_time_limit_is_reported_and_the_bench_goes_on():
    table = run("peers", "--only", "2000 s D5", "--rounds", "2", "--max-seconds", "0.0001", "--quiet")
    assert table.count("stopped after") == 2, table


def test_approximate_compares_options_facets_and_width():
    path = SCRATCH / "approximate.jsonl"
    words = ["approximate", "--only", "2000 s D5", "--rounds", "1", "--target-rounds", "2", "--widths", "10%,20%"]
    table = run(*words, "--json", str(path))
    records = {(record["engine"], record["task"], record["options"]): record for record in records_of(path)}
    qhull = records["qhull", "equal options", "W0.1 C0.01"]
    # What `rbox "2000 s D5 t1" | qhull W0.1 C0.01 s` prints: 562 facets, 138 vertices, 0.1 above, 0.082 below.
    assert (qhull["facets"], qhull["vertices"]) == (562, 138), qhull
    assert abs(qhull["max_outer_offset"] - 0.1) < 5e-4 and abs(qhull["min_inner_offset"] + 0.082) < 5e-4, qhull
    assert records["ndhull", "equal facets", "facets 562"]["facets"] <= 562
    same_width = records["ndhull", "equal width", f"width {qhull['max_facet_width']}"]
    assert same_width["max_facet_width"] <= qhull["max_facet_width"]
    assert records["ndhull", "targets", "exact"]["facets"] == 56576
    turns = [(record["round"], record["options"]) for record in records_of(path) if record["task"] == "targets"]
    names = ["exact", "width 10%", "width 20%"]
    assert turns == [(0, name) for name in names] + [(1, name) for name in reversed(names)], turns
    assert records["ndhull", "targets", "width 20%"]["max_facet_width"] <= 0.2
    thorough = records["ndhull", "thorough", "width 10% thorough"]
    assert thorough["max_facet_width"] <= 0.1 and thorough["facets"] < records["ndhull", "targets", "width 10%"]["facets"]
    for title in ("The same options", "The same number of facets", "The same width", "beside the exact one", "longer"):
        assert title in table, table

    again = run(*words, "--skip-targets", "--qhull-from", str(path), "--json", str(SCRATCH / "again.jsonl"))
    kept = [record for record in records_of(SCRATCH / "again.jsonl") if record["engine"] == "qhull"]
    assert len(kept) == 1 and kept[0]["wall_seconds"] == qhull["wall_seconds"] and "562" in again, kept
    whole = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join(whole[:5]) + "\n" + whole[5][:40], encoding="utf-8")
    run(*words, "--json", str(path), "--resume")
    resumed = path.read_text(encoding="utf-8").splitlines()
    assert resumed[:5] == whole[:5] and len(resumed) == len(whole), resumed
    assert "100000" in run("approximate", "--list") and "100000 s D8" not in run("approximate", "--list", "--skip-huge")
    alone = run(*words, "--skip-qhull", "--skip-targets")
    assert "The same options" in alone and "The same width" not in alone, alone
    path.write_text("{}\n", encoding="utf-8")
    run(*words, "--qhull-from", str(path), exit_code=1)


SWEEP = ["sweep", "--families", "sphere,cube-corners", "--dimensions", "3,4", "--points", "30,60", "--options",
         "exact,width 20%", "--engines", "ndhull,qhull", "--rounds", "2", "--warm-up", "0"]  # fmt: skip


def test_sweep_can_be_interrupted_and_resumed():
    path, sheet = SCRATCH / "sweep.jsonl", SCRATCH / "sweep.csv"
    path.unlink(missing_ok=True)
    run(*SWEEP, "--json", str(path), "--csv", str(sheet), "--resume", "--quiet")
    whole = path.read_text(encoding="utf-8").splitlines()
    # 4 spheres and 2 cubes, twice each: ndhull both, Qhull exact only.
    assert len(whole) == 6 * 3 * 2, len(whole)
    with open(sheet, encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == 6 * 3
    cubes = [row["facets"] for row in rows if row["family"] == "cube-corners" and row["options"] == "exact"]
    assert cubes == ["6", "6", "8", "8"], cubes
    exact = [row for row in rows if row["family"] == "sphere" and row["options"] == "exact"]
    for ours, theirs in zip(exact[::2], exact[1::2], strict=True):
        assert (ours["engine"], theirs["engine"], ours["facets"]) == ("ndhull", "qhull", theirs["facets"])
        assert int(ours["simplices"]) == int(ours["facets"]) <= int(ours["created_simplices"])
        assert float(ours["max_facet_width"]) < 1e-12 and int(ours["runs"]) == 2 and ours["seed"] == "1", ours
        assert abs(float(ours["outer_volume"]) / float(ours["volume"]) - 1) < 1e-9, ours
        assert float(ours["seconds_min"]) <= float(ours["seconds_median"]) <= float(ours["seconds_max"])
    assert all(float(row["max_facet_width"]) <= 0.4 for row in rows)

    path.write_text("\n".join(whole[:7]) + "\n" + whole[7][:40], encoding="utf-8")
    run(*SWEEP, "--json", str(path), "--resume", "--quiet")
    resumed = path.read_text(encoding="utf-8").splitlines()
    assert resumed[:7] == whole[:7] and len(resumed) == len(whole)
    names = ("input", "engine", "options", "round", "facets", "max_facet_width")
    seen = [[json.loads(line)[name] for name in names] for line in resumed]
    assert seen == [[json.loads(line)[name] for name in names] for line in whole]
    run(*SWEEP, "--resume", exit_code=1)


def test_sweep_reports_limits_and_goes_on():
    path = SCRATCH / "limits.jsonl"
    run("sweep", "--families", "sphere,ball", "--dimensions", "7,8", "--points", "1000", "--options", "exact",
        "--rounds", "1", "--warm-up", "0", "--max-seconds", "0.05", "--json", str(path), "--quiet")  # fmt: skip
    assert [record["end"] for record in records_of(path)] == ["time_limit", "skipped"] * 2
    run("sweep", "--families", "sphere", "--dimensions", "6", "--points", "300", "--options", "exact", "--rounds",
        "1", "--max-memory", "2M", "--json", str(path), "--quiet")  # fmt: skip
    assert [record["detail"]["status"] for record in records_of(path)] == ["memory_limit"]
    for words in (["--dimensions", "3-"], ["--options", "sharp"], ["--families", "egg"], ["--points", "many"]):
        run("sweep", *words, exit_code=1)


def test_scaling_agrees_with_the_expected_numbers_of_facets():
    path = SCRATCH / "scaling.jsonl"
    table = run("scaling", "--dimensions", "4", "--points", "400,800,1600", "--fixed-points", "60", "--all-dimensions",
                "3-6", "--seeds", "1", "--warm-up", "0", "--json", str(path), "--quiet")  # fmt: skip
    counted = SCRATCH / "counted.jsonl"
    run("scaling", "--families", "sphere", "--points", "12", "--dimensions", "11", "--fixed-points", "80",
        "--all-dimensions", "10", "--seeds", "1", "--warm-up", "0", "--json", str(counted), "--quiet")  # fmt: skip
    # Few enough points to make many hulls.
    (high,) = (record for record in records_of(counted) if record.get("task") == "counts")
    assert 11 < high["points"]["points"] < 80 and high["detail"]["expected_facets"] <= 20000, high
    assert abs(high["detail"]["mean_facets"] / high["detail"]["expected_facets"] - 1) < 0.03, high
    ratios = [record["detail"]["mean_facets"] / record["detail"]["expected_facets"]
              for record in records_of(path) if record.get("task") == "counts"]  # fmt: skip
    assert len(ratios) == 12 and all(0.97 < ratio < 1.03 for ratio in ratios), ratios
    for title in ("Measured and expected", "with the number of points", "with the number of facets"):
        assert title in table, table
    # Points on a 4-d sphere: the facets' exponent comes near 1 from above.
    row = next(line for line in table.splitlines() if line.startswith("ndhull, sphere "))
    assert all(0.95 < float(word) < 1.15 for word in row.split()[6:8]), row


def test_all_makes_a_folder_with_the_report():
    folder = SCRATCH / "all"
    shutil.rmtree(folder, ignore_errors=True)
    words = ["all", "-o", str(folder), "--dimensions", "3-5", "--points", "40", "--scaling-points", "100,200",
             "--scaling-dimensions", "4", "--parts", "sweep,scaling"]  # fmt: skip
    if shutil.which("gnuplot") is None:
        run(*words, exit_code=1)
        print("not done: the page, because gnuplot is not installed")
    else:
        assert "part 2 of 8, scaling" in run(*words)
        assert "<svg" in (folder / "report.html").read_text(encoding="utf-8")
        # A part more, and what is there stays and is reported on.
        before = records_of(folder / "sweep.jsonl")
        run(*words[:-1], "sweep,joggle", "--resume", "--joggle-runs", "20")
        assert records_of(folder / "sweep.jsonl") == before and len(records_of(folder / "joggle.jsonl")) == 44
        assert "### Joggled unit cube" in (folder / "report.md").read_text(encoding="utf-8")
    assert "### Measured and expected numbers of facets" in (folder / "report.md").read_text(encoding="utf-8")
    assert "## Runtime against dimension" in (folder / "report.md").read_text(encoding="utf-8")
    records = records_of(folder / "sweep.jsonl")
    seen = {(record["points"]["family"], record["points"]["dimension"]) for record in records}
    assert seen == {(family, d) for family in ("sphere", "ball", "gaussian", "cube") for d in (3, 4, 5)}, seen
    options = {(record["engine"], record["options"]) for record in records}
    assert len(options) == 6 and ("qhull", "W5% C1%") in options, options
    assert all(record["end"] in ("done", "failed") for record in records)
    assert all(record["end"] == "done" for record in records if record["engine"] == "ndhull")
    assert any(record.get("task") == "counts" for record in records_of(folder / "scaling.jsonl"))
    run("all", "-o", str(folder), "--parts", "nothing", exit_code=1)


def test_halfspaces_have_the_same_vertices_as_qhalf():
    path = SCRATCH / "halfspaces.jsonl"
    words = ["halfspaces", "--only", "1000 in 6-d", "--rounds", "2", "--json", str(path), "--quiet"]
    table = run(*words)
    records = records_of(path)
    assert len(records) == 8 and table.count("1000 in 6-d") == 2, table
    if shutil.which("qhalf") is None:
        assert "is it installed" in table, table
        print("not done: the program qhalf is not installed")
        return
    for ours, theirs in ((records[0], records[1]), (records[4], records[5])):
        assert (ours["engine"], theirs["engine"], ours["input"]) == ("ndhull", "qhull", theirs["input"]), records
        assert ours["vertices"] == theirs["vertices"] > 10000, (ours, theirs)
        furthest = [record["detail"]["furthest_vertex"] for record in (ours, theirs)]
        assert abs(furthest[0] / furthest[1] - 1) < 1e-9 and furthest[0] > 1, furthest
        assert min(ours["peak_bytes"], theirs["peak_bytes"]) > 2**20, (ours, theirs)
    # What is there is kept; a program that is not there is reported.
    assert "1000 in 6-d" in run(*words, "--resume") and records_of(path) == records
    run("halfspaces", "--only", "300 in 8-d", "--rounds", "1", "--ndhull", "/nowhere/ndhull", "--max-seconds", "0.5",
        "--json", str(path), "--quiet", exit_code=3)  # fmt: skip
    ends = [(record["end"], record["reason"]) for record in records_of(path)]
    assert ends[0][0] == "failed" and "/nowhere/ndhull cannot be started" in ends[0][1], ends
    assert ends[1] == ("time_limit", "stopped after 0.5 s"), ends
    run("halfspaces", "--only", "no such set", exit_code=1)


def test_selections_tells_what_planes_enclose():
    path = SCRATCH / "selections.jsonl"
    table = run("selections", "--only", "400 D5", "--json", str(path), "--quiet")
    records = {(record["engine"], record["options"]): record for record in records_of(path)}
    excess = {key: 100 * (record["detail"]["outer_ratio"] - 1) for key, record in records.items()}
    # What Qhull's own pipe of outer planes encloses, and what ndhull may with as many.
    for facets, options, theirs, ours in ((503, "C0.01", 3.6, 2.8), (375, "W0.1 C0.01", 13.2, 4.2)):
        assert records["qhull", options]["facets"] == facets and abs(excess["qhull", options] - theirs) < 0.1, excess
        target = records["ndhull", f"facets {facets}, volume"]
        assert target["facets"] == facets and target["detail"]["is_certified"] is True, target
        assert 0 < excess["ndhull", f"facets {facets}, volume"] <= ours, excess
    by_area, for_volume = (records["ndhull", name] for name in ("largest, bounded", "chosen for volume"))
    assert by_area["facets"] >= for_volume["facets"] >= 6
    assert 0 < excess["ndhull", "chosen for volume"] <= excess["ndhull", "largest, bounded"], excess
    assert "20 outer planes" in table and table.count("yes") == 2, table
    run("selections", "--only", "no such input", exit_code=1)


def test_joggle_has_fewer_problems_with_larger_joggles():
    path = SCRATCH / "joggle.jsonl"
    run("joggle", "--only", "c D3", "--runs", "40", "--json", str(path), "--quiet")
    records = records_of(path)
    assert len(records) == 24
    shares = {engine: [record["detail"]["share"] for record in records
                       if record["engine"] == engine and record["end"] == "done"]
              for engine in ("ndhull", "qhull")}  # fmt: skip
    assert shares["ndhull"][0] > 0.9 and shares["ndhull"][-1] < 0.1, shares
    if shutil.which("qhull") is not None and shutil.which("rbox") is not None:
        # 40 joggles: one standard deviation is 0.08 at most.
        assert all(abs(ours - theirs) < 0.45 for ours, theirs in zip(*shares.values(), strict=True)), shares
    run("joggle", "--only", "no such input", exit_code=1)


def test_phases_names_the_phases():
    path = SCRATCH / "phases.jsonl"
    table = run("phases", "--only", "c D8", "--rounds", "2", "--json", str(path), "--quiet")
    assert all(word in table for word in ("total", "growth", "certify", "merge", "visible set")), table
    row = next(line for line in table.splitlines() if line.startswith("c D8")).split()
    seconds = sorted(record["wall_seconds"] for record in records_of(path))
    assert row[3] == f"{seconds[0]:.4f}" and sum(map(float, row[4:7])) <= 1.01 * float(row[3]), (table, seconds)


def test_micro_measures_the_phases():
    table = run("micro", "--filter", "5-d, 500, exact", "--min-seconds", "0.01")
    rows = [line for line in table.splitlines() if line.startswith("sphere 5-d, 500, exact")]
    assert len(rows) == 1 and all(f"{word}=" in rows[0] for word in ("facets", "growth", "certify", "merge")), table


def test_rays_counts_its_recall():
    path = SCRATCH / "rays.jsonl"
    table = run("rays", "--only", "2000 s D5", "--seeds", "1", "--skip-big", "--json", str(path), "--quiet")
    words = table.splitlines()[-1].split()
    assert words[:6] == ["2000", "s", "D5", "t1", "56,576", "1"] and 0.5 <= float(words[-2]) <= 1, table
    assert [record["facets"] for record in records_of(path)] == [56576]


def test_list_and_usage():
    assert "80 s D10 t1" in run("peers", "--list").splitlines()
    run("peers", "--only", "no such input", exit_code=1)
    run("no-such-command", exit_code=1)


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            print("passed:", name)
