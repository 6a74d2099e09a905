#!/usr/bin/env python3
"""The counted work of a small fixed set is no more than bench/data/counts.jsonl says; results of now compared with
themselves are equal; what is worse is seen.

counts_test.py PROGRAM SCRATCH. After a change that is meant to do more work: ndhull-bench counts --json
bench/data/counts.jsonl.
"""

import json
import pathlib
import shutil
import subprocess
import sys

PROGRAM, SCRATCH = sys.argv[1], pathlib.Path(sys.argv[2])
BASELINE = pathlib.Path(__file__).resolve().parent / "data" / "counts.jsonl"
NOW = SCRATCH / "counts.jsonl"


def run(*words, exit_code=0):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, timeout=250, check=False)
    assert done.returncode == exit_code, (words, done.returncode, done.stdout, done.stderr)
    return done.stdout


def test_no_more_work_than_before():
    run("counts", "--json", NOW)
    print(run("compare", "--counts-only", BASELINE, NOW))


def test_compare_ends_with_2_when_work_grows():
    lines = [json.loads(line) for line in NOW.read_text(encoding="utf-8").splitlines()]
    lines[0]["detail"]["created_simplices"] *= 2
    worse = SCRATCH / "worse.jsonl"
    worse.write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    assert "created_simplices" in run("compare", "--counts-only", NOW, worse, exit_code=2)
    assert "Improvements" in run("compare", "--counts-only", worse, NOW)
    run("compare", NOW, SCRATCH / "missing.jsonl", exit_code=1)


def test_instructions_are_counted():
    if shutil.which("valgrind") is None:
        print("not done: valgrind is not installed")
        return
    path = SCRATCH / "instructions.jsonl"
    run("counts", "--only", "500 s D4", "--instructions", "--json", path)
    (line,) = path.read_text(encoding="utf-8").splitlines()
    # 3,000 facets of 4-d cannot be had for less, and the program starts in less.
    assert 1e6 < json.loads(line)["detail"]["instructions"] < 1e10, line


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            print("passed:", name)
