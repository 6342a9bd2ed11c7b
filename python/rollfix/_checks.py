"""What users give, checked where the argument's name is still known: numbers, arrays, names, paths."""

from __future__ import annotations

import math
import os
from typing import Any, List, Mapping, Optional, Tuple

import numpy as np

from . import _core
from ._core import InputError
from ._messages import shown

Array = np.ndarray  # of float64
READINGS = (("length", "turn"), ("length_a", "length_b", "turn"))  # by name, of one finger or of two


def number(value: Any, name: str) -> float:
    """A finite number."""
    try:
        if isinstance(value, (str, bytes, bool, np.bool_)):
            raise ValueError
        result = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected a number, found {shown(value)}") from None
    if not math.isfinite(result):
        raise InputError(f"{name}: expected a finite number, found {result!r}")
    return result


def optional_number(value: Any, name: str) -> Optional[float]:
    return None if value is None else number(value, name)


def least(value: Any, name: str, lowest: float, what: str) -> float:
    """A finite number of at least `lowest`; `what` it is, for the message."""
    result = number(value, name)
    if result < lowest:
        raise InputError(f"{name}: expected {what} of at least {lowest:g}, found {result!r}")
    return result


def numbers(value: Any, count: int, name: str, form: str) -> List[float]:
    """So many finite numbers."""
    named = names_in(value)
    if named:
        raise InputError(f"{name}: expected {form}, found one by names, {', '.join(named)}: give a tuple in that order")
    try:
        found = [] if isinstance(value, (str, bytes)) else [number(one, name) for one in value]
    except TypeError:
        found = []
    if len(found) != count:
        raise InputError(f"{name}: expected {form}, found {shown(value)}")
    return found


def whole(value: Any, name: str, lowest: int = 0, most: Optional[int] = None) -> int:
    try:
        result = int(value)
        if isinstance(value, (str, bytes, bool, np.bool_)) or result != value or result < lowest:
            raise ValueError
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name}: expected a whole number of at least {lowest}, found {shown(value)}") from None
    if most is not None and result > most:
        raise InputError(f"{name}: expected a whole number of at most {most}, found {result}")
    return result


def flag(value: Any, name: str) -> bool:
    """True or False and nothing that happens to count as such: 'no' is a mistake."""
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"{name}: expected True or False, found {shown(value)}")
    return bool(value)


def decimal_comma(decimal: Any) -> bool:
    """Whether numbers have commas."""
    if decimal not in (".", ","):
        raise InputError(f"decimal: expected '.' or ',', found {shown(decimal)}")
    return bool(decimal == ",")


