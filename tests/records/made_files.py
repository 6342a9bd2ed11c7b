"""Catalogs, and what commands write: certificates, saved parts, figures. The files are recorded as well."""

from contacts import contact_part, touch_words
from courses import Rolled
from logs import (columns_of, course_part, finger_for, noisy_log, noisy_pair_log, noisy_words_for, one_log, pair_log,
                  table)
from parts import any_part, drawn_part
from readings import Problem, one_finger_readings, pair_facing, place, readings_gallery, stretch

# ---- catalogs

FAMILY = ["gallery:cam", "gallery:ellipse", "gallery:limacon", "gallery:reuleaux", "gallery:superellipse",
          "gallery:rounded-rectangle"] + [f"gallery:spline,n=9,seed={seed}" for seed in range(14)]


def catalog_of(part):
    """The part among others, and the command that makes a catalog of them."""
    listed = [one for one in FAMILY if one != part.words[0]]
    files = {**part.files, "list.txt": "\n".join(part.words + listed) + "\n"}
    return files, ["catalog", "build", "list.txt", "-o", "parts.db"]


def plain_part(dice):
    """One that a list can name: nothing but a file or a shape, all of whose rolls are known."""
    while True:
        part = course_part(dice)
        if len(part.words) == 1:
            return part


def identify_readings(dice):
    part = plain_part(dice)
    files, build = catalog_of(part)
    words = one_finger_readings(part, dice)
    return Problem(["identify", "parts.db"] + words + ["--json"], files, before=[build])


def identify_log(dice):
    part = plain_part(dice)
    files, build = catalog_of(part)
    words, more, finger = finger_for(part.course, dice)
    length = stretch(part, dice, 0.1, 0.45)
    rolled = Rolled(part.course, finger, place(part, dice, length), length, dice.whole(10, 60))
    noise = noisy_words_for(part, dice, rolled, finger)
    text = table(columns_of(rolled, "contact", part), dice, 9)
    asked = ["identify", "parts.db", "--log", "roll.csv"] + words + noise + ["--json"]
    return Problem(asked, {**files, **more, "roll.csv": text}, before=[build])


def identify_touches(dice):
    part = plain_part(dice)
    files, build = catalog_of(part)
    words, _ = touch_words(part, dice, count=5, felt_normals=True)
    return Problem(["identify", "parts.db"] + words + ["--json"], files, before=[build])


def catalog_lists(dice):
    part = plain_part(dice)
    files, build = catalog_of(part)
    if dice.chance(0.5):
        return Problem(["catalog", "list", "parts.db"], files, before=[build])
    remove = ["catalog", "remove", "parts.db", "gallery:cam" if dice.chance(0.7) else "gallery:none"]
    return Problem(["identify", "parts.db", "--reading", "0.5,0.4", "--json"], files, before=[build, remove])


# ---- what is written

def also_writing(problem, *options):
    return Problem(problem.words[:-1] + list(options) + ["--json"], problem.files, problem.stdin, writes=[options[1]])


def certificate(dice):
    """Of one finger, of two and of touches; and what the second program says of it."""
    kind = dice.whole(0, 2)
    if kind == 0:
        return also_writing(readings_gallery(dice), "--certify", "proof.json")
    if kind == 1:
        return also_writing(pair_facing(dice), "--certify", "proof.json", "--budget", "20000")
    part = contact_part(dice)
    words, _ = touch_words(part, dice, count=3, felt_normals=True)
    return also_writing(Problem(["locate"] + part.words + words + ["--json"], part.files), "--certify", "proof.json")


def figure(dice):
    maker = dice.choice([readings_gallery, one_log, noisy_log, noisy_pair_log, pair_log])
    return also_writing(maker(dice), "-o", "figure.svg")


def touch_figure(dice):
    part = contact_part(dice)
    words, _ = touch_words(part, dice, count=4, felt_normals=True)
    return also_writing(Problem(["locate"] + part.words + words + ["--json"], part.files), "-o", "figure.svg")


def saved_part(dice):
    part = any_part(dice) if dice.chance(0.5) else drawn_part(dice)
    return Problem(["inspect"] + part.words + ["-o", "saved.json"], part.files, writes=["saved.json"])


def part_figure(dice):
    part = any_part(dice)
    return Problem(["inspect"] + part.words + ["-o", "figure.svg"], part.files, writes=["figure.svg"])
