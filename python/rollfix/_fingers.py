"""What rolls on a part: `Disk`, `Jaw`, `OutlineFinger`, and `Wheel` beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Optional, Sequence, Union

from . import _core
from ._checks import number
from ._core import InputError
from ._made import Made
from ._messages import shown
from ._shape import Shape

if TYPE_CHECKING:
    from ._part import Part


class Finger(Made):
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
    """A finger with a convex outline. On its corners it pivots.

    Parameters
    ----------
    outline : Part
        Its outline in its own frame, closed or open. In logs `u` is arc length along it, counter-clockwise from its
        first point.
    """

    __slots__ = ("_outline",)

    def __init__(self, outline: "Part") -> None:
        _core.finger_name(outline._core)  # concave: now, not at the first log
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


class Wheel(Finger):
    """A wheel without skin that turns freely on its pin, beside fingers with skin: docs/rig.md.

    Parameters
    ----------
    radius : float
        Above 0, in the part's unit. Its log has `x` and `y` of the pin, and `psi` where it has an encoder.
    """

    __slots__ = ("_radius",)

    def __init__(self, radius: float) -> None:
        value = number(radius, "radius")
        if not value > 0:
            raise InputError(f"radius: expected a wheel's radius above 0, found {value!r}")
        self._radius = value

    @property
    def radius(self) -> float:
        """float: in the part's unit."""
        return self._radius

    def _given(self) -> Any:
        raise InputError(
            "finger: a Wheel has no skin: `Part.locate` and `Part.watch` take it beside a finger with skin, as in finger=[Jaw(), Wheel(0.4)]"
        )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Wheel) and other._radius == self._radius

    def __hash__(self) -> int:
        return hash(("Wheel", self._radius))

    def __repr__(self) -> str:
        return f"Wheel({self._radius!r})"


FingerLike = Union[Finger, Sequence[Finger]]


def fingers(given: Optional[FingerLike], most: int = 2) -> List[Any]:
    """As the C++ takes them: none, one for all, or one of each."""
    if given is None:
        return []
    several = [given] if isinstance(given, Finger) else list(given) if isinstance(given, (list, tuple)) else None
    if several is None or not all(isinstance(one, Finger) for one in several):
        raise InputError(f"finger: expected Disk(radius), Jaw() or OutlineFinger(part), or two, found {shown(given)}")
    if not 1 <= len(several) <= most:
        expected = "one" if most == 1 else "one or two" if most == 2 else f"one, or one of each up to {most}"
        raise InputError(f"finger: expected {expected}, found {len(several)}")
    return [one._given() for one in several]


def finger_from(given: Any) -> Finger:
    """The other way round."""
    if isinstance(given, str):
        return Jaw()
    if isinstance(given, float):
        return Disk(given)
    return OutlineFinger(Shape._part_of(given))