def text(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise InputError(f"{name}: expected a text, found {shown(value)}")
    return value


def unit_of_length(value: Any, name: str = "unit") -> str:
    """Its usual name, such as 'in' of 'inches'; '' stays."""
    return _core.unit_of_length(text(value, name), name)


def radians_up_to(value: Any, name: str, most: float) -> float:
    """An angle from 0 to this. Beyond it degrees were meant."""
    angle = number(value, name)
    if not 0 <= angle <= most:
        limit = "pi" if most == math.pi else f"{most:g}"
        raise InputError(f"{name}: expected radians from 0 to {limit}, found {angle!r}{degrees_hint(angle)}")
    return angle


def degrees_hint(angle: float) -> str:
    """Behind what is said of an angle that is too large."""
    return f"; of degrees make radians: np.radians({angle:g})" if angle > 0 else ""


def corner_angle(value: Any) -> Optional[float]:
    return None if value is None else radians_up_to(value, "corner_angle", math.pi)


def array(values: Any, name: str, masked_is_nan: bool = False) -> Array:
    """Numbers as they are: what is no number, complex, ragged or masked is refused."""
    values = _without_mask(values, name, masked_is_nan)
    try:
        given = np.asarray(values)
        if given.dtype.kind not in "fiub":
            if given.dtype.kind != "O" or _holds_text(given):
                raise ValueError
            given = given.astype(np.float64)
        return np.ascontiguousarray(given, dtype=np.float64) if given.ndim else np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        found = getattr(np.asarray(values, dtype=object), "dtype", None) if not hasattr(values, "dtype") else values.dtype
        raise InputError(f"{name}: expected an array of numbers, found {shown(values)} ({found})") from None


def names_in(values: Any) -> Optional[List[str]]:
    """What a table, or one row of it, calls its columns; None where they have no names, only places."""
    labels = _labels(values)
    if labels == list(range(len(labels))):
        return None
    return [str(one).strip() for one in labels]


def by_name(values: Any, name: str, *wanted: Tuple[str, ...]) -> Any:
    """The columns of a table in the order in which an array has them; what has no names stays as it is.

    `wanted`: the names, of which the first that are all there count.
    """
    if isinstance(values, (list, tuple)) and len(values) > 0 and names_in(values[0]) is not None:
        return [by_name(one, name, *wanted) for one in values]
    found = names_in(values)
    if found is None:
        return values
    for names in wanted:
        if all(found.count(one) == 1 for one in names):
            keys = dict(zip(found, _labels(values)))
            columns = [array(values[keys[one]], f"{name}: {one}", masked_is_nan=True) for one in names]
            return np.stack(np.broadcast_arrays(*columns), axis=-1)
    expected = " or ".join(" and ".join((", ".join(names[:-1]), names[-1])) for names in wanted)
    hint = f"{name}[[...]].to_numpy()" if hasattr(values, "to_numpy") else "numpy.array"
    raise InputError(
        f"{name}: expected the columns {expected}, found {', '.join(found) or 'none'}; name them so, or give an array, "
        f"in that order, as of {hint}"
    )


def _labels(values: Any) -> List[Any]:
    """None of what has no names."""
    if hasattr(values, "columns") and hasattr(values, "dtypes"):
        return list(values.columns)
    if getattr(getattr(values, "dtype", None), "names", None):
        return list(values.dtype.names)
    if isinstance(values, Mapping):
        return list(values)
    is_row = hasattr(values, "index") and hasattr(values, "to_dict") and any(isinstance(one, str) for one in values.index)
    return list(values.index) if is_row else []  # a Series, as of iterrows


def _holds_text(values: np.ndarray) -> bool:
    return any(isinstance(one, (str, bytes)) for one in values.flat)


_ma: Any = np.ma  # numpy has no types of it


def masked_array(values: Any) -> Any:
    """The array, or one of a list of them, with its mask, which numpy.asarray forgets; None where nothing is masked."""
    if isinstance(values, (list, tuple)) and any(isinstance(one, np.ma.MaskedArray) for one in values):
        values = _ma.array(values)
    return values if isinstance(values, np.ma.MaskedArray) and _ma.is_masked(values) else None


def _without_mask(values: Any, name: str, is_nan: bool) -> Any:
    masked = masked_array(values)
    if masked is None:
        return values
    if is_nan:
        return masked.astype(np.float64).filled(np.nan)
    raise InputError(f"{name}: expected numbers, found a masked one{_place(np.argwhere(_ma.getmaskarray(masked))[0])}")


def _place(index: Any) -> str:
    return f" in row {index[0]}" if len(index) > 1 else f" as number {index[0]}" if len(index) else ""


def finite(values: Array, name: str) -> Array:
    """Throws InputError with the first row that is not finite."""
    if not np.isfinite(values).all():
        at = np.argwhere(~np.isfinite(values))[0]
        raise InputError(f"{name}: expected finite numbers, found {values[tuple(at)]}{_place(at)}")
    return values


def places(values: Any) -> Array:
    """Of any shape, along an outline."""
    return finite(array(values, "s"), "s")


def readings(given: Any, turn: Any, name: str = "readings") -> Array:
    """(n, 2) or (n, 3) from all that is taken for readings."""
    if turn is not None:
        length, turned = array(given, "length"), array(turn, "turn")
        if length.shape != turned.shape or length.ndim > 1:
            raise InputError(
                f"turn: expected as many turns as lengths, found shapes {length.shape} and {turned.shape}; of two "
                "fingers give readings of (length_a, length_b, turn)"
            )
        rows = np.stack([np.atleast_1d(length), np.atleast_1d(turned)], axis=-1)
    else:
        rows = array(by_name(given, name, *READINGS), name)
        if rows.ndim == 1:
            rows = rows[np.newaxis]
    if rows.ndim != 2 or rows.shape[1] not in (2, 3):
        raise InputError(
            f"{name}: expected (length, turn) of one finger or (length_a, length_b, turn) of two in each row, an array "
            f"of shape (n, 2) or (n, 3), found shape {np.shape(given)}"
        )
    if len(rows) == 0:
        raise InputError(f"{name}: expected at least one reading, found none")
    return finite(np.ascontiguousarray(rows), name)


def path(value: Any, name: str) -> str:
    if isinstance(value, (str, os.PathLike)):
        found = os.fspath(value)
        if isinstance(found, str):
            return found
    raise InputError(f"{name}: expected a path, found {shown(value)}")


def clockwise(direction: Any, either: bool = False) -> bool:
    """`either`: whether that is taken as well, by whom calls."""
    if isinstance(direction, str) and direction in ("ccw", "cw"):
        return direction == "cw"
    known = "'ccw', 'cw' or 'either'" if either else "'ccw' or 'cw'"
    hint = "; 'either' is of `locate` and `locate_logs`" if not either and direction == "either" else ""
    raise InputError(f"direction: expected {known}, found {shown(direction)}{hint}")


def rounding(given: Any) -> Tuple[float, float]:
    length, turn = numbers(given, 2, "rounding", "(length, turn)")
    if length < 0 or turn < 0:
        raise InputError(f"rounding: expected half units of at least 0, found ({length!r}, {turn!r})")
    return length, turn


def place_prior(given: Any) -> Tuple[float, float]:
    s, sd = numbers(given, 2, "prior", "(s, sd)")
    if not sd > 0:
        raise InputError(f"prior: expected a standard deviation above 0, found {sd!r}")
    return s, sd


def pose_prior(heading: Any, pose: Any) -> Optional[List[float]]:
    """x, y, heading, and the standard deviations of both and of it."""
    if heading is not None and pose is not None:
        raise InputError("heading: `pose` says how the part is turned as well: leave one out")
    if heading is not None:
        angle, sd = numbers(heading, 2, "heading", "(angle, sd)")
        return [0.0, 0.0, angle, float("inf"), _heading_sd(sd, "heading")]
    if pose is None:
        return None
    given = numbers(pose, 5, "pose", "(x, y, heading, sd, sd_heading)")
    if not given[3] > 0:
        raise InputError(f"pose: expected standard deviations above 0, found {given[3]!r}")
    _heading_sd(given[4], "pose")
    return given


def _heading_sd(sd: float, name: str) -> float:
    if not sd > 0:
        raise InputError(f"{name}: expected a standard deviation above 0, found {sd!r}")
    if sd > math.pi:  # says nothing, so degrees were meant
        raise InputError(f"{name}: expected a standard deviation of at most pi radians, found {sd!r}{degrees_hint(sd)}")
    return sd


def travel(given: Any) -> Optional[Tuple[float, float]]:
    """How far a finger can roll on: a length, or (back, forward)."""
    if given is None:
        return None
    if np.ndim(given) == 0:
        most = number(given, "travel")
        if not most > 0:
            raise InputError(f"travel: expected a length above 0, or (back, forward), found {most!r}")
        return (-most, most)
    back, forward = numbers(given, 2, "travel", "a length or (back, forward)")
    if not (back <= 0 <= forward and back < forward):
        raise InputError(f"travel: expected back <= 0 <= forward, found ({back!r}, {forward!r})")
    return (back, forward)


def friction(given: Any) -> Optional[Tuple[float, float]]:
    """One coefficient of both fingers, or one of each."""
    if given is None:
        return None
    if np.ndim(given) == 0:
        one = least(given, "friction", 0, "a coefficient")
        return one, one
    a, b = numbers(given, 2, "friction", "(finger a's, finger b's)")
    return least(a, "friction", 0, "a coefficient"), least(b, "friction", 0, "a coefficient")
