#!/usr/bin/env python3
"""ndhull qhull: cdd's points (Fd), and points that span fewer dimensions."""

import shutil
import subprocess

from program import PATIENCE, fresh_folder, one_error_line, run, run_tests

QHULL = shutil.which("qhull")


def test_fd_reads_points_whose_file_says_nothing():
    points = run("rbox", "h c D3").stdout.encode()
    assert b"representation" not in points and b"begin" in points
    for options in ("Fd FS", "Fd Fs", "Fd FV"):
        mine = run("qhull", options, stdin=points).stdout
        assert mine == run("qhull", options.removeprefix("Fd "), stdin=run("rbox", "c D3").stdout.encode()).stdout
        if QHULL is None or options == "Fd Fs":
            continue
        other = subprocess.run([QHULL, *options.split()], input=points, capture_output=True, timeout=PATIENCE, check=True)
        qhulls = other.stdout.decode()
        assert mine.split() == qhulls.split(), (options, mine, qhulls)
    for text in (b"V-representation\n" + points, b"comment\n" + points):
        assert run("qhull", "Fd FS", stdin=text).stdout.split()[-1] == "1"
    one_error_line(run("qhull", "Fd n", stdin=b"H-representation\n" + points, exit_code=1), "bad-header")


def test_fd_of_another_format_is_an_error():
    for stdin in (run("rbox", "c").stdout.encode(), b"0,0\n1,0\n0,1\n"):
        done = run("qhull", "Fd n", stdin=stdin, exit_code=1)
        one_error_line(done, "bad-header")
        assert "Fd" in done.stderr and "begin" in done.stderr, done.stderr
    assert "Fd" in run("qhull", "--help").stdout


def test_flat_points_are_warned_of():
    flat = b"3\n4\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
    path = fresh_folder("flat") / "flat.txt"
    path.write_bytes(flat)
    for done in (run("qhull", "FS", stdin=flat), run("hull", path, "--format", "FS")):
        assert done.stdout == "0\n2      4      1 \n", done.stdout
        assert done.stderr.count("\n") == 1 and done.stderr.startswith("ndhull: warning: "), done.stderr
        assert "span 2 of 3" in done.stderr and "volume 2-dimensional" in done.stderr and "areas 1-" in done.stderr
    assert run("qhull", "FS Pp", stdin=flat).stderr == run("hull", path, "--format", "FS", "--quiet").stderr == ""
    assert run("qhull", "FS", stdin=run("rbox", "c").stdout.encode()).stderr == ""


if __name__ == "__main__":
    run_tests(globals())
