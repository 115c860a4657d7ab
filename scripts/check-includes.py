#!/usr/bin/env python3
"""check-includes.py — holds the source tree to its layout.

Checks   includes point to the left only: base, image, csg, scene, geometry, edges, then rounding,
         beam, edgepoint and shading (which never include each other), then render; io takes only
         base, image, scene and geometry; the public headers take only each other; no cycles of
         headers; files of at most 700 lines, lines of at most 120 columns; no notes to do later. A file
         that uses a common name of the standard library includes its header, or a header of the project
         that does: precompiled headers and batches (batches.py) would hide from compilers that it doesn't.
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

# The names looked for; those that come with most headers anyway (std::move, std::errc) are not.
STANDARD_NAMES = {
    "algorithm": "all_of any_of clamp copy count count_if equal fill find find_if lower_bound max max_element "
    "min min_element minmax none_of nth_element ranges reverse rotate sort stable_sort transform unique upper_bound",
    "array": "array to_array",
    "atomic": "atomic atomic_ref",
    "bit": "bit_cast bit_width countl_zero countr_zero endian has_single_bit popcount",
    "charconv": "from_chars to_chars",
    "chrono": "chrono",
    "cmath": "acos asin atan atan2 cbrt ceil copysign cos exp fabs floor fma fmod frexp hypot isfinite isinf "
    "isnan ldexp llround log log2 lround nextafter pow round signbit sin sqrt tan trunc",
    "complex": "complex",
    "condition_variable": "condition_variable",
    "cstdint": "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t",
    "cstdio": "FILE fopen fputs fread printf remove snprintf",
    "cstdlib": "abort exit getenv",
    "cstring": "memcmp memcpy memset strlen",
    "deque": "deque",
    "filesystem": "filesystem",
    "fstream": "ifstream ofstream",
    "functional": "function greater hash less",
    "future": "async future",
    "initializer_list": "initializer_list",
    "iomanip": "setprecision setw",
    "iostream": "cerr cin cout",
    "limits": "numeric_limits",
    "list": "list",
    "map": "map multimap",
    "memory": "make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "lock_guard mutex scoped_lock unique_lock",
    "numbers": "numbers",
    "numeric": "accumulate gcd inner_product iota partial_sum",
    "optional": "make_optional nullopt optional",
    "queue": "priority_queue queue",
    "random": "mt19937 mt19937_64 normal_distribution uniform_int_distribution uniform_real_distribution",
    "regex": "regex",
    "set": "multiset set",
    "span": "as_bytes span",
    "sstream": "istringstream ostringstream stringstream",
    "string": "getline stod stoi stoul string to_string",
    "string_view": "string_view",
    "thread": "jthread this_thread thread",
    "tuple": "make_tuple tie tuple",
    "type_traits": "conditional_t decay_t invoke_result_t is_floating_point_v is_same_v",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "variant": "get_if holds_alternative monostate variant visit",
}
HEADER_OF = {name: header for header, names in STANDARD_NAMES.items() for name in names.split()}
STANDARD_NAME = re.compile(r"\bstd::(\w+)")
ANY_INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
COMMENT = re.compile(r"(?<!:)//.*")  # not that of a URL


def source_files(root):
    folders = ["include", "src", "apps", "tests", "bench", "examples", "scripts", "cmake"]
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if "node_modules" in path.parts:  # what npm has installed
                continue
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


def check_standard_headers(root):
    folders = ("include", "src", "apps", "tests", "bench")
    texts = {}

    def text_of(path):
        if path not in texts:
            texts[path] = path.read_text(encoding="utf-8")
        return texts[path]

    def reached(path, found):
        """Adds the names of all headers that the file includes, and the project's among them include."""
        for name in ANY_INCLUDE.findall(text_of(path)):
            if name not in found:
                found.add(name)
                for folder in folders:
                    if (root / folder / name).is_file():
                        reached(root / folder / name, found)
        return found

    for path in source_files(root):
        if path.suffix not in (".h", ".cpp") or path.relative_to(root).parts[0] not in folders:
            continue
        missing = {}
        for number, line in enumerate(text_of(path).splitlines(), 1):
            for name in STANDARD_NAME.findall(COMMENT.sub("", line)):
                if name in HEADER_OF:
                    missing.setdefault(HEADER_OF[name], (number, name))
        if "fmt::format" in text_of(path):
            missing["fmt/format.h"] = (1, "fmt")
        for header in reached(path, set()):
            missing.pop(header, None)
        for header, (number, name) in missing.items():
            yield path, number, f"{name} without <{header}>"


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
        # Headers in -inl.h are read once for each kind of processor (Highway).
        if path.suffix == ".h" and not path.name.endswith("-inl.h") and "#pragma once" not in lines:
            yield path, 1, "header without #pragma once"


def check(root):
    findings = [*check_arrows(root), *check_cycles(root), *check_standard_headers(root), *check_texts(root)]
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
    ({"src/base/a.cpp": "// std::map\n#include <string>\nstd::map<int, int> a;\n"}, "a.cpp:3: map without <map>"),
    (
        {
            "src/base/a.cpp": '#include "base/b.h"\nstd::map<int, int> a;\n',
            "src/base/b.h": ONCE + "#include <map>\n",
        },
        None,
    ),
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
