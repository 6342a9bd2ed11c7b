"""Logs of one finger and two, exact, rounded and noisy."""

import cmath
import math

from courses import Curve, Disk, Jaw, Rolled, Shaped, TAU, near
from parts import any_part
from readings import locate, one_finger_readings, pair_readings, pair_starts, place, search_options, stretch


def finger_for(course, dice, smooth=True):
    """A finger that fits the concavities of the boundary as a rule: its words, its files, itself."""
    size = course.length / TAU
    tightest = -1 / course.least_curvature if course.least_curvature < -1e-6 else 10 * size
    kind = dice.choice(["disk"] * 6 + ["jaw"] + ["shape"] * 2) if smooth else "disk"
    if kind == "jaw" and course.least_curvature > 0:
        return ["--finger", "jaw"], {}, Jaw()
    if kind == "shape" and tightest > size:
        a, b = round(0.2 * size, 4), round(0.12 * size, 4)
        text = f'{{"gallery": "ellipse", "parameters": {{"a": {a}, "b": {b}}}}}'
        outline = Curve(lambda u: (a * cmath.cos(u), b * cmath.sin(u)), 0, TAU, True)
        return ["--finger", "tip.json"], {"tip.json": text}, Shaped(outline)
    r = float(f"{min(dice.uniform(0.05, 0.4) * size, 0.8 * tightest):.3g}")
    return ["--finger", f"disk,r={r:g}"], {}, Disk(r)


def per_length(finger):
    return 1 / finger.r if isinstance(finger, Disk) else 1.0


def table(columns, dice, digits=17, gap=None, degrees=()):
    """A log of named columns, in full or rounded to so many decimals."""
    gap = gap or dice.choice([","] * 6 + [";", "\t"])

    def cell(name, value):
        if value is None or isinstance(value, (int, str)):
            return str(value)
        end = "deg" if name in degrees else ""
        value = math.degrees(value) if end else value
        return f"{value:.{digits}{'g' if digits > 15 else 'f'}}" + end

    names = list(columns)
    if dice.chance(0.2):
        names = names[::-1]
    rows = [gap.join(cell(name, columns[name][i]) for name in names) for i in range(len(columns[names[0]]))]
    return "\n".join([gap.join(names)] + rows) + "\n"


def increments(values):
    return [b - a for a, b in zip([0.0] + values, values)]


def columns_of(rolled, kind, part, world=False, wrap=False):
    """The columns of one finger; lengths run along the outline as it was given."""
    given = -1 if part.reversed else 1
    if kind == "contact":
        u, psi = rolled.u, rolled.psi
        if wrap:
            u, psi = [near(v, 0) for v in u], [near(v, 0) for v in psi]
        columns = {"u": u, "psi": psi}
    elif kind == "travelled":
        columns = {"length": [given * v for v in rolled.length], "turn": rolled.turn}
    else:
        columns = {"distance": increments([given * v for v in rolled.length]), "dturn": increments(rolled.turn)}
    if world and kind == "contact":
        columns.update(x=rolled.x, y=rolled.y)
    return columns


def some_instants(rows, dice, count):
    return ",".join(f"{0.25 * dice.whole(max(1, rows // 4), rows - 1):g}" for _ in range(count))


def course_part(dice):
    return any_part(dice, known=True)


