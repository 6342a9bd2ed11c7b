"""How far sensors are off."""

from __future__ import annotations

import inspect
import math
import re
from typing import Any, Dict, Mapping, Optional, Tuple, Union

from ._checks import number
from ._core import InputError
from ._made import no_value
from ._messages import did_you_mean, shown, warn

MOST_ANGLE = 0.5  # radians: beyond that a row says nothing, and degrees were meant
UNUSUAL_ANGLE = 0.1  # radians: from there on a number without a unit may well be degrees
_ANGLE = re.compile(r"\s*([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(deg|°|rad)\s*", re.IGNORECASE)


class Noise:
    """How far the sensors are off: standard deviations.

    Parameters
    ----------
    contact : float
        Of a contact's place along the outline, in the part's unit, each row on its own.
    angle : float or str
        Of a turn, each row on its own: a number in radians, or a text with the unit, "0.5deg" or "0.2rad". A number of 0.1
        or more is taken in radians as any other, with a warning that says how to write degrees.
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
    gyro : float
        Of a gyroscope's scale: of all turns that it measures, per turn.
    """

    __slots__ = ("_sds",)
    NAMES: Tuple[str, ...]

    def __init__(
        self,
        contact: float = 0,
        angle: Union[float, str] = 0,
        slip: float = 0,
        radius: float = 0,
        position: float = 0,
        correlation: float = 0,
        drift: float = 0,
        walk: float = 0,
        gyro: float = 0,
    ) -> None:
        given = locals()
        sds = {name: _angle(angle) if name == "angle" else number(given[name], f"noise: {name}") for name in self.NAMES}
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
        raise no_value(self, name)

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


Noise.NAMES = tuple(inspect.signature(Noise).parameters)


def angle_from(text: str) -> Optional[float]:
    """Radians of "0.5deg" or "0.2rad"; None of anything else."""
    found = _ANGLE.fullmatch(text)
    if not found:
        return None
    try:
        value = float(found[1])
    except ValueError:  # such as 1.2.3
        return None
    return value if found[2].lower() == "rad" else math.radians(value)


def _angle(given: Any) -> float:
    """Radians."""
    if isinstance(given, str):
        angle = angle_from(given)
        if angle is None:
            raise InputError(f"noise: angle: expected radians as a number, or a text such as '0.5deg', found {given!r}")
        return number(angle, "noise: angle")
    value = number(given, "noise: angle")
    if UNUSUAL_ANGLE <= value <= MOST_ANGLE:
        warn(
            f"noise: angle {value!r} is in radians, {math.degrees(value):.3g} degrees: "
            f"write angle='{value:g}deg' or angle='{value:g}rad'"
        )
    return value


NoiseLike = Union[Noise, Mapping[str, Any], None]


def noise(given: NoiseLike) -> Optional[Dict[str, float]]:
    """As the C++ takes it."""
    if given is None:
        return None
    if isinstance(given, Noise):
        return given._sds
    if isinstance(given, Mapping):
        unknown = [name for name in given if name not in Noise.NAMES]
        if unknown:
            hint = did_you_mean(unknown[0], Noise.NAMES)
            raise InputError(f"noise: there is no {unknown[0]!r}; {hint}known are {', '.join(Noise.NAMES)}")
        return Noise(**given)._sds
    raise InputError(f"noise: expected Noise(contact=..., angle=...), found {shown(given)}")
