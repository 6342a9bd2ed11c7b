#!/usr/bin/env python3
"""Writes DXF drawings with ezdxf, and drawings.json with the length and the area of each.

Usage: write_with_ezdxf.py FOLDER [SEED [RANDOM_DRAWINGS]]

Lengths and areas come from closed forms where there are any, else from Gauss-Legendre quadrature of the same shapes
here, which knows nothing of DXF. The area is half the integral of x dy - y dx over all curves, closed or not.
"""
import json
import math
import random
import sys
from pathlib import Path

import ezdxf
from ezdxf import math as ezmath
from ezdxf import units

FULL_TURN = 2 * math.pi


def gauss_legendre(n):
    """Nodes and weights on [-1, 1]: Newton on the Legendre polynomial."""
    rule = []
    for k in range(n):
        x = math.cos(math.pi * (k + 0.75) / (n + 0.5))
        for _ in range(100):
            p0, p1 = 1.0, x
            for j in range(2, n + 1):
                p0, p1 = p1, ((2 * j - 1) * x * p1 - (j - 1) * p0) / j
            slope = n * (x * p1 - p0) / (x * x - 1)
            step = p1 / slope
            x -= step
            if abs(step) < 1e-16:
                break
        rule.append((x, 2 / ((1 - x * x) * slope * slope)))
    return rule


RULE = gauss_legendre(16)


class Affine:
    """x' = a x + b y + e, y' = c x + d y + f."""

    def __init__(self, a=1.0, b=0.0, c=0.0, d=1.0, e=0.0, f=0.0):
        self.a, self.b, self.c, self.d, self.e, self.f = a, b, c, d, e, f

    def vector(self, x, y):
        return self.a * x + self.b * y, self.c * x + self.d * y

    def point(self, x, y):
        vx, vy = self.vector(x, y)
        return vx + self.e, vy + self.f

    def after(self, inner):
        a, c = self.vector(inner.a, inner.c)
        b, d = self.vector(inner.b, inner.d)
        e, f = self.point(inner.e, inner.f)
        return Affine(a, b, c, d, e, f)


def inserted(at, scale=(1, 1), degrees=0, base=(0, 0), mirrored=False):
    """Where an INSERT puts its block; mirrored: drawn with the extrusion (0, 0, -1)."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    sx, sy = scale
    turn = Affine(c * sx, -s * sy, s * sx, c * sy, at[0], at[1]).after(Affine(e=-base[0], f=-base[1]))
    return Affine(a=-1).after(turn) if mirrored else turn


class Piece:
    """A smooth curve: position and velocity as functions of u on [lo, hi]."""

    def __init__(self, position, velocity, lo, hi):
        self.position, self.velocity, self.lo, self.hi = position, velocity, lo, hi

    def measure(self, place):
        """Length and area, by halving until nothing changes: a spline may be close to a cusp."""
        def over(lo, hi):
            length = area = size = 0.0
            half = 0.5 * (hi - lo)
            for node, weight in RULE:
                u = lo + half * (1 + node)
                x, y = place.point(*self.position(u))
                vx, vy = place.vector(*self.velocity(u))
                length += abs(half) * weight * math.hypot(vx, vy)
                area += 0.5 * half * weight * (x * vy - y * vx)
                size += 0.5 * abs(half) * weight * (abs(x * vy) + abs(y * vx))
            return length, area, length + size

        def halved(lo, hi, whole, depth):
            middle = 0.5 * (lo + hi)
            left, right = over(lo, middle), over(middle, hi)
            both = left[0] + right[0], left[1] + right[1]
            if depth == 12 or abs(both[0] - whole[0]) + abs(both[1] - whole[1]) <= tolerance:
                return both
            left, right = halved(lo, middle, left, depth + 1), halved(middle, hi, right, depth + 1)
            return left[0] + right[0], left[1] + right[1]

        whole = over(self.lo, self.hi)
        tolerance = 1e-11 * whole[2]  # of a rule that is far better on the halves
        return halved(self.lo, self.hi, whole, 0)


def line(p, q):
    dx, dy = q[0] - p[0], q[1] - p[1]
    return Piece(lambda u: (p[0] + u * dx, p[1] + u * dy), lambda u: (dx, dy), 0, 1)


def ellipse(centre, major, ratio, start, end):
    ax, ay = major
    bx, by = -ratio * ay, ratio * ax
    return Piece(
        lambda u: (centre[0] + math.cos(u) * ax + math.sin(u) * bx, centre[1] + math.cos(u) * ay + math.sin(u) * by),
        lambda u: (math.cos(u) * bx - math.sin(u) * ax, math.cos(u) * by - math.sin(u) * ay),
        start, end)


def arc(centre, radius, start, end):
    """Degrees; counter-clockwise."""
    start, end = math.radians(start), math.radians(end)
    return ellipse(centre, (radius, 0), 1, start, end if end > start else end + FULL_TURN)


def bulged(p, q, bulge):
    """By the circle through p, q and the point a sagitta off the chord's middle."""
    if bulge == 0:
        return line(p, q)
    chord = math.dist(p, q)
    sagitta = bulge * chord / 2
    nx, ny = (q[1] - p[1]) / chord, (p[0] - q[0]) / chord  # to the right
    radius = (chord * chord / 4 + sagitta * sagitta) / (2 * abs(sagitta))
    off = sagitta - math.copysign(radius, bulge)
    centre = ((p[0] + q[0]) / 2 + off * nx, (p[1] + q[1]) / 2 + off * ny)
    start = math.atan2(p[1] - centre[1], p[0] - centre[0])
    return ellipse(centre, (radius, 0), 1, start, start + 4 * math.atan(bulge))


