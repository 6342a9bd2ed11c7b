"""The 3,400 problems: deterministic, made from closed formulas, independent of the program that answers them.

Each problem has dice of its own, so a new group leaves the others as they are."""

import in_python
from contacts import next_touch, rolls_together, three_fingers, touch_table, touches
from courses import TAU, Dice, Disk, Rolled
from logs import (columns_of, course_part, finger_for, many_rolls, noisy_log, noisy_pair_log, noisy_pair_readings,
                  noisy_readings, one_log, pair_log, pair_rolled, pair_tables, table)
from made_files import (catalog_lists, certificate, figure, identify_log, identify_readings, identify_touches,
                        part_figure, saved_part, touch_figure)
from mistakes import BAD_FILES, ONE_FINGER, TWO_FINGERS
from parts import any_part, gallery_part
from readings import (Problem, locate, one_finger_readings, pair_facing, pair_free, pair_readings, place,
                      readings_drawings, readings_gallery, readings_points, stretch)


# ---- reach and overlap

def big_finger(part, dice):
    size = part.length / TAU
    if dice.chance(0.25):
        return ["--finger", "jaw"]
    return ["--finger", f"disk,r={float(f'{size * dice.uniform(0.3, 4):.3g}'):g}"]


def with_concavities(dice):
    while True:
        part = any_part(dice, known=True)
        if part.course.least_curvature < -1e-3 or getattr(part.course, "has_corners", False) or dice.chance(0.2):
            return part


def reach(dice):
    part = with_concavities(dice)
    words = one_finger_readings(part, dice) + big_finger(part, dice) + (["--explain"] if dice.chance(0.6) else [])
    return locate(part, words)


def reach_log(dice):
    """A log whose finger is said to be larger than it was: what it can't do is dropped."""
    part = with_concavities(dice)
    length = stretch(part, dice, 0.05, 0.3)
    rolled = Rolled(part.course, Disk(0.05 * part.length), place(part, dice, length), length, 20)
    text = table(columns_of(rolled, "travelled", part), dice, 12)
    return locate(part, ["--log", "roll.csv", "--explain"] + big_finger(part, dice), {"roll.csv": text})


def overlap(dice):
    """Disks that may lie over each other at the first contacts or later."""
    part = with_concavities(dice)
    facing = dice.chance(0.7)
    words = pair_readings(part, dice, 1 if facing else 2, facing)
    words += big_finger(part, dice) + (big_finger(part, dice) if dice.chance(0.3) else [])
    return locate(part, words + (["--explain"] if dice.chance(0.7) else []))


def overlap_log(dice):
    part = with_concavities(dice)
    _, _, _, rolled = pair_rolled(part, dice, 15, fit=False)
    asked, texts, _ = pair_tables(part, dice, rolled, dice.choice(["contact", "travelled"]), 12, world=False)
    return locate(part, asked + big_finger(part, dice) + ["--explain"], texts)


# ---- other commands

def inspect(dice):
    part = any_part(dice)
    finger = big_finger(part, dice) if dice.chance(0.3) else []
    return Problem(["inspect"] + part.words + finger + ["--json"], part.files)


def advise(dice):
    part = any_part(dice, known=True)
    words = one_finger_readings(part, dice)[:2] + ["--tolerance", "0.01"] if dice.chance(0.6) else None
    files = {}
    if words is None:
        noisy = noisy_log(dice)
        words, files = noisy.words[1:-1], noisy.files
        return Problem(["advise"] + words + ["--json"], files)
    words += ["--travel", f"{-0.2 * part.length:.3f},{0.3 * part.length:.3f}"] if dice.chance(0.5) else []
    return Problem(["advise"] + part.words + words + ["--json"], part.files)


def watch(dice):
    noisy = noisy_log(dice)
    extra = ["--every", dice.whole(5, 20)] if dice.chance(0.5) else []
    return Problem(["watch"] + noisy.words[1:-1] + extra + ["--once", "--jsonl"], noisy.files)


def teach(dice):
    part = course_part(dice)
    while not part.closed or part.reversed or part.course.least_curvature < 1e-3:
        part = course_part(dice)
    words, files, finger = finger_for(part.course, dice, smooth=False)
    rolled = Rolled(part.course, finger, 0, part.length, dice.whole(150, 300))
    text = table(columns_of(rolled, "contact", part), dice, 12)
    return Problem(["teach", "roll.csv"] + words + ["--json"], {**files, "roll.csv": text})


