#!/usr/bin/env python3
"""What `ndhull hull` prints when no file is asked for."""

from program import DIAMONDS, fresh_folder, rbox, run, run_tests


def test_summary_without_an_output_and_nothing_with_quiet():
    summary = run("hull", DIAMONDS, "--unit-cube").stdout
    for text in ("53,940 points in 7-d, complete", "vertices  258", "19,110", "[input^7]", "[unit cube]", "time"):
        assert text in summary, summary
    quiet = run("hull", DIAMONDS, "--quiet")
    assert quiet.stdout == quiet.stderr == ""


def test_a_target_that_is_missed_is_told():
    path = fresh_folder("missed") / "points.npy"
    rbox("300 s D4 t1", path)
    assert "was asked for" not in run("hull", path, "--width", "5%").stdout
    assert "1e-20 was asked for, which is less than rounding" in run("hull", path, "--width", "1e-20").stdout
    limited = run("hull", path, "--width", "1%", "--max-facets", 100).stdout
    line = next(line for line in limited.splitlines() if line.startswith("width"))
    assert "was asked for" in line and "rounding" not in line, line


if __name__ == "__main__":
    run_tests(globals())
