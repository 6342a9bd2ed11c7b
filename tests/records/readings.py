"""Bare readings of one finger and two, typed as people type them."""

import hashlib
import math

from courses import TAU, near
from parts import any_part, drawn_part, gallery_part, points_part


class Problem:
    """A command and the files that it needs. `before`: commands that are run first; `writes`: files that are recorded;
    `python`: the words are a script's, not the program's."""

    def __init__(self, words, files=None, stdin=None, before=(), writes=(), python=False):
        self.id = None
        self.words, self.stdin = [str(word) for word in words], stdin
        self.before, self.writes, self.python = list(before), list(writes), python
        self.files = {name: text if isinstance(text, bytes) else text.encode() for name, text in (files or {}).items()}

    def digest(self):
        """What was asked: two records are comparable where these agree."""
        more = (self.before,) if self.before else ()
        asked = repr((self.words, sorted(self.files.items()), self.stdin) + more)
        return hashlib.sha256(asked.encode()).hexdigest()[:16]


def locate(part, words, files=None, stdin=None):
    return Problem(["locate"] + part.words + words + ["--json"], {**part.files, **(files or {})}, stdin)


def typed(length, dice, digits):
    """A number as people type it."""
    text = f"{length:.{digits}f}"
    return text.rstrip("0").rstrip(".") if "." in text and dice.chance(0.1) else text


def typed_angle(angle, dice, digits):
    return typed(math.degrees(angle), dice, digits) + "deg" if dice.chance(0.35) else typed(angle, dice, digits)


def place(part, dice, span):
    """A start from which a roll of `span` stays on the part."""
    if part.closed:
        return dice.uniform(0, part.length)
    return dice.uniform(max(0, -span), min(part.length, part.length - span))


def stretch(part, dice, least=0.03, most=0.6):
    """A signed length; on closed parts now and then above a lap."""
    most = 1.7 if part.closed and dice.chance(0.08) else most
    return dice.sign() * part.length * dice.uniform(least, most)


def turned(part, dice, s, length):
    if part.course is None:
        return length * TAU / part.length * dice.uniform(0.6, 1.4)
    return part.course.theta(s + length) - part.course.theta(s)


SPECIAL = [(0, 0), (0, 1.0472), (0, -0.5), (1, TAU), (-1, -TAU), (2, 2 * TAU), (0.5, math.pi), (0.25, math.pi / 2),
           (0.3333333333, TAU / 3), (0.1, 0), (0.4, 0), (0.3, 20), (1.2, 1), (-0.2, 0.4), (1e-6, 0)]


def one_finger_readings(part, dice):
    digits = dice.choice([2, 3, 4, 4, 6, 9, 12])
    words = []
    if dice.chance(0.12):
        laps, angle = dice.choice(SPECIAL)
        return ["--reading", f"{typed(laps * part.length, dice, 12)},{typed_angle(angle, dice, 12)}"]
    longest = stretch(part, dice)
    s = place(part, dice, longest)
    count = dice.choice([1, 1, 1, 2, 2, 3])
    for i in range(count):
        length = longest * (i + 1) / count
        angle = turned(part, dice, s, length) + (dice.normal() if dice.chance(0.05) else 0)
        words += ["--reading", f"{typed(length, dice, digits)},{typed_angle(angle, dice, digits)}"]
    return words


def search_options(part, dice):
    words = []
    if not part.exact and dice.chance(0.7):
        words += ["--tolerance", dice.choice(["0.003", "0.01", "1deg"])]
    elif dice.chance(0.2):
        words += ["--tolerance", dice.choice(["1e-6", "0.001", "0.05deg", "0.1", "1deg", "1e-9", "0.5"])]
    if dice.chance(0.08):
        words += ["--budget", dice.choice([1, 10, 40, 200])]
    return words


def readings_gallery(dice):
    part = gallery_part(dice)
    return locate(part, one_finger_readings(part, dice) + search_options(part, dice))


def readings_points(dice):
    part = points_part(dice)
    return locate(part, one_finger_readings(part, dice) + search_options(part, dice))


def readings_drawings(dice):
    part = drawn_part(dice)
    return locate(part, one_finger_readings(part, dice) + search_options(part, dice))


def pair_starts(part, dice):
    lengths = [stretch(part, dice, 0.03, 0.35), stretch(part, dice, 0.03, 0.35)]
    if dice.chance(0.07):
        lengths[dice.whole(0, 1)] = 0.0
    if dice.chance(0.04):
        lengths[1] = lengths[0]
    return lengths, [place(part, dice, length) for length in lengths]


def pair_readings(part, dice, count, facing):
    digits = dice.choice([3, 4, 6, 9, 12])
    lengths, starts = pair_starts(part, dice)
    words = []
    for i in range(count):
        rolled = [length * (i + 1) / count for length in lengths]
        if i + 1 < count and dice.chance(0.5):
            rolled[1] *= 0.8
        angle = turned(part, dice, starts[0], rolled[0]) - turned(part, dice, starts[1], rolled[1])
        angle = 0.0 if lengths[0] == lengths[1] and dice.chance(0.5) else angle
        words += ["--reading", ",".join([typed(v, dice, digits) for v in rolled] + [typed_angle(angle, dice, digits)])]
    if facing:
        angle = dice.uniform(-3, 3)
        if part.course:
            angle = near(part.course.theta(starts[0]) - part.course.theta(starts[1]), 0)
        words += ["--facing", typed_angle(angle, dice, digits)]
    return words


def pair_free(dice):
    part = any_part(dice)
    return locate(part, pair_readings(part, dice, dice.choice([2, 2, 2, 3]), False) + search_options(part, dice))


def pair_facing(dice):
    part = any_part(dice)
    return locate(part, pair_readings(part, dice, dice.choice([1, 1, 2, 3]), True) + search_options(part, dice))
