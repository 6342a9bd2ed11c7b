"""Rolls that did not happen."""

from __future__ import annotations

import functools
from typing import Any, Dict, List, Optional

import numpy as np

from . import _core
from ._checks import array, number, numbers, optional_number, whole
from ._core import InputError
from ._fingers import FingerLike, fingers
from ._messages import shown, warn
from ._noise import NoiseLike, noise as noise_given

MOST_SEED = 2**64 - 1


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
