"""What must hold whatever the part and the reading: moving, turning, scaling and mirroring a part; a dense scan."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rollfix
from conftest import reading_of

POINTS = 12


@st.composite
def outlines(draw):
    """A wobbly ring of points: a smooth closed part with inflections."""
    radii = np.array(draw(st.lists(st.floats(0.75, 1.25), min_size=POINTS, max_size=POINTS)))
    angles = 2 * np.pi * np.arange(POINTS) / POINTS
    return radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)


share = st.floats(0.02, 0.6)
place = st.floats(0, 0.999)


def located(xy, reading, tolerance=1e-9):
    return rollfix.Part.from_points(xy).locate([reading], tolerance=tolerance)


def problem(xy, at, length_share):
    part = rollfix.Part.from_points(xy)
    return part, reading_of(part, at * part.perimeter, length_share * part.perimeter)


def starts(answer):
    return np.sort(answer.starts[:, 0])


def is_decided(answer):
    """Far from where a root comes or goes: rounding can't tell otherwise."""
    return all(one.kind == "crossing" and one.error is not None and one.error < 1e-5 for one in answer)


@given(outlines(), place, share)
def test_a_planted_start_is_found(xy, at, length_share):
    part, reading = problem(xy, at, length_share)
    answer = part.locate([reading], tolerance=1e-8)
    assert answer.status == "complete"
    s = at * part.perimeter
    gap = np.abs((starts(answer) - s + part.perimeter / 2) % part.perimeter - part.perimeter / 2)
    near = gap.min() < 1e-4 * part.perimeter
    assert near or any(one.extent[0, 0] <= s <= one.extent[0, 1] or one.extent[0, 0] <= s + part.perimeter <= one.extent[0, 1]
                       for one in answer)


@given(outlines(), place, share, st.floats(-100, 100), st.floats(-100, 100), st.floats(-3, 3))
def test_moving_and_turning_a_part_moves_no_start(xy, at, length_share, dx, dy, angle):
    _, reading = problem(xy, at, length_share)
    answer = located(xy, reading)
    assume(is_decided(answer))
    turned = xy @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]) + [dx, dy]
    moved = located(turned, reading)
    assert len(moved) == len(answer)
    np.testing.assert_allclose(starts(moved), starts(answer), atol=1e-7)


@given(outlines(), place, share, st.floats(0.01, 100))
def test_scaling_a_part_scales_its_starts(xy, at, length_share, factor):
    _, (length, turn) = problem(xy, at, length_share)
    answer = located(xy, (length, turn))
    assume(is_decided(answer))
    scaled = located(factor * xy, (factor * length, turn))
    assert len(scaled) == len(answer)
    np.testing.assert_allclose(starts(scaled) / factor, starts(answer), atol=1e-7)


@given(outlines(), place, share)
def test_a_mirrored_part_is_that_part_face_down(xy, at, length_share):
    """The mirror image, run through in its own direction, feels what `mirrored` says of the original."""
    part, (length, turn) = problem(xy, at, length_share)
    answer = part.locate([(length, turn)], tolerance=1e-9)
    assume(is_decided(answer))
    image = rollfix.Part.from_points((xy * [-1, 1]))  # clockwise, so stored the other way round: s becomes P - s
    assert image.reversed
    seen = image.locate([(-length, -turn)], tolerance=1e-9)
    mapped = np.sort((part.perimeter - starts(seen)) % part.perimeter)
    distance = np.abs((mapped - starts(answer) + part.perimeter / 2) % part.perimeter - part.perimeter / 2)
    assert len(seen) == len(answer)
    assert distance.max(initial=0) < 1e-6 or len(answer) > 1  # order around s = 0 may differ
    face_down = part.locate([(-length, -turn)], tolerance=1e-9, mirrored=True)
    np.testing.assert_allclose(starts(face_down), starts(answer), atol=1e-9)


@given(outlines(), place, share)
def test_a_dense_scan_finds_no_sign_change_that_is_not_listed(xy, at, length_share):
    """f(s) = Theta(s + L) - Theta(s) - theta on 20000 places, with tangents of the points' own spline by scipy-free
    differences of positions: independent of the turning function."""
    part, (length, turn) = problem(xy, at, length_share)
    answer = part.locate([(length, turn)], tolerance=1e-9)
    assume(is_decided(answer))
    s = np.linspace(0, part.perimeter, 20001)
    step = 1e-4 * part.perimeter

    def direction(at):
        chord = part.point(at + step) - part.point(at - step)
        return np.arctan2(chord[:, 1], chord[:, 0])

    f = np.remainder(direction(s + length) - direction(s) - turn + np.pi, 2 * np.pi) - np.pi
    crosses = np.nonzero((f[:-1] * f[1:] < 0) & (np.abs(f[:-1]) < 1))[0]
    found = starts(answer)
    for k in crosses:
        gap = np.abs(np.remainder(found - s[k] + part.perimeter / 2, part.perimeter) - part.perimeter / 2)
        # A chord's direction is off by step^2 kappa''/6: near-double roots move by its root.
        assert gap.min(initial=np.inf) < 0.02 * part.perimeter


@pytest.mark.parametrize("count", [1, 2, 3])
def test_more_readings_of_one_roll_never_add_places(ellipse, count):
    lengths = np.linspace(0.4, 1.3, count)
    readings = [reading_of(ellipse, 0.7, length) for length in lengths]
    sizes = [len(ellipse.locate(readings[: k + 1], tolerance=1e-9)) for k in range(count)]
    assert sizes == sorted(sizes, reverse=True)
