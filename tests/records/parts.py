"""The parts that are asked about: gallery shapes, points, scans and drawings, each with its boundary in closed form."""

import cmath
import json
import math
from pathlib import Path

from courses import GALLERY, TAU, Chain, Curve, airfoil, blob, filleted, gallery, star, wavy

SOURCE = Path(__file__).resolve().parents[2]


class Part:
    """What stands on the command line, the files it needs, and the boundary (None where no closed form is known)."""

    def __init__(self, words, course, files=None, reversed=False, length=None):
        self.words, self.course, self.files, self.reversed = words, course, files or {}, reversed
        self.length = course.length if course else length
        self.exact = True  # the closed form is the outline, not just near it

    @property
    def closed(self):
        return self.course is None or self.course.closed


def gallery_part(dice, names=GALLERY):
    name, course = gallery(dice.choice(names), dice)
    return Part([name], course, length=6.4)


def points_text(points, dice, digits=6, title=False):
    gap = dice.choice([" ", ",", ", ", "\t"])
    rows = [f"{p.real:.{digits}f}{gap}{p.imag:.{digits}f}" for p in points]
    if dice.chance(0.2):
        rows = [row + gap + "0.5" for row in rows]
    if dice.chance(0.2):
        rows.insert(len(rows) // 2, "# half of it\n")
    return "\n".join((["a part"] if title or dice.chance(0.2) else []) + rows) + "\n"


def along_course(course, n):
    count = n if course.closed else n - 1
    return [course.point(course.length * i / count) for i in range(n)]


def clockwise(points, dice):
    """Sometimes the same loop the other way round, its first point kept."""
    turned = dice.chance(0.25)
    return (points[:1] + points[:0:-1] if turned else points), turned


def smooth_points(dice):
    course = star(dice, dice.choice([1, 1, 25, 100]))
    points, turned = clockwise(along_course(course, dice.whole(24, 60)), dice)
    return Part(["part.csv"], course, {"part.csv": points_text(points, dice)}, turned)


def open_points(dice):
    course = wavy(dice, dice.choice([1, 10]))
    text = points_text(along_course(course, dice.whole(16, 40)), dice)
    return Part([dice.choice(["part.csv", "part.dat"]), "--open"], course, {"part.csv": text, "part.dat": text})


def cornered_points(dice):
    n = dice.whole(3, 8)
    size = dice.choice([1, 30])
    vertices = [size * cmath.rect(dice.uniform(0.85, 1.15), TAU * i / n) for i in range(n)]
    vertices = [complex(round(v.real, 3), round(v.imag, 3)) for v in vertices]
    per_side = dice.whole(1, 4)
    sides = zip(vertices, vertices[1:] + vertices[:1])
    points = [a + (b - a) * i / per_side for a, b in sides for i in range(per_side)]
    points, turned = clockwise(points, dice)
    words = ["part.txt", "--corner-angle", dice.choice(["20deg", "0.3"])]
    return Part(words, filleted(vertices, [0] * n), {"part.txt": points_text(points, dice)}, turned)


def half_moon(dice):
    """An arc on its chord, two corners."""
    r, sweep = dice.choice([1, 10]), dice.uniform(1.2, 1.6) * math.pi
    corner = (TAU - sweep) / 2
    chord = 2 * r * math.sin(sweep / 2)
    course = Chain([(corner, r * sweep, sweep), (corner, chord, 0.0)], complex(r), math.pi / 2)
    n = dice.whole(20, 40)
    points = [course.point(r * sweep * i / n) for i in range(n + 1)]
    return Part(["part.csv", "--corner-angle=40deg"], course, {"part.csv": points_text(points, dice, 9)})


def scanned_points(dice):
    size = dice.choice([1, 20])
    course = star(dice, size)
    noise = 0.002 * size
    points = [p + complex(dice.uniform(-noise, noise), dice.uniform(-noise, noise)) for p in along_course(course, 120)]
    points, turned = clockwise(points, dice)
    words = ["part.csv", "--smooth", f"{2.5 * noise:g}"]
    return Part(words, course, {"part.csv": points_text(points, dice)}, turned)


def airfoil_points(dice):
    chord = dice.choice([1, 100])
    course = airfoil(dice.choice([0.09, 0.12, 0.18]), chord)
    n = dice.whole(15, 30)
    upper = [course.f(complex(u)) for u in (math.pi * (1 - i / n) for i in range(n + 1))]
    upper = [complex(x.real, max(y.real, 0.0)) for x, y in upper]
    upper[-1] = complex(chord, 0)
    if dice.chance(0.5):
        text = points_text(upper[::-1] + [p.conjugate() for p in upper[1:]], dice, 6, True)
        return Part(["wing.dat"], course, {"wing.dat": text})
    lines = [f"{p.real:.6f} {p.imag:.6f}" for p in upper] + [""] + [f"{p.real:.6f} {-p.imag:.6f}" for p in upper]
    return Part(["wing.dat"], course, {"wing.dat": "\n".join(["A SECTION", f"{n + 1}. {n + 1}.", ""] + lines) + "\n"})


POINTS = (smooth_points, smooth_points, cornered_points, half_moon, open_points, scanned_points, airfoil_points)


def points_part(dice, kinds=POINTS):
    part = dice.choice(kinds)(dice)
    part.exact = kinds is not POINTS or part.words[0] == "part.txt"
    return part


def machined(dice):
    """A loop of lines and arcs: a plate, a bracket, a slot, a wedge; some corners sharp, some concave."""
    size = dice.choice([1, 12, 60])
    w, h = (round(size * dice.uniform(1, 2), 3) for _ in range(2))
    kind = dice.whole(0, 3)
    if kind == 0:
        corners = [(0, 0), (w, 0), (w, h), (0, h)]
    elif kind == 1:
        corners = [(0, 0), (w, 0), (w, h / 2), (w / 2, h / 2), (w / 2, h), (0, h)]
    elif kind == 2:
        corners = [(0, 0), (w, 0), (0.7 * w, h), (0.1 * w, h)]
    else:
        corners = [(0, 0), (w, 0), (w, h), (0.7 * w, h), (0.7 * w, h / 2), (0.3 * w, h / 2), (0.3 * w, h), (0, h)]
    r = round(0.14 * min(w, h), 3)
    keep = dice.choice([1.0, 1.0, 0.5, 0.0])
    return filleted([complex(x, y) for x, y in corners], [r if dice.chance(keep) else 0 for _ in corners])


def curves_of(course):
    """(from, to, centre or None, radius, from angle, sweep) of each piece."""
    for (start, angle), (end, _), (_, length, sweep) in zip(course.start, course.start[1:], course.pieces):
        radius = length / sweep if sweep else 0.0
        centre = start + radius * cmath.rect(1, angle + math.pi / 2) if sweep else None
        yield start, end, centre, radius, angle - math.copysign(math.pi / 2, sweep), sweep


def dxf_text(entities):
    groups = [(0, "SECTION"), (2, "HEADER"), (9, "$INSUNITS"), (70, 4), (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES")]
    groups += [group for entity in entities for group in entity] + [(0, "ENDSEC"), (0, "EOF")]
    spelled = lambda value: value if isinstance(value, (str, int)) else f"{value:.12f}"
    return "".join(f"{code:3d}\n{spelled(value)}\n" for code, value in groups)


def dxf_entities(course, layer="0"):
    for start, end, centre, radius, angle, sweep in curves_of(course):
        if centre is None:
            ends = [(10, start.real), (20, start.imag), (11, end.real), (21, end.imag)]
            yield [(0, "LINE"), (8, layer)] + ends
        else:
            lo, hi = sorted((angle, angle + sweep))
            at = [(10, centre.real), (20, centre.imag), (40, abs(radius))]
            yield [(0, "ARC"), (8, layer)] + at + [(50, math.degrees(lo)), (51, math.degrees(hi))]


def dxf_polyline(course, turned):
    rows = [(start, math.tan(sweep / 4)) for start, _, _, _, _, sweep in curves_of(course)]
    if turned:
        rows = [(rows[-i % len(rows)][0], -rows[-i - 1][1]) for i in range(len(rows))]
    head = [(0, "LWPOLYLINE"), (8, "0"), (90, len(rows)), (70, 1)]
    return head + [group for p, bulge in rows for group in ((10, p.real), (20, p.imag), (42, bulge))]


def svg_text(paths):
    return '<svg xmlns="http://www.w3.org/2000/svg">' + "".join(f'<path d="{path}"/>' for path in paths) + "</svg>\n"


def svg_path(course):
    words = [f"M {course.start[0][0].real:.9f} {-course.start[0][0].imag:.9f}"]
    for _, end, centre, radius, _, sweep in curves_of(course):
        if centre is None:
            words.append(f"L {end.real:.9f} {-end.imag:.9f}")
        else:
            flags = f"{int(abs(sweep) > math.pi)} {int(sweep < 0)}"
            words.append(f"A {abs(radius):.9f} {abs(radius):.9f} 0 {flags} {end.real:.9f} {-end.imag:.9f}")
    return " ".join(words) + " Z"


def json_curves(course):
    for start, end, centre, radius, angle, sweep in curves_of(course):
        if centre is None:
            yield {"type": "line", "from": [start.real, start.imag], "to": [end.real, end.imag]}
        else:
            at = [centre.real, centre.imag]
            yield {"type": "arc", "centre": at, "radius": abs(radius), "from": angle, "sweep": sweep}


def machined_part(dice):
    course, form = machined(dice), dice.whole(0, 4)
    if form == 0:
        return Part(["part.dxf"], course, {"part.dxf": dxf_text(dxf_entities(course))})
    if form == 1:
        turned = dice.chance(0.5)
        return Part(["part.dxf"], course, {"part.dxf": dxf_text([dxf_polyline(course, turned)])}, turned)
    if form == 2:
        return Part(["part.svg"], course, {"part.svg": svg_text([svg_path(course)])})
    if form == 3:
        text = json.dumps({"curves": list(json_curves(course)), "unit": "mm"})
        return Part(["part.json"], course, {"part.json": text})
    layered = list(dxf_entities(course, "Cut")) + list(dxf_entities(machined(dice), "Notes"))
    return Part(["part.dxf", "--layer", "cut"], course, {"part.dxf": dxf_text(layered)})


def plate_with_hole(dice):
    """Loop 2 is the hole, clockwise as it is stored: the closed form is that of the plate."""
    size = dice.choice([10, 80])
    plate = filleted([complex(x, y) * size for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))], [0.2 * size] * 4)
    at, r = complex(0.1 * size, 0.2 * size), round(0.3 * size, 3)
    circle = [(0, "CIRCLE"), (8, "0"), (10, at.real), (20, at.imag), (40, r)]
    text = dxf_text(list(dxf_entities(plate)) + [circle])
    if dice.chance(0.5):
        return Part(["part.dxf"], plate, {"part.dxf": text})
    hole = Chain([(0, TAU * r, -TAU)], at + r, -math.pi / 2)
    hole.theta = lambda s: -math.pi / 2 - s / r
    return Part(["part.dxf", "--loop", "2"], hole, {"part.dxf": text})


def drawn_ellipse(dice):
    a, b = round(dice.uniform(2, 3), 3), round(dice.uniform(0.8, 1.9), 3)
    course = Curve(lambda u: (a * cmath.cos(u), b * cmath.sin(u)), 0, TAU, True)
    form = dice.whole(0, 2)
    if form == 0:
        ends = [(10, 0.0), (20, 0.0), (11, a), (21, 0.0), (40, b / a), (41, 0.0), (42, TAU)]
        return Part(["part.dxf"], course, {"part.dxf": dxf_text([[(0, "ELLIPSE"), (8, "0")] + ends])})
    if form == 1:
        curve = {"type": "ellipse", "centre": [0, 0], "major": [a, 0], "minor": [0, b]}
        return Part(["part.json"], course, {"part.json": json.dumps({"curves": [curve]}, indent=1)})
    text = f'<svg xmlns="http://www.w3.org/2000/svg"><ellipse cx="3" cy="-2" rx="{a}" ry="{b}"/></svg>'
    return Part(["part.svg"], course, {"part.svg": text}, True)


def bezier_blob(dice):
    pieces, course = blob(dice, dice.choice([1, 20]))
    if dice.chance(0.5):
        curves = [{"type": "bezier", "points": [[p.real, p.imag] for p in piece]} for piece in pieces]
        return Part(["part.json"], course, {"part.json": json.dumps({"curves": curves, "closed": True})})
    start = pieces[0][0]
    path = f"M {start.real} {-start.imag}" + "".join(
        " C " + " ".join(f"{p.real} {-p.imag}" for p in piece[1:]) for piece in pieces)
    return Part(["part.svg"], course, {"part.svg": svg_text([path + " Z"])})


def nurbs_circle(dice):
    """The circle of eight control points, and a B-spline that is not one."""
    r = dice.choice([1, 5])
    if dice.chance(0.5):
        ring = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
        curve = {"type": "nurbs", "degree": 2, "knots": [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4],
                 "points": [[r * x, r * y] for x, y in ring], "weights": [1, math.sqrt(0.5)] * 4 + [1]}
        return Part(["part.json"], Chain([(0, TAU * r, TAU)], complex(r), math.pi / 2),
                    {"part.json": json.dumps({"curves": [curve]})})
    points = [[r * round(dice.uniform(0.7, 1.3) * f(TAU * i / 7), 3) for f in (math.cos, math.sin)] for i in range(7)]
    knots = [0] * 4 + [1, 2, 3, 4] + [5] * 4
    curve = {"type": "nurbs", "degree": 3, "knots": knots, "points": points + points[:1]}
    return Part(["part.json"], None, {"part.json": json.dumps({"curves": [curve]})}, length=5 * r)


STORED = [("fuzz/corpus/json/arcs.json", [], 10.4), ("fuzz/corpus/json/gallery.json", [], 9.7),
          ("fuzz/corpus/json/lines.json", [], 3.4), ("fuzz/corpus/json/splines.json", [], 13.7),
          ("fuzz/corpus/dxf/fits.dxf", [], 6.65), ("fuzz/corpus/dxf/insert.dxf", [], 7.9),
          ("fuzz/corpus/dxf/insert_binary.dxf", ["--loop", "3"], 7.9), ("fuzz/corpus/dxf/light.dxf", [], 10.4),
          ("fuzz/corpus/dxf/light_binary.dxf", [], 10.4), ("fuzz/corpus/dxf/polyline.dxf", [], 10.4),
          ("fuzz/corpus/dxf/ellipse.dxf", ["--open"], 8.8), ("fuzz/corpus/dxf/spline.dxf", ["--open"], 5.1),
          ("fuzz/corpus/svg/page.svg", [], 411.9), ("fuzz/corpus/svg/inkscape_layers.svg", [], 152.9),
          ("tests/dxf/librecad.dxf", ["--loop", "2"], 10), ("tests/dxf/librecad.dxf", [], 12.6),
          ("tests/svg/inkscape.svg", [], 210.7), ("tests/svg/inkscape.svg", ["--loop", "2"], 200),
          ("tests/svg/inkscape_plain.svg", ["--loop", "4"], 100), ("tests/svg/source_layers.svg", [], 152.9),
          ("tests/svg/source.svg", [], 186.3), ("tests/svg/source.svg", ["--loop", "3"], 90),
          ("fuzz/corpus/points/ellipse_scan", ["--smooth", "0.05"], 9.7),
          ("fuzz/corpus/points/square_scan", ["--smooth", "0.05"], 4), ("fuzz/corpus/points/selig", [], 2.04)]


def stored_part(dice):
    """A drawing that other programs wrote, or one of the fuzzers' seeds."""
    path, words, length = dice.choice(STORED)
    name = Path(path).name
    name = name if "." in name else name + ".csv"
    return Part([name] + words, None, {name: (SOURCE / path).read_bytes()}, length=length)


DRAWINGS = (machined_part, machined_part, machined_part, plate_with_hole, drawn_ellipse, bezier_blob, nurbs_circle,
            stored_part, stored_part)


def drawn_part(dice, kinds=DRAWINGS):
    return dice.choice(kinds)(dice)


def any_part(dice, known=False):
    """Mostly the gallery; `known`: one whose boundary is known in closed form."""
    while True:
        part = dice.choice([gallery_part, gallery_part, points_part, drawn_part])(dice)
        if part.course or not known:
            return part
