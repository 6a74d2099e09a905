#!/usr/bin/env python3
"""ndhull-bench report: the page has its charts, loads nothing, opens without an error, and its numbers are those of the
programs ndhull and qhull.

report_test.py PROGRAM SCRATCH. Exit code 77 (skipped) without gnuplot.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

PROGRAM, SCRATCH = sys.argv[1], pathlib.Path(sys.argv[2])
NDHULL = os.environ["NDHULL"]
SVG = "{http://www.w3.org/2000/svg}"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
RESULTS = SCRATCH / "report.jsonl"


def run(*words, stdin="", exit_code=0):
    done = subprocess.run(list(map(str, words)), input=stdin, capture_output=True, text=True, timeout=200, check=False)
    assert done.returncode == exit_code, (words, done.returncode, done.stdout[:500], done.stderr[:500])
    return done.stdout


def measure():
    run(PROGRAM, "sweep", "--families", "sphere,gaussian", "--dimensions", "3-5", "--points", "60", "--options",
        "exact,width 20%,width 10%,W5% C1%", "--engines", "ndhull,qhull", "--rounds", "2", "--warm-up", "0",
        "--json", RESULTS, "--quiet")  # fmt: skip
    return [json.loads(line) for line in RESULTS.read_text(encoding="utf-8").splitlines()]


def page():
    path = SCRATCH / "report.html"
    run(PROGRAM, "report", RESULTS, "-o", path)
    return path


def charts_of(html):
    """One parsed picture for each <svg> of the page."""
    return [ElementTree.fromstring(text) for text in re.findall(r"<svg.*?</svg>", html, re.DOTALL)]


def words_of(picture):
    return ["".join(element.itertext()).strip() for element in picture.iter(f"{SVG}text")]


def test_the_charts_name_axes_units_and_lines():
    html = page().read_text(encoding="utf-8")
    charts = [words_of(picture) for picture in charts_of(html)]
    assert len(charts) == html.count("<figure") >= 8, len(charts)
    runtime = [words for words in charts if "seconds" in words]
    assert len(runtime) == 2, charts
    for words in runtime:
        assert "dimension" in words and {"3", "4", "5"} <= set(words), words
        assert {"ndhull, exact", "Qhull, exact", "ndhull, width 20%", "Qhull, W5% C1%"} <= set(words), words
        # A logarithmic axis: neighbouring labels are decades apart.
        ticks = sorted(float(word) for word in words if re.fullmatch(r"(0\.0*1|1|1e-\d+)", word))
        assert len(ticks) >= 2 and all(abs(b / a - 10) < 1e-6 for a, b in zip(ticks, ticks[1:])), words
    assert any("facets" in words and "ndhull, targets" in words for words in charts)
    assert any("growth" in words and "certify" in words for words in charts)
    assert sum("width of the widest facet [input units]" in words for words in charts) >= 3


def test_the_page_loads_nothing():
    html = page().read_text(encoding="utf-8")
    assert set(re.findall(r"https?://[^\"'\s<]*", html)) <= {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}
    links = re.findall(r"(?:src|href)\s*=\s*[\"']([^\"']*)", html)
    assert all(link == "data:," or link.startswith("#") for link in links), links
    assert "<script" not in html and "url(http" not in html
    names = re.findall(r"\bid=['\"]([^'\"]*)", html)
    assert len(names) == len(set(names)), "two elements of one name"


PROBE = """<script>
const boxes = [...document.querySelectorAll("figure svg")].map(svg => svg.getBoundingClientRect());
const lines = document.querySelectorAll("figure svg path").length;
document.title = JSON.stringify({shown: boxes.filter(box => box.width > 200 && box.height > 100).length, lines,
                                 figures: document.querySelectorAll("figure").length,
                                 wide: document.documentElement.scrollWidth > window.innerWidth});
