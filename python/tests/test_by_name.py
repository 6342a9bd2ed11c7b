"""Tables where arrays are expected: their columns are taken by name, or refused."""

import numpy as np
import pytest

import rollfix
from rollfix import InputError, Part

pandas = pytest.importorskip("pandas")

READINGS = np.array([[1.0, 0.625], [0.9, 0.5], [2.0, 1.1]])
PAIRS = np.array([[0.58, 0.94, -0.725248], [1.01, 1.92, -1.99849]])
SQUARE = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]])


def tables(rows, *names):
    """All that has columns by name, the columns turned round and one more among them."""
    shuffled = {name: rows[:, names.index(name)] for name in reversed(names)}
    frame = pandas.DataFrame({"note": ["a"] * len(rows), **shuffled})
    return [frame, frame[list(names)], frame.drop(columns="note").to_records(index=False), shuffled]


@pytest.mark.parametrize("k", range(4))
def test_readings_are_taken_by_name(ellipse, k):
    assert ellipse.locate_many(tables(READINGS, "length", "turn")[k]) == ellipse.locate_many(READINGS)
    spline = Part.gallery("spline,n=9,seed=7,wobble=0.2")
    assert spline.locate_many(tables(PAIRS, "length_a", "length_b", "turn")[k]) == spline.locate_many(PAIRS)


@pytest.mark.parametrize("k", range(4))
def test_points_are_taken_by_name(k):
    assert Part.from_points(tables(SQUARE, "x", "y")[k]) == Part.from_points(SQUARE)


def test_several_readings_of_each_roll_are_taken_by_name(ellipse):
    frame = pandas.DataFrame(READINGS, columns=["length", "turn"])[["turn", "length"]]
    assert ellipse.locate_many([frame, frame]) == ellipse.locate_many([READINGS, READINGS])


def test_one_row_of_a_frame_is_a_reading(ellipse):
    row = pandas.DataFrame(READINGS, columns=["length", "turn"])[["turn", "length"]].iloc[0]
    assert ellipse.locate_many([row]) == ellipse.locate_many(READINGS[:1])


def test_a_frame_whose_columns_have_no_names_is_an_array(ellipse):
    assert ellipse.locate_many(pandas.DataFrame(READINGS)) == ellipse.locate_many(READINGS)
    assert Part.from_points(pandas.DataFrame(SQUARE)) == Part.from_points(SQUARE)


@pytest.mark.parametrize("ask, message", [
    (lambda part: part.locate_many(pandas.DataFrame(READINGS, columns=["theta", "L"])),
     "^readings: expected the columns length and turn or length_a, length_b and turn, found theta, L; name them so"),
    (lambda part: Part.from_points(pandas.DataFrame(SQUARE, columns=["north", "east"])),
     "^xy: expected the columns x and y or X and Y, found north, east"),
    (lambda part: part.locate(1.0, 0.6, rounding=pandas.Series({"turn": 0.1, "length": 0.0})), "^rounding: .* by names, turn, length"),
    (lambda part: part.watch(noise=rollfix.Noise(angle=0.1), prior=pandas.Series({"sd": 0.1, "s": 1.0})), "^prior: .* by names, sd, s"),
    (lambda part: part.watch(noise=rollfix.Noise(angle=0.1), heading={"angle": 0.1, "sd": 1.0}), "^heading: .* by names, angle, sd"),
])
def test_names_that_say_something_else_are_refused(ellipse, ask, message):
    with pytest.raises(InputError, match=message):
        ask(ellipse)
