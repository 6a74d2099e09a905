#!/usr/bin/env python3
"""ndhull view: pictures of points and of reports, what they hold, and what cannot be drawn."""

import json
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree

import numpy
from program import DIAMONDS, fresh_folder, one_error_line, rbox, run, run_tests

SVG = "{http://www.w3.org/2000/svg}"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def cube(dimension):
    """A file with the corners of [0, 1]^dimension."""
    path = fresh_folder(f"cube{dimension}") / f"cube{dimension}.csv"
    corners = numpy.indices([2] * dimension).reshape(dimension, -1).T
    numpy.savetxt(path, corners, delimiter=",", header=",".join("abcdefg"[:dimension]), comments="")
    return path


def sample(arguments, path):
    run("rbox", arguments, "-o", path)
    return path


def svg_of(source, *options):
    path = fresh_folder("svg") / "out.svg"
    run("view", source, "-o", path, *options)
    return ElementTree.parse(path).getroot()


def elements(root, tag, *classes):
    return [item for item in root.iter(SVG + tag) if set(classes) <= set(item.get("class", "").split())]


def texts(root, *classes):
    return [item.text for item in elements(root, "text", *classes)]


def faces(root):
    return elements(root, "polygon", "face")


def report_of(points, folder, *options):
    run("hull", points, "--report", folder / "report.json", "--facet-list", *options)
    return folder / "report.json"


def test_a_cube_in_5d_shows_three_of_six_faces():
    root = svg_of(cube(5), "--axes", "a,3,5")
    assert len(faces(root)) == 3 and all(len(face.get("points").split()) == 4 for face in faces(root))
    assert len({face.get("data-facet") for face in faces(root)}) == 3
    assert not elements(root, "polygon", "glass"), "the shells coincide"
    assert texts(root, "axis") == ["a", "c", "e"]
    assert any("6 in the section" in text for text in texts(root, "fact"))
    assert texts(root, "title") == ["Section of the hull of cube5.csv"]


def test_three_dimensions_are_the_hull_itself_and_two_are_flat():
    root = svg_of(cube(3))
    assert len(faces(root)) == 3 and texts(root, "axis") == ["a", "b", "c"]
    assert texts(root, "title") == ["Hull of cube3.csv"]
    root = svg_of(cube(2))
    assert len(elements(root, "line", "side")) == 4 and texts(root, "axis") == ["a", "b"]
    assert len(elements(svg_of(cube(5), "--axes", "2,4"), "line", "side")) == 4


def test_faces_that_are_turned_away_are_the_others():
    points = sample("200 s D3 t1", fresh_folder("sphere") / "sphere.npy")
    facets = json.loads(run("hull", points, "--report", "-").stdout)["facets"]
    seen = len(faces(svg_of(points)))
    assert facets / 3 < seen < facets / 2, (seen, facets)


def test_shells_that_differ_are_both_drawn():
    points = sample("1000 s D6 t1", fresh_folder("sphere6") / "sphere6.npy")
    for kind in ("--section", "--shadow"):
        root = svg_of(points, "--max-facets", "4000", kind)
        inner, outer = faces(root), elements(root, "polygon", "glass", "outer")
        assert len(inner) > 10 and len(outer) > 10, (kind, len(inner), len(outer))
        assert len({face.get("fill") for face in inner}) > 5
        assert any("status facet_limit" in text for text in texts(root, "fact"))
    assert any("0.2" in text for text in texts(root, "legend"))


def test_principal_components_are_named_and_weighed():
    root = svg_of(DIAMONDS, "--unit-cube", "--names", "carat,depth,table,price,x,y,z")
    assert texts(root, "axis") == ["PC1", "PC2", "PC3"]
    legend = " ".join(texts(root, "legend")).replace("\u00a0", " ")
    assert "PC1 91 %: 0.84 price" in legend and "[unit cube]" in legend, legend


