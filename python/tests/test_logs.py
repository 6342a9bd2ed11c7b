"""Logs by whatever name, in whatever unit, from whatever holds them: the same answer, or a clear refusal."""

import numpy as np
import pytest

import rollfix
from rollfix import Disk, InputError, Noise

pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def expected(ask, roll_csv):
    return ask(roll_csv)


def test_a_frame_is_the_file_to_the_bit(ask, frame, expected):
    assert ask(frame) == expected
    assert ask(frame).to_dict() == expected.to_dict()


def test_dicts_structured_arrays_arrays_and_logs_are_the_same(ask, frame, expected, roll_csv):
    assert ask({name: frame[name].to_numpy() for name in frame}) == expected
    assert ask({name: list(frame[name]) for name in frame}) == expected
    assert ask(frame.to_records(index=False)) == expected
    assert ask(frame.to_numpy(), columns=tuple(frame.columns)) == expected
    assert ask(rollfix.read_log(roll_csv)) == expected
    assert ask(str(roll_csv)) == expected


def renamed(frame):
    return pandas.DataFrame({"stamp": frame.time * 1000, "joint_4": np.degrees(frame.u), "yaw": np.degrees(frame.psi),
                             "label": ["a"] * len(frame), "x_mm": frame.x, "y_mm": frame.y})


@pytest.mark.parametrize("options", [
    dict(columns={"u": "joint_4", "psi": "yaw", "time": "stamp"}, units={"time": "ms"}, degrees=True),
    dict(columns={"u": ("joint_4", "deg"), "psi": ("yaw", "deg"), "time": ("stamp", "ms")}),
    dict(columns={"u": "joint_4", "psi": "yaw", "time": "stamp"}, units={"time": "ms", "u": "deg", "psi": "degrees"}),
    dict(columns="u=joint_4:deg,psi=yaw:deg,time=stamp:ms"),
])
def test_other_names_degrees_and_milliseconds(ask, frame, expected, options):
    answer = ask(renamed(frame), **options)
    np.testing.assert_allclose(answer.starts, expected.starts, rtol=1e-9)
    np.testing.assert_allclose(answer.log["time"], frame.time, rtol=1e-12)


def test_a_unit_in_brackets_is_read(ask, frame, expected):
    log = pandas.DataFrame({"u [deg]": np.degrees(frame.u), "psi (deg)": np.degrees(frame.psi), "time [ms]": 1000 * frame.time})
    np.testing.assert_allclose(ask(log).starts, ask(frame[["time", "u", "psi"]]).starts, rtol=1e-9)


def test_a_clock_says_its_unit(ask, frame):
    stamps = pandas.to_datetime("2026-01-01") + pandas.to_timedelta(frame.time, unit="s")
    np.testing.assert_allclose(ask(frame.assign(time=stamps)).log["time"], frame.time - frame.time[0], atol=1e-6)


def test_names_with_commas_quotes_and_marks_do_no_harm(ask, frame, expected):
    log = frame.rename(columns={"u": 'u, "the angle" #1', "psi": "psi;\tyaw"})
    np.testing.assert_array_equal(ask(log, columns={"u": 'u, "the angle" #1', "psi": "psi;\tyaw"}).starts, expected.starts)


def test_a_name_that_sounds_like_a_unit_is_not_guessed(ask, frame):
    with pytest.raises(InputError, match="psi_deg|u_deg|deg"):
        ask(frame.rename(columns={"u": "u_deg"}), columns={"u": "u_deg"})


def test_rows_without_contact_may_hold_anything(ask, frame, expected):
    before = pandas.DataFrame({name: [np.nan] for name in frame}).assign(time=-1.0)
    log = pandas.concat([before, frame], ignore_index=True).assign(contact=[0] + [1] * len(frame))
    np.testing.assert_array_equal(ask(log).starts, expected.starts)