def bulged_loop(corners):
    return [bulged(p[:2], q[:2], p[2]) for p, q in zip(corners, corners[1:] + corners[:1])]


def spline(control_points, degree, knots=None, weights=None):
    """ezdxf's own evaluation, a piece for each span of the knots."""
    curve = ezmath.BSpline(control_points, degree + 1, knots, weights)
    knots = list(curve.knots())
    spans = sorted(set(knots[degree:len(control_points) + 1]))

    def position(u):
        return tuple(curve.derivative(u, 0)[0])[:2]

    def velocity(u):
        return tuple(curve.derivative(u, 1)[1])[:2]

    return [Piece(position, velocity, lo, hi) for lo, hi in zip(spans, spans[1:])]


def cubic_through(points, closed):
    """Natural or periodic cubic spline in chord length, by elimination on the full matrix of its second derivatives."""
    if closed:
        points = points + points[:1]
    n = len(points) - 1
    h = [math.dist(p, q) for p, q in zip(points, points[1:])]
    size = n if closed else n + 1

    def second(axis):
        rows = [[0.0] * (size + 1) for _ in range(size)]
        for i in range(size):
            if not closed and i in (0, n):
                rows[i][i] = 1.0
                continue
            h0, h1 = h[i - 1], h[i % n]
            rows[i][(i - 1) % size] += h0
            rows[i][i] += 2 * (h0 + h1)
            rows[i][(i + 1) % size] += h1
            before = points[i - 1 if i > 0 else n - 1][axis]
            rows[i][size] = 6 * ((points[i + 1][axis] - points[i][axis]) / h1 - (points[i][axis] - before) / h0)
        for i in range(size):
            pivot = max(range(i, size), key=lambda r: abs(rows[r][i]))
            rows[i], rows[pivot] = rows[pivot], rows[i]
            for r in range(size):
                if r != i:
                    factor = rows[r][i] / rows[i][i]
                    rows[r] = [x - factor * y for x, y in zip(rows[r], rows[i])]
        solution = [rows[i][size] / rows[i][i] for i in range(size)]
        return solution + solution[:1] if closed else solution

    mx, my = second(0), second(1)
    pieces = []
    for i in range(n):
        def at(u, axis, m, i=i):
            p, q, hh = points[i][axis], points[i + 1][axis], h[i]
            v = 1 - u
            return v * p + u * q + hh * hh / 6 * ((v**3 - v) * m[i] + (u**3 - u) * m[i + 1])

        def rate(u, axis, m, i=i):
            p, q, hh = points[i][axis], points[i + 1][axis], h[i]
            v = 1 - u
            return q - p + hh * hh / 6 * ((1 - 3 * v * v) * m[i] + (3 * u * u - 1) * m[i + 1])

        pieces.append(Piece(lambda u, at=at: (at(u, 0, mx), at(u, 1, my)),
                            lambda u, rate=rate: (rate(u, 0, mx), rate(u, 1, my)), 0, 1))
    return pieces


