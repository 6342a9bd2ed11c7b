"""Touches without rolling, as Python takes them and as the program does."""

import json
import math
import pathlib
import pickle
import subprocess

import numpy as np
import pytest

import rollfix

BRACKET = pathlib.Path(__file__).resolve().parents[2] / "examples/bracket.dxf"
FIVE = [(108.088, 86.821), (124.014, 51.172), (180.292, 54.717), (178.374, 82.953), (134.488, 101.138)]
NOISE = {"position": 0.02}


@pytest.fixture(scope="module")
def bracket():
    return rollfix.Part(BRACKET, loop=1)


@pytest.fixture(scope="module")
def found(bracket):
    return bracket.locate(touches=FIVE, finger=rollfix.Disk(3), noise=NOISE)


def test_five_balls_give_the_pose(found):
    assert found.status == "complete"
    assert found.verdict == "unique"
    assert len(found) == 1
    assert found.poses.shape == (1, 3)
    lo, hi = np.transpose(found.placements[0]["pose_interval"])
    truth = np.array([120, 45, math.radians(12)])
    assert (lo <= truth).all() and (truth <= hi).all()


def test_an_outlier_is_named(bracket, found):
    touches = [*FIVE, (112.243, 107.744), (150, 70)]
    robust = bracket.locate(touches=touches, finger=rollfix.Disk(3), noise=NOISE, robust=True)
    assert robust.verdict == "unique"
    assert robust.placements[0]["outliers"] == [6]
    assert robust.outlier[6] > 0.999 > max(robust.outlier[:6])
    assert np.allclose(robust.poses, found.poses, atol=0.2)


def test_one_touch_makes_a_known_pose_better(bracket):
    pose = (120.2, 45.1, math.radians(12), 0.5, math.radians(0.2))
    known = bracket.locate(touches=FIVE[:1], finger=rollfix.Disk(3), noise=NOISE, pose=pose)
    assert known.verdict == "unique"
    variance = known.placements[0]["pose_covariance"]
    assert variance[0][0] < 0.2 * 0.5**2 < variance[1][1]


def test_the_program_says_the_same(found, program):
    touches = [word for x, y in FIVE for word in ("--touch", f"{x},{y}")]
    command = [program.path, "locate", str(BRACKET), *touches, "--finger", "disk,r=3", "--noise", "position=0.02", "--json"]
    told = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    assert told == found.to_dict()


@pytest.mark.parametrize("given", [np.array(FIVE), [list(touch) for touch in FIVE], [(*touch, None) for touch in FIVE]])
def test_touches_come_in_any_form(bracket, found, given):
    assert bracket.locate(touches=given, finger=rollfix.Disk(3), noise=NOISE) == found


def test_a_data_frame_has_the_columns_of_the_table(bracket, found):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(FIVE, columns=["x", "y"])
    frame["position_sd"] = [0.02] * 5
    answer = bracket.locate(touches=frame, finger=rollfix.Disk(3), noise={"position": 1})
    assert np.allclose(answer.poses, found.poses)


def test_columns_may_stand_in_a_dict(bracket, found):
    x, y = np.transpose(FIVE)
    assert bracket.locate(touches={"x": x, "y": y}, finger=rollfix.Disk(3), noise=NOISE) == found
    with pytest.raises(rollfix.InputError, match="expected columns of one length, found x 5, y 4"):
        bracket.locate(touches={"x": x, "y": y[:4]}, finger=rollfix.Disk(3), noise=NOISE)
    with pytest.raises(rollfix.InputError, match="expected columns x and y, found x"):
        bracket.locate(touches={"x": x}, finger=rollfix.Disk(3), noise=NOISE)


def test_poses_are_a_table(found):
    pytest.importorskip("pandas")
    frame = found.to_frame()
    assert np.allclose(frame[["x", "y", "heading"]], found.poses)
    assert list(frame.columns) == ["x", "y", "heading", "kind", "probability"]


def test_a_normal_and_a_tolerance(bracket):
    touches = [(108.088, 86.821, math.radians(-167.6)), *FIVE[1:]]
    answer = bracket.locate(touches=touches, finger=rollfix.Disk(3), tolerance=(0.1, 0.05))
    assert answer.placements[0]["probability"] is None
    assert answer.placements[0]["worst"] <= 1


