#!/usr/bin/env python3
"""What the Python package costs beside C++, and beside a plain scan with numpy: ratios, measured in one process.

    script/bench --only python     # or build/venv/bin/python3 bench/python.py

Times are of the processor, and the least of several rounds; only what says so is by the clock on the wall.
"""

import argparse
import subprocess
import sys
import time

import numpy as np

import rollfix

SPLINE = "gallery:spline,n=16,seed=7"
SAMPLES = (1_000, 10_000, 100_000)  # of the scans


def cpu(job):
    start = time.process_time()
    job()
    return time.process_time() - start


def rolls(part, count, seed=1):
    dice = np.random.default_rng(seed)
    s = dice.uniform(0, part.perimeter, count)
    length = dice.uniform(0.05, 0.6, count) * part.perimeter
    return s, np.stack([length, part.turning(s + length) - part.turning(s)], axis=1)


def import_milliseconds(rounds):
    """Of a new interpreter that has imported numpy already."""
    code = "import numpy, time; t = time.perf_counter(); import rollfix; print(time.perf_counter() - t)"
    return 1e3 * min(float(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)
                     for _ in range(rounds))


def one_at_a_time(part, rows):
    pairs = [(float(length), float(turn)) for length, turn in rows]

    def run():
        for length, turn in pairs:
            part.locate(length, turn)

    return cpu(run)


def scan(part, rows, samples):
    """f on places next to each other, a root where it changes sign. Returns starts of each problem."""
    s = np.linspace(0, part.perimeter, samples, endpoint=False)
    step = s[1]
    found = []
    here = part.turning(s)
    for length, turn in rows:
        f = part.turning(s + length) - here - turn
        f = np.append(f, f[0])
        k = np.nonzero(f[:-1] * f[1:] <= 0)[0]
        found.append(s[k] + step * f[k] / (f[k] - f[k + 1] + 1e-300))
    return found


def recall(part, rows, found, samples):
    """The share of the exact roots that the scan has within a step, and of the problems in which it has all."""
    hits = roots = whole = 0
    for (length, turn), starts in zip(rows, found):
        exact = np.array([root[0] for place in part.locate(float(length), float(turn)) for root in place.roots])
        if len(exact) == 0:
            continue
        gap = np.abs(np.remainder(exact[:, None] - starts[None, :] + part.perimeter / 2, part.perimeter) - part.perimeter / 2)
        near = gap.min(axis=1, initial=np.inf) < part.perimeter / samples
        hits, roots, whole = hits + near.sum(), roots + len(exact), whole + near.all()
    return hits / roots, whole / len(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--quick", action="store_true", help="little is measured")
    arguments = parser.parse_args()
    rounds = 1 if arguments.quick else arguments.rounds
    part = rollfix.Part(SPLINE)
    _, rows = rolls(part, 1_000 if arguments.quick else 100_000)
    few = rows[:10_000]

    print(f"import rollfix, beyond numpy           {import_milliseconds(rounds):8.1f} ms")
    ratios = [(one_at_a_time(part, few), rollfix._core.seconds_of_rows(part._core, few, False)) for _ in range(rounds)]
    python, native = (min(times) for times in zip(*ratios))
    print(f"one locate, Python / C++               {python / native:8.3f}     ({1e6 * python / len(few):.2f} / "
          f"{1e6 * native / len(few):.2f} us)")
    many = [(cpu(lambda: part.locate_many(rows, threads=1)), rollfix._core.seconds_of_rows(part._core, rows, True))
            for _ in range(rounds)]
    python, native = (min(times) for times in zip(*many))
    print(f"locate_many on one core, Python / C++  {python / native:8.3f}     ({python:.3f} / {native:.3f} s of {len(rows):,})")
    walls = []
    for threads in (1, 2):
        times = []
        for _ in range(rounds):
            start = time.perf_counter()
            part.locate_many(rows, threads=threads)
            times.append(time.perf_counter() - start)
        walls.append(min(times))
    print(f"locate_many, one core / two, wall      {walls[0] / walls[1]:8.3f}     ({walls[0]:.3f} / {walls[1]:.3f} s)")
    exact = python / len(rows)
    some = rows[:3 if arguments.quick else 100]
    for samples in SAMPLES:
        scanned = cpu(lambda: scan(part, some, samples)) / len(some)
        share, whole = recall(part, some, scan(part, some, samples), samples)
        print(f"numpy, {samples:7,} places / locate_many    {scanned / exact:8.1f}     ({1e6 * scanned:.0f} us; has "
              f"{100 * share:.2f} % of the roots, all of them in {100 * whole:.1f} % of the problems)")


if __name__ == "__main__":
    main()