</script>"""


def test_a_browser_shows_every_chart_without_errors():
    browser = os.environ.get("NDHULL_BROWSER") or next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        print("not done: no Chromium is installed to open the page in")
        return
    path = SCRATCH / "probed.html"
    path.write_text(page().read_text(encoding="utf-8").replace("</body>", PROBE + "</body>"), encoding="utf-8")
    done = subprocess.run([browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                           f"--user-data-dir={SCRATCH / 'profile'}", "--window-size=1000,700", "--enable-logging=stderr",
                           "--virtual-time-budget=4000", "--dump-dom", path.resolve().as_uri()],
                          capture_output=True, timeout=120, check=True)  # fmt: skip
    console = [line for line in done.stderr.decode().splitlines() if "CONSOLE" in line]
    assert not console, console
    title = re.search(r"<title>(.*?)</title>", done.stdout.decode(), re.DOTALL).group(1)
    seen = json.loads(title.replace("&quot;", '"'))
    assert seen["shown"] == seen["figures"] >= 8 and seen["lines"] > 10 * seen["figures"] and not seen["wide"], seen


def test_markdown_has_the_numbers_of_the_results():
    records = measured
    text = run(PROGRAM, "report", RESULTS, "--markdown", "-o", "-")
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:1] == "|"]
    for record in records:
        name = [record["input"], record["engine"], record["options"]]
        row = next(row for row in rows if row[:3] == name)
        assert row[3] == f"{record['facets']:,}" and row[4] == f"{record['vertices']:,}", (row, record)
    assert "Qhull's seconds over ndhull's" in text, text


def test_every_command_has_its_tables():
    others = SCRATCH / "others.jsonl"
    lines = ""
    for words in (("halfspaces", "--only", "1000 in 6-d, distance 1 to", "--rounds", "1", "--ndhull", NDHULL),
                  ("selections", "--only", "500 D4"), ("joggle", "--only", "c D3", "--runs", "20"),
                  ("phases", "--only", "c D8", "--rounds", "1"),
                  ("rays", "--only", "2000 s D5", "--seeds", "1", "--skip-big"),
                  ("approximate", "--only", "2000 s D5", "--rounds", "1", "--target-rounds", "1", "--skip-qhull", "--widths", "20%")):  # fmt: skip
        path = SCRATCH / f"{words[0]}.jsonl"
        run(PROGRAM, *words, "--json", path, *(["--quiet"] if words[0] != "approximate" else []))
        lines += path.read_text(encoding="utf-8")
    others.write_text(lines, encoding="utf-8")
    text = run(PROGRAM, "report", RESULTS, others, "--markdown", "-o", "-")
    for title in ("Intersection of halfspaces", "What 20 outer planes enclose", "Joggled unit cube", "Where the seconds go",
                  "The largest facets by rays", "Approximate hulls beside the exact one"):  # fmt: skip
        assert f"### {title}" in text, (title, text)
    run(PROGRAM, "report", RESULTS, others, "-o", SCRATCH / "every.html")
    html = (SCRATCH / "every.html").read_text(encoding="utf-8")
    charts = [words_of(picture) for picture in charts_of(html)]
    assert sum("share of joggles with a precision problem" in words for words in charts) == 1, charts
    # Only hulls are in the list of all measurements.
    rows = re.findall(r"<tr>(.*?)</tr>", html[html.index("All measurements</h2>"):])
    assert any("c D8" in row for row in rows) and not any("QJ" in row or "intersect" in row for row in rows)
    run(PROGRAM, "report", SCRATCH / "joggle.jsonl", "-o", SCRATCH / "joggle.html")


README = """# Title

Words <!-- table: exact --> stay.

