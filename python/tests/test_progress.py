"""On a terminal the program says what it is doing, once that takes a while; the bar of many logs counts reading them."""

import os
import pty
import subprocess

import numpy as np
import pytest

import rollfix
from rollfix import Disk

SLOW = ["inspect", "gallery:spline,n=6000,seed=3,wobble=0.01"]


def on_a_terminal(program, *words):
    ours, theirs = pty.openpty()
    done = subprocess.Popen([program.path, *words], stdout=subprocess.DEVNULL, stderr=theirs)
    os.close(theirs)
    said = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:
            break
        if not part:
            break
        said += part
    done.wait()
    os.close(ours)
    return said.decode()


@pytest.fixture(scope="module")
def long_roll(tmp_path_factory):
    """Many rows that fit badly: what may be wrong takes a while to try."""
    cam, finger = rollfix.Part.gallery("cam"), Disk(0.2)
    roll = cam.simulate((finger, finger), start=(1.0, 4.0), length=(1.5, -0.8), samples=3000, noise=dict(contact=0.05, angle=0.05))
    file = tmp_path_factory.mktemp("progress") / "roll.csv"
    roll.log.save(file)
    return file


def test_a_long_locate_says_on_a_terminal_what_is_done(program, long_roll):
    words = ["locate", "gallery:cam", "--log", long_roll, "--finger", "disk,r=0.2", "--noise", "contact=0.003,angle=0.003"]
    said = on_a_terminal(program, *map(str, words))
    if "rollfix: weighing all rows" not in said and "trying what may be wrong" not in said:
        pytest.skip("was done within half a second")
    assert said.rstrip("\n").count("\r") > 1
    assert "weighing" not in on_a_terminal(program, *map(str, words), "--quiet")


def test_the_bar_counts_reading(monkeypatch, ellipse):
    tqdm = pytest.importorskip("tqdm.auto")
    bars = []

    class Bar:
        def __init__(self, total, unit):
            bars.append([total, unit.strip(), 0])
            self.n = 0

        def update(self, by):
            self.n += by
            bars[-1][2] = self.n

        def close(self):
            pass

    monkeypatch.setattr(tqdm, "tqdm", Bar)
    log = {"length": np.array([0.5, 1.0]), "turn": np.array([0.3, 0.625])}
    ellipse.locate_logs([log] * 5, progress=True)
    assert bars == [[5, "logs read", 5], [5, "logs", 5]]
