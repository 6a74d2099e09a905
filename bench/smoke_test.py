#!/usr/bin/env python3
"""ndhull-bench runs, agrees with Qhull on what is agreed, and says in JSON what its table says.

smoke_test.py PROGRAM SCRATCH. Nothing here is timed.
"""

import json
import pathlib
import subprocess
import sys

PROGRAM, SCRATCH = sys.argv[1], pathlib.Path(sys.argv[2])


def run(*arguments, exit_code=0):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=250, check=False)
    assert done.returncode == exit_code, (arguments, done.returncode, done.stdout, done.stderr)
    return done.stdout


def facets_of(lines):
    return [(line["ndhull"]["facets"], line["qhull"]["facets"]) for line in lines]


def test_both_find_the_same_facets():
    # General position, and coplanar simplices to merge.
    for name, facets in [("2000 s D5 t1", 56576), ("c D8", 16)]:
        path = SCRATCH / "peers.jsonl"
        table = run("peers", "--only", name, "--rounds", "1", "--json", str(path))
        lines = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
        assert facets_of(lines) == [(facets, facets)], (name, lines)
        assert table.count(f" {facets} ") == 2, table
        for engine in ("ndhull", "qhull"):
            record = lines[0][engine]
            assert record["end"] == "done" and record["peak_bytes"] > 0, record
            assert 0 <= record["max_facet_width"] < 1e-10, record


def test_a_time_limit_is_reported_and_the_bench_goes_on():
    table = run("peers", "--only", "2000 s D5", "--rounds", "2", "--max-seconds", "0.0001")
    assert table.count("stopped after") == 2, table


def test_phases_names_the_phases():
    table = run("phases", "--only", "c D8", "--rounds", "1")
    assert all(word in table for word in ("total", "growth", "certify", "merge")), table


def test_rays_counts_its_recall():
    table = run("rays", "--only", "2000 s D5", "--seeds", "1", "--skip-big").splitlines()
    words = table[-1].split()
    assert words[:5] == ["2000", "s", "D5", "t1", "56576"] and 0.5 <= float(words[-2]) <= 1, table


def test_list_and_usage():
    assert "80 s D10 t1" in run("peers", "--list").splitlines()
    run("peers", "--only", "no such input", exit_code=1)
    run("no-such-command", exit_code=1)


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            print("passed:", name)