def test_of_several_rolls_one_is_chosen_or_told(ask, frame):
    log = pandas.concat([frame, frame.iloc[:1], frame], ignore_index=True)
    log["time"] = np.arange(len(log)) * 0.5
    log["contact"] = [1] * len(frame) + [0] + [1] * len(frame)
    with pytest.warns(rollfix.RollfixWarning, match="roll 2 of 2"):
        last = ask(log)
    assert last.starts.tobytes() == ask(log, roll=2).starts.tobytes()
    with pytest.raises(InputError, match="^roll"):
        ask(log, roll=3)


def test_two_fingers_side_by_side_and_apart(tmp_path):
    cam = rollfix.Part.gallery("cam")
    fingers = (Disk(0.2), Disk(0.2))
    roll = cam.simulate(fingers, start=(1, 4), length=(1.5, -0.8))
    both = roll.log.to_frame()
    answer = cam.locate(log=roll, finger=fingers)
    assert cam.locate(log=both, finger=Disk(0.2)).starts.tobytes() == answer.starts.tobytes()
    parts = [both[["time"] + [name for name in both if name.endswith(end)]].rename(columns=lambda n, e=end: n.replace(e, ""))
             for end in ("_a", "_b")]
    assert cam.locate(log=tuple(parts), finger=Disk(0.2)).starts.tobytes() == answer.starts.tobytes()
    files = [tmp_path / "a.csv", tmp_path / "b.csv"]
    for part, file in zip(parts, files):
        part.to_csv(file, index=False)
    assert cam.locate(log=files, finger=Disk(0.2)).starts.tobytes() == answer.starts.tobytes()
    renamed = (parts[0].rename(columns={"u": "left"}), parts[1].rename(columns={"u": "right"}))
    again = cam.locate(log=renamed, finger=Disk(0.2), columns={"u_a": "left", "u_b": "right"})
    assert again.starts.tobytes() == answer.starts.tobytes()


def test_a_saved_log_comes_back_to_the_bit(tmp_path, ellipse):
    roll = ellipse.simulate(Disk(0.2), start=1, length=2, noise=Noise(contact=0.01))
    roll.log.save(tmp_path / "roll.csv")
    back = rollfix.read_log(tmp_path / "roll.csv")
    assert all(back[name].tobytes() == roll.log[name].tobytes() for name in roll.log)
    assert len(back) == 101 and set(back.columns) == {"time", "u", "psi", "x", "y"}


@pytest.mark.parametrize("change, options, message", [
    (lambda f: f.drop(columns="u"), {}, "'u'|u and|joint"),
    (lambda f: f.assign(u=np.nan), {}, "^log: row 0: u is 'nan'"),
    (lambda f: f.assign(u=np.where(f.index == 7, np.inf, f.u)), {}, "^log: row 7: u"),
    (lambda f: f.assign(time=f.time[::-1].to_numpy()), {}, "^log: row 1: .*time|^log: row"),
    (lambda f: f.assign(u=f.u.astype(str) + "x"), {}, "^log: row 0: u is '.*x', expected a number$"),
    (lambda f: f.iloc[:0], {}, "log"),
    (lambda f: f.iloc[:1], {}, "log"),
    (lambda f: f.to_numpy(), {}, "`columns`"),
    (lambda f: f.to_numpy(), dict(columns=("time", "u")), "shape"),
    (lambda f: {"u": [1, 2], "psi": [1]}, {}, "length"),
    (lambda f: f, dict(columns={"w": "u"}), "columns"),
    (lambda f: f, dict(columns={"u": "nowhere"}), "nowhere"),
    (lambda f: f, dict(units={"u": "furlong"}), "furlong"),
    (lambda f: f, dict(units={"time": "deg"}), "time"),
    (lambda f: f, dict(units={"psi": 3}), "units"),
    (lambda f: f, dict(turn=0.1), "turn"),
    (lambda f: f, dict(direction="up"), "direction"),
    (lambda f: f, dict(direction="cw"), "direction"),
    (lambda f: f, dict(at=[99.0]), "`at`|99"),
    (lambda f: f, dict(at=["x"]), "at"),
    (lambda f: 3, {}, "^log"),
    (lambda f: None, {}, "readings"),
    (lambda f: "nowhere.csv", {}, "nowhere.csv"),
])
def test_what_can_not_be_meant_is_a_sentence(wing, noise, frame, change, options, message):
    with pytest.raises(InputError, match=message) as caught:
        wing.locate(log=change(frame), finger=Disk(10), noise=noise, **options)
    assert isinstance(caught.value, ValueError) and "\n" not in str(caught.value)


