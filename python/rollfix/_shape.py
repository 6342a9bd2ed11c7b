"""What a part is, in numbers."""

from __future__ import annotations

from typing import Any, Callable, ClassVar, Dict, Tuple

import numpy as np

from . import _core
from ._checks import places
from ._made import Made
from ._words import in_python


class Shape(Made):
    """An outline as numbers: facts, and functions of arc length."""

    __slots__ = ("_core", "__weakref__")

    _core: _core.Part
    _part_of: ClassVar[Callable[[Any], Any]]  # the Part that C++ holds: `_part` says how, as answers stand below it

    @property
    def name(self) -> str:
        """str: what it was called."""
        return self._core.name

    @property
    def unit(self) -> str:
        """str: of its lengths; '' where nobody said."""
        return self._core.unit

    @property
    def perimeter(self) -> float:
        """float: P, the boundary's length."""
        return self._core.perimeter

    @property
    def closed(self) -> bool:
        """bool: False of a curve with two ends. (Whether `close` was called is not this.)"""
        return self._core.closed

    @property
    def reversed(self) -> bool:
        """bool: given clockwise and stored counter-clockwise, a hole the other way round."""
        return self._core.reversed

    @property
    def total_turn(self) -> float:
        """float: of the tangent along the whole boundary, radians."""
        return self._core.total_turn

    @property
    def turns(self) -> int:
        """int: how often the tangent turns round along a closed boundary; 0 of an open one."""
        return self._core.turns

    @property
    def inflections(self) -> np.ndarray:
        """ndarray: places s where the curvature changes sign."""
        return self._core.inflections

    @property
    def vertices(self) -> np.ndarray:
        """ndarray: places s where the curvature's slope changes sign."""
        return self._core.vertices

    @property
    def corners(self) -> np.ndarray:
        """ndarray, (n, 2): s and turn of each corner, radians; above 0: convex."""
        return self._core.corners

    @property
    def notes(self) -> Tuple[str, ...]:
        """tuple of str: what was left out, joined or chosen when it was made."""
        return tuple(map(in_python, self._core.notes))

    def point(self, s: Any) -> np.ndarray:
        """Positions at s.

        Parameters
        ----------
        s : array_like of any shape
            Any number on a closed part; on an open one clamped to [0, P].

        Returns
        -------
        ndarray, s.shape + (2,)
        """
        return self._core.point(places(s))

    def turning(self, s: Any) -> np.ndarray:
        """The turning function Theta(s): the tangent's angle, radians, unwrapped; accurate to 1e-12. Just after s.

        Parameters
        ----------
        s : array_like of any shape

        Returns
        -------
        ndarray of the same shape
        """
        return self._core.turning(places(s))

    def curvature(self, s: Any) -> np.ndarray:
        """kappa(s) = dTheta/ds, positive where convex. Shapes as of `turning`."""
        return self._core.curvature(places(s))

    def tangent(self, s: Any) -> np.ndarray:
        """Theta(s) in (-pi, pi]. Shapes as of `turning`."""
        return self._core.tangent(places(s))

    def distance(self, s: Any, t: Any) -> Any:
        """How far apart places are along the boundary, of a closed part the shorter way round, whatever laps they name.

        Parameters
        ----------
        s, t : array_like, of shapes that go together

        Returns
        -------
        float, or ndarray
        """
        return self._core.distance(*np.broadcast_arrays(places(s), places(t)))[()]

    def samples(self) -> Dict[str, np.ndarray]:
        """The boundary as numbers, as densely as its shape asks for: `s`, `x`, `y`, `tangent` (unwrapped), `curvature`."""
        return self._core.samples()
