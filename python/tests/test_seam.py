"""Places across s = 0, and probabilities in [0, 1]."""

import numpy as np
import pytest

import rollfix
from rollfix import InputError, Noise


@pytest.fixture(scope="module")
def spline():
    return rollfix.Part.gallery("spline,n=9,seed=7,wobble=0.2")


def test_places_are_apart_the_shorter_way_round(ellipse):
    P = ellipse.perimeter
    assert ellipse.distance(0.1, P - 0.2) == pytest.approx(0.3)
    np.testing.assert_allclose(ellipse.distance([0.0, P / 2, 2 * P + 0.1], P - 0.2), [0.2, P / 2 - 0.2, 0.3])
    spiral = rollfix.Part.gallery("log-spiral")
    assert spiral.distance(0.25, 1.0) == pytest.approx(0.75)


def test_a_placement_holds_the_places_of_its_interval_across_the_seam(spline):
    P, noise = spline.perimeter, Noise(contact=0.02, angle=0.02)
    crossing = 0
    for seed in range(30):
        log = spline.simulate(start=0.0, length=2.0, samples=20, noise=noise, seed=seed)
        for place in spline.locate(log=log, noise=noise):
            lo, hi = place.interval[0]
            crossing += hi > P
            inside = np.linspace(lo, hi, 11)
            for lap in (-P, 0.0, P):
                assert place.contains(inside + lap).all()
                assert not place.contains([lo - 0.01 + lap, hi + 0.01 + lap]).any()
            assert place.contains(float(place.mean[0])) is True
    assert crossing > 5


def test_without_noise_the_extent_counts_and_two_fingers_take_a_pair(spline):
    for place in spline.locate(0.9977, 0.9936, tolerance=1e-3):
        assert place.contains(place.extent[0]).all() and not place.contains(place.extent[0, 1] + 0.1)
    pair = spline.locate([[0.58, 0.94, -0.725248], [1.01, 1.92, -1.99849]])[0]
    assert pair.contains(pair.start) and not pair.contains(pair.start + [0.1, 0])
    with pytest.raises(InputError, match="^s: expected a pair of places, one of each finger, found 1"):
        pair.contains(1.0)
    with pytest.raises(InputError, match="^s: expected finite places, found nan"):
        pair.contains([np.nan, 1.0])


def test_no_probability_is_above_1(spline):
    noise = Noise(contact=0.002 * spline.perimeter, angle=0.02, slip=0.005)
    for seed in range(40):
        log = spline.simulate(start=0.1 * seed, length=1.3, samples=5 + seed, noise=noise, seed=seed)
        document = spline.locate(log=log, noise=noise).to_dict()
        assert all(0 <= one["probability"] <= 1 for one in document["placements"])
        events = list(spline.watch(noise=noise).follow([log.log.to_frame()]))
        assert all(0 <= one["probability"] <= 1 for event in events for one in event.get("placements", []))