@pytest.mark.parametrize("call, message", [
    (lambda p: p.locate(), "readings"),
    (lambda p: p.locate(1.0), "^readings"),
    (lambda p: p.locate(np.nan, 1.0), "nan"),
    (lambda p: p.locate(1, np.inf), "^readings"),
    (lambda p: p.locate([[1, 2, 3, 4]]), "^readings.*shape"),
    (lambda p: p.locate([[[1, 2]]]), "^readings.*shape"),
    (lambda p: p.locate(np.empty((0, 2))), "^readings"),
    (lambda p: p.locate([[1, 2], [3]]), "^readings"),
    (lambda p: p.locate([[1j, 2]]), "^readings"),
    (lambda p: p.locate([["a", "b"]]), "^readings"),
    (lambda p: p.locate("a", "b"), "^length"),
    (lambda p: p.locate([1.0, 2.0], [1.0]), "^turn"),
    (lambda p: p.locate([[1, 2, 3]]), "two readings|second reading"),
    (lambda p: p.locate(1, 1, tolerance=-1), "^tolerance"),
    (lambda p: p.locate(1, 1, tolerance="x"), "^tolerance"),
    (lambda p: p.locate(1, 1, budget=0), "^budget"),
    (lambda p: p.locate(1, 1, finger=0.2), "^finger"),
    (lambda p: p.locate(1, 1, finger=[Disk(1)] * 3), "^finger"),
    (lambda p: p.locate(1, 1, noise=0.1), "^noise"),
    (lambda p: p.locate(1, 1, noise={"contakt": 1}), "^noise"),
    (lambda p: p.locate(1, 1, prior=(1, 1)), "prior"),
    (lambda p: p.locate(1, 1, prior=3, noise=dict(angle=.1)), "^prior"),
    (lambda p: p.locate(1, 1, facing=1.0), "facing"),
    (lambda p: p.locate(1, 1, at=[1]), "^at"),
    (lambda p: p.locate(1, 1, degrees=True), "^degrees"),
    (lambda p: p.locate(1, 1, log={"length": [1.0], "turn": [0.6]}), "expected readings or a log, found both"),
    (lambda p: p.locate(1, 1, heading=(1, 0), noise=dict(angle=.1)), "^heading"),
    (lambda p: p.locate(1, 1, pose=(1, 2, 3), noise=dict(angle=.1)), "^pose"),
    (lambda p: p.simulate(Disk(0.1), start=0), "`|length|expected"),
    (lambda p: p.simulate(Disk(0.1), start="x", length=1), "^start"),
    (lambda p: p.simulate((Disk(0.1), Disk(0.1)), start=1, length=1), "^start"),
    (lambda p: p.simulate(start=1), "^length"),
    (lambda p: p.advise(1.0, 0.5, travel=-1), "^travel"),
    (lambda p: p.advise(1.0, 0.5, travel=(1, 2)), "^travel"),
    (lambda p: p.locate_many([1, 2]), "^readings"),
    (lambda p: p.locate_many(np.ones((3, 2)), threads=-1), "^threads"),
    (lambda p: p.locate_many(np.ones((3, 3)), facing=[1, 2]), "facing|broadcast"),
    (lambda p: Disk(0), "^radius"),
    (lambda p: Disk("x"), "^radius"),
    (lambda p: Noise(angle=-1), "^noise"),
    (lambda p: Noise(angle=np.nan), "^noise"),
    (lambda p: rollfix.OutlineFinger(rollfix.Part.gallery("gear")), "concave|corner"),
    (lambda p: rollfix.Part(3), "^source"),
    (lambda p: rollfix.Part("x.xyz"), "xyz"),
    (lambda p: rollfix.Part.gallery("ellipse", a=-1), "a"),
    (lambda p: p.reach(None), "^finger"),
])
def test_wrong_arguments_are_named(ellipse, call, message):
    with pytest.raises(InputError, match=message):
        call(ellipse)


