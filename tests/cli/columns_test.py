#!/usr/bin/env python3
"""--columns of tables with names, in every command that reads points: the same as the columns alone."""

import json

import numpy
from program import fresh_folder, one_error_line, rbox, report_of, run, run_tests

FOLDER = fresh_folder("columns")


def test_hull_extreme_largest_and_view():
    values = rbox("60 s D4 t3", FOLDER / "four.npy")
    table = FOLDER / "names.csv"
    rows = ["species,a,b,c,d"] + ["x y," + ",".join(map(repr, row)) for row in values.tolist()]
    table.write_text("\n".join(rows))
    numpy.save(FOLDER / "chosen.npy", values[:, [3, 0, 1]])
    run("hull", FOLDER / "chosen.npy", "--planes", FOLDER / "wanted.ine", "--quiet")
    for points, columns in ((table, "d,2-3"), (FOLDER / "four.npy", "4,1,2")):
        report = report_of(points, "--columns", columns, "--planes", FOLDER / "found.ine")
        assert report["options"]["columns"] == columns and report["input"]["dimension"] == 3
        assert (FOLDER / "found.ine").read_bytes() == (FOLDER / "wanted.ine").read_bytes()
    run("verify", table, FOLDER / "wanted.ine", "--columns", "d,2-3")
    extreme = json.loads(run("extreme", table, "--columns", "d,a,b", "--report", "-").stdout)
    largest = json.loads(run("largest", table, "--columns", "d,a,b", "--report", "-").stdout)
    assert extreme["options"]["columns"] == largest["options"]["columns"] == "d,a,b"
    assert extreme["vertices"] == report["vertices"]
    assert "--columns" in run("hull", table, exit_code=1).stderr
    one_error_line(run("hull", table, "--columns", "a,e", exit_code=1), "usage")
    one_error_line(run("hull", "--points-sharded", "x-*.npy", "--columns", "1", exit_code=1), "usage")
    run("hull", table, "--columns", "d,2-3", "--report", FOLDER / "names.json", "--facet-list", "--quiet")
    run("view", FOLDER / "names.json", "-o", FOLDER / "report.svg")
    run("view", table, "--columns", "d,2-3", "-o", FOLDER / "table.svg")
    picture = (FOLDER / "report.svg").read_text()
    assert ">d<" in picture and picture == (FOLDER / "table.svg").read_text()
    one_error_line(run("view", FOLDER / "names.json", "--columns", "1", "-o", FOLDER / "n.svg", exit_code=1), "usage")


def test_names_that_are_numbers():
    # Years, or the numbers that pandas gives columns: a word above numbers, or an index without a name, tells.
    values = rbox("20 D2 t5", FOLDER / "two.npy")
    for header, columns in (("mass,2019,2020", "2,3"), ("mass,2019,2020", "mass,3"), (",0,1", "2-3")):
        table = FOLDER / "years.csv"
        table.write_text("\n".join([header] + [f"{row},{a!r},{b!r}" for row, (a, b) in enumerate(values.tolist())]))
        report = report_of(table, "--columns", columns)
        assert report["input"]["points"] == 20, (header, report["input"])
    # Text in every row is no header's, nor is a value that is missing, or an id.
    for first in ("a12,1.5,2.5", "x,1,3", "True,4,2", "yes,1,2.5"):
        (FOLDER / "ids.csv").write_text(f"{first}\n1,3,5\n1,4,1\n")
        assert report_of(FOLDER / "ids.csv", "--columns", "2,3")["input"]["points"] == 3, first
    (FOLDER / "typo.csv").write_text("O,1,2\n1,3,5\n1,4,1\n")
    one_error_line(run("hull", FOLDER / "typo.csv", exit_code=1), "bad-number")
    (FOLDER / "text.csv").write_text("a,1,2\nb,3,5\nc,4,1\n")
    assert report_of(FOLDER / "text.csv", "--columns", "2,3")["input"]["points"] == 3
    for first in ("NA,1,2", ",1,2", "nan,1,2"):
        (FOLDER / "missing.csv").write_text(f"{first}\n1,3,5\n1,4,1\n")
        assert report_of(FOLDER / "missing.csv", "--columns", "2,3")["input"]["points"] == 3, first


def test_a_header_without_a_name_for_row_names():
    # As R writes tables. A row that only ends with one separator more is none of these.
    for separator in (" ", ",", "\t"):
        for first in ('"1"', "sp_1"):
            path = FOLDER / "from_r.txt"
            rows = [["a", "b"], [first, "0", "1"], ["sp_2", "1", "1"], ["sp_3", "2", "5"]]
            path.write_text("\n".join(separator.join(row) for row in rows))
            for columns in ("a,b", "2,3"):
                report = report_of(path, "--columns", columns)
                assert report["input"]["points"] == 3 and report["volume"] == 2.0, (separator, first, columns)
            one_error_line(run("hull", path, exit_code=1), "bad-header")
    (FOLDER / "ends.csv").write_text("a,b\n1,2,\n3,4,\n5,7,\n")
    one_error_line(run("hull", FOLDER / "ends.csv", "--columns", "a,b", exit_code=1), "ragged-row")


def test_contains_and_verify():
    rbox("300 s D4 t1", FOLDER / "points.npy")
    queries = rbox("2000 D4 t2", FOLDER / "queries.npy")
    run("hull", FOLDER / "points.npy", "--planes", FOLDER / "planes.npy", "--quiet")
    table = FOLDER / "table.csv"
    rows = ['"","site","d","a","b","c"']
    for row, (a, b, c, d) in enumerate(queries.tolist()):
        rows.append(f'"{row + 1}","north, #{row}",{d!r},{a!r},{b!r},{c!r}')
    table.write_text("\n".join(rows))
    wanted = run("contains", FOLDER / "planes.npy", FOLDER / "queries.npy").stdout
    assert run("contains", FOLDER / "planes.npy", table, "--columns", "a,b,6,d").stdout == wanted
    assert run("contains", FOLDER / "planes.npy", table, "--columns", "4-6,3").stdout == wanted
    for command in ("verify", "contains"):
        files = (table, FOLDER / "planes.npy") if command == "verify" else (FOLDER / "planes.npy", table)
        done = run(command, *files, exit_code=1)
        one_error_line(done, "bad-header")
        assert "--columns" in done.stderr


if __name__ == "__main__":
    run_tests(globals())
