"""Rolls that did not happen."""

from __future__ import annotations

import functools
from typing import Any, Dict, List, Optional

import numpy as np

from . import _core
from ._checks import array, number, numbers, optional_number, whole
from ._core import InputError
from ._fingers import Disk, FingerLike, Jaw, fingers
from ._messages import shown, warn
from ._noise import NoiseLike, noise as noise_given

MOST_SEED = 2**64 - 1
SENSORS = ("skin", "encoder", "pin")
# A start of a squeezed wheel means the place within this share of the perimeter where it can be squeezed.
MEANT = 0.02


def tell_of_dropped(part: _core.Part, roll: _core.Roll, finger: Optional[FingerLike]) -> None:
    """What no such finger can do is simulated all the same, and `locate` leaves it out."""
    given = fingers(finger)
    if not given:
        return
    names = [""] if len(roll.s) == 1 else ["finger a: ", "finger b: "]
    for which, name in enumerate(names):
        one = given[min(which, len(given) - 1)]
        if not isinstance(one, (float, str)):
            continue
        met = roll.obstruction(part, _reach_of(part, one), which)
        if met:
            why = f"enter the part by {met[1]:.3g}" if met[1] > 0 else "roll over a concave corner"
            warn(f"simulate: {name}a real one can't do this roll: at s = {met[0]:.6g} it would {why}; `locate` leaves it out")
    if len(names) == 2 and (deepest := roll.overlap(given)):
        then = "`locate` leaves such a roll out; of fingers at different heights say may_overlap=True there"
        warn(f"simulate: the fingers overlap, by {deepest[1]:.3g} in row {deepest[0]}: {then}")


@functools.lru_cache(maxsize=4)
def _reach_of(part: _core.Part, given: Any) -> _core.Reach:
    return _core.reach_of(part, given)


def simulated(
    part: _core.Part,
    finger: Optional[FingerLike],
    start: Any,
    length: Any,
    rotation: Optional[float],
    samples: int,
    contact: Any,
    part_rotation: float,
    noise: NoiseLike,
    seed: int,
    seconds: Optional[float],
) -> _core.Roll:
    rows, sds, drawn = whole(samples, "samples", 1), noise_given(noise), whole(seed, "seed", 0, MOST_SEED)
    turned = number(part_rotation, "part_rotation")
    given = fingers(finger)
    is_pair = len(given) == 2 or (given and np.ndim(start) > 0)
    if turned != 0 and not is_pair:
        raise InputError("part_rotation: is of two fingers on a part that is free to move, found one on a part at rest")
    if seconds is not None and finger is not None:
        raise InputError(f"seconds: is of a wheel, and a finger turns at 1 rad/s, found {shown(seconds)}")
    if is_pair:
        return _of_two(part, given, start, length, rotation, rows, contact, turned, sds, drawn)
    if finger is None:
        return _of_wheel(part, start, length, rotation, rows, contact, sds, drawn, seconds)
    if (length is None) == (rotation is None):
        found = "neither" if length is None else "both"
        raise InputError(f"length: expected how far the contact travels, or else `rotation` of the finger, found {found}")
    return _core.simulate_one(
        part,
        given[0],
        number(start, "start"),
        optional_number(length, "length"),
        optional_number(rotation, "rotation"),
        rows,
        number(contact, "contact"),
        sds,
        drawn,
    )


def _of_wheel(
    part: _core.Part,
    start: Any,
    length: Any,
    rotation: Any,
    rows: int,
    contact: Any,
    noise: Optional[Dict[str, float]],
    seed: int,
    seconds: Optional[float],
) -> _core.Roll:
    if length is None or rotation is not None:
        raise InputError("length: expected how far the wheel drives; `rotation` is of a finger")
    if np.ndim(contact) or contact != 0:
        raise InputError(f"contact: is of a finger, and without `finger` it is a wheel that drives, found {shown(contact)}")
    duration = 0.0 if seconds is None else number(seconds, "seconds")
    if seconds is not None and duration <= 0:
        raise InputError(f"seconds: expected a time above 0, found {shown(seconds)}")
    return _core.simulate_drive(part, number(start, "start"), number(length, "length"), rows, noise, seed, duration)


def _of_two(
    part: _core.Part,
    given: List[Any],
    start: Any,
    length: Any,
    rotation: Any,
    rows: int,
    contact: Any,
    part_rotation: float,
    noise: Optional[Dict[str, float]],
    seed: int,
) -> _core.Roll:
    starts = numbers(start, 2, "start", "one for each of two fingers")
    if rotation is not None or length is None:
        raise InputError("length: expected one for each of two fingers; `rotation` is of one")
    lengths = numbers(length, 2, "length", "one for each of two fingers")
    angles = array(contact, "contact")
    if angles.shape not in ((), (2,)):
        raise InputError(f"contact: expected one or two angles, found {shown(contact)}")
    contacts = numbers(np.broadcast_to(angles, (2,)), 2, "contact", "one or two angles")
    return _core.simulate_two(part, given, starts, lengths, part_rotation, rows, contacts, noise, seed)


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
    """Of a jaw and a wheel on a pin."""
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
