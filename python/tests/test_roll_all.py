"""Several rolls, and rolls with touches, as Python takes them and as the program does."""

import json
import math
import pickle
import subprocess

import numpy as np
import pytest

import rollfix

POSE = (3.0, 1.0, 0.5)


def rolled(part, start, length, seed):
    """A log of the part at POSE: x and y moved, psi turned."""
    roll = part.simulate(rollfix.Disk(0.2), start=start, length=length, samples=40, noise={"contact": 0.005, "angle": 0.003}, seed=seed)
    columns = roll.log.to_dict()
    x, y, heading = POSE
    c, s = math.cos(heading), math.sin(heading)
    moved = dict(columns)
    moved["x"] = x + c * columns["x"] - s * columns["y"]
    moved["y"] = y + s * columns["x"] + c * columns["y"]
    moved["psi"] = columns["psi"] + heading
    return moved


@pytest.fixture(scope="module")
def part():
    return rollfix.Part("gallery:limacon")


@pytest.fixture(scope="module")
def logs(part):
    return [rollfix.read_log(rolled(part, 0.5, 1.5, 1)), rollfix.read_log(rolled(part, 6.0, 1.5, 2))]


NOISE = {"contact": 0.005, "angle": 0.003, "position": 0.005}


@pytest.fixture(scope="module")
def found(part, logs):
    return part.locate(log=logs, roll="all", finger=rollfix.Disk(0.2), noise=NOISE)


def test_a_list_of_logs_gives_the_pose(found):
    assert found.verdict == "unique"
    assert [contact["roll"] for contact in found.contacts] == [1, 2]
    lo, hi = np.transpose(found.placements[0]["pose_interval"])
    assert (lo - 0.02 <= np.array(POSE)).all() and (np.array(POSE) <= hi + 0.02).all()
    assert found.placements[0]["start"] == pytest.approx([0.5, 6.0], abs=0.1)


def test_the_program_says_the_same(found, logs, program, tmp_path):
    for name, log in zip(("a.csv", "b.csv"), logs):
        log.save(tmp_path / name)
    command = [program.path, "locate", "gallery:limacon", "--log", "a.csv", "--log", "b.csv", "--roll", "all"]
    command += ["--finger", "disk,r=0.2", "--noise", "contact=0.005,angle=0.003,position=0.005", "--json"]
    told = json.loads(subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path).stdout)
    ours = found.to_dict()
    assert told["placements"] == ours["placements"]
    assert told["verdict"] == ours["verdict"]


def test_touches_count_as_well(part, logs):
    x, y, heading = POSE
    touch = (x + 1, y + 5)
    with_touch = part.locate(log=logs[0], roll="all", touches=[touch], finger=rollfix.Disk(0.2), noise=NOISE)
    assert len(with_touch.contacts) == 2


def test_one_roll_is_answered_as_ever(part, logs):
    one = part.locate(log=logs[0], roll="all", finger=rollfix.Disk(0.2), noise=NOISE)
    assert one == part.locate(log=logs[0], finger=rollfix.Disk(0.2), noise=NOISE)


def test_without_centres_the_heading_is_known(part, logs):
    bare = [{name: log[name] for name in ("time", "u", "psi")} for log in logs]
    answer = part.locate(log=[rollfix.read_log(one) for one in bare], roll="all", finger=rollfix.Disk(0.2), noise={"contact": 0.005, "angle": 0.003})
    assert answer.place == "unknown"
    assert np.isnan(answer.poses[0, :2]).all()
    assert answer.poses[0, 2] == pytest.approx(0.5, abs=0.3)


def test_an_answer_can_be_pickled(found):
    assert pickle.loads(pickle.dumps(found)) == found


def test_what_is_of_one_roll_is_refused(part, logs):
    with pytest.raises(rollfix.InputError, match="at: roll='all' takes rows all along every roll"):
        part.locate(log=logs, roll="all", at=[1.0], finger=rollfix.Disk(0.2))
    with pytest.raises(rollfix.InputError, match="roll='all'"):
        part.locate(log=logs[0], touches=[(1, 2)], finger=rollfix.Disk(0.2), noise=NOISE)
    with pytest.raises(rollfix.InputError, match="'all', found 'every'"):
        part.locate(log=logs[0], roll="every", finger=rollfix.Disk(0.2))
