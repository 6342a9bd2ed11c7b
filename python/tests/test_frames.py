"""What data frames and plots make of answers and logs, and two clocks."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import rollfix
from rollfix import Disk, InputError, Noise, Part

pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def answer(wing, noise, roll_csv):
    return wing.locate(log=roll_csv, finger=Disk(10), noise=noise)


def test_a_data_frame_of_an_answer_is_its_table(answer, ellipse):
    exact = ellipse.locate(1.0, 0.625)
    for one in (answer, exact):  # pandas sorts the columns
        pandas.testing.assert_frame_equal(pandas.DataFrame(one)[list(one.to_frame())], one.to_frame(), check_dtype=False)
    assert dict(exact[0])["start"] == exact.starts[0, 0] and "probability" not in dict(exact[0])


@pytest.mark.parametrize("columns", [
    {"time": [0.0, 1, 2], "u": [0.0, -0.1, -0.2], "psi": [0.0, 0.1, 0.3]},
    {"length": [0.1, 0.2, 0.3], "turn": [0.1, 0.2, 0.25]},
    {"distance": [0.1, 0.1, 0.1], "dturn": [0.1, 0.1, 0.05]},
])
def test_a_data_frame_of_a_log_is_its_columns_and_a_log_again(columns):
    log = rollfix.read_log(columns)
    frame = pandas.DataFrame(log)
    pandas.testing.assert_frame_equal(frame, log.to_frame())
    assert list(frame) == list(columns) == list(log.keys()) and dict(log).keys() == columns.keys()
    assert rollfix.read_log(frame) == log and len(log) == 3
    for change in (lambda: log.update(u=1), lambda: log.pop("u"), lambda: log.__setitem__("u", 1)):
        with pytest.raises(TypeError, match="can't be changed"):
            change()


def test_plots_take_the_keywords_of_matplotlib(answer, wing, roll_csv):
    line = wing.plot(color="red", linewidth=3).lines[0]
    assert line.get_color() == "red" and line.get_linewidth() == 3
    ax = rollfix.read_log(roll_csv).plot(linestyle="--")
    assert {line.get_linestyle() for line in ax.lines} == {"--"} and len(ax.lines) >= 2
    own = answer.plot(linewidth=7)
    assert any(line.get_linewidth() == 7 for line in own.lines)
    plt.close("all")


def test_a_name_survives_save(tmp_path, ellipse):
    part = Part.from_points(ellipse.point(np.linspace(0, ellipse.perimeter, 60, endpoint=False)), name="my cam")
    part.save(tmp_path / "part.json")
    assert Part(tmp_path / "part.json").name == "my cam" and Part(tmp_path / "part.json") == part


def test_two_clocks_make_one_log():
    cam, disk = Part.gallery("cam"), Disk(0.2)
    whole = cam.simulate((disk, disk), start=(1, 4), length=(1.5, -0.8), samples=2001).log
    columns, offset = whole.to_dict(), 5.0
    sides = []
    for end, rows, ahead in (("_a", slice(0, None, 7), 0.0), ("_b", slice(3, None, 5), offset)):
        side = {name[:-2]: column[rows] for name, column in columns.items() if name.endswith(end)}
        sides.append({"time": columns["time"][rows] + ahead, **side})
    log = rollfix.resample(*sides, offset=offset)
    assert log.fingers == 2 and abs(log["time"][0] - columns["time"][3]) < 1e-12
    found = cam.locate(log=log, finger=disk, tolerance=1e-4)
    moved = cam.distance(found.starts, np.array([[1.0, 4.0]]))
    assert moved.max(axis=1).min() < 0.01
    with pytest.raises(InputError, match="b: expected times that overlap those of a, .*offset="):
        rollfix.resample(*sides, offset=1000.0)
    with pytest.raises(InputError, match="a: expected a column of times"):
        rollfix.resample({"u": [0.0, 0.1], "psi": [0.0, 0.1]}, sides[1])


def test_degrees_of_noise_are_a_text_and_a_large_number_has_a_word():
    assert Noise(angle="0.5deg") == Noise(angle=np.radians(0.5)) == Noise(angle="0.5 °")
    assert Noise(angle="0.2rad") == Noise(angle="0.2 rad")
    with pytest.warns(rollfix.RollfixWarning, match=r"angle 0.5 is in radians, 28.6 degrees: write angle='0.5deg' or angle='0.5rad'"):
        assert Noise(angle=0.5) == Noise(angle="0.5rad")
    with pytest.raises(InputError, match="noise: angle: expected radians as a number, or a text such as '0.5deg', found 'half'"):
        Noise(angle="half")


def test_rounding_is_offered_where_radians_hide_the_digits(wing):
    turns = [float(wing.turning(150.0 + length) - wing.turning(150.0)) for length in (60.1, 70.2)]
    readings = np.stack([[60.1, 70.2], np.radians(np.round(np.degrees(turns), 1))], axis=1)
    with pytest.warns(rollfix.RollfixWarning, match="degrees with 1 decimals: rounding=") as told:
        assert wing.locate(readings).verdict == "inconsistent"
    cure = str(told[0].message).split("rounding=")[1].split(" takes")[0]
    found = wing.locate(readings, rounding=eval(cure, {"np": np}))
    assert found.verdict != "inconsistent" and abs(found.starts - 150).min() < 1


def test_what_locate_would_leave_out_is_told_by_simulate():
    cam, disk = Part.gallery("cam"), Disk(0.5)
    with pytest.warns(rollfix.RollfixWarning, match="the fingers overlap, by .* in row .*may_overlap=True"):
        roll = cam.simulate((disk, disk), start=(1.0, 1.6), length=(0.3, 0.3))
    gone = cam.locate(log=roll, finger=disk)
    kept = cam.locate(log=roll, finger=disk, may_overlap=True)
    assert gone.dropped["overlap"] >= 1 and len(kept) > len(gone)
    assert cam.distance(kept.starts, np.array([[1.0, 1.6]])).max(axis=1).min() < 1e-6
    gear, small = Part.gallery("gear"), Disk(0.12)
    lo, hi = gear.reach(small).gaps[0]  # its other side is in the way
    with pytest.warns(rollfix.RollfixWarning, match="can't do this roll: at s = "):
        gear.simulate(small, start=lo + 0.02 * (hi - lo), length=0.01 * (hi - lo))


def test_an_answer_has_a_certificate(ellipse, tmp_path):
    certificate = ellipse.locate(1.0, 0.625).certify(tmp_path / "proof.json")
    assert certificate["schema"] == "rollfix/certificate/1" and (tmp_path / "proof.json").exists()
    with pytest.raises(InputError, match="certify: a certificate is of one way round without noise, found noise"):
        ellipse.locate(1.0, 0.625, noise=Noise(contact=0.01)).certify()


def test_many_logs_are_a_result_of_their_own(wing, noise, roll_csv):
    table = pandas.read_csv(roll_csv, comment="#")
    found = wing.locate_logs([table, table.iloc[:1], table.iloc[:20]], finger=Disk(10), noise=noise)
    assert len(found) == 3 and len(found.answers) == 2 and list(found.errors) == [1]
    assert isinstance(found[1], InputError) and found[0] == wing.locate(log=table, finger=Disk(10), noise=noise)
    assert set(found.to_frame()["number"]) == {0, 2}
    with pytest.raises(InputError, match="logs: number 1: log: holds 1 row"):
        wing.locate_logs([table, table.iloc[:1]], finger=Disk(10), noise=noise, errors="raise")
    with pytest.raises(InputError, match="logs: all 2 fail alike; the first: log: holds 1 row"):
        wing.locate_logs([table.iloc[:1], table.iloc[:1]], finger=Disk(10), noise=noise)
    with pytest.raises(InputError, match="errors: expected 'collect' or 'raise', found 'ignore'"):
        wing.locate_logs([table], finger=Disk(10), noise=noise, errors="ignore")


def test_a_catalog_is_built_of_parts_and_arrays_and_asked_many_rolls(tmp_path, ellipse):
    xy = ellipse.point(np.linspace(0, ellipse.perimeter, 60, endpoint=False)) * [1, 1.5]
    parts = {"a cam": Part.gallery("cam"), "scanned": xy, "limacon": Part.gallery("limacon")}
    catalog = rollfix.Catalog.build(tmp_path / "parts.db", parts)
    assert catalog.names == tuple(parts) and catalog.part("a cam").perimeter == Part.gallery("cam").perimeter
    again = rollfix.Catalog.build(tmp_path / "more.db", [Part.gallery("cam"), (ellipse, 3.0), "gallery:gear"])
    assert again.entries[1].count == 3 and len(again) == 3
    with pytest.raises(InputError, match="two parts are called"):
        rollfix.Catalog.build(tmp_path / "twice.db", [ellipse, ellipse])
    readings = [[[1.0, float(ellipse.turning(1.3) - ellipse.turning(0.3))]], [[1.0, np.nan]]]
    found = catalog.identify_many(readings)
    assert len(found) == 2 and list(found.errors) == [1] and found.answers[0].names
    noise = Noise(contact=0.005, angle=0.01)
    roll = Part.gallery("cam").simulate(Disk(0.05), start=0.8, length=0.4, samples=30, noise=noise, seed=8)
    assert catalog.identify_many(logs=[roll], finger=Disk(0.05), noise=noise)[0].names[0] == "a cam"
    advice = catalog.advise(log=roll, finger=Disk(0.05), noise=noise)
    assert advice.contenders and "part" in str(advice.to_dict()["contenders"][0])
    watch = catalog.watch(noise=noise, finger=Disk(0.05))
    events = watch.add(roll.log.to_frame()) + watch.finish()
    assert any("a cam" in str(event) for event in events)
