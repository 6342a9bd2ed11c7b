"""Rolls that did not happen."""

from __future__ import annotations

from typing import Any, Dict, List, Optional

import numpy as np

from . import _core
from ._checks import array, number, numbers, optional_number, whole
from ._core import InputError
from ._fingers import FingerLike, fingers
from ._messages import shown
from ._noise import NoiseLike, noise as noise_given

MOST_SEED = 2**64 - 1


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
) -> _core.Roll:
    rows, sds, drawn = whole(samples, "samples", 1), noise_given(noise), whole(seed, "seed", 0, MOST_SEED)
    turned = number(part_rotation, "part_rotation")
    given = fingers(finger)
    is_pair = len(given) == 2 or (given and np.ndim(start) > 0)
    if turned != 0 and not is_pair:
        raise InputError("part_rotation: is of two fingers on a part that is free to move, found one on a part at rest")
    if is_pair:
        return _of_two(part, given, start, length, rotation, rows, contact, turned, sds, drawn)
    if finger is None:
        return _of_wheel(part, start, length, rotation, rows, contact, sds, drawn)
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
) -> _core.Roll:
    if length is None or rotation is not None:
        raise InputError("length: expected how far the wheel drives; `rotation` is of a finger")
    if np.ndim(contact) or contact != 0:
        raise InputError(f"contact: is of a finger, and without `finger` it is a wheel that drives, found {shown(contact)}")
    return _core.simulate_drive(part, number(start, "start"), number(length, "length"), rows, noise, seed)


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
