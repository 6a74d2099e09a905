"""scripts/check_layers.py finds each thing it forbids, and only that, in a small tree made for the purpose."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "check_layers.py"
CLEAN = {
    "core/CMakeLists.txt": "target_sources(core PRIVATE growth.cpp exact_orientation.cpp)",
    "core/growth.cpp": '#include "core/growth.h"\n// ep' 's in a comment is prose\n',
    "core/growth.h": "int steps();\n",
    "core/exact_orientation.cpp": "#include <CGAL/Epick_d.h>\n",
    "approx/drawing/projection.h": '#include <glm/glm.hpp>\n#include "core/growth.h"\n',
}
# What is added to the clean tree, and a piece of the one line that must be reported.
BROKEN = [
    ({"core/a.h": '#include "approx/hull.h"\n'}, "core/a.h:1: core may not include approx/hull.h"),
    ({"approx/a.h": '\n#include "tools/readers.h"\n'}, "approx/a.h:2: approx may not include"),
    ({"tools/a.h": '#include "tests/support/cases.h"\n'}, "tools/a.h:1: tools may not include"),
    ({"core/a.h": "#include <CGAL/Epick_d.h>\n"}, "CGAL belongs in"),
    ({"core/exact_orientation.cpp": "#include <CGAL/Triangulation.h>\n"}, "not among the headers known to be LGPL"),
    ({"approx/a.h": "#include <glm/vec3.hpp>\n"}, "GLM belongs in"),
    ({"core/a.h": "#include <iostream>\n"}, "no input and output"),
    ({"core/lost.cpp": "\n"}, "core/lost.cpp: in no CMakeLists.txt"),
    ({"core/a.h": "class Hull {\n};\n", "core/b.h": "Hull hull;\n"}, "core/b.h: uses Hull and does not include core/a.h"),
    ({"core/CMakeLists.txt": CLEAN["core/CMakeLists.txt"] + "(a.cpp)",
      "core/a.cpp": "namespace {\n\nint twice(int x) {\n  return 2 * x;\n}\n\n}\n",
      "core/growth.cpp": "int steps() { return twice(3); }\n"}, "core/growth.cpp: uses twice of core/a.cpp"),
    ({"core/CMakeLists.txt": CLEAN["core/CMakeLists.txt"] + "(a.cpp)",
      "core/a.cpp": "namespace {\nconstexpr int kMany = 3;\n}\n",
      "core/growth.cpp": "int steps() { return kMany; }\n"}, "core/growth.cpp: uses kMany of core/a.cpp"),
    ({"core/one/a.h": '#include "core/two/b.h"\n', "core/two/b.h": "\n", "core/c.h": '#include "core/one/a.h"\n',
      "core/two/d.h": '#include "core/one/e.h"\n', "core/one/e.h": "\n"}, "core/one, core/two: include each other in a circle"),
    ({"core/one/a.h": '#include "core/b.h"\n', "core/b.h": '#include "core/one/c.h"\n', "core/one/c.h": "\n"},
     "core/b, core/one: include each other in a circle"),
    ({"core/a.h": "\n" * 401}, "401 lines"),
    ({"core/a.h": "double area_ep" "s = 0;\n"}, "say roundoff"),
    ({"core/a.h": "using  namespace std;\n"}, "no using namespace std"),
    ({"core/a.h": "// TO" "DO: later\n"}, "needs an issue"),
]


def findings(files):
    with tempfile.TemporaryDirectory(dir=os.environ.get("NDHULL_SCRATCH")) as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        (root / "scripts").mkdir()
        script = shutil.copy(SCRIPT, root / "scripts")
        run = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False)
        return run.returncode, run.stdout.splitlines()


def main():
    code, lines = findings(CLEAN)
    assert code == 0 and len(lines) == 1, lines
    code, lines = findings(CLEAN | {"core/a.h": "// TO" "DO(#12): allowed\n"})
    assert code == 0, lines
    reached = {"core/a.h": "class Hull {\n};\n", "core/b.h": '#include "core/a.h"\n',
               "core/c.h": '#include "core/b.h"\nHull hull;\n', "core/d.h": "class Hull;\nHull* hull;\n"}  # fmt: skip
    code, lines = findings(CLEAN | reached)
    assert code == 0, lines
    pair = {"core/a.h": '#include "core/b.h"\n', "core/b.h": '#include "core/a.h"\n', "core/one/c.h": '#include "core/a.h"\n'}
    code, lines = findings(CLEAN | pair)
    assert code == 0, lines
    own = {"core/CMakeLists.txt": CLEAN["core/CMakeLists.txt"] + "(a.cpp b.cpp)",
           "core/a.cpp": "namespace {\nconstexpr int kMany = 3;\nint twice(int x) {\n  return 2 * x;\n}\n}\n",
           "core/b.cpp": "int f() {\n  constexpr int kFew = 2, kMany = 4;\n  return kFew * kMany;\n}\n",
           "core/growth.cpp": "struct Steps {\n  int twice(int);\n};\nint steps() { return Steps().twice(3); }\n"}
    code, lines = findings(CLEAN | own)
    assert code == 0, lines
    for added, expected in BROKEN:
        code, lines = findings(CLEAN | added)
        assert code == 1 and len(lines) == 1 and expected in lines[0], (added, lines)
    print(f"{len(BROKEN)} broken rules found")


if __name__ == "__main__":
    main()
