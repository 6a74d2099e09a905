#!/usr/bin/env python3
"""ndhull contains: lines and .npy agree with NumPy, answers with the width, refusals."""

import subprocess

import numpy

from program import PROGRAM, fresh_folder, one_error_line, rbox, run, run_tests

FOLDER = fresh_folder("contains")
POINTS = rbox("300 s D4 t1", FOLDER / "points.npy")
run("hull", FOLDER / "points.npy", "--planes", FOLDER / "planes.npy")
PLANES = numpy.load(FOLDER / "planes.npy")
QUERIES = rbox("2000 D4 t2", FOLDER / "queries.npy")


def expected():
    values = QUERIES @ PLANES[:, :4].T + PLANES[:, 4]
    return values.max(axis=1), values.argmax(axis=1)


def test_lines():
    lines = run("contains", FOLDER / "planes.npy", FOLDER / "queries.npy").stdout.splitlines()
    distances, planes = expected()
    assert len(lines) == len(QUERIES)
    for line, distance, plane in zip(lines, distances, planes):
        found = line.split()
        assert abs(float(found[0]) - distance) < 1e-15 and int(found[1]) == plane
        assert found[2] == ("outside" if distance > 0 else "inside")
    assert 100 < sum(distances > 0) < 1900


def test_tables_have_names():
    lines = run("contains", FOLDER / "planes.npy", FOLDER / "queries.npy").stdout.splitlines()
    for ending, separator in ((".csv", ","), (".tsv", "\t")):
        run("contains", FOLDER / "planes.npy", FOLDER / "queries.npy", "-o", FOLDER / f"answers{ending}")
        table = (FOLDER / f"answers{ending}").read_text().splitlines()
        assert table == [separator.join(line.split(" ")) for line in ["distance plane answer", *lines]]


def test_npy_and_width():
    run("contains", FOLDER / "planes.npy", FOLDER / "queries.npy", "--width", "0.05", "-o", FOLDER / "answers.npy")
    answers = numpy.load(FOLDER / "answers.npy")
    distances, planes = expected()
    assert numpy.allclose(answers[:, 0], distances, atol=1e-15) and (answers[:, 1] == planes).all()
    wanted = numpy.where(distances > 0, 1, numpy.where(distances > -0.05, 0, -1))
    assert (answers[:, 2] == wanted).all() and len(set(wanted)) == 3


def test_a_width_of_0_is_no_width():
    # max_facet_width of a report may be 0.
    words = ("contains", FOLDER / "planes.npy", FOLDER / "queries.npy")
    assert run(*words, "--width", "0").stdout == run(*words).stdout


def test_summary():
    text = run("contains", FOLDER / "planes.npy", FOLDER / "queries.npy", "--summary").stdout
    distances, _ = expected()
    assert text.startswith(f"queries 2000: outside {sum(distances > 0)}, within the width 0, inside ")
    assert f"furthest: query {distances.argmax()} plane" in text


def test_a_summary_that_cannot_be_written_is_an_error():
    with open("/dev/full", "w", encoding="utf8") as full:
        for words in (
            ("contains", FOLDER / "planes.npy", FOLDER / "queries.npy", "--summary"),
            ("verify", FOLDER / "points.npy", FOLDER / "planes.npy"),
            ("contains", "--help"),
            ("--version",),
        ):
            done = subprocess.run([PROGRAM, *map(str, words)], stdout=full, stderr=subprocess.PIPE, check=False)
            assert done.returncode == 1 and done.stderr.startswith(b"ndhull: file-write: "), (words, done)


def test_the_input_is_not_outside():
    # Every point is a vertex: below the planes by roundoff.
    run("contains", FOLDER / "planes.npy", FOLDER / "points.npy", "--width", "1e-12", "-o", FOLDER / "own.npy")
    assert (numpy.load(FOLDER / "own.npy")[:, 2] == 0).all()


def test_refusals():
    rbox("10 D3", FOLDER / "low.npy")
    one_error_line(run("contains", FOLDER / "planes.npy", FOLDER / "low.npy", exit_code=1), "usage")
    one_error_line(run("contains", "-", "-", exit_code=1), "usage")
    one_error_line(run("contains", FOLDER / "planes.npy", FOLDER / "queries.npy", "--width", "-1", exit_code=1), "usage")
    one_error_line(run("verify", FOLDER / "points.npy", FOLDER / "planes.npy", "--threads", "99999999", exit_code=1), "usage")
    one_error_line(run("contains", FOLDER / "planes.npy", FOLDER / "none.npy", exit_code=1), "file-missing")


run_tests(globals())
