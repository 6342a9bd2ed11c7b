"""Outlines whose turning function is computed here, from their formulas, and not by the library.

An outline is a chain of short cells. On each the tangent's angle is a cubic in arc length (Hermite: the angle and the
curvature at both ends), on lines and arcs exactly a straight line, and so are x and y with the tangents at both ends.
A corner is a jump of the angle between two cells.
"""

import json
import math

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(10)
CELLS = 12000  # of a smooth outline: h^4/384 of the angle's fourth derivative is below 1e-9 rad on all that are used
ARC_CELL = 0.004  # radians: x and y are then good to 1e-12 of the arc's radius
CORNER = 0.95  # radians: chords of a file of points that turn more, by 59 degrees, would be a corner
SHARP = 1e-7  # radians: less is rounding and no corner


class Outline:
    """Arrays over the cells: s, length, angle and curvature and point at both ends, all along the outline."""

    def __init__(self, name, part, s, angle, curvature, point, symmetry=1, text=None):
        self.name, self.part, self.symmetry, self.text = name, part, symmetry, text
        self.s = np.asarray(s)  # n + 1 ends of cells
        self.angle = np.asarray(angle)  # n x 2: where the cell begins and where it ends, unwrapped
        self.curvature = np.asarray(curvature)  # n x 2
        self.point = np.asarray(point)  # n + 1 points
        self.perimeter = float(self.s[-1])
        self.turning = 2 * math.pi * round((self.angle[-1, 1] - self.angle[0, 0]) / (2 * math.pi) + 1e-9)
        self.turning = self.turning or 2 * math.pi
        following = np.append(self.angle[1:, 0], self.angle[0, 0] + self.turning)
        self.jump = following - self.angle[:, 1]  # the corner at each cell's end
        self.jump[np.abs(self.jump) < SHARP] = 0
        if np.any(self.jump < 0):
            raise ValueError(name + ": a concave corner, where no finger gets")

    def largest_disk(self):
        """By the curvature: what may still roll in the deepest concavity."""
        least = float(self.curvature.min())
        return math.inf if least >= 0 else -1 / least

    def is_corner(self, s):
        ends = self.s[1:][self.jump > 0]
        off = np.abs(ends - s)
        return bool(np.any(np.minimum(off, self.perimeter - off) <= 1e-12 * self.perimeter))

    def write(self, folder):
        """The program's name for the part; a file is written where it is no gallery shape."""
        if self.text is None:
            return self.part
        path = folder / self.part
        if not path.exists():
            path.write_text(self.text)
        return str(path)


class Course:
    """The way along an outline by what a finger's centre travels at corners: each has the width r dTheta."""

    def __init__(self, outline, radius):
        self.outline = outline
        corner = outline.jump > 0
        width = np.diff(outline.s)
        count = len(width)
        at = np.arange(count) + np.concatenate(([0], np.cumsum(corner[:-1])))  # where each cell goes
        total = count + int(corner.sum())
        widths = np.zeros(total)
        self.cell = np.zeros(total, dtype=np.int64)
        self.pivot = np.zeros(total, dtype=bool)
        widths[at] = width
        self.cell[at] = np.arange(count)
        widths[at[corner] + 1] = radius * outline.jump[corner]
        self.cell[at[corner] + 1] = np.flatnonzero(corner)
        self.pivot[at[corner] + 1] = True
        self.e = np.concatenate(([0], np.cumsum(widths)))
        self.total = float(self.e[-1])

    def at(self, e, points=False):
        """s and the tangent's angle, both unwrapped, and on demand x and y."""
        o = self.outline
        lap = np.floor(e / self.total)
        rest = e - lap * self.total
        place = np.clip(np.searchsorted(self.e, rest, side="right") - 1, 0, len(self.cell) - 1)
        cell, pivot = self.cell[place], self.pivot[place]
        begin, width = self.e[place], self.e[place + 1] - self.e[place]
        t = np.clip((rest - begin) / np.where(width > 0, width, 1), 0, 1)
        h = o.s[cell + 1] - o.s[cell]
        s = np.where(pivot, o.s[cell + 1], o.s[cell] + t * h)
        smooth = hermite(t, h, o.angle[cell, 0], o.angle[cell, 1], o.curvature[cell, 0], o.curvature[cell, 1])
        angle = np.where(pivot, o.angle[cell, 1] + t * o.jump[cell], smooth)
        s, angle = s + lap * o.perimeter, angle + lap * o.turning
        if not points:
            return s, angle
        t = np.where(pivot, 1.0, t)
        xy = [hermite(t, h, o.point[cell, k], o.point[cell + 1, k], f(o.angle[cell, 0]), f(o.angle[cell, 1]))
              for k, f in ((0, np.cos), (1, np.sin))]
        return s, angle, xy[0], xy[1]


