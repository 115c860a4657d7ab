#!/usr/bin/env python3
"""batches.py — groups source files so that each group can be compiled as one file.

Headers are then parsed, templates instantiated and clang-tidy's matchers run over the standard library once
for a group rather than once for a file. A group never joins a file that declares a name for itself (in an
unnamed namespace, say) with one that declares the same name or reads a header that does, nor a constant's name
with a file where it occurs at all. That is judged from the text: what clang-format leaves at the start of a
line is what stands in a namespace.

Usage   batches.py FILE…    prints a line "GROUP FILE" for each file, sorted
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LARGEST_FILES = 16
LARGEST_LINES = 3500
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
# Literals go first: a comment sign may stand in one, as in "http://".
NOISE = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
WORD = re.compile(r"[A-Za-z_]\w*")
TYPE = re.compile(r"(?:struct|class|union|enum(?: class)?)\s+(\w+)")
MACRO = re.compile(r"#\s*define\s+(\w+)|MATCHER\w*\((\w+)")
OTHER = re.compile(r"[^\s#})].*?(?<![\w:])([A-Za-z_]\w*)\s*(?:[({=;\[]|$)|([A-Za-z_]\w*)\(")
MEMBER = re.compile(r"[^=]*\w::~?(?:\w+|operator\W+)\(|.*\) (?:const|noexcept)\b")
SKIPPED = re.compile(r"\s|namespace\b|template\b|using [\w:]+;|using namespace|[A-Z]+_?[A-Z_]*\(|$")
CONSTANT = re.compile(r"k[A-Z]")

texts = {}


def text_of(path):
    """The file without comments and literals."""
    if path not in texts:
        texts[path] = NOISE.sub(lambda m: '""' if m[0][0] in 'R"' else " ", path.read_text(encoding="utf-8"))
    return texts[path]


def add_headers(path, found):
    """Adds every project header that the file reaches."""
    for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
        for folder in ("include", "src", "apps", "tests", "bench"):
            header = ROOT / folder / name
            if header not in found and header.is_file():
                found.add(header)
                add_headers(header, found)


def names_defined(path):
    """What the file declares outside functions and types, more or less."""
    found = set()
    for line in text_of(path).splitlines():
        match = MACRO.match(line)
        if not match and not SKIPPED.match(line) and not MEMBER.match(line):
            match = TYPE.match(line) or OTHER.match(line)
        if match:
            found.update(name for name in match.groups() if name)
    return found


class File:
    def __init__(self, path):
        headers = set()
        add_headers(path, headers)
        reached = headers | {path}
        self.path = path
        self.lines = path.read_text(encoding="utf-8").count("\n")
        self.local = names_defined(path).difference(*(names_defined(header) for header in headers))
        self.taken = set().union(*(names_defined(file) for file in reached))
        for file in reached:
            self.taken.update(word for word in WORD.findall(text_of(file)) if CONSTANT.match(word))


class Batch:
    def __init__(self):
        self.files = []
        self.lines = 0
        self.local = set()
        self.taken = set()

    def takes(self, file):
        fits = len(self.files) < LARGEST_FILES and self.lines + file.lines <= LARGEST_LINES
        return fits and self.taken.isdisjoint(file.local) and self.local.isdisjoint(file.taken)

    def add(self, file):
        self.files.append(file.path)
        self.lines += file.lines
        self.local |= file.local
        self.taken |= file.taken


def batches(paths):
    """Lists of paths; each file goes into the first batch that takes it."""
    found = []
    for file in map(File, sorted(Path(path).resolve() for path in paths)):
        batch = next((b for b in found if b.takes(file)), None)
        if batch is None:
            batch = Batch()
            found.append(batch)
        batch.add(file)
    return [batch.files for batch in found]


if __name__ == "__main__":
    for number, files in enumerate(batches(sys.argv[1:])):
        for path in files:
            print(number, path)
