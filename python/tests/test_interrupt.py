"""Ctrl-C ends what takes long, at once, and leaves what can be asked again."""

import functools
import os
import signal
import threading
import time

import numpy as np
import pytest

import rollfix
from rollfix import Disk, Noise, Part

PRESSED = 0.4  # seconds after the call
HEARD = 0.3  # seconds of a processor later at most: what else the machine does is no matter


@pytest.fixture(scope="module")
def wriggly():
    """Dense points whose rounded digits make a thousand inflections: a hard part."""
    angle = np.linspace(0, 2 * np.pi, 4000, endpoint=False)
    radius = 10 + 0.6 * np.cos(3 * angle) + 0.3 * np.sin(5 * angle)
    xy = np.round(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1), 6)
    with pytest.warns(rollfix.RollfixWarning, match="smooth=.* leaves them out"):
        return Part.from_points(xy, name="wriggly")


def locate_two(part):
    noise, finger = Noise(contact=0.02, angle=0.01), Disk(0.5)
    roll = part.simulate(finger, start=[5.0, 37.0], length=[12.0, -9.0], samples=300, noise=noise)
    part.locate(log=roll, finger=finger, noise=noise, may_overlap=True)


def locate_many_rows(part):
    noise, finger = Noise(contact=0.02, angle="0.05rad", slip=0.05), Disk(0.05)
    roll = part.simulate(finger, start=5.0, length=1.0, samples=500_000, noise=noise)
    for _ in range(10):
        part.locate(log=roll, finger=finger, noise=noise)


def teach_many_rows(part):
    noise, finger = Noise(contact=1e-4, angle="1e-4rad"), Disk(0.05)
    roll = part.simulate(finger, start=5.0, length=2.1 * part.perimeter, samples=200_000, noise=noise)
    for _ in range(100):
        rollfix.teach(roll.log, finger, noise=noise)


@functools.lru_cache
def two_fingers():
    """That fits none of the parts: what may be wrong is looked for on all."""
    noise, finger = Noise(contact=0.02, angle=0.02), Disk(0.05)
    cam = Part.gallery("cam")
    return cam.simulate(finger, start=[1.0, 4.0], length=[1.5, -0.8], samples=300, noise=noise).log


CALLS = {
    "locate of two fingers": locate_two,
    "locate of many rows": locate_many_rows,
    "teach": teach_many_rows,
    "simulate": lambda part: part.simulate(Disk(0.5), start=1.0, length=200.0, samples=8_000_000),
    "locate_many": lambda part: part.locate_many(np.tile([[5.0, 0.3]], (3_000_000, 1))),
    "points": lambda part: part.point(np.linspace(0, 50, 30_000_000)),
    "a log": lambda part: rollfix.read_log({"length": np.cumsum(np.full(5_000_000, 0.1)), "turn": np.arange(5e6) * 1e-3}),
    "identify": lambda part: many().identify(log=two_fingers(), finger=Disk(0.05), noise=Noise(contact=0.003, angle=0.003)),
    "Catalog.build": lambda part: built(3000),
}


def built(count):
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        rollfix.Catalog.build(os.path.join(folder, "parts.db"), [f"gallery:spline,n=40,seed={k}" for k in range(count)])


def many():
    if not hasattr(many, "made"):
        import tempfile

        many.folder = tempfile.TemporaryDirectory()
        many.made = rollfix.Catalog.build(
            os.path.join(many.folder.name, "parts.db"), [f"gallery:spline,n=40,seed={k},wobble=0.1" for k in range(20)]
        )
    return many.made


@pytest.mark.parametrize("name", CALLS)
def test_ctrl_c_is_heard(name, wriggly):
    if name == "identify":
        many(), two_fingers()
    pressed = []

    def press():
        pressed.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(PRESSED, press)
    try:
        timer.start()
        CALLS[name](wriggly)
        timer.cancel()
        timer.join()
        time.sleep(0.2 if pressed else 0)  # what was pressed just as the call ended is heard here
    except KeyboardInterrupt:
        assert time.process_time() - pressed[0] < HEARD * (os.cpu_count() or 1)
    else:
        if not pressed:
            pytest.skip("was done before")
        pytest.fail("went on after Ctrl-C")
    assert rollfix.Part.gallery("circle").locate(1.0, 1.0) is not None
