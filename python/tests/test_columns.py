"""Columns go by the names that a user says, of whatever kind, and what is said must fit together."""

import numpy as np
import pytest

from rollfix import Disk, InputError

pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def frame(roll_csv):
    return pandas.read_csv(roll_csv, comment="#")[["time", "u", "psi"]]


@pytest.mark.parametrize("names", [{"u": 0, "psi": 7, "time": 3}, {"u": ("f", "u"), "psi": ("f", "psi"), "time": ("", "t")}])
def test_names_may_be_numbers_or_tuples(ask, frame, names):
    log = frame.rename(columns=names) if 0 in names.values() else frame.set_axis(
        pandas.MultiIndex.from_tuples([names[name] for name in frame]), axis=1)
    assert ask(log, columns=names) == ask(frame)
    in_degrees = log.assign(**{}) * [1, 180 / np.pi, 1]
    said = {**names, "u": (names["u"], "deg")}
    np.testing.assert_allclose(ask(in_degrees, columns=said).starts, ask(frame).starts, rtol=1e-9)


def test_an_array_s_columns_may_go_by_their_numbers(ask, frame):
    assert ask(frame.to_numpy(), columns={"time": 0, "u": 1, "psi": 2}) == ask(frame)


def test_a_watch_takes_such_names_as_well(wing, noise, frame):
    watch = wing.watch(finger=Disk(10), noise=noise, columns={"u": 0, "psi": 7})
    watch.add(frame.rename(columns={"u": 0, "psi": 7})), watch.finish()
    assert watch.verdict == "ambiguous (2)"


def test_the_text_of_the_program_is_taken(ask, frame):
    assert ask(frame.rename(columns={"u": "joint"}), columns="u=joint") == ask(frame)


@pytest.mark.parametrize("log, columns, message", [
    (lambda f: f, 5, "^columns: expected a mapping"),
    (lambda f: f, True, "^columns: expected a mapping"),
    (lambda f: f, {"u", "psi"}, "^columns: expected a mapping"),
    (lambda f: f, ["time", "psi", "u"], "^columns: the columns of log have names, expected which is which"),
    (lambda f: f.to_dict("list"), ["time", "psi", "u"], "^columns: the columns of log have names"),
    (lambda f: f, {"w": "u"}, "^columns: there is no column 'w'"),
    (lambda f: f, {"u": ["u"]}, r"^columns: 'u' is \['u'\], expected a name or \(name, unit\)"),
    (lambda f: f, {"u": ("u", None)}, r"^columns: 'u' is \('u', None\), expected a name"),
    (lambda f: f, {"u": 3}, "^log: expected a column 'column 3' for u"),
    (lambda f: f.to_numpy(), {"time": 0, "u": 1, "psi": 5}, "^log: expected a column 'column 5' for psi"),
])
def test_columns_that_say_nothing_are_refused(ask, frame, log, columns, message):
    with pytest.raises(InputError, match=message):
        ask(log(frame), columns=columns)


def test_of_a_file_names_are_text(ask, roll_csv):
    for columns in ({"u": 3}, ["u", "psi"]):
        with pytest.raises(InputError, match="^columns: .*the columns of a file have names"):
            ask(roll_csv, columns=columns)


@pytest.mark.parametrize("units, message", [
    ("deg", "^units: expected a mapping .*degrees=True is for all angles"),
    ({"w": "deg"}, "^units: there is no column 'w'"),
    ({"tme": "ms"}, "^units: there is no column 'tme'; did you mean 'time'"),
    ({"u": 3}, "^units: 'u' is 3"),
])
def test_units_are_a_mapping_of_known_columns(ask, frame, units, message):
    with pytest.raises(InputError, match=message):
        ask(frame, units=units)


def test_a_unit_is_not_said_in_two_ways(ask, frame):
    assert ask(frame, columns={"u": ("u", "rad")}, units={"u": "rad"}) == ask(frame)
    with pytest.raises(InputError, match="^units: u is in 'deg', but `columns` says 'rad': leave one of them out"):
        ask(frame, columns={"u": ("u", "rad")}, units={"u": "deg"})


def test_columns_are_suggested_in_python(ask, frame):
    with pytest.raises(InputError) as caught:
        ask(frame.rename(columns={"u": "motor_angle_deg", "psi": "yaw"}))
    said = str(caught.value).partition("as in columns=")[2].partition(" (the header")[0]
    assert eval(said)["u"] == ("motor_angle_deg", "deg")


def test_a_column_that_occurs_twice_is_named(ask, frame):
    with pytest.raises(InputError, match="^log: the column 'u' occurs twice"):
        ask(pandas.concat([frame, frame[["u"]]], axis=1))
