"""Rolls that are planned."""

import pickle

import numpy as np
import pytest

import rollfix

ELLIPSE = rollfix.Part.gallery("ellipse")
DISK = rollfix.Disk(0.3)


def across(**others):
    return ELLIPSE.plan(DISK, **{"start": (2.4, 7.2), "length": 0.8, "friction": 0.5, **others})


def test_a_plan_is_located_where_it_starts():
    plan = across()
    assert plan.feasible
    found = ELLIPSE.locate(log=plan.log, finger=DISK)
    assert np.allclose(found[0].start, (2.4, 7.2), atol=1e-7)


def test_a_plan_has_velocities_of_both_fingers():
    rows = across(samples=11).rows
    assert rows["time"].shape == (11,)
    assert rows["vx_a"][0] == 0 and abs(rows["omega_b"][5]) > 0.1


def test_what_can_not_be_done_says_why():
    plan = across(length=(0.8, 0.7), friction=0.3)
    assert not plan.feasible
    assert "slips" in plan.verdict
    assert plan.margins[plan.failure]["condition"] == "friction"


def test_a_part_face_down_is_found_where_the_plan_starts():
    plan = across(mirrored=True)
    assert plan.feasible
    found = ELLIPSE.locate(log=plan.log, finger=DISK, mirrored=True)
    assert np.allclose(found[0].start, (2.4, 7.2), atol=1e-7)


def test_fingers_at_different_heights_are_not_kept_apart():
    assert "apart" in [margin["condition"] for margin in across().margins]
    assert "apart" not in [margin["condition"] for margin in across(may_overlap=True).margins]


def test_a_wheel_finds_its_place():
    plan = ELLIPSE.plan((rollfix.Jaw(), DISK), start=(2.4, None), length=0.3, wheel=True)
    assert plan.path == "squeezed"
    assert plan.start[1] == pytest.approx(7.310565, abs=1e-5)


def test_one_finger_on_a_part_at_rest_keeps_a_limit():
    plan = ELLIPSE.plan(DISK, start=1, length=1.5, limits={"speed": 0.2})
    assert np.hypot(plan.rows["vx"], plan.rows["vy"]).max() == pytest.approx(0.2, rel=1e-3)


def test_a_plan_is_written_and_kept(tmp_path):
    plan = across()
    plan.save(tmp_path / "plan.csv")
    plan.save(tmp_path / "plan.svg")
    assert (tmp_path / "plan.csv").read_text() == plan.to_csv()
    assert pickle.loads(pickle.dumps(plan)) == plan
    assert plan.to_csv(finger="b").startswith("time,u,psi,x,y,vx,vy,omega")


@pytest.mark.parametrize(
    "wrong, said",
    [
        ({"stays": "here"}, "stays: expected one of"),
        ({"limits": {"sped": 1}}, "limits: expected speed"),
        ({"length": (1, 2, 3)}, "length: expected one number, or 2"),
        ({"length": 0}, "nothing would move"),
        ({"pose": (1, 2)}, "pose: expected x, y and heading"),
    ],
)
def test_what_contradicts_itself_is_refused(wrong, said):
    with pytest.raises(rollfix.InputError, match=said):
        across(**wrong)