NOISE = Noise(contact=0.002, angle=0.002, slip=0.002)


def logs_of_every_kind():
    ellipse = rollfix.Part.gallery("ellipse", a=2, b=1)
    roll = ellipse.simulate(Disk(0.2), start=1.0, length=2.0, samples=60, noise=NOISE, seed=4).log
    drive = ellipse.simulate(start=2.0, length=3.0, samples=200, noise=NOISE, seed=4).log
    pair = rollfix.read_log({"distance_a": [0.1, 0.3], "dturn_a": [0.1, 0.2], "distance_b": [0.7, -0.6999], "dturn_b": [0.1, 0.25]})
    travelled = rollfix.read_log({"time": [0.0, 1.0], "length": [0.5, 1.0], "turn": [0.1, 0.7]})
    return {"contact": roll, "increments": drive, "increments of two fingers": pair, "travelled": travelled}


@pytest.mark.parametrize("way", ["save", "to_frame", "to_dict"])
@pytest.mark.parametrize("kind", list(logs_of_every_kind()))
def test_a_log_keeps_its_kind_and_its_bits_through_every_format(tmp_path, kind, way):
    log = logs_of_every_kind()[kind]
    log.save(tmp_path / "log.csv")
    again = rollfix.read_log({"save": tmp_path / "log.csv"}.get(way) or getattr(log, way)())
    assert again.kind == log.kind == kind.split()[0] and again.columns == log.columns
    sums = ["length" + end for end in ("", "_a", "_b") if "distance" + end in log.columns]
    for column in (*log.columns, *sums):
        assert again[column].tobytes() == log[column].tobytes()


def test_increments_that_were_saved_are_weighed_as_before():
    drive = logs_of_every_kind()["increments"]
    ellipse = rollfix.Part.gallery("ellipse", a=2, b=1)
    for again in (drive.to_frame(), drive.to_dict()):
        answer = ellipse.locate(log=again, noise=NOISE)
        assert answer.to_dict()["placements"] == ellipse.locate(log=drive, noise=NOISE).to_dict()["placements"]


COARSE = {"u": [0.0, -4.0, -5.0], "psi": [0.0, 4.5, 5.7]}


def test_rows_that_are_far_apart_are_asked_about_and_what_is_said_is_done():
    circle = rollfix.Part.gallery("circle", r=2)
    with pytest.raises(InputError, match=r"row 1: u goes from 0 to -4 in one row.* say it with wrapped=False, or wrapped=True"):
        circle.locate(log=COARSE, finger=Disk(0.3))
    unwrapped = circle.locate(log=COARSE, finger=Disk(0.3), wrapped=False)
    np.testing.assert_allclose(unwrapped.readings[-1], [1.5, 0.7])
    wrapped = circle.locate(log=COARSE, finger=Disk(0.3), wrapped=True)
    np.testing.assert_allclose(wrapped.readings[-1], [0.3 * (5 - 2 * np.pi), 0.7])
    one = circle.locate(log=COARSE, finger=Disk(0.3), units={"u": "unwrapped", "psi": "rad:unwrapped"})
    np.testing.assert_allclose(one.readings, unwrapped.readings)
    with pytest.raises(InputError, match="^wrapped: expected True or False, found 'no'"):
        circle.locate(log=COARSE, finger=Disk(0.3), wrapped="no")