class Drawings:
    def __init__(self, folder):
        self.folder = Path(folder)
        self.manifest = []

    def save(self, doc, name, length, area, closed=False, unit="", binary=False):
        path = self.folder / f"{name}.dxf"
        if binary:
            doc.saveas(path, fmt="bin")
        else:
            doc.saveas(path)
        self.manifest.append({"file": path.name, "length": length, "area": area, "closed": closed, "unit": unit})

    def finish(self):
        (self.folder / "drawings.json").write_text(json.dumps(self.manifest))


def measured(pieces, place=None):
    place = place or Affine()
    parts = [piece.measure(place) for piece in pieces]
    return sum(p[0] for p in parts), sum(p[1] for p in parts)


def new(version="R2010", unit=units.MM):
    doc = ezdxf.new(version)
    doc.units = unit
    return doc


def add_stadium(layout, length=3.0, r=0.5, attribs=None):
    layout.add_line((0, -r), (length, -r), attribs)
    layout.add_arc((length, 0), r, -90, 90, dxfattribs=attribs)
    layout.add_line((length, r), (0, r), attribs)
    layout.add_arc((0, 0), r, 90, 270, dxfattribs=attribs)
    return [line((0, -r), (length, -r)), arc((length, 0), r, -90, 90), line((length, r), (0, r)), arc((0, 0), r, 90, 270)]


def rounded_rectangle(width, height, r):
    """Corners for a polyline with bulges."""
    b = math.tan(math.pi / 8)
    return [(r, 0, 0), (width - r, 0, b), (width, r, 0), (width, height - r, b),
            (width - r, height, 0), (r, height, b), (0, height - r, 0), (0, r, b)]


def rounded_length(width, height, r):
    return 2 * (width + height) - 8 * r + FULL_TURN * r


def rounded_area(width, height, r):
    return width * height - (4 - math.pi) * r * r


CIRCLE_POINTS = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
CIRCLE_WEIGHTS = [1, math.sqrt(0.5)] * 4 + [1]
CIRCLE_KNOTS = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
BLOB = [(2, 0), (1.5, 1.2), (0, 1), (-1.5, 1.4), (-2, 0), (-1, -1), (0, -1.3), (1.2, -1)]


def write_closed_forms(out):
    stadium = (2 * 3 + FULL_TURN * 0.5, 2 * 3 * 0.5 + math.pi * 0.25)
    rounded = (rounded_length(4, 3, 0.6), rounded_area(4, 3, 0.6))
    for version in ("R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018"):
        doc = new(version)
        add_stadium(doc.modelspace())
        unit = "" if version == "R12" else "mm"  # ezdxf writes no unit into R12
        out.save(doc, f"stadium_{version}", *stadium, True, unit)
        out.save(doc, f"stadium_{version}_binary", *stadium, True, unit, binary=True)

    for version in ("R12", "R2018"):
        doc = new(version, units.IN)
        add = doc.modelspace().add_polyline2d if version == "R12" else doc.modelspace().add_lwpolyline
        unit = "" if version == "R12" else "in"
        add(rounded_rectangle(4, 3, 0.6), format="xyb", close=True)
        out.save(doc, f"rounded_{version}", *rounded, True, unit)
        out.save(doc, f"rounded_{version}_binary", *rounded, True, unit, binary=True)

    doc = new(unit=units.CM)
    doc.modelspace().add_circle((5, -7), 2.5)
    out.save(doc, "circle", FULL_TURN * 2.5, math.pi * 6.25, True, "cm")

    doc = new(unit=units.M)
    doc.modelspace().add_ellipse((1, 2), (2, 1), 0.4)
    a = math.sqrt(5)
    out.save(doc, "ellipse", measured([ellipse((1, 2), (2, 1), 0.4, 0, FULL_TURN)])[0], math.pi * a * a * 0.4, True, "m")

    doc = new()
    doc.modelspace().add_rational_spline(CIRCLE_POINTS, CIRCLE_WEIGHTS, 2, CIRCLE_KNOTS)
    out.save(doc, "nurbs_circle", FULL_TURN, math.pi, True, "mm")

    doc = new()
    block = doc.blocks.new("STADIUM", base_point=(1, 0.25))
    add_stadium(block)
    middle = doc.blocks.new("MIDDLE")
    middle.add_blockref("STADIUM", (2, 1), {"rotation": 30, "xscale": 2, "yscale": 2})
    doc.modelspace().add_blockref("MIDDLE", (5, 5), {"rotation": -75, "xscale": -1.5, "yscale": 1.5})
    out.save(doc, "nested_mirrored", 3 * stadium[0], -9 * stadium[1], True, "mm")

    doc = new()
    add_stadium(doc.blocks.new("STADIUM"))
    doc.modelspace().add_blockref(
        "STADIUM", (-3, 4), {"column_count": 4, "row_count": 3, "column_spacing": 5, "row_spacing": 2, "rotation": 20})
    out.save(doc, "array", 12 * stadium[0], 12 * stadium[1], False, "mm")


