"""Two fingers, watched while they roll, and which of them rolls next."""

import pickle

import pytest

import rollfix
from rollfix import Disk, InputError, Noise, Part

pytest.importorskip("pandas")

PART = Part.gallery("spline,n=9,seed=4,wobble=0.25")
NOISE = Noise(contact=0.003, angle=0.002)
ROLL = PART.simulate(
    [Disk(0.1), Disk(0.1)], start=[1, 4.2], length=[1.3, -0.9], part_rotation=0.35, samples=40, noise=NOISE, seed=2
)


def rows_of(finger):
    return {"time": ROLL.log["time"], "u": ROLL.log[f"u_{finger}"], "psi": ROLL.log[f"psi_{finger}"]}


def watch(**options):
    return PART.watch(finger=Disk(0.1), noise=NOISE, every=20, **options)


def test_two_logs_end_as_one_and_as_locate():
    two = watch(name=("left", "right"))
    assert two.add(rows_of("a"), log=0) == []
    assert [event["event"] for event in two.add(rows_of("b"), log=1)][:2] == ["begin", "found"]
    two.finish()
    one = watch()
    one.add(ROLL.log.to_frame())
    one.finish()
    assert one.placements == two.placements
    located = PART.locate(log=ROLL.log, finger=Disk(0.1), noise=NOISE)
    assert [tuple(place["start"]) for place in two.placements] == [tuple(place.start) for place in located]


def test_a_row_without_partner_is_told_by_its_number():
    two = watch(name=("left", "right"))
    two.add({"time": [0, 1, 2], "u": [0, 0.01, 0.02], "psi": [0, 0, 0]}, log=0)
    with pytest.warns(rollfix.RollfixWarning, match="left: row 1: right has no row at the time 1"):
        two.add({"time": [0, 2], "u": [0, 0.02], "psi": [0, 0]}, log=1)


def test_there_is_no_third_log():
    with pytest.raises(InputError, match="^log: expected 0 or 1, found 2"):
        watch(name=("left", "right")).add("time,u,psi", log=2)
    with pytest.raises(InputError, match="^log: expected 0: there is one log"):
        watch().add("time,u,psi", log=1)
    with pytest.raises(InputError, match="^name: expected one, or two different ones"):
        watch(name=("left", "left"))


def test_the_next_roll_is_of_both():
    short = ROLL.log.to_frame().iloc[:8]
    advice = PART.locate(log=short, finger=Disk(0.1), noise=NOISE).advise(travel=0.5)
    assert len(advice.length) == 2
    assert max(abs(length) for length in advice.length) <= 0.5
    assert len(advice.contenders[0]["contact"]) == 2
    assert " and " in repr(advice)
    assert pickle.loads(pickle.dumps(advice)).length == advice.length
    assert advice.to_svg().startswith("<")