def test_a_log_in_one_unit_on_a_part_in_another_is_converted(tmp_path):
    xy = 20 * np.stack([np.cos(np.arange(40) * np.pi / 20), 0.5 * np.sin(np.arange(40) * np.pi / 20)], axis=1)
    in_mm, in_cm = rollfix.Part.from_points(xy, unit="mm"), rollfix.Part.from_points(xy / 10, unit="cm")
    log = rollfix.read_log({"length [mm]": [10.0], "turn": [0.625]}, unit="mm")
    expected = in_mm.locate(log=log)
    found = in_cm.locate(log=log)
    assert len(found) == len(expected) > 0
    np.testing.assert_allclose(found.starts * 10, expected.starts, rtol=1e-9)
    assert found.log["length"][0] == pytest.approx(1.0)
    roll = in_mm.simulate(Disk(2), start=1.0, length=30.0, samples=20)
    starts = in_cm.locate(log=roll, finger=Disk(0.2)).starts
    assert np.min(in_cm.distance(starts[:, 0], 0.1)) < 1e-6


def test_two_files_are_read_in_degrees_as_one_is(tmp_path):
    for name in "ab":
        (tmp_path / name).write_text("u,psi\n0,0\n10,-10\n")
    log = rollfix.read_log((tmp_path / "a", tmp_path / "b"), degrees=True)
    np.testing.assert_allclose(log["u_b"], [0, np.radians(10)])


def test_rows_that_can_not_be_read_are_skipped_where_that_is_asked(tmp_path):
    rows = {"time": [0.0, 1.0, 1.0, 2.0, 3.0], "u": [0.0, -0.1, -0.1, np.nan, -0.3], "psi": [0.0, 0.15, 0.15, 0.3, 0.45]}
    with pytest.raises(InputError, match=r"row 2: time is '1', .*; read_log\(..., bad='skip'\) leaves such rows out"):
        rollfix.read_log(rows)
    with pytest.warns(rollfix.RollfixWarning, match="^log: 2 rows were left out, the first: log: row 2: time"):
        log = rollfix.read_log(rows, bad="skip")
    np.testing.assert_array_equal(log["time"], [0, 1, 3])
    assert len(log.notes) == 1 and log.notes[0].startswith("log: 2 rows were left out")
    with pytest.raises(InputError, match="^bad: expected 'refuse' or 'skip', found 'drop'"):
        rollfix.read_log(rows, bad="drop")


def test_decimal_commas_are_read_when_it_is_said(tmp_path, frame):
    file = tmp_path / "roll.txt"
    rows = "\n".join(f"{u!r}\t{psi!r}".replace(".", ",") for u, psi in zip(frame.u, frame.psi))
    file.write_text("u\tpsi\n" + rows + "\n")
    with pytest.raises(InputError, match="decimal=','"):
        rollfix.read_log(file)
    log = rollfix.read_log(file, decimal=",")
    np.testing.assert_array_equal(log["u"], frame.u)
    with pytest.raises(InputError, match="^decimal: expected '.' or ',', found ';'"):
        rollfix.read_log(file, decimal=";")
    points = tmp_path / "square.txt"
    points.write_text("0,0 0,0\n1,5 0,0\n1,5 1,5\n0,0 1,5\n")
    assert rollfix.Part(points, decimal=",").perimeter == 6


def test_decimal_commas_in_the_texts_of_a_frame_are_read_when_it_is_said(frame):
    texts = frame[["u", "psi"]].map if hasattr(frame, "map") else frame[["u", "psi"]].applymap
    commas = texts(lambda value: repr(value).replace(".", ","))
    with pytest.raises(InputError, match=r"decimal=','\) takes commas"):
        rollfix.read_log(commas)
    np.testing.assert_array_equal(rollfix.read_log(commas, decimal=",")["u"], frame.u)


def test_another_finger_in_the_log_is_told(ask, frame):
    both = frame.assign(u_b=frame.u, psi_b=frame.psi)
    with pytest.warns(UserWarning, match="u_b"):
        log = rollfix.read_log(both)
    assert len(log.notes) == 1 and "u_b" in log.notes[0]
