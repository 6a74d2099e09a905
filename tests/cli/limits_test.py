#!/usr/bin/env python3
"""ndhull hull: limits on facets, time and memory, Ctrl-C and the end by a scheduler."""

import json
import signal
import subprocess
import time

import numpy
from program import (
    PATIENCE,
    PROGRAM,
    fresh_folder,
    keeps_memory,
    rbox,
    report_of,
    run,
    run_tests,
)

# A hull of some millions of facets: it takes long enough to be interrupted, and its few points make an end quick.
LONG_RUN = "400 s D9 t1"


def test_limits_end_growth_and_the_status_says_which():
    points = rbox(LONG_RUN, fresh_folder("limits") / "points.npy").shape[0]
    path = fresh_folder("limits") / "points.npy"
    rbox(LONG_RUN, path)
    for limit, value, status in [("--max-facets", 5000, "facet_limit"), ("--max-seconds", 0.5, "time_limit"),
                                 ("--max-memory", "20M", "memory_limit")]:  # fmt: skip
        planes = path.with_name("planes.npy")
        report = report_of(path, limit, value, "--planes", planes)
        assert report["status"] == status and report["input"]["points"] == points, report["status"]
        assert report["points_outside"] == 0 and report["max_outside_gauge"] > 0
        check_no_point_is_above(numpy.load(path), planes)


def test_a_mapped_file_does_not_count_where_memory_is_short():
    path = fresh_folder("mapped") / "points.npy"
    run("generate", "gaussian", "-d", 6, "-n", 1000000, "--seed", 4, "-o", path)  # 48 MB
    short = report_of(path, "--max-memory", "56M")
    assert short["status"] == "complete", short["status"]
    keeps_memory(short, 56 * 2**20)
    assert short["facets"] == report_of(path)["facets"]


def test_little_address_space_is_enough_and_ends_growth():
    path = fresh_folder("hull_space") / "points.npy"
    rbox("300 s D7 t1", path)
    whole = report_of(path, "--threads", "1")
    for megabytes, status in [(1000, "complete"), (100, "memory_limit")]:
        limit = ["prlimit", f"--as={megabytes * 2**20}", PROGRAM]
        if subprocess.run([*limit, "--version"], capture_output=True, check=False).returncode:
            print("skipped: a sanitizer takes more address space for itself")
            return
        words = [*limit, "hull", path, "--threads", "1", "--report", "-"]
        done = subprocess.run(words, capture_output=True, timeout=PATIENCE, check=False)
        assert done.returncode == 0, (megabytes, done.stderr)
        report = json.loads(done.stdout)
        assert report["status"] == status and report["points_outside"] == 0, (megabytes, report["status"])
        assert (report["facets"] == whole["facets"]) == (status == "complete"), report["facets"]


def test_a_search_for_points_left_out_keeps_the_memory_limit():
    path = fresh_folder("left_out") / "points.npy"
    run("generate", "sphere", "-d", 6, "-n", 30000, "--seed", 1, "-o", path)
    report = report_of(path, "--outside-width", 0.05, "--max-memory", "200M")  # growth alone takes 150 MB
    keeps_memory(report, 200 * 2**20)
    assert report["points_outside"] == 0 and report["max_facet_width"] < 0.06, report["max_facet_width"]


def test_what_comes_after_growth_keeps_the_memory_limit_too():
    path = fresh_folder("hull_memory") / "points.npy"
    rbox("2000 s D6 t1", path)
    for words in [["--verify"], ["--bounded", "--largest", 5], ["--curve", path.with_name("curve.csv")]]:
        report = report_of(path, "--max-memory", "40M", "--threads", "1", *words)
        keeps_memory(report, 40 * 2**20)
        assert report["status"] == "memory_limit" and report["points_outside"] == 0, report["status"]


def check_no_point_is_above(points, planes):
    for block in numpy.array_split(numpy.load(planes), 50):
        assert (points @ block[:, :-1].T + block[:, -1]).max() <= 0


def interrupt(path, seconds, *arguments, again_after=None):
    words = [PROGRAM, "hull", str(path), *map(str, arguments)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        time.sleep(seconds)
        process.send_signal(signal.SIGINT)
        if again_after is not None:
            time.sleep(again_after)
            process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=100)
        return process.returncode, output.decode(), errors.decode()


def test_ctrl_c_ends_the_run_with_what_there_is():
    folder = fresh_folder("interrupt")
    rbox(LONG_RUN, folder / "points.npy")
    exit_code, output, _ = interrupt(folder / "points.npy", 0.8, "--report", "-", "--planes", folder / "planes.npy")
    report = json.loads(output)
    assert exit_code == 130 and report["status"] == "interrupted", (exit_code, report["status"])
    assert report["facets"] > 0 and report["points_outside"] == 0
    check_no_point_is_above(numpy.load(folder / "points.npy"), folder / "planes.npy")


def test_the_second_ctrl_c_ends_it_at_once():
    folder = fresh_folder("interrupt_twice")
    rbox(LONG_RUN, folder / "points.npy")
    start = time.monotonic()
    exit_code, _, _ = interrupt(folder / "points.npy", 1.0, "--report", folder / "report.json", again_after=0.05)
    assert exit_code == 130 and time.monotonic() - start < 20
    # It may have been written in between, but then as a whole.
    assert not (folder / "report.json").exists() or json.loads((folder / "report.json").read_text())


def test_ctrl_c_while_reading():
    with subprocess.Popen([PROGRAM, "hull", "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=10) == 130
        process.stdin.close()


def test_nothing_half_written_stays_when_a_scheduler_ends_the_run():
    folder = fresh_folder("terminate")
    rbox("200 s D9 t1", folder / "points.npy")  # writing takes seconds
    for command in (["hull", "--planes"], ["view", "-o"]):
        words = [PROGRAM, command[0], str(folder / "points.npy"), command[1], str(folder / "result.svg")]
        for number in (signal.SIGTERM, signal.SIGHUP):
            with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
                while process.poll() is None and not list(folder.glob("result.svg.*")):
                    time.sleep(0.01)
                process.send_signal(number)
                assert process.wait(timeout=10) == -number, process.returncode
            assert [path.name for path in folder.iterdir()] == ["points.npy"], list(folder.iterdir())


if __name__ == "__main__":
    run_tests(globals())
