#!/usr/bin/env python3
"""Logs without any error, of every outline and kind: the true start must be among the answers, to 1e-6 P.

It checks the simulator against the program: signs, formulas, arc lengths, the spline through points.
"""

import pathlib
import sys
import tempfile

import numpy as np

from outlines import OUTLINES
from rolls import KINDS, Noise, as_csv
from study import PROGRAM, ask

FINE = 1e-5  # contact, of the perimeter, and angle, radians: said, though there is none
CLOSE = 1e-6  # of the perimeter


def distance(placement, truth, period):
    """How far the true starts are from where the placement is likeliest, and out of its 95 % interval."""
    off = 0.0
    for k, s in enumerate(truth):
        lo, hi = placement["interval"][k]
        s = s + period * round(((lo + hi) / 2 - s) / period)
        off = max(off, lo - s, s - hi)
        if len(truth) == 1:  # two fingers on lines and arcs hardly know where along a ridge they are
            off = max(off, abs(s - placement["start"][k]))
    return off


def check(program, seed=1, each=3):
    """The failures, in words, and how many logs there were."""
    failed, count = [], 0
    with tempfile.TemporaryDirectory(prefix="exact.") as here:
        here = pathlib.Path(here)
        lines, truths = [], []
        for name, outline in OUTLINES.items():
            for kind, log in KINDS.items():
                if kind.startswith("pair") and outline.jump.any():
                    continue  # rows at corners are not normally distributed there: docs/two_fingers.md
                for k in range(each):
                    random = np.random.default_rng([seed, *name.encode(), *kind.encode(), k])
                    columns, rolled, radii = log(random, outline, 41, (0.3, 0.7, 1.6)[k % 3], Noise(0, 0), False)
                    path = here / f"{len(lines)}.csv"
                    path.write_bytes(as_csv(columns))
                    line = {"id": f"{name}, {kind}, {k}", "part": outline.write(here), "log": str(path),
                            "noise": Noise(FINE * outline.perimeter, FINE).text()}
                    if radii:
                        line["fingers"] = [f"disk,r={r!r}" for r in radii]
                    lines.append(line)
                    truths.append((outline, [r.s[0] % outline.perimeter for r in rolled]))
        answers = ask(program, lines, here)
    for answer, line, (outline, truth) in zip(answers, lines, truths):
        count += 1
        if "placements" not in answer:
            failed.append(f"{line['id']}: {answer.get('error')}")
            continue
        if abs(answer["part"]["perimeter"] / outline.perimeter - 1) > 1e-10:
            failed.append(f"{line['id']}: perimeter {answer['part']['perimeter']}, not {outline.perimeter}")
        found = [p for p in answer["placements"] if p.get("probability")]
        off = min((distance(p, truth, outline.perimeter) for p in found), default=np.inf) / outline.perimeter
        if off > CLOSE:
            failed.append(f"{line['id']}: true {truth}, {off:.2g} P from the nearest of {len(found)}; "
                          f"{answer['verdict']}; dropped {answer.get('dropped')}")
    return failed, count


if __name__ == "__main__":
    program = sys.argv[1] if len(sys.argv) > 1 else PROGRAM
    messages, checked = check(str(program))
    print("\n".join(messages))
    print(f"{checked} exact logs, {len(messages)} not located")
    sys.exit(bool(messages))
