"""Runs the built program for the tests of the command line."""

import json
import os
import pathlib
import shutil
import subprocess
import sys

import numpy

PROGRAM = os.environ["NDHULL"]
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DIAMONDS = ROOT / "bench" / "data" / "diamonds7.npy"
SCRATCH = pathlib.Path(os.environ["NDHULL_SCRATCH"])
# Seconds for one program; more where the build is slow (presets with sanitizers).
PATIENCE = 0.4 * float(os.environ.get("NDHULL_TEST_SECONDS", "300"))
# False where a sanitizer's own memory hides what the program takes.
MEMORY_IS_MEASURED = os.environ.get("NDHULL_TEST_MEMORY", "1") == "1"


def fresh_folder(name):
    folder = SCRATCH / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def run(*arguments, exit_code=0, stdin=b"", timeout=PATIENCE):
    """The finished process; stdout and stderr as text."""
    words = [PROGRAM, *map(str, arguments)]
    done = subprocess.run(words, input=stdin, capture_output=True, timeout=timeout, check=False)
    done.stdout, done.stderr = done.stdout.decode(), done.stderr.decode()
    assert done.returncode == exit_code, (words, done.returncode, done.stdout[:500], done.stderr[:500])
    return done


def one_error_line(done, code):
    """stderr is one line that starts with the code, and nothing went to stdout."""
    assert done.stdout == "", done.stdout[:500]
    assert done.stderr.endswith("\n") and done.stderr.count("\n") == 1, done.stderr
    assert done.stderr.startswith(f"ndhull: {code}: "), (code, done.stderr)


def rbox(arguments, path):
    run("rbox", arguments, "-o", path)
    return numpy.load(path) if path.suffix == ".npy" else path


def report_of(*arguments, **keywords):
    return json.loads(run("hull", *arguments, "--report", "-", **keywords).stdout)


def keeps_memory(report, most):
    """The report says that the process has kept a limit, with the tenth above it that limits have."""
    assert not MEMORY_IS_MEASURED or report["peak_memory_bytes"] < 1.1 * most, report["peak_memory_bytes"]


def run_tests(tests):
    for name, test in list(tests.items()):
        if name.startswith("test_"):
            test()
            print("passed:", name)
            sys.stdout.flush()
