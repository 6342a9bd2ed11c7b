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
from dataclasses import dataclass, field

import numpy as np

from outlines import FAMILIES, OUTLINES
from rolls import KINDS, Noise, as_csv

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = HERE.parent.parent / "build" / "release" / "rollfix"
ROWS_AT_ONCE = 200_000  # so many rows lie on the disk at a time, for each job, or those of one log
LOGS_AT_ONCE = 20
MEMORY = 3 << 30  # of the program, bytes
SECONDS, SECONDS_EACH, SECONDS_PER_ROW = 10, 1, 1e-5  # of the program: for so many logs together, for each, its rows
QUICK = 4
SURE = 0.95
TWO_SIGMA, FOUR_SIGMA = 0.023, 3.2e-5
FAR = 5.0  # standard deviations from a place's mean: nearer counts as listed
Z95 = 1.959964
FLAT = 1.8  # half of an interval with 95 %, in standard deviations: 1.65 of a flat density, 1.96 of a normal one
ALIKE = 0.2  # logarithms of densities that differ by less are alike


@dataclass
class Cell:
    name: str
    outlines: str  # a family
    kind: str = "u,psi"
    rows: int = 200
    laps: float = 0.4
    contact: float = 1e-3  # of the perimeter
    angle: float = 5e-3
    slip: float = 0.0
    here_and_there: bool = False
    position: float = 0.0  # of the perimeter
    gyro: float = 0.0
    said: float = 1.0  # so many times the true standard deviations are said
    said_slip: float = 1.0
    logs: int = 400
    quick: int = 0  # logs with --quick, in units of QUICK

    def noise_on(self, outline):
        p = outline.perimeter
        return Noise(self.contact * p, self.angle, self.slip, self.position * p, self.gyro)

    def overstated(self):
        # Slip is always said as one factor and as five times as much here and there.
        return self.said > 1 or self.said_slip > 1 or (self.slip > 0 and not self.here_and_there)


