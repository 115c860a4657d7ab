#!/usr/bin/env python3
"""tidy.py — runs clang-tidy over the project's sources, on all cores.

A file that passed is not looked at again until it, a header of the project that it includes, or
.clang-tidy changes (stamps in build/tidy/stamps/). Files still waiting when the time is over count as failed.

Usage        tidy.py [FILE…]        the files of the tidy preset's compile_commands.json by default
Environment  ARRIS_TIDY_SECONDS     the time limit, 1800 by default
"""

import concurrent.futures
import hashlib
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "tidy"
STAMPS = BUILD / "stamps"
FOLDERS = ("src", "apps", "tests", "bench", "examples")
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
FINDING = re.compile(r"^\S+:\d+:\d+: (error|warning): |^error: ")


def project_files(path, found):
    """Adds the file and every project header it reaches."""
    if path in found:
        return
    text = path.read_text(encoding="utf-8")
    found[path] = text
    for name in INCLUDE.findall(text):
        for folder in ("include", "src", "apps", "tests", "bench"):
            if (ROOT / folder / name).is_file():
                project_files(ROOT / folder / name, found)


def stamp_of(path):
    found = {}
    project_files(path, found)
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes())
    digest.update(path.as_posix().encode())
    for name in sorted(found):
        digest.update(found[name].encode())
    return STAMPS / digest.hexdigest()


def sources():
    commands = json.loads((BUILD / "compile_commands.json").read_text())
    paths = {Path(command["directory"], command["file"]).resolve() for command in commands}
    return {p for p in paths if p.is_relative_to(ROOT) and p.relative_to(ROOT).parts[0] in FOLDERS}


def run(path, stamp, deadline):
    """The findings on one file as text, or "" if there are none."""
    seconds = deadline - time.monotonic()
    if seconds <= 0:
        return f"{path.relative_to(ROOT)}: not checked, the time is over (ARRIS_TIDY_SECONDS)\n"
    command = ["clang-tidy", "-p", str(BUILD), "--quiet", str(path)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return f"{path.relative_to(ROOT)}: stopped, the time is over (ARRIS_TIDY_SECONDS)\n"
    if done.returncode == 0:
        stamp.touch()
        return ""
    return done.stdout or done.stderr


def findings_of(text):
    """Splits clang-tidy's output into findings, each with its lines of context."""
    finding = []
    for line in text.splitlines():
        if FINDING.match(line) and finding:
            yield "\n".join(finding)
            finding = []
        finding.append(line.replace(f"{ROOT}/", ""))
    if finding:
        yield "\n".join(finding)


def main():
    deadline = time.monotonic() + float(os.environ.get("ARRIS_TIDY_SECONDS", "1800"))
    subprocess.run(["cmake", "--preset", "tidy"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    STAMPS.mkdir(parents=True, exist_ok=True)
    wanted = {Path(name).resolve() for name in sys.argv[1:]} or sources()
    waiting = {path: stamp_of(path) for path in wanted}
    waiting = {path: stamp for path, stamp in waiting.items() if not stamp.exists()}
    largest_first = sorted(waiting, key=lambda path: -path.stat().st_size)
    seen = set()
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(run, path, waiting[path], deadline) for path in largest_first]
        for job in concurrent.futures.as_completed(jobs):
            failed += bool(job.result())
            for finding in findings_of(job.result()):
                if finding not in seen:
                    seen.add(finding)
                    print(finding, flush=True)
    print(f"tidy: {len(wanted)} files, {len(waiting)} checked anew, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