def hermite(t, h, f0, f1, d0, d1):
    f = f1 - f0
    return f0 + t * (h * d0 + t * ((3 * f - h * (2 * d0 + d1)) + t * (h * (d0 + d1) - 2 * f)))


def smooth_outline(name, part, formula, breaks, symmetry=1, text=None):
    """formula(u): point, first and second derivative, each 2 x n. breaks: ends of what is analytic in between."""
    breaks = np.asarray(breaks)
    each = max(4, math.ceil(CELLS / (len(breaks) - 1)))
    u = np.concatenate([np.linspace(a, b, each, endpoint=False) for a, b in zip(breaks, breaks[1:])] + [breaks[-1:]])
    half = np.diff(u) / 2
    inner = (u[:-1, None] + half[:, None] * (1 + NODES)).ravel()
    speed = np.hypot(*formula(inner)[1]).reshape(-1, len(NODES))
    s = np.concatenate(([0], np.cumsum(half * (speed @ WEIGHTS))))
    point, first, second = formula(u)
    angle = np.unwrap(np.arctan2(first[1], first[0]))
    curvature = (first[0] * second[1] - first[1] * second[0]) / np.hypot(*first) ** 3
    pairs = lambda values: np.stack((values[:-1], values[1:]), axis=1)
    return Outline(name, part, s, pairs(angle), pairs(curvature), point.T, symmetry, text)


def polar(radius):
    """radius(u): r, r', r''."""

    def formula(u):
        r, r1, r2 = radius(u)
        c, s = np.cos(u), np.sin(u)
        return (np.stack((r * c, r * s)), np.stack((r1 * c - r * s, r1 * s + r * c)),
                np.stack(((r2 - r) * c - 2 * r1 * s, (r2 - r) * s + 2 * r1 * c)))

    return formula


def cam(base=1.0, lift=0.5):
    def radius(u):
        w = (1 + np.cos(u)) / 2
        w1, w2 = -np.sin(u) / 2, -np.cos(u) / 2
        return base + lift * w * w, 2 * lift * w * w1, 2 * lift * (w1 * w1 + w * w2)

    return smooth_outline("cam", f"gallery:cam,base={base},lift={lift}", polar(radius), np.linspace(0, 2 * np.pi, 9))


def limacon(a=1.5, b=1.0):
    return smooth_outline("limacon", f"gallery:limacon,a={a},b={b}",
                          polar(lambda u: (a + b * np.cos(u), -b * np.sin(u), -b * np.cos(u))),
                          np.linspace(0, 2 * np.pi, 9))


def gear(teeth=7, depth=0.06):
    return smooth_outline(f"gear{teeth}", f"gallery:gear,teeth={teeth},r=1,depth={depth}",
                          polar(lambda u: (1 + depth * np.cos(teeth * u), -depth * teeth * np.sin(teeth * u),
                                           -depth * teeth**2 * np.cos(teeth * u))),
                          np.linspace(0, 2 * np.pi, 9), symmetry=teeth)


def ellipse(a=2.0, b=1.0):
    return smooth_outline("ellipse", f"gallery:ellipse,a={a},b={b}",
                          lambda u: (np.stack((a * np.cos(u), b * np.sin(u))),
                                     np.stack((-a * np.sin(u), b * np.cos(u))),
                                     np.stack((-a * np.cos(u), -b * np.sin(u)))),
                          np.linspace(0, 2 * np.pi, 9), symmetry=2)


