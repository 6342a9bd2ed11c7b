"""The Python package: the same kinds of problems, asked by a few lines of Python."""

from courses import Disk, Rolled
from logs import columns_of, noise_words, per_length, table
from parts import gallery_part
from readings import Problem, one_finger_readings, place, stretch

BEGIN = "import json, sys, numpy, rollfix\n"
TELL = "print(json.dumps(answer.to_dict()))\n"


def shape_of(part):
    """gallery:NAME,key=value as a call."""
    name, *given = part.words[0].removeprefix("gallery:").split(",")
    return f"part = rollfix.Part.gallery({', '.join([repr(name)] + given)})\n"


def known_part(dice):
    return gallery_part(dice, ("ellipse", "cam", "circle", "reuleaux", "polygon", "limacon", "superellipse"))


def asking(lines, files=None):
    return Problem(["ask.py"], {**(files or {}), "ask.py": BEGIN + lines}, python=True)


def readings(dice):
    part = known_part(dice)
    typed = one_finger_readings(part, dice)[1].split(",")
    length, turn = typed[0], typed[1]
    turn = f"numpy.radians({turn[:-3]})" if turn.endswith("deg") else turn
    return asking(shape_of(part) + f"answer = part.locate({length}, {turn}, tolerance=1e-3)\n" + TELL)


def many(dice):
    part = known_part(dice)
    made = f"s = numpy.linspace(0, 0.9 * part.perimeter, {dice.whole(3, 9)})\n"
    far = f"{dice.uniform(0.02, 0.1) * part.length:.4f}"
    turns = f"readings = numpy.stack([0 * s + {far}, part.turning(s + {far}) - part.turning(s)], axis=1)\n"
    tell = "print(json.dumps([one.to_dict() for one in answer]))\n"
    return asking(shape_of(part) + made + turns + "answer = part.locate_many(readings, tolerance=1e-2)\n" + tell)


def log(dice):
    part = known_part(dice)
    radius = float(f"{0.04 * part.length:.3g}")
    length = stretch(part, dice, 0.05, 0.4)
    rolled = Rolled(part.course, Disk(radius), place(part, dice, length), length, dice.whole(5, 40))
    noise, contact, angle, slip = noise_words(part, dice)
    rolled.disturb(dice, contact, angle, slip, 1 / radius)
    given = ", ".join(f"{name}={value}" for name, value in (("contact", contact), ("angle", angle), ("slip", slip)))
    asked = f"answer = part.locate(log='roll.csv', finger=rollfix.Disk({radius}), noise=rollfix.Noise({given}))\n"
    return asking(shape_of(part) + asked + TELL, {"roll.csv": table(columns_of(rolled, "contact", part), dice, 9)})


def simulated(dice):
    part = known_part(dice)
    length = stretch(part, dice, 0.05, 0.4)
    start = place(part, dice, length)
    asked = f"log = part.simulate(rollfix.Disk({0.04 * part.length:.3g}), start={start:.4f}, length={length:.4f})\n"
    tell = "print(json.dumps({name: list(map(float, log.log[name])) for name in log.log}))\n"
    return asking(shape_of(part) + asked + tell)


def touches(dice):
    part = known_part(dice)
    places = ", ".join(f"{dice.uniform(0, part.length):.4f}" for _ in range(dice.whole(3, 6)))
    asked = f"answer = part.locate(touches=part.point([{places}]), noise={{'position': {1e-3 * part.length:.3g}}})\n"
    return asking(shape_of(part) + asked + TELL)


def advice(dice):
    part = known_part(dice)
    length = dice.uniform(0.05, 0.3) * part.length
    s = place(part, dice, length)
    turn = part.course.theta(s + length) - part.course.theta(s)
    asked = f"answer = part.advise({length:.4f}, {turn:.4f}, tolerance=0.01)\n"
    return asking(shape_of(part) + asked + TELL)


WRONG = """
part.locate('a', 1)
part.locate(1.0)
part.locate([[1, 2, 3, 4]])
part.locate(log='no.csv')
part.locate(log={'u': [0, 1], 'psi': [0]})
part.locate(touches=[1, 2])
part.locate(log=[[0, 1], [1, 2]])
part.locate(1.0, 1.0, tolerance=-1)
part.advise(1.0)
part.simulate(rollfix.Disk(0.1))
rollfix.Part.gallery('elipse')
rollfix.Part.from_points([[0, 0], [1, 1]], closed=True)
rollfix.Disk(-1)
rollfix.Noise(angel=1)
""".split("\n")[1:-1]


def mistake(dice):
    """What people do wrong: the last line of what Python says."""
    wrong = dice.choice(WRONG)
    tell = "try:\n    print({})\nexcept Exception as error:\n    print(type(error).__name__, error)\n"
    return asking(shape_of(known_part(dice)) + tell.format(wrong))
