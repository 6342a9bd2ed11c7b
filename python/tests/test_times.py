"""Times may be dates: one clock for all rows of a watch, and for both of two logs."""

import datetime
import pickle

import numpy as np
import pytest

import rollfix
from rollfix import Disk, InputError

pandas = pytest.importorskip("pandas")
DAY = pandas.Timestamp("2026-01-01")


def dated(frame, later=0.0, zone=None):
    return frame.assign(time=DAY.tz_localize(zone) + pandas.to_timedelta(frame.time + later, unit="s"))


@pytest.mark.parametrize("times", [
    lambda f: dated(f).time,
    lambda f: dated(f, zone="Europe/Berlin").time,
    lambda f: dated(f).time.to_numpy().astype("datetime64[us]"),
    lambda f: list(dated(f).time.dt.to_pydatetime()),
    lambda f: list(dated(f, zone="UTC").time),
    lambda f: pandas.to_timedelta(f.time, unit="s"),
    lambda f: [datetime.timedelta(seconds=one) for one in f.time],
])
def test_dates_of_every_kind_are_seconds(ask, frame, times):
    log = ask({"time": times(frame), "u": frame.u, "psi": frame.psi}).log
    np.testing.assert_allclose(log["time"], frame.time - frame.time[0], atol=2e-6)


@pytest.mark.parametrize("change", [lambda f: f.set_index("time"), lambda f: dated(f).set_index("time"),
                                    lambda f: dated(f).set_index("time").rename_axis(None),
                                    lambda f: dated(f).assign(k=1).set_index(["k", "time"])])
def test_an_index_of_times_is_the_column(ask, frame, change):
    assert ask(change(frame)).starts.tobytes() == ask(frame).starts.tobytes()
    np.testing.assert_allclose(ask(change(frame)).log["time"], frame.time, atol=1e-6)


def test_an_index_goes_by_the_column_s_name(ask, frame):
    log = frame.assign(time=1000 * frame.time).rename(columns={"time": "stamp"}).set_index("stamp")
    np.testing.assert_allclose(ask(log, columns={"time": ("stamp", "ms")}).log["time"], frame.time, atol=1e-9)


def test_an_index_that_says_nothing_is_none(ask, frame):
    untimed = frame.drop(columns="time")
    assert "time" not in ask(untimed).log and "time" not in ask(untimed.rename_axis("row")).log


@pytest.mark.parametrize("options", [dict(units={"time": "ms"}), dict(columns={"time": ("time", "ms")})])
def test_dates_say_their_unit_themselves(ask, frame, options):
    for log in (dated(frame), frame.assign(time=pandas.to_timedelta(frame.time, unit="s"))):
        with pytest.raises(InputError, match="^units: the column 'time' .* leave 'ms' out"):
            ask(log, **options)


@pytest.fixture(scope="module")
def cam():
    return rollfix.Part.gallery("cam")


@pytest.fixture(scope="module")
def pair(cam):
    """The log of each of two fingers."""
    both = cam.simulate((Disk(0.2), Disk(0.2)), start=(1, 4), length=(1.5, -0.8)).log.to_frame()
    return [pandas.DataFrame({"time": both.time, "u": both["u" + end], "psi": both["psi" + end]}) for end in ("_a", "_b")]


def test_two_logs_have_one_clock(cam, pair):
    a, b = pair
    expected = cam.locate(log=(a, b), finger=Disk(0.2)).starts
    np.testing.assert_array_equal(cam.locate(log=(dated(a, 3600), dated(b, 3600)), finger=Disk(0.2)).starts, expected)
    with pytest.raises(InputError, match="same times in both logs"):
        cam.locate(log=(dated(a), dated(b, 3600)), finger=Disk(0.2))


def test_dates_and_numbers_can_not_be_compared(cam, pair, tmp_path):
    a, b = pair
    b.to_csv(tmp_path / "b.csv", index=False)
    for other in (b, tmp_path / "b.csv", rollfix.read_log(b), dated(b, zone="UTC")):
        with pytest.raises(InputError, match="^log_[ab]: its times are .*, and log_[ab] has .*: expected the same in both"):
            cam.locate(log=(dated(a), other), finger=Disk(0.2))


def test_logs_that_were_read_keep_their_dates(cam, pair):
    a, b = (rollfix.read_log(dated(one)) for one in pair)
    expected = cam.locate(log=tuple(pair), finger=Disk(0.2)).starts
    assert cam.locate(log=(a, pickle.loads(pickle.dumps(b))), finger=Disk(0.2)).starts.tobytes() == expected.tobytes()
    assert cam.locate(log=(a, dated(pair[1])), finger=Disk(0.2)).starts.tobytes() == expected.tobytes()
    with pytest.raises(InputError, match="was read on its own"):
        cam.locate(log=(a, rollfix.read_log(dated(pair[1], 5))), finger=Disk(0.2))


def watched(wing, noise, pieces):
    watch = wing.watch(finger=Disk(10), noise=noise)
    events = [event for rows in pieces for event in watch.add(rows)] + watch.finish()
    assert events[-1]["counts"]["malformed"] == 0
    return [(event["samples"], event["time"], event["verdict"]) for event in events if "placements" in event]


@pytest.mark.parametrize("one_by_one", [
    lambda f: [dated(f).iloc[k : k + 1] for k in range(len(f))],
    lambda f: dated(f).to_dict("records"),
    lambda f: [{**row, "time": row["time"].to_pydatetime()} for row in dated(f).to_dict("records")],
    lambda f: [row for _, row in dated(f).iterrows()],
    lambda f: [dated(f).iloc[:20], dated(f).iloc[20:]],
])
def test_a_watch_has_one_clock_for_life(wing, noise, frame, one_by_one):
    found = watched(wing, noise, one_by_one(frame))
    expected = watched(wing, noise, [frame])
    assert [one[0] for one in found] == [one[0] for one in expected]
    np.testing.assert_allclose([one[1] for one in found], [one[1] for one in expected], atol=2e-6)


def test_a_watch_takes_dates_or_numbers(wing, noise, frame):
    watch = wing.watch(finger=Disk(10), noise=noise)
    watch.add(dated(frame).iloc[:3])
    with pytest.raises(InputError, match="^rows: its times are numbers, and the rows before have dates and times"):
        watch.add(frame.iloc[3:])
