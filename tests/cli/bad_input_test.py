#!/usr/bin/env python3
"""Input and usage that cannot be honoured: one line on stderr, exit code 1, and no file written or changed."""

import subprocess

import numpy
from program import DIAMONDS, PATIENCE, PROGRAM, fresh_folder, one_error_line, run, run_tests

OUTPUTS = ["--planes", "planes.ine", "--vertices", "vertices.npy", "--report", "report.json"]


def npy_bytes(array):
    folder = fresh_folder("npy")
    numpy.save(folder / "a.npy", array)
    return (folder / "a.npy").read_bytes()


def npy_header(text):
    head = b"\x93NUMPY\x01\x00"
    text = text.encode() + b"\n"
    return head + len(text).to_bytes(2, "little") + text


GOOD = "3 comment\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
CUBE = numpy.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])

# name of the file, its bytes, the code of the message, a word it must hold
BAD_INPUTS = [
    ("ragged.csv", b"0,0,0\n1,0,0\n0,1\n0,0,1\n", "ragged-row", "line 3"),
    ("ragged.txt", GOOD.replace("0 1 0", "0 1").encode(), None, ""),
    ("nan.csv", b"0,0,0\n1,0,0\n0,nan,0\n0,0,1\n", "not-finite", "line 3"),
    ("infinity.csv", b"0,0,0\n1,0,0\n0,inf,0\n0,0,1\n", "not-finite", "line 3"),
    ("overflow.csv", b"0,0,0\n1,0,0\n0,1e999,0\n0,0,1\n", None, "line 3"),
    ("word.csv", b"0,0,0\n1,0,0\n0,12x,0\n0,0,1\n", "bad-number", "line 3"),
    ("word.txt", GOOD.replace("0 1 0", "0 one 0").encode(), "bad-number", "line 5"),
    ("more.txt", GOOD.replace("\n4\n", "\n3\n").encode(), "wrong-count", "expected 3"),
    ("fewer.txt", GOOD.replace("\n4\n", "\n5\n").encode(), "wrong-count", "5"),
    ("empty.txt", b"", "empty-input", "empty.txt"),
    ("blank.csv", b"\n  \n", "empty-input", ""),
    ("header.csv", b"x,y,z\n", "empty-input", ""),
    ("no_rows.npy", npy_bytes(numpy.zeros((0, 3))), "empty-input", ""),
    ("d0.txt", b"0\n4\n", None, ""),
    ("d0.npy", npy_bytes(numpy.zeros((4, 0))), "dimension-too-low", ""),
    ("axes.npy", npy_bytes(numpy.zeros((4, 3, 2))), "bad-header", ""),
    ("truncated.npy", npy_bytes(CUBE)[:-5], "truncated", ""),
    ("truncated_header.npy", npy_bytes(CUBE)[:40], "truncated", ""),
    ("nan.npy", npy_bytes(numpy.where(CUBE == CUBE[3], numpy.nan, CUBE)), "not-finite", "element"),
    ("nan32.npy", npy_bytes(numpy.float32([[0, 0], [1, numpy.inf], [0, 1]])), "not-finite", "[1, 1]"),
    ("complex.npy", npy_bytes(CUBE.astype(complex)), "unknown-type", "c16"),
    ("text.npy", npy_bytes(CUBE.astype("U3")), "unknown-type", ""),
    ("big_endian.npy", npy_bytes(CUBE.astype(">f8")), "unknown-type", ">f8"),
    ("no_header.npy", b"\x93NUMPY\x01\x00" + b"\x05\x00abcde", "bad-header", ""),
    ("strange.npy", npy_header("{'descr': '<f8', 'shape': (2, 2), }"), "bad-header", ""),
    ("halfspaces.ine", b"H-representation\nbegin\n3 3 real\n1 1 0\n1 0 1\n1 -1 -1\nend\n", "bad-header", ""),
    ("binary.txt", b"\x1f\x8b\x08\x00\x00", "bad-header", "gzip"),
]