def write_quadratures(out):
    doc = new()
    curve = doc.modelspace().add_spline()
    curve.set_closed([(x, y, 0) for x, y in BLOB], degree=3)
    wrapped = [tuple(p)[:2] for p in curve.control_points]
    out.save(doc, "closed_spline", *measured(spline(wrapped, 3, list(curve.knots))), True, "mm")
    out.save(doc, "closed_spline_binary", *measured(spline(wrapped, 3, list(curve.knots))), True, "mm", binary=True)

    doc = new()
    doc.modelspace().add_open_spline(BLOB, degree=4)
    out.save(doc, "open_spline", *measured(spline(BLOB, 4)), False, "mm")

    doc = new()
    doc.modelspace().add_spline(BLOB)
    out.save(doc, "fit_points", *measured(cubic_through(BLOB, False)), False, "mm")
    doc = new()
    doc.modelspace().add_spline(BLOB).closed = True
    out.save(doc, "fit_points_closed", *measured(cubic_through(BLOB, True)), True, "mm")

    doc = new()
    add_pieces = add_stadium(doc.blocks.new("STADIUM"))
    doc.modelspace().add_blockref("STADIUM", (5, 5), {"rotation": 40, "xscale": 2, "yscale": 0.5})
    out.save(doc, "unequal_scale", *measured(add_pieces, inserted((5, 5), (2, 0.5), 40)), True, "mm")

    doc = new()
    below = {"extrusion": (0, 0, -1)}
    space = doc.modelspace()
    corners = [(1, 1, 0.3), (4, 1, -0.5), (3, 3, 0)]
    space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs=below)
    out.save(doc, "from_below", *measured(bulged_loop(corners), Affine(a=-1)), True, "mm")


