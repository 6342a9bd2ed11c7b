"""The perimeter and the area of each path in an SVG file, by svgelements and mpmath: what the tests expect.
Not for arcs under a skew: svgelements keeps them round.

usage: figures.py FILE.svg...   (Debian: python3-svgelements python3-mpmath)
"""
import sys

from mpmath import cos, hypot, mp, mpf, pi, quad, sin
from svgelements import SVG, Arc, Close, CubicBezier, Length, Line, Path, QuadraticBezier, Shape

mp.dps = 30
MILLIMETRE = mpf(Length("1mm").value(ppi=96))  # svgelements counts pixels, of a rounded size


def point(p):
    return mpf(p.x), mpf(p.y)


def derivative_and_place(segment):
    """The segment as functions of t in [0, 1] that give (x, y) and (x', y')."""
    if isinstance(segment, Arc):
        cx, cy = point(segment.center)
        rx, ry = mpf(segment.rx), mpf(segment.ry)
        turn, start, sweep = (mpf(a) for a in (segment.get_rotation(), segment.get_start_t(), segment.sweep))
        c, s = cos(turn), sin(turn)

        def place(t):
            u, v = rx * cos(start + t * sweep), ry * sin(start + t * sweep)
            return cx + c * u - s * v, cy + s * u + c * v

        def slope(t):
            u, v = -rx * sweep * sin(start + t * sweep), ry * sweep * cos(start + t * sweep)
            return c * u - s * v, s * u + c * v

        return place, slope
    if isinstance(segment, CubicBezier):
        controls = [point(p) for p in (segment.start, segment.control1, segment.control2, segment.end)]
    elif isinstance(segment, QuadraticBezier):
        controls = [point(p) for p in (segment.start, segment.control, segment.end)]
    else:
        controls = [point(p) for p in (segment.start, segment.end)]

    def casteljau(row, t):
        while len(row) > 1:
            row = [((1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1]) for a, b in zip(row, row[1:])]
        return row[0]

    n = len(controls) - 1
    steps = [(n * (b[0] - a[0]), n * (b[1] - a[1])) for a, b in zip(controls, controls[1:])]
    return (lambda t: casteljau(controls, t)), (lambda t: casteljau(steps, t))


def figures(path):
    length = area = mpf(0)
    for segment in path:
        if not isinstance(segment, (Line, Close, CubicBezier, QuadraticBezier, Arc)) or segment.start == segment.end:
            continue
        place, slope = derivative_and_place(segment)
        parts = [mpf(k) / 8 for k in range(9)]
        length += quad(lambda t: hypot(*slope(t)), parts)
        area += quad(lambda t: (place(t)[0] * slope(t)[1] - place(t)[1] * slope(t)[0]) / 2, parts)
    return length, abs(area)


for name in sys.argv[1:]:
    unit = MILLIMETRE
    print(name)
    for element in SVG.parse(name, reify=True, ppi=96).elements():
        if not isinstance(element, Shape) or element.values.get("visibility") == "hidden":
            continue
        path = Path(element).reify()
        length, area = figures(path)
        print(f"  {element.id or '?':10} perimeter {mp.nstr(length / unit, 17)} mm, area {mp.nstr(area / unit**2, 17)} mm^2")