def test_degrees_are_a_text(bracket):
    texts = [(108.088, 86.821, "-167.6deg"), *FIVE[1:]]
    numbers = [(108.088, 86.821, math.radians(-167.6)), *FIVE[1:]]
    noise = {"position": 0.02, "angle": "1deg"}
    assert bracket.locate(touches=texts, noise=noise, finger=rollfix.Disk(3)) == bracket.locate(touches=numbers, noise=noise, finger=rollfix.Disk(3))
    with pytest.raises(rollfix.InputError, match=r"normal: expected radians as a number, or a text such as '162deg'"):
        bracket.locate(touches=[(1, 2, "left")], noise=noise)


def test_a_data_frame_with_its_own_noise_needs_no_other(bracket, found):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(FIVE, columns=["X", "Y"])
    frame["position_sd"] = 0.02
    assert np.allclose(bracket.locate(touches=frame, finger=rollfix.Disk(3)).poses, found.poses)


def test_clear_paths_leave_fewer_poses(bracket):
    three = FIVE[:1] + FIVE[2:4]
    given = {"finger": rollfix.Disk(3), "noise": NOISE}
    without = bracket.locate(touches=three, **given)
    towards = [(60, 86.8, *three[0]), (180, 20, *three[1]), (220, 110, *three[2])]
    with_paths = bracket.locate(touches=three, clear=towards, **given)
    assert 0 < len(with_paths) <= len(without)
    assert with_paths.clear == [list(path) for path in towards]


def test_the_next_touch_is_advised(bracket):
    three = [(106.476, 94.401), (158.015, 50.015), (192.873, 57.557)]
    answer = bracket.locate(touches=three, finger=rollfix.Disk(3), noise=NOISE)
    assert len(answer) == 2
    advice = answer.advise()
    assert advice.helps
    assert advice.bits == pytest.approx(advice.bits_wanted, abs=0.05)
    chosen = answer.advise([(0, 0, -1, 0), (100, 60, 1, 0)])
    assert chosen.approach["from"] == [100, 60]
    with pytest.raises(rollfix.InputError, match="not \\(0, 0\\)"):
        answer.advise([(0, 0, 0, 0)])


def test_an_answer_can_be_pickled_and_drawn(found, tmp_path):
    assert pickle.loads(pickle.dumps(found)) == found
    assert "class=\"touch\"" in found.to_svg()
    found.save(tmp_path / "poses.svg")
    assert (tmp_path / "poses.svg").read_text() == found.to_svg()


@pytest.mark.parametrize(
    "options, message",
    [
        ({"touches": FIVE}, "found neither `noise` nor `tolerance`"),
        ({"touches": [(1,)], "noise": NOISE}, r"expected \(x, y\) or \(x, y, normal\)"),
        ({"touches": [], "noise": NOISE}, "expected readings, a log or touches, found none"),
        ({"touches": FIVE, "noise": NOISE, "tolerance": 1}, "leave one out"),
        ({"touches": FIVE, "noise": NOISE, "facing": 1}, "facing: touches do not roll"),
        ({"touches": FIVE, "noise": NOISE, "finger": rollfix.Jaw()}, "expected a round finger"),
        ({"touches": [(float("nan"), 1)], "noise": NOISE}, "finite x and y"),
        ({"touches": FIVE, "noise": NOISE, "clear": [(1, 2, 3)]}, r"clear: expected \(x, y, x, y\)"),
        ({"readings": (1, 2), "clear": [(1, 2, 3, 4)]}, "clear: is about touches"),
    ],
)
def test_what_cannot_be_meant_is_refused(bracket, options, message):
    with pytest.raises(rollfix.InputError, match=message):
        bracket.locate(**options)


def test_an_answer_has_a_certificate(found, tmp_path):
    certificate = found.certify(tmp_path / "proof.json")
    assert certificate["schema"] == "rollfix/touch-certificate/1" and (tmp_path / "proof.json").exists()
    assert [one["listed"] for one in certificate["poses"]][0]


def test_one_touch_has_no_certificate(bracket):
    with pytest.raises(rollfix.InputError, match="expected at least two contacts, found 1"):
        bracket.locate(touches=FIVE[:1], finger=rollfix.Disk(3), noise=NOISE).certify()
