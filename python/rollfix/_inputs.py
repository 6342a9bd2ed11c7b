"""What users give, checked where the argument's name is still known: fingers, noise, arrays."""

from __future__ import annotations

import os
import sys
import warnings
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._core import InputError

if TYPE_CHECKING:
    from ._part import Part


class RollfixWarning(UserWarning):
    """Something was chosen for the user, such as one of a log's several rolls. The message says how to choose."""


def warn(message: str) -> None:
    """A RollfixWarning at the line of the user's that led to it."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == os.path.dirname(__file__):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, RollfixWarning, stacklevel=level)


class Finger:
    """A convex finger that rolls on a part without slipping: `Disk`, `Jaw` or `OutlineFinger`."""

    __slots__ = ()

    def _given(self) -> Any:
        raise NotImplementedError


class Disk(Finger):
    """A round finger.

    Parameters
    ----------
    radius : float
        Above 0, in the part's unit. In logs `u` is the contact's angle in the finger's frame, counter-clockwise,
        radians: L = -radius (u1 - u0), theta = (u1 - u0) + (psi1 - psi0), eqs. (1)-(3).
    """

    __slots__ = ("_radius",)

    def __init__(self, radius: float) -> None:
        value = number(radius, "radius")
        if not value > 0:
            raise InputError(f"radius: expected a disk's radius above 0, found {value!r}")
        self._radius = value

    @property
    def radius(self) -> float:
        """float: in the part's unit."""
        return self._radius

    def _given(self) -> Any:
        return self._radius

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Disk) and other._radius == self._radius

    def __hash__(self) -> int:
        return hash(("Disk", self._radius))

    def __repr__(self) -> str:
        return f"Disk({self._radius!r})"


class Jaw(Finger):
    """A flat jaw without ends. In logs `u` is the contact's place along it, a length; theta = psi1 - psi0."""

    __slots__ = ()

    def _given(self) -> Any:
        return "jaw"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Jaw)

    def __hash__(self) -> int:
        return hash("Jaw")

    def __repr__(self) -> str:
        return "Jaw()"


class OutlineFinger(Finger):
    """A finger with a smooth convex outline.

    Parameters
    ----------
    outline : Part
        Its outline in its own frame, closed or open. In logs `u` is arc length along it, counter-clockwise from its
        first point.
    """

    __slots__ = ("_outline",)

    def __init__(self, outline: "Part") -> None:
        _core.finger_name(outline._core)  # concave, or with corners: now, not at the first log
        self._outline = outline

    @property
    def outline(self) -> "Part":
        """Part: as given."""
        return self._outline

    def _given(self) -> Any:
        return self._outline._core

    def __eq__(self, other: object) -> bool:
        return isinstance(other, OutlineFinger) and other._outline == self._outline

    def __hash__(self) -> int:
        return hash(("OutlineFinger", self._outline))

    def __repr__(self) -> str:
        return f"OutlineFinger({self._outline!r})"


FingerLike = Union[Finger, Sequence[Finger]]


def fingers(given: Optional[FingerLike], most: int = 2) -> List[Any]:
    """As the C++ takes them: none, one for all, or one of each."""
    if given is None:
        return []
    several = [given] if isinstance(given, Finger) else list(given) if isinstance(given, (list, tuple)) else None
    if several is None or not all(isinstance(one, Finger) for one in several):
        raise InputError(f"finger: expected Disk(radius), Jaw() or OutlineFinger(part), or two of them, found {given!r}")
    if not 1 <= len(several) <= most:
        raise InputError(f"finger: expected {'one' if most == 1 else 'one or two'}, found {len(several)}")
    return [one._given() for one in several]


def finger_from(given: Any) -> Finger:
    """The other way round."""
    if isinstance(given, str):
        return Jaw()
    if isinstance(given, float):
        return Disk(given)
    from ._part import Part

    return OutlineFinger(Part._of(given))


class Noise:
    """How far the sensors are off: standard deviations.

    Parameters
    ----------
    contact : float
        Of a contact's place along the outline, in the part's unit, each row on its own.
    angle : float
        Of a turn, radians, each row on its own.
    slip : float
        Of the length travelled, per length.
    radius : float
        Of the finger's radius, in the part's unit.
    position : float
        Of each coordinate of a finger's centre; 0: centres are not looked at.
    correlation : float
        Over this length of a roll rows are off alike.
    drift : float
        Of a gyroscope's rate all along a roll, radians per second.
    walk : float
        Angle random walk of a gyroscope, radians per square root of a second.
    """

    __slots__ = ("_sds",)
    NAMES = ("contact", "angle", "slip", "radius", "position", "correlation", "drift", "walk")

    def __init__(
        self,
        contact: float = 0,
        angle: float = 0,
        slip: float = 0,
        radius: float = 0,
        position: float = 0,
        correlation: float = 0,
        drift: float = 0,
        walk: float = 0,
    ) -> None:
        values = (contact, angle, slip, radius, position, correlation, drift, walk)
        sds = {name: number(value, f"noise: {name}") for name, value in zip(self.NAMES, values)}
        for name, sd in sds.items():
            if sd < 0:
                raise InputError(f"noise: {name} is {sd!r}, expected a standard deviation of at least 0")
        self._sds = sds

    def to_dict(self) -> Dict[str, float]:
        """All of them by name, as in the JSON document."""
        return dict(self._sds)

    def __getattr__(self, name: str) -> float:
        if name in Noise.NAMES:
            return self._sds[name]
        raise AttributeError(name)

    def __getstate__(self) -> Dict[str, float]:
        return self._sds

    def __setstate__(self, state: Dict[str, float]) -> None:
        self._sds = state

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Noise) and other._sds == self._sds

    def __hash__(self) -> int:
        return hash(tuple(self._sds.values()))

    def __repr__(self) -> str:
        return f"Noise({', '.join(f'{name}={sd!r}' for name, sd in self._sds.items() if sd != 0)})"


