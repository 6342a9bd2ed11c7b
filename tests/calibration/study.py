#!/usr/bin/env python3
"""How often the program's answers are true, by a simulator that shares no code with it: see README.md.

    /usr/bin/python3 tests/calibration/study.py --program build/release/rollfix --cells 'dense' --logs 100
"""

import argparse
import json
import math
import multiprocessing
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

from cells import CELLS
from judging import Count, judge, share, verdicts
from outlines import FAMILIES, OUTLINES
from rolls import KINDS, as_csv

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = HERE.parent.parent / "build" / "release" / "rollfix"
ROWS_AT_ONCE = 200_000  # so many rows lie on the disk at a time, for each job, or those of one log
LOGS_AT_ONCE = 20
MEMORY = 3 << 30  # of the program, bytes
SECONDS, SECONDS_EACH, SECONDS_PER_ROW = 10, 1, 1e-5  # of the program: for so many logs together, for each, its rows
QUICK = 4


def ask(program, lines, folder, rows=0):
    """The program's answers. Where it dies or takes too long, half of the logs at a time, down to the one that does it."""
    batch = folder / "batch.jsonl"
    batch.write_text("".join(json.dumps(line) + "\n" for line in lines))
    why = "took too long"
    try:
        done = subprocess.run([program, "locate", lines[0]["part"], "--batch", str(batch), "--json"], check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=limit_memory,
                              timeout=SECONDS + (SECONDS_EACH + SECONDS_PER_ROW * rows) * len(lines))
        answers = done.stdout.decode().splitlines()
        if len(answers) == len(lines):
            return [json.loads(text) for text in answers]
        why = f"exit code {done.returncode}; {done.stderr.decode().strip()[:300]}"
    except subprocess.TimeoutExpired:
        pass
    if len(lines) == 1:
        return [{"error": f"no answer to {lines[0]['id']}: {why}"}]
    half = len(lines) // 2
    return ask(program, lines[:half], folder, rows) + ask(program, lines[half:], folder, rows)


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def run_chunk(task):
    program, cell, seed, first, logs, folder = task
    counts = {}
    names = FAMILIES[cell.outlines]
    with tempfile.TemporaryDirectory(dir=folder) as here:
        here = pathlib.Path(here)
        truth, lines = [], []
        for k in range(first, first + logs):
            outline = OUTLINES[names[k % len(names)]]
            random = np.random.default_rng([seed, *cell.name.encode(), k])
            noise = cell.noise_on(outline)
            columns, rolled, radii = KINDS[cell.kind](random, outline, cell.rows, cell.laps, noise,
                                                      cell.here_and_there)
            log = here / f"{k}.csv"
            log.write_bytes(as_csv(columns))
            said = noise.times(cell.said, cell.said_slip)
            line = {"id": f"{outline.name}/{k}", "part": outline.write(here), "log": str(log), "noise": said.text()}
            if radii:
                line["fingers"] = [f"disk,r={r!r}" for r in radii]
            truth.append((outline, np.array([r.s[0] % outline.perimeter for r in rolled])))
            lines.append(line)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        answers = ask(program, lines, here, cell.rows)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        for answer, (outline, start), line in zip(answers, truth, lines):
            count = counts.setdefault(outline.name, Count())
            count.seconds += seconds / len(lines)
            judge({**answer, "id": line["id"]}, start, outline, count)
    return counts


HEAD = ("| cell | logs | in 95 % | own 95 % | listed | first | claimed | sure, wrong | misfits | median sd [P] | "
        "s per log | no answer | outside |")


def row(name, count, marks):
    n = count.logs
    show = lambda hits, digits=1: "{:.{d}f} ± {:.{d}f}".format(*share(hits, n), d=digits)
    return (f"| {name} | {n} | {show(count.inside)} | {show(count.own)} | {100 * count.listed / n:.1f} | "
            f"{show(count.first)} | {100 * count.claimed / n:.1f} | {count.sure_wrong} | "
            f"{100 * count.misfit / n:.1f} | {np.median(count.sd) if count.sd else math.nan:.2g} | "
            f"{count.seconds / n:.2g} | {count.errors} | {' '.join(marks)} |")


def some_of(pool, tasks, ahead, seconds):
    """What the tasks give, in their order; none is begun after so many seconds."""
    begin, waiting = time.time(), []
    for task in tasks:
        if len(waiting) == ahead:
            yield waiting.pop(0).get()
        if time.time() - begin > seconds:
            break
        waiting.append(pool.apply_async(run_chunk, (task,)))
    for result in waiting:
        yield result.get()


def run(chosen, options):
    begin = time.time()
    failed = []
    print(HEAD)
    print("|" + " --- |" * HEAD.count(" | ") + " --- |", flush=True)
    with tempfile.TemporaryDirectory(prefix="calibration.", dir=options.folder) as folder, \
            multiprocessing.Pool(options.jobs) as pool:
        for cell in chosen:
            if options.minutes and time.time() - begin > 60 * options.minutes:
                print(f"{options.minutes} minutes are over: left out {cell.name} and what follows", file=sys.stderr)
                break
            logs = options.logs or (QUICK * cell.quick if options.quick else cell.logs)
            at_once = max(1, min(LOGS_AT_ONCE, ROWS_AT_ONCE // cell.rows, math.ceil(logs / options.jobs)))
            tasks = [(str(options.program), cell, options.seed, k, min(at_once, logs - k), folder)
                     for k in range(0, logs, at_once)]
            count, counts = Count(), {}
            for part in some_of(pool, tasks, 2 * options.jobs, options.cell_seconds):
                for name, of_outline in part.items():
                    counts.setdefault(name, Count()).add(of_outline)
                    count.add(of_outline)
            marks, clear = verdicts(cell, count)
            failed += [(cell.name, clear)] if clear else []
            print(row(cell.name, count, marks), flush=True)
            for name in sorted(counts) if options.each else ():
                print(row("&nbsp; " + name, counts[name], verdicts(cell, counts[name])[0]), flush=True)
            if count.message:
                print(f"{cell.name}: {count.errors} errors: {count.message}", file=sys.stderr)
            for line in count.wrong if options.wrong else []:
                print(f"{cell.name}: sure and wrong: {line}", file=sys.stderr)
    print(f"\n{time.time() - begin:.0f} s, seed {options.seed}")
    for name, clear in failed:
        print(f"clearly outside: {name}: {', '.join(clear)}")
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, default=PROGRAM)
    parser.add_argument("--cells", default="", metavar="REGEX", help="only cells whose names this finds")
    parser.add_argument("--logs", type=int, help="so many for each cell, and not by its cost")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("--minutes", type=float, help="begin no further cell after that")
    parser.add_argument("--cell-seconds", type=float, default=90, help="take no further logs for a cell after that")
    parser.add_argument("--quick", action="store_true", help="cheap cells with few logs; fails where one clearly does")
    parser.add_argument("--wrong", action="store_true", help="list what was sure and wrong, on stderr")
    parser.add_argument("--each", action="store_true", help="a line for each outline as well")
    parser.add_argument("--list", action="store_true", help="list the cells")
    parser.add_argument("--folder", help="for the logs, up to 300 MB; default: the system's for such files")
    options = parser.parse_args()
    chosen = [c for c in CELLS if re.search(options.cells, c.name) and (c.quick or not options.quick)]
    if options.list:
        print("\n".join(f"{c.name}: {c}" for c in chosen))
        return 0
    if not chosen:
        parser.error(f"no cell's name has {options.cells!r} in it; --list shows all")
    failed = run(chosen, options)
    return 1 if failed and options.quick else 0


if __name__ == "__main__":
    sys.exit(main())