def spline(seed, points, wobble):
    """A file of points; through them the periodic cubic spline in cumulative chord length."""
    for attempt in range(100000):
        random = np.random.default_rng([11, seed, attempt])
        around = 2 * np.pi * (np.arange(points) + random.uniform(-0.2, 0.2, points)) / points
        r = 1 + wobble * random.uniform(-1, 1, points)
        xy = np.stack((r * np.cos(around), r * np.sin(around)))
        chord = np.diff(np.concatenate((xy, xy[:, :2]), axis=1))
        turn = np.angle(np.exp(1j * np.diff(np.arctan2(chord[1], chord[0]))))
        if np.abs(turn).max() < CORNER:
            break
    else:
        raise ValueError("no outline without corners")
    text = "".join(f"{x!r} {y!r}\n" for x, y in xy.T.tolist())
    xy = np.concatenate((xy, xy[:, :1]), axis=1)
    knots = np.concatenate(([0], np.cumsum(np.hypot(*np.diff(xy)))))
    formula = periodic_cubic(knots, xy)
    return smooth_outline(f"spline{seed}", f"spline{seed}.csv", formula, knots, text=text)


def periodic_cubic(knots, xy):
    """The periodic cubic spline through xy (2 x n + 1, the last as the first), by its second derivatives at the knots."""
    h = np.diff(knots)
    count = len(h)
    system = np.zeros((count, count))
    right = np.zeros((count, 2))
    slope = (np.diff(xy) / h).T
    for k in range(count):
        system[k, k - 1] += h[k - 1]
        system[k, k] += 2 * (h[k - 1] + h[k])
        system[k, (k + 1) % count] += h[k]
        right[k] = 6 * (slope[k] - slope[k - 1])
    bend = np.linalg.solve(system, right)
    bend = np.concatenate((bend, bend[:1]))

    def formula(u):
        k = np.clip(np.searchsorted(knots, u, side="right") - 1, 0, count - 1)
        a, b, width = (knots[k + 1] - u)[:, None], (u - knots[k])[:, None], h[k][:, None]
        m0, m1, p0, p1 = bend[k], bend[k + 1], xy.T[k], xy.T[k + 1]
        c0, c1 = p0 / width - m0 * width / 6, p1 / width - m1 * width / 6
        return ((m0 * a**3 + m1 * b**3) / (6 * width) + c0 * a + c1 * b).T, \
            ((m1 * b**2 - m0 * a**2) / (2 * width) + c1 - c0).T, ((m0 * a + m1 * b) / width).T

    return formula


def chain(name, curves, symmetry=1):
    """Lines (from, to) and arcs (centre, radius, from, sweep), counter-clockwise, in a JSON drawing."""
    s, angle, curvature, point, parts = [0.0], [], [], [], []
    last = None
    for curve in curves:
        if len(curve) == 2:
            (x0, y0), (x1, y1) = curve
            steps, length, bend, turn = 1, math.hypot(x1 - x0, y1 - y0), 0.0, 0.0
            first = math.atan2(y1 - y0, x1 - x0)
            points = [(x0, y0), (x1, y1)]
            parts.append({"type": "line", "from": [x0, y0], "to": [x1, y1]})
        else:
            centre, r, start, sweep = curve
            steps, length = max(1, math.ceil(abs(sweep) / ARC_CELL)), r * abs(sweep)
            first, bend, turn = start + math.copysign(math.pi / 2, sweep), math.copysign(1 / r, sweep), sweep
            points = [(centre[0] + r * math.cos(start + sweep * k / steps),
                       centre[1] + r * math.sin(start + sweep * k / steps)) for k in range(steps + 1)]
            parts.append({"type": "arc", "centre": list(centre), "radius": r, "from": start, "sweep": sweep})
        if last is not None:
            first = last + math.remainder(first - last, 2 * math.pi)
        for k in range(steps):
            s.append(s[-1] + length / steps)
            angle.append((first + turn * k / steps, first + turn * (k + 1) / steps))
            curvature.append((bend, bend))
        point.extend(points[:-1])
        last = first + turn
    point.append(point[0])
    return Outline(name, name + ".json", s, angle, curvature, point, symmetry,
                   json.dumps({"curves": parts, "closed": True}))