def test_marks_are_the_largest_facets():
    folder = fresh_folder("marks")
    points = sample("100 s D3 t1", folder / "sphere.npy")
    report = report_of(points, folder)
    areas = [facet["area"] for facet in json.loads(report.read_text())["facet_list"]]
    largest = numpy.argsort(areas)[::-1][:40].tolist()
    marked = {int(item.get("data-facet")) for item in elements(svg_of(report, "--highlight", "40"), "polygon", "mark")}
    assert marked and marked <= set(largest)
    seen = {int(face.get("data-facet")) for face in faces(svg_of(report))}
    assert marked == seen & set(largest)
    assert not elements(svg_of(report, "--highlight", "0"), "polygon", "mark")
    assert elements(svg_of(points, "--shadow"), "line", "mark")


def test_a_report_gives_the_same_picture_as_its_points():
    folder = fresh_folder("report")
    flat = numpy.load(sample("60 D3 t1", folder / "flat3.npy"))
    numpy.save(folder / "flat.npy", numpy.c_[flat, flat.sum(axis=1), numpy.full(60, 2.0)] * [1, 2, 3, 4, 5])
    for points in (sample("300 s D5 t1", folder / "five.npy"), folder / "flat.npy"):
        for options in ([], ["--unit-cube"], ["--max-facets", "40"]):
            report = report_of(points, folder, *options)
            for wish in ([], ["--shadow", "--axes", "1,2,3"]):
                run("view", points, *options, *wish, "-o", folder / "points.svg")
                run("view", report, *wish, "-o", folder / "report.svg")
                one, other = (folder / "points.svg").read_text(), (folder / "report.svg").read_text()
                assert one == other, (points, options, wish)


def test_points_are_found_beside_the_report():
    folder = fresh_folder("beside")
    points = sample("20 s D4 t1", folder / "points.npy")
    report = json.loads(report_of(points, folder).read_text())
    report["input"]["path"] = "points.npy"
    (folder / "moved.json").write_text(json.dumps(report))
    svg_of(folder / "moved.json")


def test_names_are_escaped():
    folder = fresh_folder("names")
    path = folder / "a<b>&amp; \"c\".csv"
    path.write_text("<i>,x&y,\"q\"\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n")
    assert texts(svg_of(path), "axis")[:2] == ["<i>", "x&y"]
    run("view", path, "-o", folder / "out.html")
    html = (folder / "out.html").read_text()
    assert html.count("</script>") == 2 and "<i>" not in html


def test_threads_do_not_change_the_bytes():
    folder = fresh_folder("threads")
    for name in ("one.html", "two.html"):
        run("view", DIAMONDS, "--unit-cube", "--threads", len(name) % 2 + 1, "-o", folder / name)
    assert (folder / "one.html").read_bytes() == (folder / "two.html").read_bytes()


def test_the_page_loads_nothing():
    folder = fresh_folder("page")
    run("view", DIAMONDS, "-o", folder / "out.html")
    html = (folder / "out.html").read_text()
    links = re.findall(r"(?:src|href)\s*=\s*[\"']([^\"']*)|url\(([^)]*)\)|@import|https?://[^\"'\s<]*", html)
    assert all(link[0] in ("", "data:,") and link[1] in ("", "#widths") for link in links), links
    assert set(re.findall(r"https?://[^\"'\s<]*", html)) == {"http://www.w3.org/2000/svg"}


# Without a screen frames may never come: the page's script gets a clock instead.
CLOCK = "<script>window.requestAnimationFrame = work => setTimeout(work, 1);</script>"
# Runs after the page's own script: turns the drawing, points at it, and writes down what was seen.
PROBE = """<script>
const errors = [];
window.onerror = message => { errors.push(message); };
const canvas = document.getElementById("drawing");
const send = (type, fields) => canvas.dispatchEvent(new PointerEvent(type, {pointerId: 1, bubbles: true, ...fields}));
const inked = () => new Set(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data).size;
const box = canvas.getBoundingClientRect();
const middle = {clientX: box.left + box.width / 2, clientY: box.top + box.height / 2};
canvas.setPointerCapture = () => {};
const frame = () => new Promise(done => setTimeout(done, 100));
(async () => {
  await frame();
  const before = canvas.toDataURL();
  send("pointermove", {buttons: 0, ...middle});
  const tip = document.getElementById("tip").textContent;
  send("pointermove", {buttons: 1, movementX: 60, movementY: 20, ...middle});
  await frame();
  const turned = canvas.toDataURL();
  document.getElementById("reset").click();
  await frame();
  document.title = JSON.stringify({errors, tip, colours: inked(), turns: before !== turned,
                                   returns: before === canvas.toDataURL()});
})();
</script>"""