def test_bad_input_gives_one_line_and_no_file():
    for name, content, code, word in BAD_INPUTS:
        folder = fresh_folder("bad_input")
        (folder / name).write_bytes(content)
        outputs = [folder / text if not text.startswith("--") else text for text in OUTPUTS]
        done = run("hull", folder / name, *outputs, exit_code=1)
        one_error_line(done, code or done.stderr.split(": ")[1])
        assert word in done.stderr and name in done.stderr, (name, done.stderr)
        assert [path.name for path in folder.iterdir()] == [name], (name, list(folder.iterdir()))


def test_the_same_from_standard_input():
    for name, content, code, _ in BAD_INPUTS:
        if name.endswith((".npy", ".txt")):
            done = run("hull", "-", exit_code=1, stdin=content)
            one_error_line(done, code or done.stderr.split(": ")[1])


def test_bad_input_leaves_the_old_results_alone():
    folder = fresh_folder("old_results")
    (folder / "nan.csv").write_text("0,nan\n1,2\n")
    (folder / "report.json").write_text("old")
    run("hull", folder / "nan.csv", "--report", folder / "report.json", exit_code=1)
    assert (folder / "report.json").read_text() == "old"
    assert len(list(folder.iterdir())) == 2, list(folder.iterdir())


def test_missing_and_unreadable_files():
    folder = fresh_folder("missing")
    for path in (folder / "not there.npy", folder):
        one_error_line(run("hull", path, exit_code=1), "file-missing")
        one_error_line(run("verify", path, path, exit_code=1), "file-missing")


def test_usage_gives_one_line():
    hull = ["hull", DIAMONDS]
    usages = [
        [], ["no-such-command"], ["hull"], [*hull, "more"], [*hull, "--no-such-option"],
        [*hull, "--max-facets", "0"], [*hull, "--max-facets", "-3"], [*hull, "--max-facets", "1.5"],
        [*hull, "--max-seconds", "0"], [*hull, "--max-seconds", "nan"], [*hull, "--max-seconds", "soon"],
        [*hull, "--width", ""], [*hull, "--max-memory", ""], ["hull", "--points-sharded", ""],
        [*hull, "--max-memory", "4X"], [*hull, "--max-memory", "0"], [*hull, "--max-memory", "-1G"],
        [*hull, "--threads", "-1"], [*hull, "--threads", "1000000"], [*hull, "--seed", "-1"],
        [*hull, "--format", "n Fq"], [*hull, "--format", ""], [*hull, "--format"],
        [*hull, "--facet-list"], [*hull, "--plane-kind", "outer"],
        [*hull, "--planes", "p.npy", "--plane-kind", "middle"], [*hull, "--planes", ""],
        [*hull, "--report", "-", "--format", "n"], [*hull, "--report", "-", "--vertices", "-"],
        [*hull, "--planes", "one.txt", "--vertices", "one.txt"], [*hull, "--verify=thoroughly"],
        ["generate"], ["generate", "doughnut"], ["generate", "sphere", "-n", "-1"],
        ["generate", "sphere", "-d", "0"], ["generate", "sphere", "-n", "0"],
        ["generate", "sphere", "--side", "4"], ["generate", "lattice", "--spread", "0.1"],
        ["generate", "cube", "--axes", "1", "2"], ["generate", "cone", "--lens-radius", "2"],
        ["generate", "lens", "--curve", "auto"], ["generate", "ball", "--clusters", "3"],
        ["generate", "ellipsoid", "-d", "3", "--axes", "1", "2"], ["generate", "lens", "--lens-radius", "0.5"],
        ["rbox"], ["rbox", "10 D0"], ["rbox", "10 nonsense"], ["verify"], ["verify", "-", "-"],
    ]  # fmt: skip
    for usage in usages:
        done = run(*usage, exit_code=1)
        one_error_line(done, done.stderr.split(": ")[1])


