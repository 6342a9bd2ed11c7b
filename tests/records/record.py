#!/usr/bin/env python3
r"""Records what a program answers to the 3,400 problems: command line, exit code, output and narration.

    tests/records/record.py build/release/rollfix -o old.json.gz [--only '2/*'] [--keep FOLDER] [--jobs 2] \\
        [--python build/release/python]
"""

import argparse
import collections
import concurrent.futures
import fnmatch
import gzip
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from problems import all_problems

SECONDS = 60  # a problem that takes longer counts as an answer of its own
CLOCK = re.compile(r'"seconds_per_sample": ?[^,}]*')  # the only field that tells of the clock


def answer(program, folder, problem):
    """Each problem has a folder of its own, so that messages hold no path. `program`: words."""
    place = folder / problem.id
    place.mkdir(parents=True)
    for name, data in problem.files.items():
        (place / name).write_bytes(data)
    began = time.monotonic()
    stdin = (problem.stdin or "").encode()
    run = lambda words: subprocess.run([*program, *words], cwd=place, input=stdin, capture_output=True, timeout=SECONDS)
    try:
        for words in problem.before:
            run(words)
        ran = run(problem.words)
        code, out, err = ran.returncode, ran.stdout.decode(), ran.stderr.decode()
    except subprocess.TimeoutExpired:
        code, out, err = "timeout", "", ""
    out = CLOCK.sub('"seconds_per_sample":0', out)
    asked = {"id": problem.id, "command": problem.words, "digest": problem.digest()}
    files = {name: (place / name).read_text() for name in problem.writes if (place / name).exists()}
    written = {"files": files} if problem.writes else {}
    return {**asked, "code": code, "out": out, "err": err, **written}, time.monotonic() - began


def summary(rows):
    """How many problems there are of each group, and what came of them."""
    groups = collections.defaultdict(collections.Counter)
    for row, seconds in rows:
        verdict = re.search(r'"verdict": ?"(\w+)', row["out"])
        outcome = verdict.group(1) if verdict and row["code"] in (0, 1, 3) else f"exit {row['code']}"
        groups[row["id"].rsplit("/", 1)[0]][outcome] += 1
    groups["all"] = sum(groups.values(), collections.Counter())
    for group, outcomes in groups.items():
        counts = ", ".join(f"{n} {what}" for what, n in outcomes.most_common())
        print(f"{group:24} {sum(outcomes.values()):5}  {counts}")
    slowest = sorted(rows, key=lambda row: -row[1])[:5]
    print("slowest: " + ", ".join(f"{row['id']} {seconds:.2f} s" for row, seconds in slowest))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("-o", dest="output", required=True, help="the record, .json.gz")
    parser.add_argument("--only", default="*", help="problems whose name fits this pattern")
    parser.add_argument("--keep", help="a new folder for the problems' files, to try one by hand")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--python", help="the folder of the package, for problems that Python asks; else left out")
    options = parser.parse_args()
    program = [os.path.abspath(options.program)]
    chosen = [problem for problem in all_problems() if fnmatch.fnmatch(problem.id, options.only)]
    if options.python:
        os.environ["PYTHONPATH"] = os.path.abspath(options.python)
    else:
        chosen = [problem for problem in chosen if not problem.python]
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        folder = Path(options.keep or scratch).resolve()
        asks = lambda problem: [sys.executable] if problem.python else program
        rows = list(pool.map(lambda problem: answer(asks(problem), folder, problem), chosen))
    summary(rows)
    print(f"{len(rows)} problems in {time.monotonic() - began:.0f} s")
    Path(options.output).parent.mkdir(parents=True, exist_ok=True)
    text = "[\n" + ",\n".join(json.dumps(row) for row, _ in rows) + "\n]\n"
    Path(options.output).write_bytes(gzip.compress(text.encode(), mtime=0))
    return 0


if __name__ == "__main__":
    sys.exit(main())