def simulate(dice):
    """The rows themselves, of one finger or two, with and without noise."""
    part = gallery_part(dice, ("ellipse", "cam", "circle", "reuleaux", "polygon", "exponential"))
    count = dice.whole(1, 2)
    words = ["--finger", f"disk,r={part.length * 0.05:.3f}", "--samples", 9]
    for _ in range(count):
        length = stretch(part, dice, 0.05, 0.3)
        words += ["--start", f"{place(part, dice, length):.4f}", "--length", f"{length:.4f}"]
    if dice.chance(0.5):
        words += ["--noise", "contact=0.001,angle=0.1deg,slip=0.01", "--seed", dice.whole(0, 99)]
    return Problem(["simulate"] + part.words + words, part.files)


def text(dice):
    """What people read, without --json."""
    maker = dice.choice([readings_gallery, one_log, noisy_log, pair_free, pair_log, reach, overlap, noisy_pair_log])
    problem = maker(dice)
    return Problem(problem.words[:-1], problem.files, problem.stdin)


# ---- mistakes

def mistakes(listed):
    for words in (line.split() for line in listed.split("\n") if line):
        json = {"watch": ["--jsonl"], "simulate": []}.get(words[0], ["--json"])
        yield Problem(words + json, {name: BAD_FILES[name] for name in words if name in BAD_FILES}, "")


# ---- all of them

GROUPS = [  # name, how many, fingers (or what else it is about); the mistakes are as many as are listed
    (readings_gallery, 380, 1), (readings_points, 220, 1), (readings_drawings, 240, 1), (one_log, 260, 1),
    (many_rolls, 40, 1), (noisy_log, 220, 1), (noisy_readings, 60, 1), (reach, 110, 1), (reach_log, 40, 1),
    (inspect, 50, 1), (advise, 40, 1), (watch, 30, 1), (teach, 15, 1), (simulate, 15, 1), (text, 30, 1),
    (pair_free, 327, 2), (pair_facing, 240, 2), (pair_log, 250, 2), (noisy_pair_log, 120, 2),
    (noisy_pair_readings, 50, 2), (overlap, 80, 2), (overlap_log, 40, 2),
    (touches, 60, "contacts"), (touch_table, 20, "contacts"), (rolls_together, 20, "contacts"),
    (three_fingers, 15, "contacts"), (next_touch, 10, "contacts"),
    (identify_readings, 20, "catalog"), (identify_log, 20, "catalog"), (identify_touches, 10, "catalog"),
    (catalog_lists, 6, "catalog"),
    (certificate, 45, "written"), (figure, 30, "written"), (touch_figure, 10, "written"), (saved_part, 20, "written"),
    (part_figure, 10, "written"),
    (in_python.readings, 20, "python"), (in_python.many, 8, "python"), (in_python.log, 15, "python"),
    (in_python.simulated, 6, "python"), (in_python.touches, 8, "python"), (in_python.advice, 6, "python"),
    (in_python.mistake, 20, "python"),
]


# Two fingers on sides and arcs can take a minute: these get a small budget, or are drawn anew where that does not help.
LONG = {
    "2/noisy-pair-log": "010 025 028 048 053 084", "2/pair-log": "005 051 094 159 179 238 247", "2/overlap-log": "022",
    "2/pair-free": "000 022 067 079 094 122 140 164 204 209 243 263 267 279 321",
    "2/overlap": "016 024 035 046 053 071",
    "2/pair-facing": "001 028 039 048 064 105 109 139",
}
ENDLESS = {"2/pair-free": "124 234", "2/overlap": "013", "2/noisy-pair-log": "035", "2/noisy-pair-readings": "027 049"}


def drawn(maker, name, number):
    again = "/again" if number in ENDLESS.get(name, "") else ""
    problem = maker(Dice(f"{name}/{int(number)}{again}"))
    if number in LONG.get(name, "") and "--budget" not in problem.words:
        problem.words += ["--budget", "1000"]
    problem.id = f"{name}/{number}"
    return problem


def all_problems():
    found = []
    for maker, count, fingers in GROUPS:
        name = f"{fingers}/{maker.__name__.replace('_', '-')}"
        found += [drawn(maker, name, f"{i:03d}") for i in range(count)]
    for name, listed in (("1/mistakes", ONE_FINGER), ("2/mistakes", TWO_FINGERS)):
        for i, problem in enumerate(mistakes(listed)):
            problem.id = f"{name}/{i:03d}"
            found.append(problem)
    return found