def test_usage_says_what_was_found_and_expected():
    hull, folder = ["hull", DIAMONDS], fresh_folder("usage_words")
    commands = ["intersect", "contains", "largest", "extreme", "generate", "rbox", "verify", "view"]
    usages = [([command], "found no ") for command in commands] + [([command, "--bogus"], '"--bogus"') for command in commands]
    usages += [
        ([], "no command"), (["--bogus"], '"--bogus"'), (["-"], '"-"'), (["bogus"], '"bogus"'),
        (["contains", "a", "--bogus"], '"--bogus"'), (["view", "a"], "--output"), (["hull", "a", "b"], '"b"'),
        ([*hull, "--report"], "nothing"), ([*hull, "--width"], "nothing"), (["extreme", "a", "--keep"], "nothing"),
        ([*hull, "--threads", "2", "--threads", "3"], "2 times"), ([*hull, "--max-cosine", "3"], "a number from -1 to 1"),
        ([*hull, "--max-cosine", "x"], "a number from -1 to 1"), ([*hull, "--facets", "9", "--objective", "x"], "width or volume"),
        ([*hull, "--effort", "x"], "quick or thorough"), ([*hull, "--largest", "3", "--select", "x"], "area or volume or distance"),
        ([*hull, "--verify=x"], "floating or exact"), ([*hull, "--planes", "p.npy", "--plane-kind", "x"], "outer or mean or inner"),
        ([*hull, "--facet-list"], "without --report"), ([*hull, "--objective", "volume"], "without --facets"),
        (["largest", "a", "--plane-kind", "inner"], "without --planes"), (["largest", "a", "--method", "x"], "auto or hull or rays"),
        (["largest", "a", "--verify=x"], '"x"'), ([*hull, "--progress=x"], '"x"'), (["view", "a", "-o", "b.svg", "--section", "1", "--shadow"], "found with"),
    ]  # fmt: skip
    for usage, words in usages:
        done = run(*usage, exit_code=1)
        one_error_line(done, "usage")
        assert words in done.stderr and "found" in done.stderr and "expected" in done.stderr, (usage, done.stderr)
        assert "--help" in done.stderr, (usage, done.stderr)
        assert not any(text in done.stderr for text in ("is required", "not in {", "Could not", "required", "requires")), done.stderr
    assert not list(folder.iterdir())


def test_places_that_cannot_be_written_are_said_before_the_work():
    folder = fresh_folder("no_place")
    for path in (folder, folder / "no folder" / "planes.npy"):
        for option in ("--planes", "--vertices", "--report"):
            one_error_line(run("hull", DIAMONDS, option, path, exit_code=1), "file-write")
    assert not list(folder.iterdir())