def random_entities(rng, layout, old):
    """Adds a few entities; returns their pieces."""
    def point():
        return rng.uniform(-5, 5), rng.uniform(-5, 5)

    pieces = []
    for _ in range(rng.randint(1, 5)):
        kind = rng.choice(["line", "arc", "circle", "polyline"] + ([] if old else ["ellipse", "spline", "rational", "closed"]))
        below = rng.random() < 0.25
        attribs = {"extrusion": (0, 0, -1)} if below else {}
        own = []
        if kind == "line":
            p, q = point(), point()
            layout.add_line(p, q)
            pieces.append((line(p, q), Affine()))
        elif kind == "arc":
            c, r, start, end = point(), rng.uniform(0.1, 3), rng.uniform(-360, 360), rng.uniform(-360, 360)
            end = start + (end - start) % 360
            layout.add_arc(c, r, start, end, dxfattribs=attribs)
            own = [arc(c, r, start, end)]
        elif kind == "circle":
            c, r = point(), rng.uniform(0.1, 3)
            layout.add_circle(c, r, dxfattribs=attribs)
            own = [arc(c, r, 0, 360)]
        elif kind == "polyline":
            corners = [(*point(), rng.choice([0, rng.uniform(-2, 2)])) for _ in range(rng.randint(2, 6))]
            add = layout.add_polyline2d if old else layout.add_lwpolyline
            add(corners, format="xyb", close=True, dxfattribs=attribs)
            own = bulged_loop(corners)
        elif kind == "ellipse":
            c, major, ratio, start = point(), point(), rng.uniform(0.2, 1), rng.uniform(0, FULL_TURN)
            end = start + rng.uniform(0.1, FULL_TURN)
            layout.add_ellipse(c, major, ratio, start, end)
            pieces.append((ellipse(c, major, ratio, start, end), Affine()))
        else:
            degree = rng.randint(2, 5)
            controls = [point() for _ in range(degree + rng.randint(1, 5))]
            weights = [rng.uniform(0.5, 2) for _ in controls]
            if kind == "spline":
                layout.add_open_spline(controls, degree)
                found = spline(controls, degree)
            elif kind == "rational":
                entity = layout.add_rational_spline(controls, weights, degree)
                found = spline(controls, degree, list(entity.knots), weights)
            else:
                entity = layout.add_spline()
                entity.set_closed([(x, y, 0) for x, y in controls], degree=degree)
                found = spline([tuple(p)[:2] for p in entity.control_points], degree, list(entity.knots))
            pieces += [(piece, Affine()) for piece in found]
        pieces += [(piece, Affine(a=-1 if below else 1)) for piece in own]
    return pieces


def random_drawing(rng, out, number):
    old = rng.random() < 0.3
    doc = new("R12" if old else rng.choice(["R2000", "R2007", "R2010", "R2018"]))
    contents = []  # of each block: placed pieces
    blocks = [doc.blocks.new(f"B{k}", base_point=(rng.uniform(-1, 1), rng.uniform(-1, 1))) for k in range(rng.randint(0, 3))]
    for layout in blocks + [doc.modelspace()]:
        content = random_entities(rng, layout, old)
        for k, inner in enumerate(contents):
            if rng.random() < 0.6:
                at = rng.uniform(-9, 9), rng.uniform(-9, 9)
                degrees = rng.choice([0, 90, 180, rng.uniform(-400, 400)])
                equal = rng.uniform(0.3, 3)
                scale = rng.choice([(1, 1), (equal, equal), (-equal, equal), (rng.uniform(0.3, 3), -rng.uniform(0.3, 3))])
                columns, rows = rng.choice([(1, 1), (2, 3)])
                spacing = rng.uniform(-9, 9), rng.uniform(-9, 9)
                mirrored = rng.random() < 0.25
                attribs = {"xscale": scale[0], "yscale": scale[1], "rotation": degrees}
                if columns * rows > 1:
                    attribs.update(column_count=columns, row_count=rows, column_spacing=spacing[0], row_spacing=spacing[1])
                if mirrored:
                    attribs["extrusion"] = (0, 0, -1)
                layout.add_blockref(f"B{k}", at, attribs)
                c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
                base = tuple(blocks[k].base_point)[:2]
                for column in range(columns):
                    for row in range(rows):
                        dx, dy = column * spacing[0], row * spacing[1]
                        cell = at[0] + c * dx - s * dy, at[1] + s * dx + c * dy
                        place = inserted(cell, scale, degrees, base, mirrored)
                        content = content + [(piece, place.after(own)) for piece, own in inner]
        contents.append(content)
    parts = [piece.measure(place) for piece, place in contents[-1]]
    unit = "" if old else "mm"
    length, area = sum(p[0] for p in parts), sum(p[1] for p in parts)
    out.save(doc, f"random_{number}", length, area, False, unit)
    out.save(doc, f"random_{number}_binary", length, area, False, unit, binary=True)


def main():
    folder = sys.argv[1]
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 10
    out = Drawings(folder)
    write_closed_forms(out)
    write_quadratures(out)
    rng = random.Random(seed)
    for number in range(count):
        random_drawing(rng, out, number)
    out.finish()


if __name__ == "__main__":
    main()
