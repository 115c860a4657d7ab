#!/usr/bin/env python3
"""tidy.py — runs clang-tidy over the project's sources, on all cores.

Sources are read in the batches in which the sanitizers' presets compile them (scripts/batches.py), which takes a
quarter of the time that they take one by one. A batch that passed is not looked at again until one of its files,
a header of the project that they include, or .clang-tidy changes (stamps in build/tidy/stamps/). Batches still
waiting when the time is over count as failed.

Usage        tidy.py [FILE…]        the batches of these files; all by default
Environment  ARRIS_TIDY_SECONDS     the time limit, 1800 by default
"""

import concurrent.futures
import hashlib
import json
import os
import re
import shutil
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


def stamp_of(batch, config):
    found = {}
    project_files(batch, found)
    digest = hashlib.sha256(config)
    for name in sorted(found):
        digest.update(name.as_posix().encode() + found[name].encode())
    return STAMPS / digest.hexdigest()


def batches():
    """The files that the tidy preset compiles, each with the set of the project's own that it is made of."""
    commands = json.loads((BUILD / "compile_commands.json").read_text())
    found = {}
    for path in {Path(command["directory"], command["file"]).resolve() for command in commands}:
        if "Unity" in path.parts:
            found[path] = {Path(name) for name in INCLUDE.findall(path.read_text(encoding="utf-8"))}
        elif path.relative_to(ROOT).parts[0] in FOLDERS:
            found[path] = {path}
    return found


def run(path, stamp, deadline):
    """The findings on one batch as text, or "" if there are none."""
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
    # clang-tidy looks for its settings in the folders above the file that it is given.
    shutil.copy(ROOT / "tests" / ".clang-tidy", BUILD / "tests" / ".clang-tidy")
    config = (ROOT / ".clang-tidy").read_bytes() + (ROOT / "tests" / ".clang-tidy").read_bytes()
    named = {Path(name).resolve() for name in sys.argv[1:]}
    found = batches()
    if unknown := named.difference(*found.values()):
        sys.exit(f"tidy: {sorted(map(str, unknown))} are in no target of the tidy preset")
    wanted = [batch for batch, files in found.items() if not named or named & files]
    waiting = {batch: stamp_of(batch, config) for batch in wanted}
    waiting = {batch: stamp for batch, stamp in waiting.items() if not stamp.exists()}
    largest_first = sorted(waiting, key=lambda batch: -sum(file.stat().st_size for file in found[batch]))
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
    print(f"tidy: {len(wanted)} batches, {len(waiting)} checked anew, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
