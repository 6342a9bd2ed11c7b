"""What is simulated: a line of the tables for each kind of log."""

from dataclasses import dataclass

from rolls import Noise


@dataclass
class Cell:
    name: str
    outlines: str  # a family
    kind: str = "u,psi"
    rows: int = 200
    laps: float = 0.4
    contact: float = 1e-3  # of the perimeter
    angle: float = 5e-3
    slip: float = 0.0
    here_and_there: bool = False
    position: float = 0.0  # of the perimeter
    gyro: float = 0.0
    said: float = 1.0  # so many times the true standard deviations are said
    said_slip: float = 1.0
    logs: int = 400
    quick: int = 0  # logs with --quick, in units of QUICK

    def noise_on(self, outline):
        p = outline.perimeter
        return Noise(self.contact * p, self.angle, self.slip, self.position * p, self.gyro)

    def overstated(self):
        # Slip is always said as one factor and as five times as much here and there.
        return self.said > 1 or self.said_slip > 1 or (self.slip > 0 and not self.here_and_there)


def cells():
    made = []

    def add(name, *args, **more):
        made.append(Cell(name, *args, **more))

    both = dict(slip=0.005, here_and_there=True)
    strong = dict(slip=0.05, here_and_there=True)
    # How many rows: 0.4 laps, contact 1e-3 P, 5e-3 rad.
    for rows, logs, quick in ((20, 400, 100), (200, 500, 200), (2000, 400, 60), (20000, 200, 24), (200000, 200, 0),
                              (1000000, 40, 0)):
        more = dict(rows=rows, logs=logs, quick=quick)
        add(f"rows {rows}, no slip", "all", **{**more, "quick": quick // 2})
        add(f"rows {rows}, slip .005", "all", **more, **both)
        add(f"rows {rows}, slip .05", "all", **{**more, "quick": quick // 2}, **strong)
    add("rows 200, slip .005 one factor", "all", slip=0.005, logs=500, quick=100)
    add("rows 200, slip .05 one factor", "all", slip=0.05, logs=500)
    add("rows 20000, slip .05 one factor", "all", rows=20000, slip=0.05, logs=200)
    # How noisy.
    for contact in (1e-4, 1e-2):
        for angle in (1e-3, 5e-2, 0.5):
            add(f"contact {contact:g}, angle {angle:g}", "all", contact=contact, angle=angle, **both)
    add("contact 1e-3, angle .1, rows 2000", "all", angle=0.1, rows=2000, **both)
    add("contact 1e-3, angle .5, rows 20000", "all", angle=0.5, rows=20000, logs=200, **both)
    add("contact 1e-4, angle 1e-3, rows 20000", "all", contact=1e-4, angle=1e-3, rows=20000, logs=200, **both)
    # How long.
    for laps in (0.02, 0.1, 1.0, 2.0):
        add(f"laps {laps:g}", "all", laps=laps, quick=60 if laps in (0.1, 2.0) else 0, **both)
    add("laps .02, angle .1", "all", laps=0.02, angle=0.1, **both)
    add("laps .02, angle .1, rows 20000", "all", laps=0.02, angle=0.1, rows=20000, logs=200, **both)
    add("laps 2, rows 20000, slip .05", "all", laps=2, rows=20000, logs=200, **strong)
    # Which outline.
    for family in ("splines", "curves", "rounded", "drawing", "sharp", "corners", "symmetric"):
        quick = 60 if family in ("corners", "symmetric") else 0
        add(f"{family}", family, quick=quick, **both)
    add("sharp, no slip", "sharp")
    add("sharp, laps .1, angle .1", "sharp", laps=0.1, angle=0.1, **both)
    add("sharp, rows 20000", "sharp", rows=20000, logs=200, **both)
    add("drawing, rows 20000", "drawing", rows=20000, logs=200, **both)
    # Which log.
    add("length,turn, no slip", "all", kind="length,turn", quick=60)
    add("length,turn, slip .005", "all", kind="length,turn", quick=60, **both)
    add("length,turn, rows 2000, slip .05", "all", kind="length,turn", rows=2000, **strong)
    add("length,turn, rows 20000, slip .05", "all", kind="length,turn", rows=20000, logs=200, **strong)
    add("length,turn, sharp", "sharp", kind="length,turn", **both)
    steps = dict(kind="increments", contact=1e-4)
    add("increments, no slip", "all", rows=300, quick=60, **steps)
    add("increments, slip .005", "all", rows=300, quick=60, **steps, **both)
    add("increments, slip .05", "all", rows=300, **steps, **strong)
    add("increments, rows 20000, slip .005", "all", rows=20000, logs=200, kind="increments", contact=1e-5, angle=5e-4,
        **both)
    add("increments, sharp", "sharp", rows=300, **steps, **both)
    add("centres, no slip", "all", kind="centres", position=1e-3, quick=60)
    add("centres, slip .005", "all", kind="centres", position=1e-3, quick=60, **both)
    add("centres, rows 20000, slip .05", "all", kind="centres", position=1e-3, rows=20000, logs=60, **strong)
    add("centres, sharp", "sharp", kind="centres", position=1e-3, **both)
    for kind in ("u,psi", "length,turn"):
        add(f"{kind}, gyro .03", "all", kind=kind, gyro=0.03, quick=40, **both)
    add("length,turn, gyro .03, rows 20000", "all", kind="length,turn", gyro=0.03, rows=20000, logs=200, **both)
    add("length,turn, gyro .03, laps 2", "all", kind="length,turn", gyro=0.03, laps=2.0, **both)
    add("increments, gyro .03", "all", gyro=0.03, rows=300, quick=40, **steps, **both)
    add("increments, gyro .03, laps 2", "all", gyro=0.03, rows=300, laps=2.0, **steps, **both)
    pair = dict(kind="pair", rows=100, contact=5e-4, angle=2e-3, logs=200)
    add("pair, no slip", "smooth", quick=20, **pair)
    add("pair, slip .003 one factor", "smooth", slip=0.003, quick=20, **pair)
    add("pair, slip .003", "smooth", slip=0.003, here_and_there=True, **pair)
    add("pair, slip .02", "smooth", slip=0.02, here_and_there=True, quick=20, **pair)
    add("pair, drawing", "drawing", slip=0.003, **pair)
    add("pair, sharp", "sharp", **{**pair, "rows": 200})
    add("pair, sharp, slip .003", "sharp", slip=0.003, here_and_there=True, **{**pair, "rows": 200})
    add("pair, sharp, rows 2000", "sharp", **{**pair, "rows": 2000})
    add("pair, sharp, rows 20000", "sharp", **{**pair, "rows": 20000, "logs": 80})
    add("pair, corners", "corners", quick=20, **pair)
    add("pair, rows 20000", "smooth", slip=0.003, **{**pair, "rows": 20000, "logs": 40})
    add("pair, rows 20000, slip .02", "smooth", slip=0.02, here_and_there=True, **{**pair, "rows": 20000, "logs": 40})
    seen = {**pair, "kind": "pair centres", "position": 1e-3}
    add("pair centres, no slip", "smooth", quick=20, **seen)
    add("pair centres, slip .003 one factor", "smooth", slip=0.003, **seen)
    # What is said is more than there is.
    for times in (2, 5, 20):
        add(f"said x{times}, u,psi", "all", said=times, quick=40 if times == 5 else 0, **both)
        add(f"said x{times}, u,psi, rows 2000, slip .02", "all", said=times, rows=2000, slip=0.02,
            here_and_there=True, logs=200)
        add(f"said x{times}, length,turn", "all", kind="length,turn", said=times, **both)
        add(f"said x{times}, increments", "all", rows=300, said=times, quick=40 if times == 5 else 0, **steps, **both)
        add(f"said x{times}, increments, slip .02", "all", rows=300, said=times, slip=0.02, here_and_there=True,
            **steps)
        add(f"said x{times}, increments, drawing", "drawing", rows=300, said=times, logs=200, **steps, **both)
        add(f"said x{times}, centres", "all", kind="centres", position=1e-3, said=times, logs=200, **both)
        add(f"said x{times}, pair", "smooth", said=times, slip=0.003, **{**pair, "logs": 80})
        add(f"slip said x{times}, u,psi", "all", said_slip=times, **both)
        add(f"slip said x{times}, increments", "all", rows=300, said_slip=times, **steps, **both)
    return made


CELLS = cells()
