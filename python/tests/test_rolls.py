"""Simulated, watched and taught rolls, and the next one: what the program says."""

import io
import pickle
import subprocess

import numpy as np
import pytest

import rollfix
from rollfix import Disk, Jaw, Noise


def lines_of(program, words):
    return subprocess.run([program.path, *map(str, words)], check=True, capture_output=True, text=True).stdout


@pytest.mark.parametrize("seed", [0, 7])
def test_a_simulated_roll_is_that_of_the_program(ellipse, program, seed, tmp_path):
    noise = Noise(contact=0.01, angle=0.02, slip=0.01)
    roll = ellipse.simulate(Disk(0.2), start=1, length=2, samples=31, noise=noise, seed=seed)
    text = lines_of(program, ["simulate", ellipse.name, "--finger", "disk,r=0.2", "--start", 1, "--length", 2, "--samples", 31,
                              "--noise", "contact=0.01,angle=0.02,slip=0.01", "--seed", seed])
    roll.log.save(tmp_path / "roll.csv")
    assert (tmp_path / "roll.csv").read_text() == text
    assert roll.s[0][0] == 1 and roll.s[0][-1] == pytest.approx(3, abs=0.2)


def test_two_simulated_fingers_are_those_of_the_program(program, tmp_path):
    cam = rollfix.Part.gallery("cam")
    roll = cam.simulate((Disk(0.2), Disk(0.1)), start=(1, 4), length=(1.5, -0.8), part_rotation=0.3)
    text = lines_of(program, ["simulate", "gallery:cam", "--finger", "disk,r=0.2", "--finger", "disk,r=0.1", "--start", 1,
                              "--start", 4, "--length", 1.5, "--length", -0.8, "--part-rotation", 0.3])
    roll.log.save(tmp_path / "roll.csv")
    assert (tmp_path / "roll.csv").read_text() == text
    assert roll.pose.shape == (101, 3)


def test_a_jaw_and_a_disk_are_those_of_the_program_and_found_again(program, tmp_path):
    cam = rollfix.Part.gallery("cam")
    roll = cam.simulate((Jaw(), Disk(0.3)), start=(1, 4), length=(1, 2), contact=(0.2, 0.3))
    text = lines_of(program, ["simulate", "gallery:cam", "--finger", "jaw", "--finger", "disk,r=0.3", "--start", 1, "--start", 4,
                              "--length", 1, "--length", 2, "--contact", 0.2, "--contact-angle", 0.3])
    roll.log.save(tmp_path / "roll.csv")
    assert (tmp_path / "roll.csv").read_text() == text
    np.testing.assert_allclose(cam.locate(log=roll, finger=(Jaw(), Disk(0.3))).starts, [[1, 4]], atol=1e-8)


@pytest.mark.parametrize("wheel", ["skin", "encoder", "pin"])
def test_a_jaw_and_a_wheel_on_a_pin_are_those_of_the_program(ellipse, program, wheel, tmp_path):
    noise = Noise(contact=0.001, angle=0.002, slip=0.01, radius=0.01, position=0.01)
    roll = ellipse.simulate((Jaw(), Disk(0.4)), start=(2.4, 6.3), pin=(-0.4, -0.15), jaw_rotation=0.3, wheel=wheel,
                            noise=noise, seed=5)
    text = lines_of(program, ["simulate", ellipse.name, "--finger", "jaw", "--finger", "wheel,r=0.4", "--start", 2.4, "--start",
                              6.3, "--pin", "-0.4,-0.15", "--jaw-rotation", 0.3, "--wheel", wheel, "--seed", 5, "--noise",
                              "contact=0.001,angle=0.002,slip=0.01,radius=0.01,position=0.01"])
    roll.log.save(tmp_path / "roll.csv")
    assert (tmp_path / "roll.csv").read_text() == text


def test_a_squeezed_wheel_starts_where_it_can_be_squeezed(ellipse):
    roll = ellipse.simulate((Jaw(), Disk(0.4)), start=2.4, pin=0.2, squeeze=True)
    assert roll.s[1][0] == pytest.approx(7.310565, abs=1e-6)
    assert ellipse.simulate((Jaw(), Disk(0.4)), start=(2.4, 7.3), pin=0.2, squeeze=True) == roll
    with pytest.raises(rollfix.InputError, match="can't be squeezed at 5.8, expected a place near s = 7.31"):
        ellipse.simulate((Jaw(), Disk(0.4)), start=(2.4, 5.8), pin=0.2, squeeze=True)


