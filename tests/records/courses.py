"""Boundaries in closed form: arc length, tangent angle and point of the shapes that problems are made of, and what a
finger would feel that rolls along them. Nothing here asks the program: what it is asked must not change with it."""

import bisect
import cmath
import math

TAU = 2 * math.pi


class Dice:
    """A generator of its own (splitmix64), so that the problems are the same with every version of Python."""

    def __init__(self, name):
        self.state = 0xCBF29CE484222325
        for byte in name.encode():
            self.state = (self.state ^ byte) * 0x100000001B3 % 2**64

    def bits(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) % 2**64
        z = self.state
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
        return z ^ z >> 31

    def uniform(self, lo=0.0, hi=1.0):
        return lo + (hi - lo) * (self.bits() >> 11) / 2**53

    def whole(self, lo, hi):
        return lo + self.bits() % (hi - lo + 1)

    def chance(self, p):
        return self.uniform() < p

    def choice(self, items):
        return items[self.bits() % len(items)]

    def normal(self):
        return math.sqrt(-2 * math.log(1 - self.uniform())) * math.cos(TAU * self.uniform())

    def sign(self):
        return 1 if self.bits() & 1 else -1


GAUSS = ((0.5, 64 / 225),) + tuple((0.5 + side * x, w) for x, w in (
    (0.2692346550528415, 0.2393143352496832), (0.4530899229693320, 0.1184634425280945)) for side in (-1, 1))


class Curve:
    """A curve f(u), u0 <= u <= u1, f taking complex u: derivatives are complex steps, lengths Gauss's rule."""

    def __init__(self, f, u0, u1, closed, nodes=96):
        self.f, self.closed = f, closed
        self.u = [u0 + (u1 - u0) * i / nodes for i in range(nodes + 1)]
        self.s, self.angle = [0.0], [cmath.phase(self.velocity(u0))]
        for a, b in zip(self.u, self.u[1:]):
            self.s.append(self.s[-1] + self.between(a, b))
            self.angle.append(near(cmath.phase(self.velocity(b)), self.angle[-1]))
        self.length = self.s[-1]
        slopes = [(b - a) / (t - s) for a, b, s, t in zip(self.angle, self.angle[1:], self.s, self.s[1:])]
        self.least_curvature = min(slopes)

    def velocity(self, u):
        x, y = self.f(complex(u, 1e-30))
        return complex(x.imag, y.imag) * 1e30

    def between(self, a, b):
        return (b - a) * sum(w * abs(self.velocity(a + (b - a) * x)) for x, w in GAUSS)

    def parameter(self, s):
        i = min(max(bisect.bisect_right(self.s, s) - 1, 0), len(self.s) - 2)
        lo, hi = self.u[i], self.u[i + 1]
        u = lo + (hi - lo) * (s - self.s[i]) / (self.s[i + 1] - self.s[i])
        for _ in range(4):
            step = (s - self.s[i] - self.between(lo, u)) / max(abs(self.velocity(u)), 1e-9)
            u = min(max(u + step, lo), hi)
            if abs(step) < 1e-12:
                break
        return u, i

    def theta(self, s):
        laps = math.floor(s / self.length) if self.closed else 0
        u, i = self.parameter(s - laps * self.length)
        return near(cmath.phase(self.velocity(u)), self.angle[i]) + TAU * laps

    def point(self, s):
        u, _ = self.parameter(s % self.length if self.closed else s)
        x, y = self.f(complex(u))
        return complex(x.real, y.real)


class Chain:
    """Lines and arcs: pieces (turn of the corner before it, length, sweep), closed, from a point in a direction."""

    def __init__(self, pieces, start, direction, closed=True):
        self.pieces, self.closed = pieces, closed
        self.s, self.start = [0.0], [(start, direction)]
        for i, (turn, length, sweep) in enumerate(pieces):
            point, angle = self.start[-1]
            angle += turn if i else 0
            self.start[-1] = (point, angle)
            self.start.append((point + along(length, sweep) * cmath.rect(1, angle), angle + sweep))
            self.s.append(self.s[-1] + length)
        self.length = self.s[-1]
        self.least_curvature = min(sweep / length for _, length, sweep in pieces)
        self.has_corners = any(abs(turn) > 1e-9 for turn, _, _ in pieces)

    def locate(self, s):
        laps = math.floor(s / self.length) if self.closed else 0
        s -= laps * self.length
        i = min(max(bisect.bisect_right(self.s, s) - 1, 0), len(self.pieces) - 1)
        return laps, i, s - self.s[i]

    def theta(self, s):
        laps, i, rest = self.locate(s)
        _, length, sweep = self.pieces[i]
        return self.start[i][1] + sweep * rest / length + TAU * laps

    def point(self, s):
        _, i, rest = self.locate(s)
        _, length, sweep = self.pieces[i]
        return self.start[i][0] + along(rest, sweep * rest / length) * cmath.rect(1, self.start[i][1])


def near(angle, other):
    return angle - TAU * round((angle - other) / TAU)