<!-- table: exact -->
| old |
<!-- end of table -->
between
<!-- table: machine -->
<!-- end of table -->
"""


def test_readme_has_the_tables_of_the_results():
    folder, readme = SCRATCH / "readme", SCRATCH / "readme" / "README.md"
    folder.mkdir(exist_ok=True)
    readme.write_text(README, encoding="utf-8")
    run(PROGRAM, "peers", "--only", "2000 s D5", "--rounds", "1", "--quiet", "--json", folder / "peers.jsonl")
    run(PROGRAM, "readme", folder, readme, "--check", exit_code=1)
    assert readme.read_text(encoding="utf-8") == README
    assert run(PROGRAM, "readme", folder, readme) == f"{readme}\n"
    text = readme.read_text(encoding="utf-8")
    ours, theirs = (json.loads(line) for line in (folder / "peers.jsonl").read_text(encoding="utf-8").splitlines())
    row = next(line for line in text.splitlines() if line.startswith("| `2000 s D5 t1`")).strip("| ").split(" | ")
    assert row[1] == "56,576" and row[7] == f"{theirs['wall_seconds'] / ours['wall_seconds']:.1f}", row
    assert "| old |" not in text and ours["machine"]["cpu"] in text, text
    assert text.startswith("# Title\n\nWords <!-- table: exact --> stay.\n") and "\nbetween\n" in text, text
    run(PROGRAM, "readme", folder, readme, "--check")
    # A peer that met a limit is not left out.
    stopped = {**theirs, "end": "time_limit", "reason": "stopped after 20 s"}
    (folder / "peers.jsonl").write_text(f"{json.dumps(ours)}\n{json.dumps(stopped)}\n", encoding="utf-8")
    run(PROGRAM, "readme", folder, readme)
    assert row[:5] + ["stopped after 20 s", "-", "-"] in [
        line.strip("| ").split(" | ") for line in readme.read_text(encoding="utf-8").splitlines()]  # fmt: skip
    for bad in ("<!-- table: exact -->\n", "<!-- end of table -->\n", "<!-- table: exact -->\n" * 2,
                "<!-- table: unknown -->\n<!-- end of table -->\n", "<!-- table: joggled cube -->\n<!-- end of table -->\n"):  # fmt: skip
        readme.write_text(bad, encoding="utf-8")
        run(PROGRAM, "readme", folder, readme, exit_code=1)
        assert readme.read_text(encoding="utf-8") == bad
    run(PROGRAM, "readme", SCRATCH / "no-such-folder", readme, exit_code=1)


def test_two_rows_are_what_the_programs_say():
    points = run(NDHULL, "generate", "sphere", "-d", "5", "-n", "60", "--seed", "1", "-o", "-")
    row = {(record["engine"], record["options"]): record for record in measured
           if record["input"] == "sphere 5-d, 60, seed 1"}  # fmt: skip
    report = json.loads(run(NDHULL, "hull", "-", "--width", "20%", "--threads", "1", "--report", "-", stdin=points))
    ours = row["ndhull", "width 20%"]
    assert (report["facets"], report["vertices"]) == (ours["facets"], ours["vertices"]), (report, ours)
    assert report["max_facet_width"] == ours["max_facet_width"] and report["volume"] == ours["detail"]["volume"]
    if shutil.which("qhull") is None:
        print("not done: the program qhull is not installed")
        return
    summary = subprocess.run(["qhull", "s"], input=points, capture_output=True, text=True, timeout=60, check=True)
    facets = int(re.search(r"Number of facets: (\d+)", summary.stderr).group(1))
    assert facets == row["qhull", "exact"]["facets"] == row["ndhull", "exact"]["facets"]


def test_what_is_no_result_is_refused():
    bad = SCRATCH / "bad.jsonl"
    for text in ("", "{}\n", "points\n"):
        bad.write_text(text, encoding="utf-8")
        run(PROGRAM, "report", bad, "-o", SCRATCH / "bad.html", exit_code=1)
    run(PROGRAM, "report", SCRATCH / "missing.jsonl", "-o", SCRATCH / "bad.html", exit_code=1)
    assert not (SCRATCH / "bad.html").exists()


if __name__ == "__main__":
    if shutil.which("gnuplot") is None:
        print("skipped: gnuplot, which draws the charts, is not installed (apt-get install gnuplot-nox)")
        sys.exit(77)
    measured = measure()
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            print("passed:", name)