@pytest.mark.parametrize(
    "given, why",
    [
        ({"start": (2.4, 6.3), "pin": (1, 2), "length": (1, 2)}, "leave length, rotation and part_rotation out"),
        ({"start": (2.4, 6.3), "pin": 1}, r"expected \(dx, dy\) in the jaw's frame"),
        ({"start": (2.4, 6.3), "pin": (0.1, 0), "wheel": "rim"}, "expected 'skin', 'encoder' or 'pin'"),
        ({"start": (2.4, 6.3), "squeeze": True}, "pin: expected how far"),
        ({"start": (2.4, 5.8), "pin": (0.4, -0.1)}, "the wheel's normal passes through the jaw's contact"),
    ],
)
def test_what_is_no_rig_is_refused(ellipse, given, why):
    with pytest.raises(rollfix.InputError, match=why):
        ellipse.simulate((Jaw(), Disk(0.4)), **given)


def test_a_simulated_roll_is_found_again(ellipse):
    roll = ellipse.simulate(Disk(0.2), start=1.0, length=2.0)
    answer = ellipse.locate(log=roll, finger=Disk(0.2))
    assert min(abs(answer.starts[:, 0] - 1.0)) < 1e-8
    # Of a disk L = -r (u1 - u0), theta = (u1 - u0) + (psi1 - psi0).
    du, dpsi = np.diff(roll.log["u"][[0, -1]])[0], np.diff(roll.log["psi"][[0, -1]])[0]
    np.testing.assert_allclose(answer.readings, [[-0.2 * du, du + dpsi]], atol=1e-9)


def test_a_wheel_with_a_gyroscope_drives(ellipse):
    noise = Noise(contact=0.002, angle=0.002, slip=0.002)
    drive = ellipse.simulate(start=2.0, length=3.0, samples=200, noise=noise, seed=4)
    assert drive.log.kind == "increments" and drive.log.columns == ("distance", "dturn")
    answer = ellipse.locate(log=drive, noise=noise)
    assert any(one.interval[0, 0] - 0.1 <= 2.0 <= one.interval[0, 1] + 0.1 for one in answer)


def test_advice_is_that_of_the_program(program):
    limacon = rollfix.Part.gallery("limacon")
    words = ["--reading", "0.9,0.526", "--tolerance", "1e-9", "--finger", "disk,r=0.1", "--travel", "-1,1.5", "--json"]
    advice = limacon.advise(0.9, 0.526, finger=Disk(0.1), travel=(-1, 1.5), tolerance=1e-9, rounding=(0.0005, 0))
    assert advice.to_dict() == program("advise", "gallery:limacon", *words)
    assert advice.helps and advice.length == advice.to_dict()["length"] and advice._repr_svg_()
    answer = limacon.locate(0.9, 0.526, finger=Disk(0.1), tolerance=1e-9, rounding=(0.0005, 0))
    assert answer.advise((-1, 1.5)) == advice == answer.advise(travel=(-1, 1.5))
    assert answer.advise(1.5) == answer.advise((-1.5, 1.5)) != answer.advise((0, 1.5))


def test_where_nothing_helps_it_says_why(ellipse):
    advice = rollfix.Part.gallery("circle").advise(1.0, 1.0)
    assert not advice.helps and "looks the same" in advice.why
    assert ellipse.advise(1.0, 3.0).why.startswith("nothing fits")


def test_a_taught_part_is_that_of_the_program(ellipse, program, tmp_path):
    roll = ellipse.simulate(Disk(0.2), start=0, length=9.75, samples=400)
    file = tmp_path / "around.csv"
    roll.log.save(file)
    taught = rollfix.teach(str(file), Disk(0.2))
    assert taught.to_dict() == program("teach", file, "--finger", "disk,r=0.2", "--json")
    assert taught.part.perimeter == pytest.approx(ellipse.perimeter, rel=1e-4) and taught.notes
    assert rollfix.teach(roll.log.to_frame(), Disk(0.2)).taught == taught.taught


WATCHED = dict(finger=Disk(10), noise=Noise(contact=0.05, angle=0.006, slip=0.004))


def without_clock(events):
    return [{name: value for name, value in event.items() if name not in ("seconds_per_sample", "log")} for event in events]