def one_log(dice):
    part = course_part(dice)
    words, files, finger = finger_for(part.course, dice)
    kind = dice.choice(["contact"] * 4 + ["travelled", "increments"])
    length = stretch(part, dice, 0.05, 0.5)
    rows = dice.whole(3, 60)
    rolled = Rolled(part.course, finger, place(part, dice, length), length, rows, dice.uniform(-1, 1))
    wrap = kind == "contact" and isinstance(finger, Disk) and rows > 40 and dice.chance(0.4)
    columns = columns_of(rolled, kind, part, world=dice.chance(0.5), wrap=wrap)
    asked = ["--log", "roll.csv"]
    if dice.chance(0.7):
        columns = {"time": [0.25 * i for i in range(rows)], **columns}
        if dice.chance(0.35):
            asked += ["--at", some_instants(rows, dice, dice.choice([1, 2, 3]))]
    if dice.chance(0.1):
        columns["contact"] = [1] * rows
    if kind == "contact" or dice.chance(0.3):
        asked += words
    if kind == "increments" and dice.chance(0.4) and "time" not in columns and "contact" not in columns:
        text = "".join(f"{d:.9f},{t:.9f}\n" for d, t in zip(columns["distance"], columns["dturn"]))
    else:
        digits = dice.choice([17, 17, 12, 7, 5])
        text = table(columns, dice, digits, degrees=dice.choice([(), (), ("psi", "turn", "dturn")]))
    asked += search_options(part, dice)
    if dice.chance(0.1):
        return locate(part, ["--log", "-"] + asked[2:], files, text)
    return locate(part, asked, {**files, "roll.csv": text})


def many_rolls(dice):
    """One file, contact lost and found again."""
    part = course_part(dice)
    words, files, finger = finger_for(part.course, dice)
    kind = dice.choice(["contact", "contact", "travelled", "increments"])
    columns, rows = {}, 0
    for number in range(dice.whole(2, 3)):
        length = stretch(part, dice, 0.05, 0.4)
        rolled = Rolled(part.course, finger, place(part, dice, length), length, 12)
        more = columns_of(rolled, kind, part, world=True)
        more["contact"] = [1] * 12
        lost = {name: [values[-1], values[-1]] for name, values in more.items()}
        lost["contact"] = [0, 0]
        for name, values in more.items():
            columns[name] = columns.get(name, []) + values + lost[name]
        rows += 14
    if dice.chance(0.7):
        columns["time"] = [0.25 * i for i in range(rows)]
    asked = ["--log", "roll.csv"] + words + (["--roll", dice.whole(1, 3)] if dice.chance(0.7) else [])
    return locate(part, asked, {**files, "roll.csv": table(columns, dice, 12)})


def pair_rolled(part, dice, rows, alike=True, fit=True):
    """Two fingers' rows on a part that moves, and the words and files for the fingers."""
    words, files, a = finger_for(part.course, dice, smooth=fit)
    b = a
    if not alike and isinstance(a, Disk):
        b = Disk(float(f"{0.7 * a.r:.3g}"))
        words = words + ["--finger", f"disk,r={b.r:g}"]
    lengths, starts = pair_starts(part, dice)
    spin, vx, vy = dice.uniform(-0.5, 0.5), *(part.length * dice.uniform(-0.2, 0.2) for _ in range(2))
    poses = lambda t: (complex(vx * t, vy * t), spin * t)
    rolled = [Rolled(part.course, f, s, length, rows, 0.2, poses) for f, s, length in zip((a, b), starts, lengths)]
    return words, files, (a, b), rolled


def pair_tables(part, dice, rolled, kind, digits=17, two=None, world=None):
    """The log of two fingers in one file or in two: the words for it and the files."""
    world = dice.chance(0.5) if world is None else world
    sides = [columns_of(r, kind, part, world) for r in rolled]
    rows = len(rolled[0].u)
    time = {"time": [0.25 * i for i in range(rows)]} if dice.chance(0.75) else {}
    if dice.chance(0.35) if two is None else two:
        texts = {name: table({**time, **side}, dice, digits) for name, side in zip(("a.csv", "b.csv"), sides)}
        return ["--log", "a.csv", "--log", "b.csv"], texts, time
    both = {name + end: values for end, side in zip(("_a", "_b"), sides) for name, values in side.items()}
    return ["--log", "both.csv"], {"both.csv": table({**time, **both}, dice, digits)}, time


def pair_log(dice):
    part = course_part(dice)
    rows = dice.whole(3, 40)
    words, files, _, rolled = pair_rolled(part, dice, rows, alike=dice.chance(0.6))
    kind = dice.choice(["contact"] * 5 + ["travelled", "increments"])
    asked, texts, time = pair_tables(part, dice, rolled, kind, dice.choice([17, 17, 12, 7]))
    if time and dice.chance(0.3):
        asked += ["--at", some_instants(rows, dice, 2)]
    if kind == "contact" or dice.chance(0.3):
        asked += words
    return locate(part, asked + search_options(part, dice), {**files, **texts})


