#!/usr/bin/env python3
"""check-includes.py — holds the source tree to its layout.

Checks   includes point to the left only: base, image, csg, scene, geometry, edges, then rounding,
         beam, edgepoint and shading (which never include each other), then render; io takes only
         base, image, scene and geometry; the public headers take only each other; no cycles of
         headers; files of at most 700 lines, lines of at most 120 columns; no notes to do later.
Prints   one line for each finding: file:line: what is wrong. Exit 1 if there is any.
Usage    check-includes.py [ROOT] | check-includes.py --self-test
"""

import re
import sys
import tempfile
from pathlib import Path

MAX_LINES = 700
MAX_COLUMNS = 120
SUFFIXES = {".h", ".cpp", ".py", ".sh"}

# Module → what it may include besides itself and the public headers.
LEFT_OF_PARTS = ["base", "image", "csg", "scene", "geometry", "edges"]
PARTS = ["rounding", "beam", "edgepoint", "shading"]
MAY_INCLUDE = {name: set(LEFT_OF_PARTS[:at]) for at, name in enumerate(LEFT_OF_PARTS)}
MAY_INCLUDE |= {name: set(LEFT_OF_PARTS) for name in PARTS}
MAY_INCLUDE["render"] = set(LEFT_OF_PARTS) | set(PARTS)
MAY_INCLUDE["io"] = {"base", "image", "scene", "geometry"}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<(arris/[^>]+)>)')
LATER = re.compile(r"\b(" + "|".join(["TO" + "DO", "FIX" + "ME", "XX" + "X", "HA" + "CK"]) + r")\b")


def source_files(root):
    folders = ["include", "src", "apps", "tests", "bench", "examples", "scripts", "cmake"]
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file():
                yield path


def includes_of(path):
    """(line number, included name) of each quoted or <arris/…> include."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1) or match.group(2)


def arrow_error(path, root, name):
    """Why the file may not include `name`, or None."""
    parts = path.relative_to(root).parts
    target = name.split("/")[0]
    if parts[0] == "include":
        return None if target == "arris" else "public headers include only public headers"
    if parts[0] != "src" or target == "arris":
        return None
    if len(parts) < 3:
        return "sources belong into a module's folder, src/<module>/"
    module = parts[1]
    if module not in MAY_INCLUDE:
        return f'unknown module "{module}": give it a place in the arrows'
    if "/" not in name:
        return f'write the module too: "{module}/{name}"'
    if target == module:
        return None
    if target not in MAY_INCLUDE:
        return f'"{target}" is no module of the library'
    if target not in MAY_INCLUDE[module]:
        return f"{module} must not include {target}: includes point to the left only"
    return None


def find_header(root, name):
    for folder in ("src", "include"):
        if (root / folder / name).is_file():
            return root / folder / name
    return None


def check_arrows(root):
    for path in source_files(root):
        if path.suffix not in (".h", ".cpp"):
            continue
        for number, name in includes_of(path):
            error = arrow_error(path, root, name)
            if error:
                yield path, number, error


def check_cycles(root):
    """Depth-first walk of the headers; a header met again on the current path closes a cycle."""
    done = set()

    def walk(path, trail):
        if path in trail:
            cycle = [*trail[trail.index(path) :], path]
            yield path, 1, "headers in a circle: " + " → ".join(step.name for step in cycle)
            return
        if path in done:
            return
        for _, name in includes_of(path):
            header = find_header(root, name)
            if header:
                yield from walk(header, [*trail, path])
        done.add(path)

    for path in source_files(root):
        if path.suffix == ".h" and path.relative_to(root).parts[0] in ("src", "include"):
            yield from walk(path, [])


def check_texts(root):
    for path in source_files(root):
        lines = path.read_text(encoding="utf-8").splitlines()
        if len(lines) > MAX_LINES:
            yield path, MAX_LINES, f"{len(lines)} lines; at most {MAX_LINES}: split the file"
        for number, line in enumerate(lines, 1):
            if len(line) > MAX_COLUMNS:
                yield path, number, f"{len(line)} columns; at most {MAX_COLUMNS}"
            if LATER.search(line):
                yield path, number, "a note to do something later: do it, or open an issue"
        if path.suffix == ".h" and "#pragma once" not in lines:
            yield path, 1, "header without #pragma once"


def check(root):
    findings = [*check_arrows(root), *check_cycles(root), *check_texts(root)]
    return [f"{path.relative_to(root)}:{line}: {text}" for path, line, text in findings]


# Each case: the files of a small tree, and what its one finding must contain (None: no finding).
ONCE = "#pragma once\n"
SELF_TESTS = [
    ({"src/render/a.h": ONCE + '#include "rounding/b.h"\n', "src/rounding/b.h": ONCE}, None),
    ({"src/io/a.cpp": '#include "geometry/b.h"\n#include "arris/io.h"\n'}, None),
    ({"src/rounding/a.cpp": '#include "shading/b.h"\n'}, "rounding must not include shading"),
    ({"src/base/a.cpp": '#include "geometry/b.h"\n'}, "base must not include geometry"),
    ({"src/geometry/a.cpp": '#include "render/b.h"\n'}, "geometry must not include render"),
    ({"src/io/a.cpp": '#include "render/b.h"\n'}, "io must not include render"),
    ({"src/render/a.cpp": '#include "io/b.h"\n'}, "render must not include io"),
    ({"src/render/a.cpp": '#include "apps/arris/b.h"\n'}, '"apps" is no module'),
    ({"src/render/a.cpp": '#include "b.h"\n'}, 'write the module too: "render/b.h"'),
    ({"src/odd/a.cpp": '#include "base/b.h"\n'}, 'unknown module "odd"'),
    ({"include/arris/a.h": ONCE + '#include "base/b.h"\n'}, "only public headers"),
    ({"include/arris/a.h": "int a;\n"}, "without #pragma once"),
    (
        {
            "src/base/a.h": ONCE + '#include "base/b.h"\n',
            "src/base/b.h": ONCE + '#include "base/a.h"\n',
        },
        "a.h → b.h → a.h",
    ),
    ({"src/base/a.cpp": "// x\n" * (MAX_LINES + 1)}, "at most 700: split"),
    ({"src/base/a.cpp": "x" * (MAX_COLUMNS + 1)}, "at most 120"),
    ({"tests/base/a.cpp": "// TO" + "DO: later\n"}, "a note to do something later"),
]


def self_test():
    failures = 0
    for files, expected in SELF_TESTS:
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            findings = check(Path(folder))
        wrong = findings if expected is None else [f for f in findings if expected not in f]
        if wrong or bool(findings) != (expected is not None):
            failures += 1
            print(f"self-test: {files} expected {expected!r}, found {findings}")
    print(f"self-test: {len(SELF_TESTS) - failures} passed, {failures} failed")
    return failures


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 1 if self_test() else 0
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    findings = check(root)
    for finding in findings:
        print(finding)
    if findings:
        print(f"check-includes: {len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
