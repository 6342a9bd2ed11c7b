"""Numbers that can't be meant are refused with the bound, and at once."""

import time

import pytest

import rollfix
from rollfix import Disk, InputError, Noise


@pytest.fixture(scope="module")
def rolled():
    part = rollfix.Part.gallery("spline,n=9,seed=7,wobble=0.2")
    return part, part.simulate(Disk(0.1), start=1, length=3, samples=50, noise=Noise(contact=0.01, angle=0.01), seed=1)


@pytest.mark.parametrize("options, message", [
    (dict(noise=Noise(contact=1e200)), "^noise: contact of 1e.200 says nothing .* at most 6.74479"),
    (dict(noise=Noise(contact=0.1, radius=7)), "^noise: radius of 7 says nothing .* at most 6.74479"),
    (dict(noise=Noise(contact=0.1, slip=1e10)), "^noise: slip of 1e.10 says nothing .* at most 1$"),
    (dict(noise=Noise(contact=0.1, drift=1e10)), "^noise: drift of 1e.10 says nothing .* at most 10$"),
    (dict(noise=Noise(contact=0.1, walk=1e10)), "^noise: walk of 1e.10 says nothing .* at most 10$"),
    (dict(noise=Noise(contact=0.1, position=1e200)), "^noise: position of 1e.200 says nothing"),
    (dict(noise=Noise(contact=0.1, position=1e-300)), "noise of the position that is not lost in the rounding"),
    (dict(noise=Noise(contact=0.1, correlation=1e200)), "^noise: correlation of 1e.200 says nothing"),
    (dict(noise=Noise(contact=0.1), finger=Disk(1e-200)), "disk with a radius that is not lost in the rounding"),
    (dict(noise=Noise(contact=0.1), pose=(0, 0, 0, 1e-300, 0.1)), "pose with a standard deviation that is not lost"),
])
def test_absurd_numbers_are_refused_at_once(rolled, options, message):
    part, roll = rolled
    begun = time.monotonic()
    with pytest.raises(InputError, match=message):
        part.locate(log=roll, **{"finger": Disk(0.1), **options})
    with pytest.raises(InputError, match=message):
        list(part.watch(**{"finger": Disk(0.1), **options}).follow([roll.log.to_frame()]))
    assert time.monotonic() - begun < 2


def test_noise_at_the_bound_is_taken(rolled):
    part, roll = rolled
    for noise in (Noise(contact=part.perimeter), Noise(contact=0.1, slip=1), Noise(contact=0.1, drift=10, walk=10)):
        assert len(part.locate(log=roll, finger=Disk(0.1), noise=noise)) > 0
