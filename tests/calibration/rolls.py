"""Rolls of one finger and of two, what their sensors read, and the logs as CSV.

Signs: s and L along the outline, counter-clockwise; u + psi = Theta + pi/2 + the part's heading; L = -r (u - u0).
"""

from dataclasses import dataclass

import numpy as np

from outlines import Course

PATCH = 0.01  # of the perimeter: slip here and there is one factor over such a stretch
PATCH_TIMES = 5  # times as large as the factor of the whole roll
DISK = 0.03  # of the perimeter: the finger's radius
FITS = 0.6  # of the largest disk that still rolls by the curvature


@dataclass
class Noise:
    """Standard deviations as --noise takes them; lengths in the outline's unit."""

    contact: float
    angle: float
    slip: float = 0.0
    position: float = 0.0
    gyro: float = 0.0

    def times(self, all_sds, slip=1.0):
        return Noise(self.contact * all_sds, self.angle * all_sds, self.slip * all_sds * slip, self.position * all_sds,
                     self.gyro * all_sds)

    def text(self):
        said = [f"contact={self.contact!r}", f"angle={self.angle!r}"]
        if self.slip > 0:
            said.append(f"slip={self.slip!r}")
        if self.position > 0:
            said.append(f"position={self.position!r}")
        if self.gyro > 0:
            said.append(f"gyro={self.gyro!r}")
        return ",".join(said)


def disk_on(outline):
    return min(DISK * outline.perimeter, FITS * outline.largest_disk())


def gyroscope_scale(random, noise):
    return 1 + random.normal(0, noise.gyro) if noise.gyro > 0 else 1.0


def smooth_course(random, rows, knots=2049):
    """From 0 to 1 in so many rows, by an uneven but smooth speed, never backwards; the first is at 0, the last at 1."""
    time = np.linspace(0, 1, knots)
    log_speed = np.zeros(knots)
    for k in range(1, 5):
        log_speed += random.normal(0, 0.5 / k) * np.cos(np.pi * k * time + random.uniform(0, 2 * np.pi))
    speed = np.exp(log_speed)
    way = np.concatenate(([0], np.cumsum((speed[1:] + speed[:-1]) / 2)))
    return np.interp(np.linspace(0, 1, rows), time, way / way[-1])


def smooth_wander(random, rows, size):
    """What a part that nobody holds does in one coordinate: 0 at first."""
    time = np.linspace(0, 1, rows)
    moved = np.zeros(rows)
    for k in range(1, 4):
        moved += random.normal(0, size / k) * np.sin(np.pi * k * time / 2)
    return moved


def measured_length(random, s, perimeter, slip, here_and_there):
    """The length that the finger is rolled off, from the way s of the contact on the part; 0 at the first row."""
    factor = 1 + random.normal(0, slip) if slip > 0 else 1.0
    way = s - s[0]
    if slip == 0 or not here_and_there:
        return factor * way
    patch = PATCH * perimeter
    lo, hi = min(way[0], way[-1]), max(way[0], way[-1])
    edges = lo - random.uniform(0, 1) * patch + patch * np.arange(int((hi - lo) / patch) + 3)
    local = np.maximum(1 + random.normal(0, min(1.0, PATCH_TIMES * slip), len(edges) - 1), 0.02)
    gone = np.concatenate(([0], np.cumsum(local * patch)))
    return factor * (np.interp(way, edges, gone) - np.interp(0.0, edges, gone))


@dataclass
class Roll:
    """One finger's: where it really was, row by row, and what length it was rolled off."""

    s: np.ndarray
    angle: np.ndarray
    length: np.ndarray
    x: np.ndarray = None  # of the contact, in the part's frame
    y: np.ndarray = None
    radius: float = 0.0


def roll(random, outline, corner_radius, rows, laps, noise, here_and_there, points=False, radius=0.0):
    """The start is drawn as the prior says: evenly along the way on which a corner is corner_radius dTheta long."""
    course = Course(outline, corner_radius)
    start = random.uniform(0, course.total)
    way = random.choice((-1.0, 1.0)) * laps * outline.perimeter
    at = course.at(start + way * smooth_course(random, rows), points)
    length = measured_length(random, at[0], outline.perimeter, noise.slip, here_and_there)
    return Roll(at[0], at[1], length, *(at[2:] if points else ()), radius=radius)


def felt(random, rolled, noise, heading):
    """u, psi of a disk, and the true direction of the contact's normal in the world."""
    rows = len(rolled.s)
    normal = rolled.angle + np.pi / 2 + heading
    u = random.uniform(-np.pi, np.pi) - rolled.length / rolled.radius
    psi = normal - u
    psi = psi[0] + gyroscope_scale(random, noise) * (psi - psi[0])
    whole = 2 * np.pi * np.round(psi[0] / (2 * np.pi))
    return (u + random.normal(0, noise.contact, rows) / rolled.radius,
            psi - whole + random.normal(0, noise.angle, rows), normal)


def centre(random, rolled, noise, heading, moved, normal):
    rows = len(rolled.s)
    c, s = np.cos(heading), np.sin(heading)
    x = c * rolled.x - s * rolled.y + moved[0] - rolled.radius * np.cos(normal)
    y = s * rolled.x + c * rolled.y + moved[1] - rolled.radius * np.sin(normal)
    return x + random.normal(0, noise.position, rows), y + random.normal(0, noise.position, rows)


