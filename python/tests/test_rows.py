"""What is said of a log that came from no file is said of rows from 0, as data frames count them; of a file of lines."""

import pickle

import numpy as np
import pytest

import rollfix
from rollfix import Disk, InputError, Noise
from rollfix._words import Numbering

pandas = pytest.importorskip("pandas")
TABLE = Numbering({"log": [1]})


def at(frame, row, **cells):
    """The frame with other cells in one row."""
    return frame.assign(**{name: np.where(np.arange(len(frame)) == row, cell, frame[name]) for name, cell in cells.items()})


@pytest.mark.parametrize("line, row", [
    ("log:12: expected a roll that goes on", "log: row 10: expected a roll that goes on"),
    ("log:12: a jump since line 11, but", "log: row 10: a jump since row 9, but"),
    ("log:3: time is '0', expected more than 1 in line 2:", "log: row 1: time is '0', expected more than 1 in row 0:"),
    ("log:5: contact is lost here, found again in line 8, x", "log: row 3: contact is lost here, found again in row 6, x"),
    ("log:1: the header 'a' has", "log: the header 'a' has"),
    ("log, lines 38 to 61: holds 1 row", "log, rows 36 to 59: holds 1 row"),
    ("log, lines 38 to 61:40: u is off", "log, rows 36 to 59: row 38: u is off"),
    ("took roll 2 of 2, log, lines 38 to 61; x", "took roll 2 of 2, log, rows 36 to 59; x"),
    ("but log:59 has no partner", "but row 57 of log has no partner"),
    ("log:2: u is 'nan', expected a finite number such as 1.25 (radians) or 73deg",
     "log: row 0: u is 'nan', expected a finite number"),
    ("my/log:5: is a file's", "my/log:5: is a file's"),
    ("catalog:5: since line 4", "catalog:5: since line 4"),
])
def test_lines_of_a_table_are_rows(line, row):
    assert TABLE.said(line) == row


def test_each_of_two_logs_has_its_own_rows():
    both = Numbering({"log_a": [1], "log_b": [1]})
    said = both.said("log_a:2 is at the time 0 and log_b:4 at 1")
    assert said == "row 0 of log_a is at the time 0 and row 2 of log_b at 1"


def test_a_header_may_come_again():
    assert [Numbering({"log": [1, 5]}).row(line) for line in (2, 4, 6)] == [0, 2, 3]


def test_a_simulated_roll_has_rows_from_0_too():
    assert Numbering({"the roll": []}).said("the roll, row 5: jumps since line 4") == "the roll: row 4: jumps since row 3"


@pytest.mark.parametrize("cells, message", [
    (dict(u=np.nan), "^log: row 7: u is 'nan', expected a finite number; read_log"),
    (dict(psi=50.0), "^log: row 7: .* since row 6, but"),
    (dict(time=0.0), "^log: row 7: time .* in row 6: time must grow"),
    (dict(contact=0.5), "^log: row 7: contact is '0.5', expected 0 or 1"),
])
def test_errors_count_as_iloc_does(ask, frame, cells, message):
    with pytest.raises(InputError, match=message):
        ask(at(frame.assign(contact=1), 7, **cells))


def test_of_a_file_the_line_is_told(ask, roll_csv, tmp_path):
    lines = roll_csv.read_text().splitlines()
    (tmp_path / "roll.csv").write_text("\n".join([*lines[:9], "nonsense", *lines[9:]]))
    with pytest.raises(InputError, match=r"roll\.csv:10: "):
        ask(tmp_path / "roll.csv")


def test_strays_are_named_by_their_rows(ask, frame, roll_csv, tmp_path):
    strayed = at(frame, 15, psi=frame.psi[15] + 0.2, u=frame.u[15] + 3)
    assert ask(strayed, robust=True).notes == ("left out stray rows: 15",)
    strayed.to_csv(tmp_path / "roll.csv", index=False)
    assert ask(tmp_path / "roll.csv", robust=True).notes == ("left out stray rows, of lines 17",)


def test_of_several_rolls_the_rows_are_named(ask, frame):
    log = pandas.concat([frame, frame.iloc[:1], frame], ignore_index=True)
    log = log.assign(time=np.arange(len(log)), contact=np.arange(len(log)) != len(frame))
    with pytest.warns(rollfix.RollfixWarning, match="log, rows 34 to 66; `roll` takes another"):
        answer = ask(log)
    assert answer.log.name == "log, rows 34 to 66" == pickle.loads(pickle.dumps(answer)).log.name


def test_many_logs_name_rows_as_well(wing, frame, noise):
    (error,) = wing.locate_logs([at(frame, 7, psi=50.0)], finger=Disk(10), noise=noise)
    assert str(error).startswith("log: row 7: ") and "since row 6" in str(error)


def test_teaching_names_rows(frame):
    with pytest.raises(InputError, match="^log: row 3: u"):
        rollfix.teach(at(frame, 3, u=np.inf), Disk(10))


def test_points_are_counted_from_0():
    with pytest.raises(InputError, match="rows 1 and 2 hold the same point"):
        rollfix.Part.from_points([[0, 0], [1, 0], [1, 0], [1, 1]])


@pytest.mark.parametrize("size", [1, 4, 1000])
def test_a_watch_counts_all_rows_of_its_life(wing, frame, noise, size):
    watch, log = wing.watch(finger=Disk(10), noise=noise), at(frame, 7, u=np.nan)
    with pytest.warns(rollfix.RollfixWarning, match="^log: row 7: u is 'nan'"):
        events = [event for k in range(0, len(log), size) for event in watch.add(log.iloc[k : k + size])]
    assert events[-1]["row"] == events[-1]["line"] - 2


def test_after_a_header_came_again_too(wing, frame, noise):
    watch = wing.watch(finger=Disk(10), noise=noise)
    watch.add(frame.iloc[:5]), watch.resume()
    with pytest.warns(rollfix.RollfixWarning, match="^log: row 7: u is 'nan'"):
        watch.add(at(frame, 7, u=np.nan).iloc[5:])


def test_a_watch_of_text_counts_lines(wing, roll_csv):
    watch = wing.watch(finger=Disk(10), noise=Noise(contact=0.05, angle=0.006))
    with pytest.warns(rollfix.RollfixWarning, match="^log:3: "):
        watch.add("u,psi\n0,0\nnan,0\n")