def along(length, sweep):
    """The chord of an arc that starts at the origin along x."""
    return length * cmath.rect(math.sin(sweep / 2) / (sweep / 2) if sweep else 1, sweep / 2)


def polar(radius, nodes=96):
    return Curve(lambda u: (radius(u) * cmath.cos(u), radius(u) * cmath.sin(u)), 0, TAU, True, nodes)


def filleted(vertices, radii):
    """A polygon, counter-clockwise, each corner rounded by its radius (0: left sharp). s = 0 on the first side."""
    n = len(vertices)
    sides = [vertices[(i + 1) % n] - vertices[i] for i in range(n)]
    turns = [cmath.phase(sides[i] / sides[i - 1]) for i in range(n)]
    cut = [abs(r * math.tan(turn / 2)) for r, turn in zip(radii, turns)]
    pieces = []
    for i in range(n):
        if not radii[i]:
            pieces.append((turns[i], abs(sides[i]) - cut[i] - cut[(i + 1) % n], 0.0))
        else:
            pieces.append((0.0, abs(sides[i]) - cut[i] - cut[(i + 1) % n], 0.0))
        j = (i + 1) % n
        if radii[j]:
            pieces.append((0.0, radii[j] * abs(turns[j]), turns[j]))
    direction = cmath.phase(sides[0])
    return Chain(pieces, vertices[0] + cut[0] * cmath.rect(1, direction), direction)


def star(dice, size):
    """A smooth random closed curve around the origin."""
    waves = [(k, dice.uniform(-0.25, 0.25) / k, dice.uniform(0, TAU)) for k in range(1, 5)]
    squeeze = dice.uniform(0.5, 1)

    def f(u):
        r = size * (1 + sum(a * cmath.cos(k * u + p) for k, a, p in waves))
        return r * cmath.cos(u), squeeze * r * cmath.sin(u)

    return Curve(f, 0, TAU, True)


def wavy(dice, size):
    """A smooth random open curve from left to right."""
    waves = [(k, dice.uniform(-0.3, 0.3) / k, dice.uniform(0, TAU)) for k in range(1, 4)]
    return Curve(lambda u: (size * u, size * sum(a * cmath.sin(k * u + p) for k, a, p in waves)), 0, 5, False)


def airfoil(thickness, chord=1.0):
    """A symmetric 4-digit section with its closed trailing edge, from there over the top."""

    def f(u):
        x = (1 + cmath.cos(u)) / 2
        rest = x * (0.126 + x * (0.3516 - x * (0.2843 - 0.1036 * x)))
        side = 1 if u.real < math.pi else -1
        return chord * x, 5 * thickness * chord * (0.2969 * cmath.cos(u / 2) - side * rest)

    return Curve(f, 1e-4, TAU - 1e-4, True)


def blob(dice, size):
    """Cubic Bezier curves through random points, smooth in tangent only: control points and the curve itself."""
    n = dice.whole(3, 6)
    at = [cmath.rect(size * dice.uniform(0.7, 1.3), TAU * i / n) for i in range(n)]
    at = [complex(round(p.real, 3), round(p.imag, 3)) for p in at]
    handle = [(at[(i + 1) % n] - at[i - 1]) / 6 for i in range(n)]
    handle = [complex(round(p.real, 3), round(p.imag, 3)) for p in handle]
    pieces = []
    for i in range(n):
        j = (i + 1) % n
        pieces.append((at[i], at[i] + handle[i], at[j] - handle[j], at[j]))

    def f(u):
        i = min(int(u.real), n - 1)
        w = u - i
        weights = ((1 - w) ** 3, 3 * w * (1 - w) ** 2, 3 * w * w * (1 - w), w**3)
        terms = list(zip(weights, pieces[i]))
        return sum(q * p.real for q, p in terms), sum(q * p.imag for q, p in terms)

    return pieces, Curve(f, 0, n, True, 24 * n)


GALLERY = ("circle", "ellipse", "superellipse", "limacon", "cam", "gear", "naca", "reuleaux", "stadium",
           "rounded-rectangle", "polygon", "log-spiral", "exponential", "spline")