def contact_log(random, outline, rows, laps, noise, here_and_there, centres=False):
    radius = disk_on(outline)
    rolled = roll(random, outline, radius, rows, laps, noise, here_and_there, centres, radius)
    heading = random.uniform(-np.pi, np.pi)
    u, psi, normal = felt(random, rolled, noise, heading)
    columns = {"u": u, "psi": psi}
    if centres:
        columns["x"], columns["y"] = centre(random, rolled, noise, heading, random.normal(0, 1, 2), normal)
    return columns, [rolled], [radius]


def travelled_log(random, outline, rows, laps, noise, here_and_there):
    """length, turn: each row's own errors, an offset as large in all of them, and a gyroscope's drift."""
    rolled = roll(random, outline, corner_without_finger(outline, noise), rows + 1, laps, noise, here_and_there)
    steps = np.abs(np.diff(rolled.s)) / outline.perimeter
    drift = np.cumsum(random.normal(0, 1, rows) * noise.angle * np.sqrt(steps))
    turn = gyroscope_scale(random, noise) * (rolled.angle[1:] - rolled.angle[0]) + drift
    columns = {"length": rolled.length[1:] + random.normal(0, noise.contact) + random.normal(0, noise.contact, rows),
               "turn": turn + random.normal(0, noise.angle) + random.normal(0, noise.angle, rows)}
    return columns, [rolled], []


def increments_log(random, outline, rows, laps, noise, here_and_there):
    rolled = roll(random, outline, corner_without_finger(outline, noise), rows + 1, laps, noise, here_and_there)
    columns = {"distance": np.diff(rolled.length) + random.normal(0, noise.contact, rows),
               "dturn": gyroscope_scale(random, noise) * np.diff(rolled.angle) + random.normal(0, noise.angle, rows)}
    return columns, [rolled], []


def corner_without_finger(outline, noise):
    """How much a corner weighs where no disk is known: what a turn is worth in length, by how sure both are."""
    if noise.angle == 0:
        return DISK * outline.perimeter
    return min(noise.contact / noise.angle, DISK * outline.perimeter)


def pair_log(random, outline, rows, laps, noise, here_and_there, centres=False):
    """Two disks of which neither comes near the other; the part turns and moves as it likes."""
    radii = [disk_on(outline), 0.8 * disk_on(outline)]
    while True:
        rolls = [roll(random, outline, r, rows, laps * random.uniform(0.5, 1), noise, here_and_there, True, r)
                 for r in radii]
        place = [(p.x + p.radius * np.sin(p.angle), p.y - p.radius * np.cos(p.angle)) for p in rolls]
        if np.hypot(place[0][0] - place[1][0], place[0][1] - place[1][1]).min() > 1.2 * sum(radii):
            break
    heading = random.uniform(-np.pi, np.pi) + smooth_wander(random, rows, 0.7)
    moved = [smooth_wander(random, rows, 0.3 * outline.perimeter) for _ in range(2)]
    columns = {}
    for name, rolled in zip("ab", rolls):
        u, psi, normal = felt(random, rolled, noise, heading)
        columns["u_" + name], columns["psi_" + name] = u, psi
        if centres:
            columns["x_" + name], columns["y_" + name] = centre(random, rolled, noise, heading, moved, normal)
    return columns, rolls, radii


KINDS = {
    "u,psi": contact_log,
    "length,turn": travelled_log,
    "increments": increments_log,
    "centres": lambda *args: contact_log(*args, centres=True),
    "pair": pair_log,
    "pair centres": lambda *args: pair_log(*args, centres=True),
}

DIGITS = 12  # behind the point
_QUADS = np.frombuffer("".join(f"{k:04d}" for k in range(10000)).encode(), dtype=np.uint8).reshape(10000, 4)


def as_csv(columns):
    """The log as bytes: all numbers as wide, by tables of four digits, for a million rows in less than a second."""
    values = np.stack(list(columns.values()), axis=1)
    rows, count = values.shape
    width = 1 + 4 + 1 + DIGITS + 1  # sign, digits, point, digits, comma or end of line
    size = np.abs(values)
    if not size.max() < 9999:
        raise ValueError("a number that does not fit into the log's columns")
    whole = np.floor(size)
    rest = np.rint((size - whole) * 10.0**DIGITS).astype(np.int64)
    carry = rest == 10**DIGITS
    rest[carry] = 0
    whole = whole.astype(np.int64) + carry
    out = np.empty((rows, count, width), dtype=np.uint8)
    out[:, :, 0] = np.where(values < 0, ord("-"), ord("0"))
    out[:, :, 1:5] = _QUADS[whole]
    out[:, :, 5] = ord(".")
    for k in range(DIGITS // 4 - 1, -1, -1):
        rest, digits = np.divmod(rest, 10000)
        out[:, :, 6 + 4 * k : 10 + 4 * k] = _QUADS[digits]
    out[:, :, -1] = ord(",")
    out[:, -1, -1] = ord("\n")
    return (",".join(columns) + "\n").encode() + out.tobytes()