def test_the_input_is_never_written_over():
    folder = fresh_folder("input_kept")
    (folder / "sub").mkdir()
    points = folder / "points.csv"
    points.write_text("0,0,0\n1,0,0\n0,1,0\n0,0,1\n")
    content = points.read_bytes()
    (folder / "link.csv").symlink_to(points)
    (folder / "halfspaces.ine").write_bytes(b"H-representation\nbegin\n3 3 real\n0 1 0\n0 0 1\n1 -1 -1\nend\n")
    (folder / "points.html").write_bytes(content)
    names = [points, folder / "link.csv", folder / "sub" / ".." / "points.csv"]
    usages = [["hull", one, option, other]
              for option in ("--planes", "--vertices", "--report") for one in names for other in names]  # fmt: skip
    for command in ("extreme", "largest"):
        for option in ("--planes", "--vertices", "--report"):
            usages.append([command, points, option, names[2]])
    halfspaces, page = folder / "halfspaces.ine", folder / "points.html"
    usages += [
        ["extreme", points, "--keep", 3, "--distances", points],
        ["hull", points, "--curve", folder / "points"],
        ["hull", "--points-sharded", folder / "p*.csv", "--planes", points],
        ["intersect", halfspaces, "--vertices", halfspaces], ["intersect", halfspaces, "--report", halfspaces],
        ["contains", halfspaces, folder / "plane.csv", "-o", halfspaces],
        ["contains", halfspaces, folder / "plane.csv", "-o", folder / "plane.csv"],
        ["view", page, "-o", folder / "sub" / ".." / "points.html"],
        ["qhull", f"TI {points} TO {folder}/link.csv n"], ["qhalf", f"Fp TI {halfspaces} TO {halfspaces}"],
    ]  # fmt: skip
    (folder / "plane.csv").write_text("0,0\n1,0\n0,1\n")
    before = {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    for usage in usages:
        done = run(*usage, exit_code=1)
        one_error_line(done, "usage")
        assert "which is the input" in done.stderr and "expected another file" in done.stderr, done.stderr
        assert {path: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before, usage
    # Standard input redirected from a file is that file; a pipe is none, and /dev/null may be both.
    with points.open() as stream:
        words = [PROGRAM, "hull", "-", "--planes", str(points)]
        done = subprocess.run(words, stdin=stream, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.returncode == 1 and "which is the input standard input" in done.stderr, done
    assert points.read_bytes() == content
    run("hull", "-", "--planes", folder / "new.txt", stdin=content)
    one_error_line(run("hull", "/dev/null", "--planes", "/dev/null", exit_code=1), "empty-input")


def test_outputs_with_one_place_under_two_names():
    folder = fresh_folder("two_names")
    (folder / "sub").mkdir()
    (folder / "old.txt").write_text("old")
    (folder / "link.txt").symlink_to(folder / "old.txt")
    for one, other in (("old.txt", "link.txt"), ("new.txt", "sub/../new.txt"), ("new.txt", "./new.txt")):
        done = run("hull", DIAMONDS, "--planes", f"{folder}/{one}", "--vertices", f"{folder}/{other}", exit_code=1)
        one_error_line(done, "usage")
        assert "found both on" in done.stderr, done.stderr
    assert (folder / "old.txt").read_text() == "old" and not (folder / "new.txt").exists()


def test_extensions_that_say_something_else_than_what_is_written():
    folder = fresh_folder("extensions")
    run("rbox", "20 D3 t1", "-o", folder / "points.ext")
    run("generate", "cube", "-d", 3, "-n", 30, "-o", folder / "more.ext")
    run("hull", folder / "points.ext", "--planes", folder / "planes.ine")
    run("intersect", folder / "planes.ine", "--vertices", folder / "corners.ext")
    for name in ("more.ext", "corners.ext"):
        run("contains", folder / "planes.ine", folder / name, "-o", folder / "distances.csv")
    points, planes = folder / "points.ext", folder / "planes.ine"
    usages = [
        (["generate", "cube", "-o"], "x.ine", ".ext"), (["rbox", "20 D3", "-o"], "x.ine", ".ext"),
        (["hull", points, "--planes"], "x.ext", ".ine"), (["hull", points, "--vertices"], "x.ext", ".npy"),
        (["hull", points, "--vertices"], "x.ine", ".npy"), (["largest", points, "--planes"], "x.ext", ".ine"),
        (["extreme", points, "--planes"], "x.ext", ".ine"), (["extreme", points, "--vertices"], "x.ext", ".npy"),
        (["extreme", points, "--keep", "3", "--distances"], "x.ine", ".npy"),
        (["intersect", planes, "--vertices"], "x.ine", ".ext"), (["contains", planes, points, "-o"], "x.ine", ".npy"),
    ]  # fmt: skip
    for words, name, fitting in usages:
        done = run(*words, folder / name, exit_code=1)
        one_error_line(done, "usage")
        assert f"name it {fitting}" in done.stderr and not (folder / name).exists(), done.stderr


def test_a_full_disk_is_an_error():
    one_error_line(run("hull", DIAMONDS, "--report", "/dev/full", exit_code=1), "file-write")


if __name__ == "__main__":
    run_tests(globals())