def gallery(name, dice):
    """A gallery shape with random parameters: its name on the command line, and its boundary (None: a spline's)."""

    def draw(lo, hi, digits=2):
        return round(dice.uniform(lo, hi), digits)

    if name == "circle":
        r = draw(0.3, 3)
        return f"gallery:circle,r={r}", Chain([(0, TAU * r, TAU)], complex(r), math.pi / 2)
    if name == "ellipse":
        a, b = draw(0.5, 3), draw(0.5, 3)
        return f"gallery:ellipse,a={a},b={b}", Curve(lambda u: (a * cmath.cos(u), b * cmath.sin(u)), 0, TAU, True)
    if name == "superellipse":
        a, b, n = draw(0.5, 2), draw(0.5, 2), dice.choice([3, 4, 5, 3.5])
        power = lambda x: (x**2) ** (n / 2)
        shape = polar(lambda u: (power(cmath.cos(u) / a) + power(cmath.sin(u) / b)) ** (-1 / n))
        return f"gallery:superellipse,a={a},b={b},n={n}", shape
    if name == "limacon":
        a, b = draw(1.2, 2.5), draw(0.2, 1.1)
        return f"gallery:limacon,a={a},b={b}", polar(lambda u: a + b * cmath.cos(u))
    if name == "cam":
        base, lift = draw(0.5, 2), draw(0.1, 0.6)
        return f"gallery:cam,base={base},lift={lift}", polar(lambda u: base + lift * ((1 + cmath.cos(u)) / 2) ** 2)
    if name == "gear":
        teeth, r, depth = dice.whole(2, 9), draw(0.8, 2), draw(0.02, 0.08)
        shape = polar(lambda u: r + depth * cmath.cos(teeth * u), 24 * teeth)
        return f"gallery:gear,teeth={teeth},r={r},depth={depth}", shape
    if name == "naca":
        digits, chord = dice.choice(["0008", "0012", "0018", "0024"]), draw(0.5, 10)
        return f"gallery:naca,digits={digits},chord={chord}", airfoil(int(digits) / 100, chord)
    if name == "reuleaux":
        width = draw(0.5, 3)
        pieces = [(math.pi / 3, width * math.pi / 3, math.pi / 3)] * 3
        return f"gallery:reuleaux,width={width}", Chain(pieces, complex(width / math.sqrt(3)), math.pi * 2 / 3)
    if name == "stadium":
        side, r = draw(0.5, 3), draw(0.3, 1.5)
        pieces = [(0, side, 0.0), (0, math.pi * r, math.pi)] * 2
        return f"gallery:stadium,length={side},r={r}", Chain(pieces, complex(-side / 2, -r), 0.0)
    if name == "rounded-rectangle":
        w, h, r = draw(1.5, 4), draw(1.5, 4), draw(0.1, 0.7)
        corners = [complex(x * w / 2, y * h / 2) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        return f"gallery:rounded-rectangle,width={w},height={h},r={r}", filleted(corners, [r] * 4)
    if name == "polygon":
        n, r = dice.whole(3, 9), draw(0.5, 2)
        return f"gallery:polygon,n={n},r={r}", filleted([cmath.rect(r, TAU * i / n) for i in range(n)], [0] * n)
    if name == "log-spiral":
        a, b, turns = draw(0.5, 2), draw(0.05, 0.3), draw(0.5, 2.5)
        f = lambda u: (a * cmath.exp(b * u) * cmath.cos(u), a * cmath.exp(b * u) * cmath.sin(u))
        return f"gallery:log-spiral,a={a},b={b},turns={turns}", Curve(f, 0, TAU * turns, False)
    if name == "exponential":
        low, high, scale = draw(-4, -1), draw(0.5, 2.5), draw(0.5, 2)
        f = lambda u: (scale * u, scale * cmath.exp(u))
        return f"gallery:exponential,from={low},to={high},scale={scale}", Curve(f, low, high, False)
    assert name == "spline"
    n, seed, wobble = dice.whole(5, 12), dice.whole(0, 999), draw(0.05, 0.3)
    return f"gallery:spline,n={n},seed={seed},wobble={wobble}", None


class Disk:
    def __init__(self, r):
        self.r = r

    def contact(self, distance, first):
        """u, the normal's direction and the contact's place in the finger's frame, after `distance` on the part."""
        u = first - distance / self.r
        return u, u, cmath.rect(self.r, u)


class Jaw:
    def contact(self, distance, first):
        return first - distance, -math.pi / 2, complex(first - distance)


class Shaped:
    """A convex outline as a finger."""

    def __init__(self, course):
        self.course = course

    def contact(self, distance, first):
        u = first - distance
        return u, self.course.theta(u) - math.pi / 2, self.course.point(u)


class Rolled:
    """One finger's rows, u, psi, x, y, length and turn, of a roll from s over a length, on a part with poses."""

    def __init__(self, course, finger, s, length, rows, first=0.3, poses=None):
        self.u, self.psi, self.x, self.y, self.length, self.turn = [], [], [], [], [], []
        for i in range(rows):
            distance = length * i / max(rows - 1, 1)
            at, heading = poses(i / max(rows - 1, 1)) if poses else (0j, 0.0)
            theta = course.theta(s + distance)
            u, normal, place = finger.contact(distance, first)
            psi = heading + theta + math.pi / 2 - normal
            centre = at + cmath.rect(1, heading) * course.point(s + distance) - cmath.rect(1, psi) * place
            for column, value in ((self.u, u), (self.psi, psi), (self.x, centre.real), (self.y, centre.imag),
                                  (self.length, distance), (self.turn, theta - course.theta(s))):
                column.append(value)

    def disturb(self, dice, contact, angle, slip, per_length=1.0):
        """Errors of the sensors. `per_length`: u per length, 1/r of a disk."""
        factor = 1 + slip * dice.normal()
        self.u = [self.u[0] + (u - self.u[0]) / factor + contact * per_length * dice.normal() for u in self.u]
        self.psi = [psi + angle * dice.normal() for psi in self.psi]
        self.length = [length / factor + contact * dice.normal() for length in self.length]
        self.turn = [turn + angle * dice.normal() for turn in self.turn]
