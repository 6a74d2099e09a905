#!/usr/bin/env python3
"""ndhull hull --curve: facets against certified width, as a table and a picture."""

import xml.etree.ElementTree

from program import DIAMONDS, fresh_folder, one_error_line, rbox, report_of, run, run_tests


def table_of(path):
    header, *rows = path.read_text().splitlines()
    assert header == "facets,width,seconds", header
    return [(int(facets), float(width), float(seconds)) for facets, width, seconds in (row.split(",") for row in rows)]


def test_the_curve_starts_at_the_hull_and_every_point_is_a_hull():
    folder = fresh_folder("curve")
    report = report_of(DIAMONDS, "--unit-cube", "--width", "3%", "--curve", folder / "trade.csv")
    rows = table_of(folder / "trade.csv")
    assert rows[0][:2] == (report["facets"], report["max_facet_width"]), rows[0]
    assert report["options"]["curve"] == str(folder / "trade.csv")
    assert len(rows) >= 5 and rows[-1][0] <= 12, rows
    for finer, coarser in zip(rows, rows[1:]):
        assert finer[0] > coarser[0] and finer[1] < coarser[1], (finer, coarser)
        assert coarser[2] > 0.0
    target = rows[0][1] * 2.0**0.5
    again = report_of(DIAMONDS, "--unit-cube", "--width", repr(target))
    assert (again["facets"], again["max_facet_width"]) == rows[1][:2], (again["facets"], rows[1])


def test_the_picture_has_every_point_that_a_logarithm_can_show():
    folder = fresh_folder("picture")
    points = rbox("300 s D4 t1", folder / "points.txt")
    run("hull", points, "--curve", folder / "trade", "--quiet")
    rows = table_of(folder / "trade.csv")
    assert rows[0][1] < 1e-10, rows[0]  # the exact hull, left of any logarithmic axis
    root = xml.etree.ElementTree.parse(folder / "trade.svg").getroot()
    circles = root.findall("{http://www.w3.org/2000/svg}circle")
    assert len(circles) == len(rows) - 1 > 4, (len(circles), len(rows))
    across = [float(circle.get("cx")) for circle in circles]
    down = [float(circle.get("cy")) for circle in circles]
    assert across == sorted(across) and down == sorted(down)
    texts = [text.text for text in root.iter("{http://www.w3.org/2000/svg}text")]
    assert "facet width [input], certified" in texts and "facets" in texts, texts


def test_no_row_is_beaten_by_a_later_one():
    folder = fresh_folder("beaten")
    for words in ("24 s D2 t26", "60 W1e-3 D3 t25", "11 D5 t28"):
        run("hull", rbox(words, folder / "points.txt"), "--curve", folder / "trade", "--quiet")
        rows = table_of(folder / "trade.csv")
        for finer, coarser in zip(rows, rows[1:]):
            assert finer[0] > coarser[0] and finer[1] < coarser[1], (words, finer, coarser)


def test_every_axis_has_ticks():
    folder = fresh_folder("ticks")
    for words, width in (("30 s D2 t1", "30%"), ("30 s D2 t1", "60%"), ("300 s D4 t1", "35%"), ("300 s D4 t1", "45%")):
        points = rbox(words, folder / "points.txt")
        run("hull", points, "--width", width, "--curve", folder / "trade", "--quiet")
        root = xml.etree.ElementTree.parse(folder / "trade.svg").getroot()
        ticks = [text for text in root.iter("{http://www.w3.org/2000/svg}text") if text.get("class") == "tick"]
        widths = [float(tick.text) for tick in ticks if tick.get("text-anchor") == "middle"]
        facets = [int(tick.text) for tick in ticks if tick.get("text-anchor") == "end"]
        assert len(widths) >= 2 and len(facets) >= 1, (words, width, widths, facets)
        assert widths == sorted(set(widths)) and facets == sorted(set(facets)), (words, width, widths, facets)


def test_what_cannot_be_written_is_said_before_anything_is_computed():
    folder = fresh_folder("errors")
    points = rbox("30 s D3 t1", folder / "points.txt")
    one_error_line(run("hull", points, "--curve", "-", exit_code=1), "usage")
    same = ("hull", points, "--curve", folder / "a.csv", "--report", folder / "a.svg")
    one_error_line(run(*same, exit_code=1), "usage")
    one_error_line(run("hull", points, "--curve", folder / "no" / "a.csv", exit_code=1), "file-write")
    assert sorted(path.name for path in folder.iterdir()) == ["points.txt"]


run_tests(globals())
