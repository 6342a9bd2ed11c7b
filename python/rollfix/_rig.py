"""A jaw and a wheel on a pin, simulated."""

from __future__ import annotations

from typing import Any, List, Optional

import numpy as np

from . import _core
from ._checks import array, number, numbers, whole
from ._core import InputError
from ._fingers import Disk, FingerLike, Jaw
from ._messages import shown
from ._noise import NoiseLike, noise as noise_given
from ._simulate import MOST_SEED

SENSORS = ("skin", "encoder", "pin")
# A start of a squeezed wheel means the place within this share of the perimeter where it can be squeezed.
MEANT = 0.02


def simulated_rig(
    part: _core.Part,
    finger: Optional[FingerLike],
    start: Any,
    pin: Any,
    squeeze: bool,
    jaw_rotation: float,
    samples: int,
    contact: Any,
    wheel: str,
    noise: NoiseLike,
    seed: int,
    is_told_how_far: bool,
) -> _core.Roll:
    rows, sds, drawn = whole(samples, "samples", 1), noise_given(noise), whole(seed, "seed", 0, MOST_SEED)
    radius = _radius_of_wheel(finger)
    if is_told_how_far:
        raise InputError(
            "pin: says how the wheel's pin moves, and the part rolls as it must: leave length, rotation and part_rotation out"
        )
    if wheel not in SENSORS:
        raise InputError(f"wheel: expected 'skin', 'encoder' or 'pin', found {shown(wheel)}")
    if pin is None:
        raise InputError("pin: expected how far the pin moves in the jaw's frame, (dx, dy), with squeeze dx alone, found nothing")
    moved = [number(pin, "pin"), 0.0] if squeeze else numbers(pin, 2, "pin", "(dx, dy) in the jaw's frame")
    starts = _squeezed(part, radius, start) if squeeze else numbers(start, 2, "start", "the jaw's and the wheel's")
    angles = array(contact, "contact")
    if angles.shape not in ((), (2,)):
        raise InputError(f"contact: expected one or two numbers, found {shown(contact)}")
    contacts = numbers(np.broadcast_to(angles, (2,)), 2, "contact", "the jaw's and the wheel's")
    turned = number(jaw_rotation, "jaw_rotation")
    return _core.simulate_rig(part, radius, starts, moved, squeeze, turned, rows, contacts, wheel, sds, drawn)


def _radius_of_wheel(finger: Optional[FingerLike]) -> float:
    pair = list(finger) if isinstance(finger, (list, tuple)) else []
    if len(pair) == 2 and isinstance(pair[0], Jaw) and isinstance(pair[1], Disk):
        return pair[1].radius
    raise InputError(f"finger: expected a jaw and a wheel on a pin, (Jaw(), Disk(radius)), found {shown(finger)}")


def _squeezed(part: _core.Part, radius: float, start: Any) -> List[float]:
    """Both first contacts: the wheel's is where it can be squeezed, near where it was said to be."""
    is_told = np.ndim(start) > 0
    given = list(numbers(start, 2, "start", "the jaw's and the wheel's")) if is_told else [number(start, "start")]
    places = _core.squeezed_places(part, radius, given[0])
    listed = " and ".join(f"{place:.6g}" for place in places)
    if not places:
        raise InputError(
            f"start: expected a place where the wheel can be squeezed against the jaw at s = {given[0]:.6g}, found none in a "
            "stable grip"
        )
    if len(given) == 1 and len(places) > 1:
        raise InputError(f"start: the wheel can be squeezed at s = {listed}: expected (s, t)")
    if len(given) == 1:
        return [given[0], places[0]]
    off = [abs((place - given[1] + part.perimeter / 2) % part.perimeter - part.perimeter / 2) for place in places]
    nearest = int(np.argmin(off))
    if off[nearest] > MEANT * part.perimeter:
        raise InputError(f"start: the wheel can't be squeezed at {given[1]:.6g}, expected a place near s = {listed}")
    return [given[0], places[nearest]]