def cells():
    made = []

    def add(name, *args, **more):
        made.append(Cell(name, *args, **more))

    both = dict(slip=0.005, here_and_there=True)
    strong = dict(slip=0.05, here_and_there=True)
    # How many rows: 0.4 laps, contact 1e-3 P, 5e-3 rad.
    for rows, logs, quick in ((20, 400, 100), (200, 500, 200), (2000, 400, 60), (20000, 200, 24), (200000, 200, 0),
                              (1000000, 40, 0)):
        more = dict(rows=rows, logs=logs, quick=quick)
        add(f"rows {rows}, no slip", "all", **{**more, "quick": quick // 2})
        add(f"rows {rows}, slip .005", "all", **more, **both)
        add(f"rows {rows}, slip .05", "all", **{**more, "quick": quick // 2}, **strong)
    add("rows 200, slip .005 one factor", "all", slip=0.005, logs=500, quick=100)
    add("rows 200, slip .05 one factor", "all", slip=0.05, logs=500)
    add("rows 20000, slip .05 one factor", "all", rows=20000, slip=0.05, logs=200)
    # How noisy.
    for contact in (1e-4, 1e-2):
        for angle in (1e-3, 5e-2, 0.5):
            add(f"contact {contact:g}, angle {angle:g}", "all", contact=contact, angle=angle, **both)
    add("contact 1e-3, angle .1, rows 2000", "all", angle=0.1, rows=2000, **both)
    add("contact 1e-3, angle .5, rows 20000", "all", angle=0.5, rows=20000, logs=200, **both)
    add("contact 1e-4, angle 1e-3, rows 20000", "all", contact=1e-4, angle=1e-3, rows=20000, logs=200, **both)
    # How long.
    for laps in (0.02, 0.1, 1.0, 2.0):
        add(f"laps {laps:g}", "all", laps=laps, quick=60 if laps in (0.1, 2.0) else 0, **both)
    add("laps .02, angle .1", "all", laps=0.02, angle=0.1, **both)
    add("laps .02, angle .1, rows 20000", "all", laps=0.02, angle=0.1, rows=20000, logs=200, **both)
    add("laps 2, rows 20000, slip .05", "all", laps=2, rows=20000, logs=200, **strong)
    # Which outline.
    for family in ("splines", "curves", "rounded", "drawing", "sharp", "corners", "symmetric"):
        quick = 60 if family in ("corners", "symmetric") else 0
        add(f"{family}", family, quick=quick, **both)
    add("sharp, no slip", "sharp")
    add("sharp, laps .1, angle .1", "sharp", laps=0.1, angle=0.1, **both)
    add("sharp, rows 20000", "sharp", rows=20000, logs=200, **both)
    add("drawing, rows 20000", "drawing", rows=20000, logs=200, **both)
    # Which log.
    add("length,turn, no slip", "all", kind="length,turn", quick=60)
    add("length,turn, slip .005", "all", kind="length,turn", quick=60, **both)
    add("length,turn, rows 2000, slip .05", "all", kind="length,turn", rows=2000, **strong)
    add("length,turn, rows 20000, slip .05", "all", kind="length,turn", rows=20000, logs=200, **strong)
    add("length,turn, sharp", "sharp", kind="length,turn", **both)
    steps = dict(kind="increments", contact=1e-4)
    add("increments, no slip", "all", rows=300, quick=60, **steps)
    add("increments, slip .005", "all", rows=300, quick=60, **steps, **both)
    add("increments, slip .05", "all", rows=300, **steps, **strong)
    add("increments, rows 20000, slip .005", "all", rows=20000, logs=200, kind="increments", contact=1e-5, angle=5e-4,
        **both)
    add("increments, sharp", "sharp", rows=300, **steps, **both)
    add("centres, no slip", "all", kind="centres", position=1e-3, quick=60)
    add("centres, slip .005", "all", kind="centres", position=1e-3, quick=60, **both)
    add("centres, rows 20000, slip .05", "all", kind="centres", position=1e-3, rows=20000, logs=60, **strong)
    add("centres, sharp", "sharp", kind="centres", position=1e-3, **both)
    for kind in ("u,psi", "length,turn"):
        add(f"{kind}, gyro .03", "all", kind=kind, gyro=0.03, quick=40, **both)
    add("length,turn, gyro .03, rows 20000", "all", kind="length,turn", gyro=0.03, rows=20000, logs=200, **both)
    add("length,turn, gyro .03, laps 2", "all", kind="length,turn", gyro=0.03, laps=2.0, **both)
    add("increments, gyro .03", "all", gyro=0.03, rows=300, quick=40, **steps, **both)
    add("increments, gyro .03, laps 2", "all", gyro=0.03, rows=300, laps=2.0, **steps, **both)
    pair = dict(kind="pair", rows=100, contact=5e-4, angle=2e-3, logs=200)
    add("pair, no slip", "smooth", quick=20, **pair)
    add("pair, slip .003 one factor", "smooth", slip=0.003, quick=20, **pair)
    add("pair, slip .003", "smooth", slip=0.003, here_and_there=True, **pair)
    add("pair, slip .02", "smooth", slip=0.02, here_and_there=True, quick=20, **pair)
    add("pair, drawing", "drawing", slip=0.003, **pair)
    add("pair, sharp", "sharp", **{**pair, "rows": 200})
    add("pair, sharp, slip .003", "sharp", slip=0.003, here_and_there=True, **{**pair, "rows": 200})
    add("pair, sharp, rows 2000", "sharp", **{**pair, "rows": 2000})
    add("pair, sharp, rows 20000", "sharp", **{**pair, "rows": 20000, "logs": 80})
    add("pair, corners", "corners", quick=20, **pair)
    add("pair, rows 20000", "smooth", slip=0.003, **{**pair, "rows": 20000, "logs": 40})
    add("pair, rows 20000, slip .02", "smooth", slip=0.02, here_and_there=True, **{**pair, "rows": 20000, "logs": 40})
    seen = {**pair, "kind": "pair centres", "position": 1e-3}
    add("pair centres, no slip", "smooth", quick=20, **seen)
    add("pair centres, slip .003 one factor", "smooth", slip=0.003, **seen)
    # What is said is more than there is.
    for times in (2, 5, 20):
        add(f"said x{times}, u,psi", "all", said=times, quick=40 if times == 5 else 0, **both)
        add(f"said x{times}, u,psi, rows 2000, slip .02", "all", said=times, rows=2000, slip=0.02,
            here_and_there=True, logs=200)
        add(f"said x{times}, length,turn", "all", kind="length,turn", said=times, **both)
        add(f"said x{times}, increments", "all", rows=300, said=times, quick=40 if times == 5 else 0, **steps, **both)
        add(f"said x{times}, increments, slip .02", "all", rows=300, said=times, slip=0.02, here_and_there=True,
            **steps)
        add(f"said x{times}, increments, drawing", "drawing", rows=300, said=times, logs=200, **steps, **both)
        add(f"said x{times}, centres", "all", kind="centres", position=1e-3, said=times, logs=200, **both)
        add(f"said x{times}, pair", "smooth", said=times, slip=0.003, **{**pair, "logs": 80})
        add(f"slip said x{times}, u,psi", "all", said_slip=times, **both)
        add(f"slip said x{times}, increments", "all", rows=300, said_slip=times, **steps, **both)
    return made


CELLS = cells()


@dataclass
class Count:
    """What is counted of a cell's logs."""

    logs: int = 0
    inside: int = 0
    own: int = 0
    listed: int = 0
    first: int = 0
    claimed: float = 0.0
    sure_wrong: int = 0
    doubt: float = 0.0  # what was claimed with SURE and more: how often that says it is wrong
    misfit: int = 0
    errors: int = 0
    sd: list = field(default_factory=list)
    seconds: float = 0.0
    wrong: list = field(default_factory=list)
    message: str = ""

    def add(self, other):
        for name, value in vars(other).items():
            setattr(self, name, getattr(self, name) + value if name != "message" else self.message or value)


def nearest(x, target, period):
    return x + period * np.round((target - x) / period)


def judge(answer, truth, outline, count):
    """Counts one log's answer against the true starts, one for each finger."""
    count.logs += 1
    if "error" in answer and "placements" not in answer:
        count.errors += 1
        count.message = count.message or answer["error"]
        return
    verdict = answer["verdict"]
    misfit = bool(re.search("fits? badly|inconsistent", verdict) or answer.get("diagnosis"))
    count.misfit += misfit
    found = [p for p in answer["placements"] if p.get("probability")]
    known = [p for p in found if not any(v is None for v in (*p["mean"], *p["sd"], *sum(p["interval"], [])))]
    if len(known) < len(found):
        count.errors += 1
        count.message = count.message or f"{answer['id']}: a place whose mean, sd or interval is not a number"
    found = known
    if not found:
        return
    found.sort(key=lambda p: -p["probability"])
    period, slack = outline.perimeter, 1e-7 * outline.perimeter
    p = np.array([f["probability"] for f in found])
    mean = np.array([f["mean"] for f in found])
    sd = np.array([f["sd"] for f in found])
    interval = np.array([f["interval"] for f in found])  # places x fingers x 2
    middle = interval.mean(axis=2)
    # On a part that looks the same m times one place stands for m, both fingers' together.
    share = period / outline.symmetry
    turns = [share * k for k in range(outline.symmetry)]
    standing = np.array([[nearest(t + turn, middle, period)[:, k] for k, t in enumerate(truth)] for turn in turns])
    standing = np.moveaxis(standing, 1, 2)  # turns x places x fingers: the truth beside each place
    outside = np.maximum(0, np.maximum(interval[:, :, 0] - standing, standing - interval[:, :, 1]))
    wide = np.maximum(sd, 1e-9 * period)
    far = (np.abs(standing - mean) / wide).max(axis=2)
    within = outside.max(axis=2) <= slack  # turns x places
    near = within | (far <= FAR)
    # Which of them it is: the one that is densest there.
    density = np.log(p) - np.log(wide).sum(axis=1) - np.where(within, np.minimum(far, 2), far) ** 2 / 2
    mine = np.where(near, density, -np.inf).argmax(axis=1)

    count.listed += bool(near[0].any())
    if len(truth) == 1:
        count.own += bool(within[0].any())
        count.inside += bool(within[0].any() and outline.is_corner(truth[0])) or in_smallest(
            p, interval[:, 0], sd[:, 0], standing[0, :, 0], within[0], slack)
    elif near[0].any():
        sides = outside[0, mine[0]] <= slack
        count.inside += bool(sides[0])
        count.own += bool(sides[1])
    # The first place with those that look like it, and whether the truth is one of them.
    is_first = any(near[k][0] and mine[k] == 0 for k in range(len(turns)))
    alike = np.zeros(len(p), dtype=bool)
    for turn in turns:
        apart = np.abs(nearest(mean[0] + turn, mean, period) - mean)
        alike |= (apart <= 0.5 * (sd + sd[0]) + 10 * slack).all(axis=1)
    alike[0] = True
    claim = min(1.0, float(p[alike].sum()))
    count.first += is_first
    count.claimed += claim
    if claim >= SURE:
        count.doubt += 1 - claim
    if (claim >= SURE or (verdict.startswith("unique") and not misfit)) and not is_first:
        count.sure_wrong += 1
        count.wrong.append(f"{answer.get('id')}: true {np.round(truth, 4).tolist()}, said {mean[0].round(4).tolist()} "
                           f"sd {sd[0].round(4).tolist()} p {p[0]:.4f}")
    count.sd.append(float(sd[0].max()) / period)


def in_smallest(p, interval, sd, standing, within, slack):
    """Whether the smallest set with 95 % holds the truth: each place is a normal density with its own interval, or a flat
    one where that is as short beside the standard deviation as only a flat one's is. (A corner, which has no size, is in
    that set wherever a place's interval holds it.)"""
    if len(p) == 1:
        return bool(within[0])
    half = np.maximum((interval[:, 1] - interval[:, 0]) / 2, slack)
    flat = half < FLAT * sd
    reach = np.where(flat, half / 0.95, half / Z95)  # to the end of a flat one, else a standard deviation
    height = p / np.where(flat, 2 * reach, math.sqrt(2 * math.pi) * reach)
    z = np.abs(standing - interval.mean(axis=1)) / reach
    log_density = np.log(height) + np.where(flat, np.where(z <= 1, 0, -np.inf), -z * z / 2)
    if not np.isfinite(log_density).any():
        return False
    mine = np.argmax(log_density)
    above = np.log(height) - log_density[mine]
    held = np.array([math.erf(math.sqrt(max(0, a))) for a in above])
    # Flat ones that are about as high are filled from their middles, all of them at once.
    held = np.where(flat, np.where(np.abs(above) < ALIKE, min(1, z[mine]) if flat[mine] else 0, above > 0), held)
    return bool((p * held).sum() / p.sum() <= 0.95)


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


def share(hits, n):
    """Per cent with a standard error: of hits + 1/2 among n + 1, so that it is never 0."""
    q = (hits + 0.5) / (n + 1)
    return 100 * hits / n, 100 * math.sqrt(q * (1 - q) / n)


def tail(hits, n, rate):
    """How likely it is that chance alone is as far on this side of the rate: of hits among n, whichever side they are."""
    rate = min(max(rate, 1e-12), 1 - 1e-12)
    counts = range(hits + 1) if hits <= rate * n else range(hits, n + 1)
    log = lambda k: (math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1) + k * math.log(rate)
                     + (n - k) * math.log1p(-rate))
    return sum(math.exp(log(k)) for k in counts)


def verdicts(cell, count):
    """What lies outside of what is promised. `?`: chance alone does that once in 40 times at the limit itself; `!`: not
    once in 30,000, as 4 standard errors."""
    n = count.logs
    marks, clear = [], []

    def hold(name, hits, least=0.0, most=1.0):
        if least * n <= hits <= most * n:
            return
        chance = tail(hits, n, least if hits < least * n else most)
        marks.append(name + ("!" if chance < FOUR_SIGMA else "?" if chance > TWO_SIGMA else ""))
        if chance < FOUR_SIGMA:
            clear.append(name)

    claim = count.claimed / n
    hold("in95", count.inside, 0.93, 1.0 if cell.overstated() else 0.97)
    hold("claim", count.first, claim - 0.03, 1.0 if cell.overstated() else claim + 0.03)
    hold("listed", count.listed, 0.995)
    if count.sure_wrong:
        # What is claimed with 0.95 to 1 may be wrong as often as that says.
        chance = tail(count.sure_wrong, n, count.doubt / n + 1e-3)
        marks.append("sure" + ("!" if chance < FOUR_SIGMA else "?" if chance > TWO_SIGMA else ""))
        clear += ["sure"] if chance < FOUR_SIGMA else []
    hold("misfit", count.misfit, 0, 0.005)
    if count.errors:
        marks.append("no answer!")
        clear.append("no answer")
    return marks, clear


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
