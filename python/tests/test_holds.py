"""Three fingers on a part that moves, as Python takes them."""

import pickle

import numpy as np
import pytest

import rollfix

DISK = rollfix.Disk(0.1)
NOISE = {"contact": 0.01, "angle": 0.005, "position": 0.01}


@pytest.fixture(scope="module")
def part():
    return rollfix.Part("gallery:spline,n=9,seed=4,wobble=0.25")


@pytest.fixture(scope="module")
def logs(part):
    """From s = 1, 3 and 5: the third is simulated with the first one again."""
    tables = {}
    for name, start, length in (("b", 3, -0.4), ("c", 5, 0.3)):
        roll = part.simulate((DISK, DISK), start=(1, start), length=(0.6, length), part_rotation=0.3, samples=30)
        columns = roll.log.to_dict()
        for finger, one in (("a", "a"), ("b", name)):
            tables[one] = {key: columns[f"{key}_{finger}"] for key in ("u", "psi", "x", "y")}
            tables[one]["time"] = columns["time"]
    return [tables[name] for name in "abc"]


@pytest.fixture(scope="module")
def found(part, logs):
    return part.locate(log=logs, finger=DISK)


def test_all_fingers_are_found(found):
    assert found.verdict == "unique"
    assert found.starts == pytest.approx(np.array([[1, 3, 5]]), abs=1e-6)
    assert found.ends == pytest.approx(np.array([[1.6, 2.6, 5.3]]), abs=1e-6)
    assert found.poses.shape == (1, 2, 3)
    assert found.poses[0, 1, 2] - found.poses[0, 0, 2] == pytest.approx(0.3, abs=1e-6)


def test_logs_may_be_files_and_fingers_one_for_each(part, logs, found, tmp_path):
    files = []
    for number, table in enumerate(logs):
        files.append(tmp_path / f"{number}.csv")
        rows = np.column_stack(list(table.values()))
        np.savetxt(files[-1], rows, delimiter=",", header=",".join(table), comments="", fmt="%.17g")
    again = part.locate(log=files, finger=[DISK] * 3)
    assert again.starts == pytest.approx(found.starts, abs=1e-9)


def test_with_noise_there_are_probabilities(part, logs):
    answer = part.locate(log=logs, finger=DISK, noise=NOISE)
    assert answer.placements[0]["probability"] > 0.99
    assert len(answer.placements[0]["sd"]) == 3


def test_placements_are_a_table(part, logs, found):
    pytest.importorskip("pandas")
    frame = found.to_frame()
    assert np.allclose(frame[["start_a", "start_b", "start_c"]], found.starts)
    assert np.allclose(frame[["last_x", "last_y", "last_heading"]], found.poses[:, 1])
    noisy = part.locate(log=logs, finger=DISK, noise=NOISE).to_frame()
    assert {"probability", "sd_a", "end_sd_c"} <= set(noisy.columns)


def test_it_is_pickled_and_drawn(found, tmp_path):
    assert pickle.loads(pickle.dumps(found)).verdict == "unique"
    found.save(tmp_path / "hold.svg")
    assert "3 fingers" in (tmp_path / "hold.svg").read_text()


@pytest.mark.parametrize(
    "options, words",
    [
        ({}, "expected `finger`, once for all or once for each"),
        ({"finger": [DISK] * 2}, "3, one for each log"),
        ({"finger": DISK, "robust": True}, "robust"),
        ({"finger": DISK, "noise": NOISE, "tolerance": 0.1}, "tolerance"),
    ],
)
def test_what_is_not_taken_is_refused(part, logs, options, words):
    with pytest.raises(rollfix.InputError, match=words):
        part.locate(log=logs, **options)


@pytest.fixture(scope="module")
def rig(part):
    """A jaw and a wheel at three instants, on a cam: where they touch, and the part's pose, are as told."""
    cam = rollfix.Part.gallery("cam")
    jaw = {"u": [], "psi": [], "x": [], "y": []}
    pin = {"x": [], "y": []}
    for s, t, x, y, heading in ((1.0, 5.0, 0.2, 0.1, 0.4), (1.4, 5.5, 0.3, 0.1, 0.2), (1.7, 5.6, 0.4, 0.2, 0.1)):
        turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        tangents = [float(cam.tangent(place)) for place in (s, t)]
        psi = heading + tangents[0] + np.pi
        origin = turn @ np.asarray(cam.point(s)) + (x, y) - (1 - s) * np.array([np.cos(psi), np.sin(psi)])
        normal = np.array([np.sin(tangents[1]), -np.cos(tangents[1])])
        centre = turn @ (np.asarray(cam.point(t)) + 0.3 * normal) + (x, y)
        for key, value in zip(jaw, (1 - s, psi, *origin)):
            jaw[key].append(value)
        for key, value in zip(pin, centre):
            pin[key].append(value)
    return cam, jaw, pin


def test_a_wheel_without_skin_has_its_pins_place(rig):
    cam, jaw, pin = rig
    found = cam.locate(log=[jaw, pin], finger=[rollfix.Jaw(), rollfix.Wheel(0.3)])
    assert found.starts == pytest.approx(np.array([[1, 5]]), abs=1e-5)
    assert pickle.loads(pickle.dumps(found)).starts == pytest.approx(found.starts)


def test_an_answer_has_a_certificate(rig, tmp_path):
    cam, jaw, pin = rig
    found = cam.locate(log=[jaw, pin], finger=[rollfix.Jaw(), rollfix.Wheel(0.3)])
    certificate = found.certify(tmp_path / "proof.json")
    assert certificate["schema"] == "rollfix/hold-certificate/1" and (tmp_path / "proof.json").exists()
    assert [one["listed"] for one in certificate["sets"]] == [True]


def test_a_wheel_alone_or_first_is_refused(rig):
    cam, jaw, pin = rig
    for finger in (rollfix.Wheel(0.3), [rollfix.Wheel(0.3), rollfix.Jaw()]):
        with pytest.raises(rollfix.InputError, match="fingers with skin first"):
            cam.locate(log=[pin, jaw], finger=finger)
    with pytest.raises(rollfix.InputError, match="a wheel has no skin"):
        cam.locate(log=[jaw, jaw], finger=[rollfix.Jaw(), rollfix.Wheel(0.3)])
    with pytest.raises(rollfix.InputError, match="squeezed"):
        cam.locate(0.5, 0.1, squeezed=0.1)


def test_errors_of_several_fingers_name_rows_from_0_and_cures_in_python(part):
    time, u = np.arange(5.0), np.linspace(0, 0.1, 5)
    logs = [{"time": time, "u": u, "psi": k * u} for k in (1, 2, 3)]
    logs[1]["time"] = time + [0, 0, 0, 0.3, 0]
    with pytest.raises(rollfix.InputError, match=r"^row 3 of log is at the time 3 and row 3 of log at 3\.3"):
        part.locate(log=logs, finger=rollfix.Disk(0.1))