@pytest.fixture
def printed(wing, roll_csv, program):
    events = program("watch", wing.name, "--log", roll_csv, "--finger", "disk,r=10", "--noise",
                     "contact=0.05,angle=0.006,slip=0.004", "--once", "--jsonl", lines=True)
    return without_clock(events)


def test_watching_says_what_the_program_prints(wing, roll_csv, printed):
    with open(roll_csv) as file:
        watch = wing.watch(**WATCHED)
        assert without_clock(watch.follow(file)) == printed
    assert watch.verdict == printed[-1]["verdict"] and watch.placements == printed[-2]["placements"]


@pytest.mark.parametrize("size", [1, 5, 1000])
def test_rows_come_in_pieces_of_any_size(wing, roll_csv, printed, size):
    pandas = pytest.importorskip("pandas")
    frame = pandas.read_csv(roll_csv, comment="#")
    watch = rollfix.Watch(wing, **WATCHED)
    events = [event for k in range(0, len(frame), size) for event in watch.add(frame.iloc[k : k + size])] + watch.finish()

    def what(one):
        return [(event["event"], event.get("verdict"), event.get("placements")) for event in one]

    assert what(events) == what(printed)


def test_rows_are_mappings_and_arrays_as_well(wing, roll_csv):
    log = rollfix.read_log(roll_csv).to_dict()
    rows = [{name: log[name][k] for name in log} for k in range(len(log["u"]))]
    by_name, by_place = wing.watch(**WATCHED), wing.watch(columns=("time", "u", "psi"), **WATCHED)
    for row in rows:
        by_name.add(row)
        by_place.add([row["time"], row["u"], row["psi"]])
    by_name.finish(), by_place.finish()
    assert by_name.verdict and by_place.verdict
    assert by_name.placements[0]["start"] == by_place.placements[0]["start"]


def test_a_live_source_ends_the_watch(wing, roll_csv):
    source = io.BytesIO(roll_csv.read_bytes())
    with wing.watch(live=True, **WATCHED) as watch:
        events = list(watch.follow(source))
    assert events[0]["event"] == "begin" and events[-1]["event"] == "end"
    with pytest.raises(rollfix.InputError, match="over"):
        watch.add("1,2,3")


def test_what_can_not_be_read_is_skipped_with_a_warning(wing, roll_csv):
    lines = roll_csv.read_text().splitlines()
    lines.insert(12, "nonsense,1,2")
    watch = wing.watch(**WATCHED)
    with pytest.warns(rollfix.RollfixWarning, match="nonsense"):
        watch.add("\n".join(lines))
    assert watch.finish()[-1]["counts"]["malformed"] == 1


@pytest.mark.parametrize("rows", [3.0, {"u": [1, 2], "psi": [1]}, [1, 2], {"v": 1.0}])
def test_rows_that_are_none_are_refused(wing, rows):
    with pytest.raises(rollfix.InputError):
        wing.watch(**WATCHED).add(rows)


def test_lengths_may_count_either_way_round(ellipse):
    part = rollfix.Part.gallery("spline,n=9,seed=7,wobble=0.2")
    length, turn = 0.9977, 0.9936
    both = part.locate(length, turn, direction="either", tolerance=1e-9)
    ways = {"ccw": part.locate(length, turn, tolerance=1e-9), "cw": part.locate(length, turn, direction="cw", tolerance=1e-9)}
    for way, alone in ways.items():
        found = [one.start[0] for one in both if one.direction == way]
        np.testing.assert_allclose(sorted(found), sorted(alone.starts[:, 0]))
    assert ways["ccw"][0].direction is None
    with pytest.raises(rollfix.InputError, match="^direction"):
        ellipse.locate(log=ellipse.simulate(Disk(0.2), start=1, length=1), finger=Disk(0.2), direction="either")


def test_a_square_fingertip_pivots_on_its_corners():
    cam = rollfix.Part.gallery("cam")
    tip = rollfix.OutlineFinger(rollfix.Part.from_points([(0, 0), (0.2, 0), (0.2, 0.4), (-0.2, 0.4), (-0.2, 0)]))
    roll = cam.simulate(tip, start=2, length=1.2, samples=101)
    answer = cam.locate(log=roll, finger=tip)
    assert min(abs(place.start[0] - 2) for place in answer) < 1e-6
    assert any("on a corner of the finger" in note for note in answer.notes)
    assert answer.pivots.tolist() == [0]
    assert np.array_equal(pickle.loads(pickle.dumps(answer)).pivots, answer.pivots)
