"""A cell that is no number is named by its row; masked ones count as missing, everywhere."""

import numpy as np
import pytest

import rollfix
from rollfix import Disk, InputError, Part

pandas = pytest.importorskip("pandas")


def holding(frame, cell, row=7):
    return frame.assign(u=[cell if k == row else value for k, value in enumerate(frame.u.astype(object))])


@pytest.mark.parametrize("cell, message", [
    ("--", "^log: row 7: u is '--', expected a number$"),
    ("1,5", "^log: row 7: u is '1,5', expected a number with a decimal point; read_log"),
    (pandas.NA, "^log: row 7: u is <NA>, expected a number$"),
    (1j, "^log: (row 7: u is 1j|the column 'u' holds complex numbers)"),
    (pandas.Timestamp("2026-01-01"), "^log: row 7: u is Timestamp"),
    (None, "^log: row 7: u is 'nan'"),
])
def test_one_bad_cell_is_found(ask, frame, cell, message):
    with pytest.raises(InputError, match=message):
        ask(holding(frame, cell))


def test_numbers_may_be_written_in_text(ask, frame):
    assert ask(frame.astype(str)) == ask({name: [str(one) for one in frame[name]] for name in frame}) == ask(frame)


def test_where_nothing_touches_anything_may_stand(ask, frame):
    log = pandas.concat([frame.iloc[:1], frame], ignore_index=True).assign(contact=[0] + [1] * len(frame))
    log["time"] = np.arange(len(log))
    assert ask(holding(log, "--", row=0)).starts.tobytes() == ask(log).starts.tobytes()


def test_dates_are_no_angles(ask, frame):
    with pytest.raises(InputError, match="^log: the column 'u' holds dates and times"):
        ask(frame.assign(u=pandas.to_datetime(frame.time)))


def masked(values, *where):
    mask = np.zeros(np.shape(values), bool)
    mask[where] = True
    return np.ma.array(values, mask=mask)


@pytest.mark.parametrize("wrap", [lambda f, u: {"u": u, "psi": f.psi}, lambda f, u: {"u": list(u), "psi": f.psi}])
def test_a_masked_cell_is_missing(ask, frame, wrap):
    with pytest.raises(InputError, match="^log: row 10: u is 'nan'"):
        ask(wrap(frame, masked(frame.u, 10)))


def test_a_masked_cell_of_an_array_is_missing(ask, frame):
    rows = frame[["time", "u", "psi"]].to_numpy()
    with pytest.raises(InputError, match="^log: row 10: psi is 'nan'"):
        ask(masked(rows, 10, 2), columns=("time", "u", "psi"))
    assert ask(np.ma.array(rows), columns=("time", "u", "psi")) == ask(rows, columns=("time", "u", "psi"))


def test_a_mask_may_cover_what_does_not_touch(ask, frame):
    contact = np.arange(len(frame)) > 0
    log = {name: masked(frame[name], 0) for name in ("u", "psi")} | {"contact": contact}
    assert ask(log).starts.tobytes() == ask(frame[["u", "psi"]].iloc[1:]).starts.tobytes()


@pytest.mark.parametrize("call, message", [
    (lambda p: p.locate(masked([[1.0, 0.6], [1.9, 0.9]], 1, 0)), "^readings: .* masked one in row 1"),
    (lambda p: p.locate(masked([1.0, 0.6], 1)), "^readings: .* masked"),
    (lambda p: p.locate([masked([1.0, 0.6], 0), [1.9, 0.9]]), "^readings: .* masked one in row 0"),
    (lambda p: p.point(masked([1.0, 2.0], 1)), "^s: .* masked one as number 1"),
    (lambda p: Part.from_points(masked([[0, 0], [1, 0], [1, 1]], 2)), "^xy: .* masked one in row 2"),
    (lambda p: p.locate_many(np.ones((2, 3)), facing=masked([1.0, 2.0], 0)), "^facing: .* masked"),
    (lambda p: p.locate(np.ma.masked, 1.0), "^length: .* masked"),
])
def test_masks_are_seen_everywhere(ellipse, call, message):
    with pytest.raises(InputError, match=message):
        call(ellipse)


def test_of_many_problems_a_masked_one_is_an_error_of_its_own(ellipse):
    many = ellipse.locate_many(masked([[1.0, 0.6], [1.9, 0.9]], 1, 0))
    assert list(many.errors) == [1]


def test_a_masked_row_of_a_watch_is_skipped(wing, noise):
    with pytest.warns(rollfix.RollfixWarning, match="row 1: u is 'nan'"):
        wing.watch(finger=Disk(10), noise=noise).add({"u": masked([0.0, 0.1], 1), "psi": [0.0, 0.1]})
