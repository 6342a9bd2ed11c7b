"""What a diagnosis advises can be typed in Python as it stands, and helps; the document keeps the program's words."""

import pathlib
import re

import numpy as np
import pytest

import rollfix
from rollfix import Disk, Noise
from rollfix._words import diagnosis_in_python, in_python

pytest.importorskip("pandas")
SOURCE = pathlib.Path(__file__).resolve().parents[2] / "src/documents/diagnosis_text.cpp"


def typed(cure):
    """The keyword arguments that a cure is, as Python reads them."""
    return eval(f"dict({cure})", vars(rollfix) | {"np": np})


@pytest.mark.parametrize("words, said", [
    ("--finger disk,r=10.082", "finger=Disk(10.082)"),
    ("--finger disk,r=10 --finger disk,r=7.5e-05", "finger=(Disk(10), Disk(7.5e-05))"),
    ("--noise contact=0.05,angle=0.344deg,slip=0.004", "noise=Noise(contact=0.05, angle=0.006, slip=0.004)"),
    ("--direction either", "direction='either'"),
    ("--finger disk,r=0.2 --noise contact=0.1", "finger=Disk(0.2), noise=Noise(contact=0.1)"),
    ("--robust --noise contact=0.1", "robust=True, noise=Noise(contact=0.1)"),
    ("--columns u=u:rad,psi=psi:rad --noise contact=0.1", 'units={"u": "rad", "psi": "rad"}, noise=Noise(contact=0.1)'),
    ("--columns u=u:deg,psi=psi:deg", 'units={"u": "deg", "psi": "deg"}'),
    ("give turns with their unit, as in 73deg", "give turns in radians, as in np.radians(73)"),
    ("--mirror", "mirrored=True"),
    ("what --prior, --heading or --pose says", "what prior, heading or pose says"),
    ("--robust", "robust=True"),
    ("leave it out", "leave it out"),
    ("x.csv:3: u is '--off'", "x.csv:3: u is '--off'"),
])
def test_options_are_keyword_arguments(words, said):
    assert in_python(words) == said


def test_no_text_of_a_diagnosis_is_left_in_the_program_s_words():
    written = re.findall(r'"((?:[^"\\]|\\.)*--[a-z](?:[^"\\]|\\.)*)"', SOURCE.read_text())
    filled = [re.sub(r"=\{[^}]*\}", "=0.5", one).replace("--finger {},", "--finger disk,") for one in written]
    numbers = [one.replace("=0.5{}", "=0.5").replace("{}", "contact=0.1,angle=2deg") for one in filled]
    assert len(numbers) > 10 and not [one for one in numbers if "--" in in_python(one) or "deg," in in_python(one)]


def test_what_else_it_may_be_is_said_in_python_as_well():
    found = {"cause": "stray", "cure": "--robust", "stray": 2, "others": [{"cause": "slip", "cure": "--noise slip=0.1"}]}
    assert diagnosis_in_python(found)["others"][0]["cure"] == "noise=Noise(slip=0.1)"
    assert found["cure"] == "--robust" and diagnosis_in_python(None) is None


@pytest.mark.parametrize("change, options, cause", [
    (lambda f: f, dict(finger=Disk(20)), "radius"),
    (lambda f: f.assign(psi=np.degrees(f.psi)), {}, "psi_degrees"),
    (lambda f: f, dict(noise=Noise(contact=0.05, angle=0.0006, slip=0.004)), "noise"),
    (lambda f: f.assign(psi=np.where(f.index == 15, f.psi + 0.2, f.psi)), {}, "stray"),
])
def test_doing_what_it_says_helps(ask, frame, change, options, cause):
    log = change(frame)
    badly = ask(log, **options)
    assert badly.diagnosis["cause"] == cause and "--" not in badly.diagnosis["cure"]
    mended = ask(log, **{**options, **typed(badly.diagnosis["cure"])})
    assert mended.diagnosis is None and mended.starts.shape[0] > 0


def slipping(f):
    u = f.u.to_numpy().copy()
    u[10:] += 0.12 * (u[10:] - u[10]) + 0.05
    return f.assign(u=u)


MISTAKES = {
    "radius": (lambda f: f, dict(finger=Disk(20))),
    "psi in degrees": (lambda f: f.assign(psi=np.degrees(f.psi)), {}),
    "u in degrees": (lambda f: f.assign(u=np.degrees(f.u)), {}),
    "both in degrees": (lambda f: f.assign(u=np.degrees(f.u), psi=np.degrees(f.psi)), {}),
    "noise": (lambda f: f, dict(noise=Noise(contact=0.05, angle=0.0006, slip=0.004))),
    "stray": (lambda f: f.assign(psi=np.where(f.index == 15, f.psi + 0.2, f.psi)), {}),
    "face down": (lambda f: f.assign(u=-f.u, psi=-f.psi), {}),
    "u clockwise": (lambda f: f.assign(u=-f.u), {}),
    "exchanged": (lambda f: f.assign(u=f.psi, psi=f.u), {}),
    "slip": (slipping, {}),
    "no noise said": (lambda f: f.assign(psi=f.psi + 0.003 * np.sin(7 * np.arange(len(f)))), dict(noise=None)),
    "another part": (lambda f: f.assign(psi=f.psi * 1.3 + 0.02 * np.sin(f.index)), {}),
    "a prior that is wrong": (lambda f: f, dict(prior=(5.0, 0.5))),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_every_cure_is_a_sentence_or_can_be_typed_as_it_stands(ask, frame, mistake):
    change, options = MISTAKES[mistake]
    log = change(frame)
    found = ask(log, **options).diagnosis
    for one in [] if found is None else [found, *found.get("others", [])]:
        cure = one["cure"]
        if re.search(r"\w=|--", cure) is None:
            assert "`" not in cure  # a sentence
            continue
        arguments = typed(cure)
        assert arguments
        ask(log, **{**options, **arguments})


def test_the_document_is_the_program_s(ask, frame, program, wing, roll_csv):
    words = ["--log", roll_csv, "--finger", "disk,r=20", "--noise", "contact=0.05,angle=0.006,slip=0.004", "--json"]
    answer = ask(frame, finger=Disk(20))
    assert answer.to_dict() == program("locate", wing.name, *words)
    assert answer.to_dict()["diagnosis"]["cure"].startswith("--finger") and answer.diagnosis["cure"].startswith("finger=")


def test_a_watch_advises_in_python(wing, frame, noise):
    watch = wing.watch(finger=Disk(10), noise=noise)
    events = watch.add(frame.assign(psi=np.degrees(frame.psi))) + watch.finish()
    (over,) = [event for event in events if event["event"] == "over"]
    assert over["diagnosis"]["cure"] == 'units={"psi": "deg"}'
