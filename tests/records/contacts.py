"""Contacts that share a pose: touches, rolls of one finger on a part at rest, three fingers on one that moves."""

import cmath
import math

from courses import Disk, Rolled, TAU
from logs import columns_of, table
from parts import any_part
from readings import locate, place, stretch


def contact_part(dice):
    """A part around which a small ball can go: no concavity that it is larger than."""
    return any_part(dice, known=True)


def ball_for(part, dice):
    """Radius of the finger; 0: a point."""
    tightest = -1 / part.course.least_curvature if part.course.least_curvature < -1e-6 else part.length
    return dice.choice([0.0, float(f"{min(dice.uniform(0.01, 0.05) * part.length, 0.5 * tightest):.3g}")])


def pose_of(part, dice):
    """Place and heading of the part in the world."""
    away = part.length * complex(dice.uniform(-0.3, 0.3), dice.uniform(-0.3, 0.3))
    return (away, dice.uniform(-3.1, 3.1)) if dice.chance(0.7) else (0j, 0.0)


def touched(part, dice, pose, radius, off=0.0):
    """Where the finger's centre is when it touches some place, and the direction out of the part there."""
    at, heading = pose
    s = dice.uniform(0, part.length)
    normal = part.course.theta(s) - math.pi / 2
    centre = part.course.point(s) + cmath.rect(radius, normal)
    error = complex(dice.normal(), dice.normal()) * off
    return at + cmath.rect(1, heading) * centre + error, normal + heading


def sensors(part, dice):
    """Either noise or tolerances: the words, and by how much places and normals are off."""
    place_off = float(f"{part.length * dice.choice([2e-5, 1e-4, 1e-3]):.2g}")
    normal_off = dice.choice([0.002, 0.02, 0.1])
    if dice.chance(0.5):
        return ["--noise", f"position={place_off:g},angle={normal_off:g}"], place_off, normal_off
    return ["--tolerance", f"{3 * place_off:g},{3 * normal_off:g}"], place_off, normal_off


def touch_words(part, dice, count=None, felt_normals=None):
    """Words of some touches, the finger and the sensors."""
    radius, pose = ball_for(part, dice), pose_of(part, dice)
    noise, place_off, normal_off = sensors(part, dice)
    felt_normals = dice.chance(0.5) if felt_normals is None else felt_normals
    count = count or (dice.whole(2, 4) if felt_normals else dice.whole(3, 6))
    words = ["--finger", f"disk,r={radius:g}"] if radius else []
    for _ in range(count):
        centre, normal = touched(part, dice, pose, radius, 0.5 * place_off)
        told = f",{math.degrees(normal + 0.5 * normal_off * dice.normal()):.4f}deg" if felt_normals else ""
        words += ["--touch", f"{centre.real:.9g},{centre.imag:.9g}{told}"]
    return words + noise, pose


def touches(dice):
    part = contact_part(dice)
    words, (at, heading) = touch_words(part, dice)
    if dice.chance(0.15):
        words += ["--heading", f"{math.degrees(heading + 0.05):.3f}deg,10deg"] if "--noise" in words else ["--mirror"]
    if dice.chance(0.1):
        far = 0.6 * part.length
        ends = [f"{(at + complex(x, far)).real:.6g},{(at + complex(x, far)).imag:.6g}" for x in (-far, far)]
        words += ["--clear", ",".join(ends)]
    return locate(part, words + ["--budget", "2000000"])


def touch_table(dice):
    part = contact_part(dice)
    radius, pose = ball_for(part, dice), pose_of(part, dice)
    noise, place_off, _ = sensors(part, dice)
    felt = [touched(part, dice, pose, radius, 0.5 * place_off) for _ in range(dice.whole(3, 5))]
    columns = {"x": [at.real for at, _ in felt], "y": [at.imag for at, _ in felt]}
    if dice.chance(0.5):
        columns["normal"] = [normal for _, normal in felt]
    words = ["--log", "touches.csv"] + (["--finger", f"disk,r={radius:g}"] if radius else [])
    return locate(part, words + noise + ["--budget", "2000000"], {"touches.csv": table(columns, dice, 9)})


def rolls_together(dice):
    """One file with two rolls of one finger, with the finger's centre or without it."""
    part = contact_part(dice)
    size = part.length / TAU
    tightest = -1 / part.course.least_curvature if part.course.least_curvature < -1e-6 else size
    radius = float(f"{min(0.2 * size, 0.6 * tightest):.3g}")
    world = dice.chance(0.5)
    columns, rolls = {}, 2
    for number in range(rolls):
        length = stretch(part, dice, 0.03, 0.1)
        rolled = Rolled(part.course, Disk(radius), place(part, dice, length), length, 12)
        for name, values in {**columns_of(rolled, "contact", part, world), "contact": [1] * 12}.items():
            columns.setdefault(name, []).extend(values)
        if number + 1 < rolls:
            for name, values in columns.items():
                values.append(0 if name == "contact" else values[-1])
    words = ["--log", "roll.csv", "--roll", "all", "--finger", f"disk,r={radius:g}"]
    if dice.chance(0.5):
        words += ["--noise", f"contact={2e-4 * part.length:.2g},angle=0.002" + (",position=0.001" if world else "")]
    return locate(part, words + ["--budget", "2000000"], {"roll.csv": table(columns, dice, 9)})


def three_fingers(dice):
    """Three disks that roll on a part while it moves."""
    part = contact_part(dice)
    while not part.closed or part.reversed or part.course.least_curvature < 1e-3:
        part = contact_part(dice)
    radius = float(f"{0.1 * part.length / TAU:.3g}")
    spin, by = dice.uniform(-0.5, 0.5), part.length * complex(dice.uniform(-0.1, 0.1), dice.uniform(-0.1, 0.1))
    poses = lambda t: (by * t, spin * t)
    world, first, texts = dice.chance(0.5), dice.uniform(0, part.length), {}
    for finger, name in enumerate("abc"):
        s = first + finger * part.length / 3 + part.length * dice.uniform(-0.08, 0.08)
        length = part.length * dice.uniform(-0.1, 0.1)
        rolled = Rolled(part.course, Disk(radius), s % part.length, length, 9, 0.2, poses)
        columns = {"time": [0.25 * i for i in range(9)], **columns_of(rolled, "contact", part, world)}
        texts[f"{name}.csv"] = table(columns, dice, 9)
    words = [word for name in texts for word in ("--log", name)] + ["--finger", f"disk,r={radius:g}"]
    if dice.chance(0.4):
        noise = f"contact={2e-4 * part.length:.2g},angle=0.002"
        words += ["--noise", noise + (f",position={2e-4 * part.length:.2g}" if world else "")]
    return locate(part, words + ["--budget", "2000000"], texts)


def next_touch(dice):
    part = contact_part(dice)
    words, _ = touch_words(part, dice, count=dice.whole(1, 2), felt_normals=True)
    problem = locate(part, words)
    problem.words[0] = "advise"
    return problem