def browse(browser, path):
    """The page's title and the console's lines, after the scripts have run."""
    words = [browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             f"--user-data-dir={path.parent / 'profile'}", "--window-size=1000,700", "--virtual-time-budget=4000",
             "--enable-logging=stderr", "--dump-dom", path.as_uri()]  # fmt: skip
    done = subprocess.run(words, capture_output=True, timeout=120, check=True)
    title = re.search(r"<title>(.*?)</title>", done.stdout.decode(), re.DOTALL).group(1)
    return title, [line for line in done.stderr.decode().splitlines() if "CONSOLE" in line]


def test_the_page_turns_in_a_browser_without_errors():
    browser = os.environ.get("NDHULL_BROWSER") or next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        print("not done: no Chromium is installed to open the page in")
        return
    for options in (["--max-facets", "2000"], ["--shadow"], ["--axes", "1,2"]):
        folder = fresh_folder("browser")
        run("view", DIAMONDS, "--unit-cube", *options, "-o", folder / "out.html")
        page = folder / "out.html"
        is_flat = options[-1] == "1,2"
        if not is_flat:
            html = page.read_text().replace("<body>", "<body>" + CLOCK).replace("</body>", PROBE + "</body>")
            page.write_text(html)
        title, console = browse(browser, page)
        assert not console, console
        if is_flat:
            continue
        seen = json.loads(title.replace("&quot;", '"'))
        assert seen["turns"] and seen["returns"] and seen["colours"] > 30 and not seen["errors"], seen
        assert "facet" in seen["tip"] or "outer shell" in seen["tip"], seen


def test_shadows_of_hulls_as_thin_as_rounding_end():
    # Their outer shells are 1e10 times as far out as the hull, all by the same factor but for rounding.
    folder = fresh_folder("thin")
    for seed in range(4, 8):
        draw = numpy.random.default_rng(seed).standard_normal
        points = draw((8, 6)) * [1, 1, 1, 1, 1, 1e-13]
        numpy.save(folder / "thin.npy", points @ numpy.linalg.qr(draw((6, 6)))[0])
        for name in ("thin.svg", "thin.html"):
            run("view", folder / "thin.npy", "--shadow", "--width", "10%", "-o", folder / name, timeout=20)
        assert "nan" not in (folder / "thin.svg").read_text()


