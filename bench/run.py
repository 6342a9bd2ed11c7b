#!/usr/bin/env python3
"""Runs the benchmarks one after another, writes their tables into a document and their figures into one JSON file.

A program's table stands in the document between `<!-- bench: NAME -->` and `<!-- /bench -->`; what is measured on stands
under the name `machine`. script/bench builds the programs and calls this.
"""

import argparse
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]

# In the order of the document. Those that end in .py are run by the system's Python and need the Python package.
PROGRAMS = ["one_finger", "two_fingers", "mixed_fingers", "points", "answers", "readings", "memory", "peers_one", "peers_two",
            "touches", "python.py", "files", "program", "watch", "posterior", "noisy", "advised", "identify"]


def command_of(name, build):
    if name.endswith(".py"):
        return ["/usr/bin/python3", f"bench/{name}"]
    return [f"{build}/bench/{name}"]


def run(name, build, options):
    """What it prints, and its figures."""
    with tempfile.TemporaryDirectory() as folder:
        figures = pathlib.Path(folder) / "figures.json"
        environment = dict(os.environ, PYTHONPATH=f"{build}/python")
        start = time.monotonic()
        if not name.endswith(".py"):
            options = [*options, f"--figures={figures}"]
        done = subprocess.run([*command_of(name, build), *options], cwd=ROOT, env=environment,
                              stdout=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f"bench: {name} failed with {done.returncode}")
        print(f"=== {name}, {time.monotonic() - start:.0f} s\n{done.stdout}", flush=True)
        return done.stdout, json.loads(figures.read_text()) if figures.exists() else {}


def first_match(pattern, text, otherwise):
    match = re.search(pattern, text, re.MULTILINE)
    return match.group(1).strip() if match else otherwise


def output_of(*command):
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def machine(build):
    """On what, how it was built, and of which commit."""
    processor = first_match(r"^model name\s*:(.*)$", pathlib.Path("/proc/cpuinfo").read_text(), platform.machine())
    cache = (ROOT / build / "CMakeCache.txt").read_text()
    compiler = output_of(first_match(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache, "c++"), "--version").splitlines()[0]
    flags = " ".join(first_match(rf"^{name}:\w+=(.*)$", cache, "") for name in ("CMAKE_CXX_FLAGS", "CMAKE_CXX_FLAGS_RELEASE"))
    changed = output_of("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/performance.md")
    commit = output_of("git", "rev-parse", "--short=10", "HEAD") + (", with changes" if changed else "")
    return (f"{len(os.sched_getaffinity(0))} cores of {processor}; {compiler}, `{flags.strip()} -ffp-contract=off`; "
            f"commit {commit}.\n")


def block(name, build, table):
    by_itself = f"`script/bench --only {name.removesuffix('.py')}`"
    return f"{by_itself} (`{' '.join(command_of(name, build))}`):\n\n```text\n{table.rstrip()}\n```\n"


def marks_of(name):
    return re.compile(rf"(<!-- bench: {re.escape(name)} -->\n).*?(<!-- /bench -->)", re.DOTALL)


def require_places(document, names):
    """Before anything is measured."""
    whole = document.read_text()
    if missing := [name for name in names if not marks_of(name).search(whole)]:
        sys.exit(f"bench: {document} has no place for {', '.join(missing)}: <!-- bench: NAME -->, <!-- /bench -->")


def write_into(document, texts):
    """Puts the texts between their marks."""
    whole = document.read_text()
    for name, text in texts.items():
        whole = marks_of(name).sub(lambda match: f"{match.group(1)}{text}{match.group(2)}", whole)
    document.write_text(whole)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="where the programs are")
    parser.add_argument("--figures", type=pathlib.Path, default=ROOT / "build/bench.json")
    parser.add_argument("--document", type=pathlib.Path, default=ROOT / "docs/performance.md")
    parser.add_argument("--only", action="append", metavar="NAME", help="one program; the others' tables stay")
    parser.add_argument("--quick", action="store_true", help="little is measured, the document stays")
    arguments = parser.parse_args()

    names = {name.removesuffix(".py"): name for name in PROGRAMS}
    if unknown := set(arguments.only or []) - names.keys():
        parser.error(f"there is no {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    wanted = [name for word, name in names.items() if not arguments.only or word in arguments.only]
    require_places(arguments.document, ["machine", *names])
    start = time.monotonic()
    options = ["--quick"] if arguments.quick else []
    texts = {"machine": machine(arguments.build)}
    figures = json.loads(arguments.figures.read_text()) if arguments.only and arguments.figures.exists() else {}
    arguments.figures.parent.mkdir(parents=True, exist_ok=True)
    for name in wanted:
        if name.endswith(".py") and not (ROOT / arguments.build / "python/rollfix/__init__.py").exists():
            print(f"=== {name} is left out: the Python package was not built")
            continue
        table, own = run(name, arguments.build, options)
        texts[name.removesuffix(".py")] = block(name, arguments.build, table)
        figures.update(own)
    if arguments.only:
        del texts["machine"]  # the other tables are of another time
    if not arguments.quick:
        write_into(arguments.document, texts)
    arguments.figures.write_text(json.dumps(figures, indent=2, sort_keys=True) + "\n")
    print(f"{arguments.figures}: {len(figures)} figures, in {time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    main()