def filleted(name, vertices, radii, symmetry=1):
    """A polygon, counter-clockwise, whose corners are rounded with these radii; 0 leaves one sharp."""
    count = len(vertices)
    curves, before = [], None
    ends = []
    for k in range(count):
        here = np.array(vertices[k], dtype=float)
        back = here - np.array(vertices[k - 1], dtype=float)
        ahead = np.array(vertices[(k + 1) % count], dtype=float) - here
        back, ahead = back / np.hypot(*back), ahead / np.hypot(*ahead)
        turn = math.atan2(back[0] * ahead[1] - back[1] * ahead[0], back @ ahead)
        cut = radii[k] * math.tan(abs(turn) / 2)
        inside = math.copysign(1, turn) * np.array([-back[1], back[0]])
        centre = here - cut * back + radii[k] * inside
        ends.append((here - cut * back, here + cut * ahead, centre, turn, math.atan2(-inside[1], -inside[0])))
    for k in range(count):
        begin, end, centre, turn, start = ends[k]
        if radii[k] > 0:
            curves.append((tuple(centre.tolist()), float(radii[k]), start, turn))
        curves.append((tuple(end.tolist()), tuple(ends[(k + 1) % count][0].tolist())))
    return chain(name, curves, symmetry)


def random_polygon(seed, count):
    """Convex: vertices on an ellipse at uneven angles."""
    random = np.random.default_rng([12, seed])
    while True:
        around = 2 * np.pi * (np.arange(count) + random.uniform(-0.3, 0.3, count)) / count
        x, y = 1.3 * np.cos(around), np.sin(around)
        side = np.hypot(x - np.roll(x, 1), y - np.roll(y, 1))
        if side.min() > 0.35:
            return list(zip(x.tolist(), y.tolist())), random


def rounded(seed, count=5):
    vertices, random = random_polygon(seed, count)
    return filleted(f"rounded{seed}", vertices, random.uniform(0.08, 0.25, count).tolist())


def sharp(seed, count=5):
    vertices, _ = random_polygon(seed, count)
    return filleted(f"sharp{seed}", vertices, [0] * count)


def bracket():
    """As drawn for a workshop: straight sides, fillets of a few radii, an inner one, and three corners left sharp."""
    return filleted("bracket", [(0, 0), (6, 0), (6, 2), (2.6, 2.2), (2.4, 5), (0.6, 5), (0, 4.2)],
                    [0.5, 0.3, 0, 1.0, 0.4, 0, 0])


def plate():
    """Lines and arcs with bulges: no side is like another."""
    return filleted("plate", [(0, 0), (5, -0.4), (5.5, 1.2), (3.6, 1.7), (3.4, 3.1), (0.3, 3.4)],
                    [0.6, 0.3, 0.25, 0.9, 0.5, 0.35])


def hexagon():
    return filleted("hexagon", [(math.cos(k * math.pi / 3), math.sin(k * math.pi / 3)) for k in range(6)], [0] * 6, 6)


OUTLINES = {}


def _all():
    made = [cam(), limacon(), ellipse(), gear(), bracket(), plate(), hexagon()]
    made += [spline(1, 11, 0.15), spline(2, 15, 0.12), spline(3, 22, 0.08)]
    made += [rounded(1), rounded(2, 6), sharp(1), sharp(2, 6)]
    OUTLINES.update((outline.name, outline) for outline in made)


_all()

FAMILIES = {
    "splines": ["spline1", "spline2", "spline3"],
    "curves": ["cam", "limacon"],
    "smooth": ["spline1", "spline2", "spline3", "cam", "limacon"],
    "rounded": ["rounded1", "rounded2"],
    "sharp": ["sharp1", "sharp2"],
    "drawing": ["bracket", "plate"],
    "symmetric": ["ellipse", "gear7", "hexagon"],
    "all": ["spline1", "spline2", "spline3", "cam", "limacon", "rounded1", "rounded2", "bracket", "plate"],
    "corners": ["sharp1", "sharp2", "bracket"],
}
