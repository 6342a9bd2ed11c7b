"""What several tests share: the program to compare with, parts, and how documents are compared."""

import json
import os
import pathlib
import subprocess

import hypothesis
import numpy as np
import pytest

import rollfix

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
SHAPES = ["ellipse,a=2,b=1", "cam", "spline,n=9,seed=7,wobble=0.2", "limacon", "naca", "polygon", "log-spiral"]

hypothesis.settings.register_profile("fast", max_examples=30, deadline=None, derandomize=True)
hypothesis.settings.register_profile("slow", max_examples=2000, deadline=None)


def pytest_addoption(parser):
    parser.addoption("--slow", action="store_true", help="the slow tests as well, and more random cases")


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: runs with --slow only")
    hypothesis.settings.load_profile("slow" if config.getoption("--slow") else "fast")


def pytest_collection_modifyitems(config, items):
    if config.getoption("--slow"):
        return
    for item in items:
        if "slow" in item.keywords:
            item.add_marker(pytest.mark.skip(reason="runs with --slow"))


@pytest.fixture(scope="session")
def program():
    """Runs `rollfix`, and returns its JSON."""
    path = os.environ.get("ROLLFIX_PROGRAM", str(REPOSITORY / "build/release/rollfix"))
    if not os.path.exists(path):
        pytest.fail(f"ROLLFIX_PROGRAM: there is no {path}; build the program first")

    def run(*words, cwd=None, stdin="", lines=False):
        done = subprocess.run([path, *map(str, words)], cwd=cwd, input=stdin, capture_output=True, text=True)
        if done.returncode not in (0, 1, 3) and not lines:
            raise RuntimeError(done.stderr)
        return [json.loads(line) for line in done.stdout.splitlines()] if lines else json.loads(done.stdout)

    run.path = path
    return run


@pytest.fixture(scope="session", params=SHAPES)
def part(request):
    return rollfix.Part.gallery(request.param)


@pytest.fixture(scope="session")
def ellipse():
    return rollfix.Part.gallery("ellipse", a=2, b=1)


@pytest.fixture(scope="session")
def wing():
    return rollfix.Part(REPOSITORY / "examples/wing.csv")


@pytest.fixture(scope="session")
def noise():
    return rollfix.Noise(contact=0.05, angle=0.006, slip=0.004)


@pytest.fixture(scope="session")
def roll_csv():
    return REPOSITORY / "examples/roll.csv"


@pytest.fixture(scope="session")
def frame(roll_csv):
    """The same rows as a data frame."""
    return pytest.importorskip("pandas").read_csv(roll_csv, comment="#")


@pytest.fixture(scope="session")
def ask(wing, noise):
    """Locates the wing by a log of a disk."""
    usual = {"finger": rollfix.Disk(10), "noise": noise}
    return lambda log, **options: wing.locate(log=log, **{**usual, **options})


def reading_of(part, s, length):
    """What a roll from s over this length reads, from the turning function alone."""
    return length, float(part.turning(s + length) - part.turning(s))


def random_rolls(part, count, seed):
    """Starts and readings of rolls that stay on the part."""
    dice = np.random.default_rng(seed)
    length = dice.uniform(0.03, 0.5, count) * part.perimeter
    start = dice.uniform(0, part.perimeter if part.closed else part.perimeter - length, count)
    return start, np.stack([length, part.turning(start + length) - part.turning(start)], axis=1)