def test_what_cannot_be_drawn_is_one_line_and_no_file():
    folder = fresh_folder("bad")
    points = sample("30 s D5 t1", folder / "points.npy")
    report = json.loads(report_of(points, folder).read_text())

    def changed(name, **fields):
        (folder / name).write_text(json.dumps({**report, **fields}))
        return folder / name

    short = {key: value for key, value in report.items() if key != "facet_list"}
    (folder / "short.json").write_text(json.dumps(short))
    (folder / "text.json").write_text("{\"input\": ")
    (folder / "other.json").write_text("{\"a\": [1, 2]}")
    numpy.save(folder / "line.npy", numpy.outer(numpy.arange(5.0), [1, 2, 3]))
    numpy.save(folder / "plane.npy", numpy.random.default_rng(1).normal(size=(9, 2)) @ [[1, 2, 3, 1], [0, 1, 1, 2]])
    numpy.save(folder / "far.npy", numpy.load(points) * 1e250)
    numpy.save(folder / "near.npy", numpy.load(points) * 1e-250)
    first = {**report["facet_list"][0], "outer_offset": -1.0}
    cases = [
        ([folder / "far.npy", "-o", "out.svg"], "out-of-range", "--axes"),
        ([folder / "near.npy", "-o", "out.svg", "--unit-cube"], "out-of-range", "--axes"),
        ([points, "-o", "out.png"], "usage", ".svg"),
        ([points, "-o", "out"], "usage", ".svg"),
        ([points], "usage", "output"),
        ([points, "-o", folder / "none" / "out.svg"], "file-write", "none"),
        ([points, "-o", "out.svg", "--axes", "1,2,6"], "usage", "1 to 5"),
        ([points, "-o", "out.svg", "--axes", "1,2,2"], "usage", "different"),
        ([points, "-o", "out.svg", "--axes", "1"], "usage", "two or three"),
        ([points, "-o", "out.svg", "--axes", "1,2,3,4"], "usage", "two or three"),
        ([points, "-o", "out.svg", "--axes", "0,1,2"], "usage", "1 to 5"),
        ([points, "-o", "out.svg", "--axes", "price,1,2"], "usage", "price"),
        ([points, "-o", "out.svg", "--axes", ""], "usage", "axes"),
        ([points, "-o", "out.svg", "--axes", "1,2", "--principal"], "usage", ""),
        ([points, "-o", "out.svg", "--section", "--shadow"], "usage", ""),
        ([points, "-o", "out.svg", "--names", "a,b"], "usage", "expected 5"),
        ([points, "-o", "out.svg", "--highlight", "-1"], "usage", "-1"),
        ([folder / "absent.npy", "-o", "out.svg"], "file-missing", "absent"),
        ([folder / "line.npy", "-o", "out.svg"], "usage", "span only 1"),
        ([folder / "plane.npy", "-o", "out.svg", "--axes", "1,2"], "usage", "2-d subspace"),
        ([folder / "plane.npy", "-o", "out.svg", "--axes", "1,2,3", "--shadow"], "usage", "flat"),
        ([folder / "short.json", "-o", "out.svg"], "usage", "--facet-list"),
        ([folder / "text.json", "-o", "out.svg"], "bad-header", "text.json"),
        ([folder / "other.json", "-o", "out.svg"], "bad-header", "other.json"),
        ([changed("gone.json", input={**report["input"], "path": "gone.npy"}), "-o", "out.svg"], "file-missing", "gone"),
        ([changed("pipe.json", input={**report["input"], "path": "-"}), "-o", "out.svg"], "usage", "standard input"),
        ([changed("more.json", input={**report["input"], "points": 31}), "-o", "out.svg"], "wrong-count", "expected 31"),
        ([changed("part.json", facet_list=report["facet_list"][:9]), "-o", "out.svg"], "usage", "expected all"),
        ([changed("open.json", facet_list=report["facet_list"][:3], facets=3), "-o", "out.svg"], "usage", "open"),
        ([changed("none.json", facet_list=[], facets=0), "-o", "out.svg"], "usage", ""),
        ([changed("minus.json", facet_list=[first], facets=1), "-o", "out.svg"], "bad-header", "inside out"),
    ]  # fmt: skip
    before = sorted(folder.iterdir())
    for arguments, code, word in cases:
        words = [folder / word if isinstance(word, str) and word.startswith("out") else word for word in arguments]
        done = run("view", *words, exit_code=1)
        one_error_line(done, code)
        assert word in done.stderr, (arguments, done.stderr)
        assert sorted(folder.iterdir()) == before, arguments


def test_a_report_has_its_hull():
    folder = fresh_folder("view_report")
    rbox("100 s D4 t1", folder / "points.npy")
    run("hull", folder / "points.npy", "--report", folder / "hull.json", "--facet-list", "--quiet")
    for words in (("--width", "5%"), ("--facets", "20"), ("--outside-width", "1%"), ("--columns", "1,2,3")):
        done = run("view", folder / "hull.json", *words, "-o", folder / "hull.svg", exit_code=1)
        one_error_line(done, "usage")
        assert "report" in done.stderr and not (folder / "hull.svg").exists()
    run("view", folder / "hull.json", "--max-seconds", 5, "-o", folder / "hull.svg")


if __name__ == "__main__":
    run_tests(globals())
