#!/usr/bin/env python3
"""Compares the instructions that queries take with a file of them, by valgrind's callgrind.

Usage: instructions.py BUILD FILE [--update]
The file has a name and a number in each line. The counts are those of one compiler and one C library: with others
they are written anew with --update before a change is judged.
"""

import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys

SLACK = 0.05
LOCATE = ["locate", "gallery:spline,n=9,seed=7,wobble=0.2", "--reading", "0.9977,56.93deg"]


def counted(command, function=None):
    """Of the whole program, or of what it does within one function."""
    options = [f"--toggle-collect={function}"] if function else []
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *options, *command],
                          capture_output=True, text=True)
    collected = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not collected:
        sys.exit(f"instructions: {' '.join(map(str, command))} failed:\n{done.stderr}")
    return int(collected.group(1))


def count_all(build):
    """By name: the queries, and a call of the program from its start to its end."""
    program = build / "bench" / "instructions"
    names = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        whole = pool.submit(counted, [build / "rollfix", *LOCATE])
        counts = dict(zip(names, pool.map(lambda name: counted([program, name], "measured_query"), names)))
        return {**counts, "program_locate": whole.result()}


def read(file):
    lines = [line.split() for line in file.read_text().splitlines() if line and not line.startswith("#")]
    return {name: int(count) for name, count in lines}


def write(file, counts):
    lines = ["# Instructions of the queries in bench/instructions.cpp; `script/instructions --update` writes them.",
             *(f"{name} {count}" for name, count in counts.items())]
    file.write_text("\n".join(lines) + "\n")


def judge(name, now, before):
    """A line of what is said, and whether it passes."""
    if before is None or now is None:
        return f"{name}: {'not in the file' if before is None else 'not counted any more'}: FAILED", False
    ratio = now / before
    verdict = "FAILED: more than 5 % above" if ratio > 1 + SLACK else "less: --update keeps it" if ratio < 1 - SLACK else "ok"
    return f"{name:<26} {now:>12,} {ratio:8.3f} of {before:,}: {verdict}", ratio <= 1 + SLACK


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    now = count_all(arguments.build)
    if arguments.update:
        write(arguments.file, now)
        print(f"{arguments.file}: {len(now)} counts")
        return 0
    before = read(arguments.file)
    judged = [judge(name, now.get(name), before.get(name)) for name in {**now, **before}]
    print(*(line for line, _ in judged), sep="\n")
    failed = sum(not passes for _, passes in judged)
    print(f"instructions: {len(judged) - failed} as before or less, {failed} more")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
