"""A watch takes rows of every kind that rows come in, and says what it can't take."""

import pytest

from rollfix import Disk, InputError

pytest.importorskip("pandas")


@pytest.fixture
def watch(wing, noise):
    return wing.watch(finger=Disk(10), noise=noise)


def turned(row):
    return dict(reversed(row.items()))


@pytest.mark.parametrize("pieces", [
    lambda f: f.to_dict("records"),
    lambda f: [f.to_dict("records")],
    lambda f: [row if k % 2 else turned(row) for k, row in enumerate(f.to_dict("records"))],
    lambda f: [{**row, "note": "x", **({"more": 1.0} if k else {})} for k, row in enumerate(f.to_dict("records"))],
    lambda f: f.itertuples(index=False),
    lambda f: f.itertuples(),
    lambda f: (row for _, row in f.iterrows()),
    lambda f: [f[["psi", "u", "y", "x", "time"]].iloc[:5], f.iloc[5:]],
    lambda f: [f.to_csv(index=False).encode()],
    lambda f: [bytearray(f.to_csv(index=False).encode())],
    lambda f: f.to_csv(index=False).splitlines(),
    lambda f: [f.astype(str)],
])
def test_rows_of_every_kind_are_the_same(watch, frame, pieces):
    events = list(watch.follow(pieces(frame)))
    assert events[-1]["counts"]["samples"] == len(frame) and events[-1]["counts"]["malformed"] == 0
    assert watch.verdict == "ambiguous (2)"


@pytest.mark.parametrize("rows, message", [
    (None, "^rows: expected lines of text, columns by name, or an array, found None"),
    (3.0, "^rows: expected lines of text"),
    ({"time": 1.0, "u": 0.0}, "^rows: expected the columns time, u, psi as before, found time, u"),
    ({"time": 1.0, "u": 0.0, "psi": 0.1, "x": 1.0, "y": 2.0}, "^rows: expected the columns .* as before"),
    ({"time": 1.0, "u": [0.0, 1.0], "psi": [0.1]}, "^rows: expected columns of one length"),
    ({"time": 1.0, "u": "--", "psi": 0.1}, "^rows: row 0: u is '--', expected a number"),
    ([[1.0, 2.0, 3.0]], "^rows: an array has no names"),
])
def test_rows_that_do_not_go_on_are_refused(watch, rows, message):
    watch.add({"time": 0.0, "u": 0.0, "psi": 0.0})
    with pytest.raises(InputError, match=message):
        watch.add(rows)


@pytest.mark.parametrize("source, message", [
    (lambda f: f, "^source: .*found a data frame: give it to `add`"),
    (lambda f: f.to_dict("list"), "^source: .*found a mapping: give it to `add`"),
    (lambda f: "roll.csv", r"^source: .*found a path: open it, as in `with open\('roll.csv'\) as file`"),
    (lambda f: f.to_csv(), "^source: .*found a text: give it to `add`"),
    (lambda f: f.to_csv().encode(), "^source: .*found a text"),
    (lambda f: None, "^source: .*found None"),
])
def test_what_can_not_be_followed_is_told_at_once(watch, frame, source, message):
    with pytest.raises(InputError, match=message):
        watch.follow(source(frame))


def test_the_finger_s_shape_is_asked_for_in_python(wing, noise, frame):
    with pytest.raises(InputError, match=r"finger=Disk\("):
        wing.watch(noise=noise).add(frame)


def test_a_header_that_is_wrong_may_be_mended(watch, frame):
    with pytest.raises(InputError, match="^log: the header"):
        watch.add(frame.rename(columns={"u": "v"}))
    watch.add(frame), watch.finish()
    assert watch.verdict == "ambiguous (2)"


def test_after_a_dropped_connection_rows_may_have_other_columns(watch, frame):
    watch.add(frame.iloc[:5])
    with pytest.raises(InputError, match="^rows: expected the columns .* as before, found u, psi$"):
        watch.add(frame[["u", "psi"]].iloc[5:])
    watch.resume()
    watch.add(frame[["u", "psi"]].iloc[5:])
    assert watch.finish()[-1]["counts"]["samples"] == len(frame)