# ---- noise

def noise_words(part, dice, radius=False):
    contact = float(f"{part.length * dice.choice([2e-4, 1e-3, 4e-3]):.2g}")
    angle, slip = dice.choice([0.002, 0.005, 0.02]), dice.choice([0, 0.002, 0.01])
    fields = [f"contact={contact:g}", dice.choice([f"angle={angle}", f"angle={math.degrees(angle):.4g}deg"])]
    if slip or dice.chance(0.3):
        fields.append(f"slip={slip}")
    if radius and dice.chance(0.3):
        fields.append(f"radius={0.02 * contact:g}")
    if dice.chance(0.08):
        fields = fields[:1]
    return ["--noise", ",".join(fields)], contact, angle, slip


def noisy_words_for(part, dice, rolled, finger):
    """Disturbs a roll, and says by how much."""
    noise, contact, angle, slip = noise_words(part, dice)
    rolled.disturb(dice, contact, angle, slip, per_length(finger))
    return noise


def belief_options(part, dice, start):
    words = []
    if dice.chance(0.3):
        at = start + part.length * dice.choice([0, 0.01, 0.3])
        at = at % part.length if part.closed else min(at, part.length)
        words += ["--prior", f"{at:.4f},{part.length * dice.choice([0.01, 0.05, 0.3]):.3g}"]
    if dice.chance(0.2):
        words += ["--robust"]
    return words


def noisy_log(dice):
    part = course_part(dice)
    words, files, finger = finger_for(part.course, dice)
    kind = dice.choice(["contact"] * 4 + ["travelled", "increments"])
    noise, contact, angle, slip = noise_words(part, dice, kind == "contact" and isinstance(finger, Disk))
    length = stretch(part, dice, 0.05, 0.45)
    start, rows = place(part, dice, length), dice.whole(10, 120)
    rolled = Rolled(part.course, finger, start, length, rows)
    rolled.disturb(dice, contact, angle, slip, per_length(finger))
    if dice.chance(0.08):
        rolled.length = [1.2 * v for v in rolled.length]
        rolled.u = [1.2 * v for v in rolled.u]
    if dice.chance(0.1):
        rolled.psi[rows // 2] += 1
    columns = columns_of(rolled, kind, part, world=dice.chance(0.5))
    if dice.chance(0.7):
        columns["time"] = [0.25 * i for i in range(rows)]
    asked = ["--log", "roll.csv"] + (words if kind == "contact" or dice.chance(0.3) else []) + noise
    asked += belief_options(part, dice, start)
    return locate(part, asked, {**files, "roll.csv": table(columns, dice, dice.choice([9, 6]))})


def noisy_readings(dice):
    part = any_part(dice)
    noise, *_ = noise_words(part, dice)
    asked = one_finger_readings(part, dice) + noise + belief_options(part, dice, dice.uniform(0, part.length))
    return locate(part, asked)


def noisy_pair_log(dice):
    part = course_part(dice)
    words, files, fingers, rolled = pair_rolled(part, dice, dice.whole(8, 40), alike=dice.chance(0.7))
    kind = dice.choice(["contact"] * 5 + ["travelled", "increments"])
    noise, contact, angle, slip = noise_words(part, dice)
    for finger, side in zip(fingers, rolled):
        side.disturb(dice, contact, angle, slip, per_length(finger))
    asked, texts, _ = pair_tables(part, dice, rolled, kind, 8)
    asked += (words if kind == "contact" else []) + noise + (["--robust"] if dice.chance(0.2) else [])
    return locate(part, asked, {**files, **texts})


def noisy_pair_readings(dice):
    part = any_part(dice)
    noise, *_ = noise_words(part, dice)
    facing = dice.chance(0.6)
    return locate(part, pair_readings(part, dice, dice.choice([1, 2]) if facing else 2, facing) + noise)
