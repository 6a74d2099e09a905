#!/usr/bin/env python3
"""House rules a compiler does not check; prints every place that breaks one and exits 1 if there is any.

Layers      core includes nothing of approx, tools; approx nothing of tools; none of them tests or bench. Folders inside
            them include each other in no circle, nor by way of the files that stand beside them.
Libraries   CGAL only in core/exact_orientation.cpp, and there only headers under the LGPL; GLM only in
            approx/drawing/projection.*; no streams in core and approx: they have no output. (Tests and bench are free.)
Sources     every .cpp is named in a CMakeLists.txt of its folder or one above; no file has more than 400 lines.
Headers     a file that uses a type of one of our headers includes it, itself or through what it includes: sources that are
            compiled as one unit would hide that. For the same reason no file uses a function or a constant that another
            source keeps in its unnamed namespace.
Words       no identifier `eps`, no `using namespace std`, no note left open without an issue number.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ["core", "approx", "tools", "tests", "bench", "include", "scripts"]
SUFFIXES = {".cpp", ".h", ".py"}
MAX_LINES = 400
MAY_NOT_INCLUDE = {
    "core": {"approx", "tools", "tests", "bench"},
    "approx": {"tools", "tests", "bench"},
    "tools": {"tests", "bench"},
}
CGAL_FILE = "core/exact_orientation.cpp"
# NewKernel_d and Number_types are LGPL; Triangulation, QP_solver, Spatial_searching and most others are GPL.
CGAL_HEADERS = {"CGAL/Epick_d.h", "CGAL/Epeck_d.h", "CGAL/Gmpq.h", "CGAL/Gmpz.h", "CGAL/Gmpzf.h", "CGAL/Mpzf.h",
                "CGAL/Interval_nt.h", "CGAL/determinant.h"}
GLM_FILES = re.compile(r"approx/drawing/projection\.(cpp|h)$")
STREAMS = {"iostream", "fstream", "ostream", "istream"}
# Written in two halves, so that this file passes its own check.
OPEN_NOTE = re.compile(r"\b(TO" + r"DO|FIX" + r"ME|XX" + r"X|HA" + r"CK)\b(?!\(#\d+\))")
EPSILON = re.compile(r"\b(\w+_)?ep" + r"s(_\w*)?\b")
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def without_comments_and_strings(text):
    return COMMENT_OR_STRING.sub(lambda match: "\n" * match.group().count("\n"), text)


def check_includes(name, line_number, header):
    top = name.split("/")[0]
    where = f"{name}:{line_number}"
    if header.split("/")[0] in MAY_NOT_INCLUDE.get(top, set()):
        yield f"{where}: {top} may not include {header}"
    if top not in MAY_NOT_INCLUDE:
        return
    if header.startswith("CGAL/") and name != CGAL_FILE:
        yield f"{where}: CGAL belongs in {CGAL_FILE}"
    if header.startswith("CGAL/") and header not in CGAL_HEADERS:
        yield f"{where}: {header} is not among the headers known to be LGPL"
    if header.startswith("glm/") and not GLM_FILES.match(name):
        yield f"{where}: GLM belongs in approx/drawing/projection.*"
    if header in STREAMS and top != "tools":
        yield f"{where}: {top} has no input and output, <{header}> is not for it"


def check_file(path):
    name = path.relative_to(ROOT).as_posix()
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    if len(lines) > MAX_LINES:
        yield f"{name}: {len(lines)} lines, at most {MAX_LINES}: does it hold two ideas?"
    for number, line in enumerate(lines, 1):
        if OPEN_NOTE.search(line):
            yield f"{name}:{number}: a note left open needs an issue, written as in TO" + "DO(#12)"
        include = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
        if include:
            yield from check_includes(name, number, include.group(1))
    if path.suffix == ".py":
        return
    for number, line in enumerate(without_comments_and_strings(text).splitlines(), 1):
        if EPSILON.search(line):
            yield f"{name}:{number}: say roundoff (what arithmetic forces) or tolerance (what the user allows)"
        if re.search(r"\busing\s+namespace\s+std\b", line):
            yield f"{name}:{number}: no using namespace std"


def check_is_built(path):
    name = path.relative_to(ROOT).as_posix()
    folder = path.parent
    while folder != ROOT:
        lists = folder / "CMakeLists.txt"
        if lists.exists() and path.relative_to(folder).as_posix() in re.split(r"[\s()]+", lists.read_text()):
            return
        folder = folder.parent
    yield f"{name}: in no CMakeLists.txt, so it is not built"


class Types:
    """Which header declares a type, and what each file includes, itself or through others."""

    DECLARED = re.compile(r"^(?:class|struct|enum class)\s+(\w+)\b(?![^;{]*;)", re.MULTILINE)
    FORWARD = re.compile(r"^(?:class|struct|enum class)\s+(\w+)[^;{]*;", re.MULTILINE)
    INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)

    def __init__(self, files):
        self.includes, self.text, self.reach, header_of = {}, {}, {}, {}
        for path in files:
            name = path.relative_to(ROOT).as_posix()
            text = path.read_text(encoding="utf-8")
            included = self.INCLUDE.findall(text)
            self.includes[name] = [f"include/{header}" if header.startswith("ndhull/") else header for header in included]
            self.text[name] = without_comments_and_strings(text)
            if name.endswith(".h"):
                for declared in self.DECLARED.findall(self.text[name]):
                    header_of.setdefault(declared, set()).add(name)
        self.header_of = {declared: min(names) for declared, names in header_of.items() if len(names) == 1}

    def reached_from(self, name):
        if name not in self.reach:
            self.reach[name] = {name}
            for header in self.includes.get(name, []):
                self.reach[name] |= self.reached_from(header)
        return self.reach[name]

    def check(self):
        for name, text in self.text.items():
            own = set(self.FORWARD.findall(text)) | set(self.DECLARED.findall(text))
            for word in sorted(set(re.findall(r"\w+", text)) - own):
                header = self.header_of.get(word)
                if header and header not in self.reached_from(name):
                    yield f"{name}: uses {word} and does not include {header}"


def room_of(name):
    """The folder inside core, approx or tools; of a file that stands in these itself, it and its header."""
    parts = name.split("/")
    return "/".join(parts[:2]) if len(parts) > 2 else name.rsplit(".", 1)[0]


def check_circles(includes):
    below = {}
    for name, headers in includes.items():
        if name.split("/")[0] in MAY_NOT_INCLUDE:
            inside = {room_of(header) for header in headers if header.split("/")[0] == name.split("/")[0]}
            below.setdefault(room_of(name), set()).update(inside - {room_of(name)})
    while ground := {room for room, rooms in below.items() if not rooms & below.keys()}:
        below = {room: rooms for room, rooms in below.items() if room not in ground}
    while roof := below.keys() - set().union(*below.values()):
        below = {room: rooms for room, rooms in below.items() if room not in roof}
    if below.keys() & {room_of(name) for name in includes if name.count("/") > 1}:
        yield f"{', '.join(sorted(below))}: include each other in a circle"


class OwnNames:
    """Functions and constants in the unnamed namespace of a source, for nobody else."""

    UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}", re.MULTILINE | re.DOTALL)
    FUNCTION = re.compile(r"^[A-Za-z](?:[\w:<>,&*\[\] ]|\n )*?[ >&*](\w+)\(", re.MULTILINE)
    CONSTANT = re.compile(r"^(?:inline )?const(?:expr)? [^=;{(]*?\b(\w+)(?:\[[^\]]*\])? ?[={]", re.MULTILINE)
    def __init__(self, types):
        self.types, self.owners = types, {}
        for name, text in types.text.items():
            if name.endswith(".cpp"):
                for part in self.UNNAMED.findall(text):
                    for own in self.FUNCTION.findall(part) + self.CONSTANT.findall(part):
                        self.owners.setdefault(own, set()).add(name)

    def is_declared(self, word, name):
        """In the file or in what it includes: after a type, as another one of the same type, or by a capture."""
        declaration = re.compile(rf"[\w>&*\]](?<!return)(?<!else)(?<!case)(?<!throw)\s+[&*]*{word}\b *[({{=;:,\[)]"
                                 rf"|, {word} *[=\[]|[\[ ,]&?{word}\]")
        return any(declaration.search(self.types.text.get(file, "")) for file in self.types.reached_from(name))

    def check(self):
        for name, text in self.types.text.items():
            if not name.endswith(".cpp"):
                continue
            for word in sorted(set(re.findall(r"(?<![\w.>:])\w+", text)) & self.owners.keys()):
                beside = sorted(owner for owner in self.owners[word] if owner.split("/")[0] == name.split("/")[0])
                is_used = re.search(rf"(?<![\w.>:]){word}(?:<[^;()]*>)?\(", text) or word.startswith("k")
                if is_used and beside and name not in beside and not self.is_declared(word, name):
                    yield f"{name}: uses {word} of {beside[0]}, which keeps it to itself"


def main():
    findings = []
    files = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.suffix in SUFFIXES)
    for path in files:
        findings.extend(check_file(path))
        if path.suffix == ".cpp":
            findings.extend(check_is_built(path))
    types = Types(path for path in files if path.suffix != ".py")
    findings.extend(types.check())
    findings.extend(check_circles(types.includes))
    findings.extend(OwnNames(types).check())
    print("\n".join(findings) if findings else f"check_layers: {len(files)} files, nothing found")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