NoiseLike = Union[Noise, Dict[str, float], None]


def noise(given: NoiseLike) -> Optional[Dict[str, float]]:
    """As the C++ takes it."""
    if given is None:
        return None
    if isinstance(given, Noise):
        return given._sds
    if isinstance(given, dict):
        unknown = [name for name in given if name not in Noise.NAMES]
        if unknown:
            raise InputError(f"noise: there is no {unknown[0]!r}; known are {', '.join(Noise.NAMES)}")
        return Noise(**given)._sds
    raise InputError(f"noise: expected Noise(contact=..., angle=...), found {given!r}")


def number(value: Any, name: str) -> float:
    """A finite number."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected a number, found {value!r}") from None
    if not np.isfinite(result):
        raise InputError(f"{name}: expected a finite number, found {result!r}")
    return result


def optional_number(value: Any, name: str) -> Optional[float]:
    return None if value is None else number(value, name)


def numbers(value: Any, count: int, name: str, form: str) -> List[float]:
    """So many finite numbers."""
    try:
        found = [number(one, name) for one in value]
    except TypeError:
        found = []
    if len(found) != count:
        raise InputError(f"{name}: expected {form}, found {value!r}")
    return found


def whole(value: Any, name: str, least: int = 0) -> int:
    try:
        result = int(value)
        if result != value or result < least:
            raise ValueError
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected a whole number of at least {least}, found {value!r}") from None
    return result


def array(values: Any, name: str) -> "np.ndarray[Any, np.dtype[np.float64]]":
    """Numbers as they are: what is no number, complex or ragged is refused."""
    try:
        given = np.asarray(values)
        if given.dtype.kind not in "fiub":
            if given.dtype.kind != "O":
                raise ValueError
            given = given.astype(np.float64)
        return np.ascontiguousarray(given, dtype=np.float64) if given.ndim else np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        found = getattr(np.asarray(values, dtype=object), "dtype", None) if not hasattr(values, "dtype") else values.dtype
        raise InputError(f"{name}: expected an array of numbers, found {_shown(values)} ({found})") from None


def finite(values: "np.ndarray[Any, np.dtype[np.float64]]", name: str) -> "np.ndarray[Any, np.dtype[np.float64]]":
    """Throws InputError with the first row that is not finite."""
    if not np.isfinite(values).all():
        at = np.argwhere(~np.isfinite(values))[0]
        where = f"row {at[0]}" if values.ndim > 1 else f"number {at[0]}" if values.ndim else "it"
        raise InputError(f"{name}: expected finite numbers, found {values[tuple(at)]} in {where}")
    return values


def _shown(values: Any) -> str:
    text = repr(values).replace("\n", " ")
    return text if len(text) <= 60 else text[:57] + "..."


def readings(given: Any, turn: Any, name: str = "readings") -> "np.ndarray[Any, np.dtype[np.float64]]":
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
        rows = array(given, name)
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
        text = os.fspath(value)
        if isinstance(text, str):
            return text
    raise InputError(f"{name}: expected a path, found {value!r}")


def clockwise(direction: str) -> bool:
    if direction not in ("ccw", "cw"):
        raise InputError(f"direction: expected 'ccw' or 'cw', found {direction!r}")
    return direction == "cw"


def pose_prior(heading: Any, pose: Any) -> Optional[List[float]]:
    """x, y, heading, and the standard deviations of both and of it."""
    if heading is not None and pose is not None:
        raise InputError("heading: `pose` says how the part is turned as well: leave one out")
    if heading is not None:
        angle, sd = numbers(heading, 2, "heading", "(angle, sd)")
        if not sd > 0:
            raise InputError(f"heading: expected a standard deviation above 0, found {sd!r}")
        return [0.0, 0.0, angle, float("inf"), sd]
    if pose is None:
        return None
    given = numbers(pose, 5, "pose", "(x, y, heading, sd, sd_heading)")
    if not (given[3] > 0 and given[4] > 0):
        raise InputError(f"pose: expected standard deviations above 0, found {given[3]!r} and {given[4]!r}")
    return given


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
