"""Where a finger can touch a part."""

from __future__ import annotations

from typing import Any, Tuple

import numpy as np

from . import _core
from ._checks import places
from ._fingers import Finger, finger_from
from ._made import Made


class Reach(Made):
    """Where a finger can touch a part without entering it anywhere.

    See docs/reach.md. Lengths are in the part's unit; s runs along the stored outline.
    """

    __slots__ = ("_core", "_part", "_given")

    def __init__(self, part: _core.Part, given: Any) -> None:
        self._core = _core.reach_of(part, given)
        self._part = part
        self._given = given

    @property
    def finger(self) -> Finger:
        """Finger: as given."""
        return finger_from(self._given)

    @property
    def arcs(self) -> np.ndarray:
        """ndarray, (n, 2): along these the finger can roll; lo in [0, P), hi may exceed P."""
        return self._core.arcs

    @property
    def gaps(self) -> np.ndarray:
        """ndarray, (n, 2): there it can't touch."""
        return self._core.gaps

    @property
    def share(self) -> float:
        """float: of the boundary's length that is within reach."""
        return self._core.share

    @property
    def is_whole(self) -> bool:
        """bool: every place, and every pivot at corners."""
        return self._core.is_whole

    @property
    def decided(self) -> bool:
        """bool: False where a budget ran out; what is not decided counts as within reach."""
        return self._core.decided

    @property
    def slack(self) -> float:
        """float: how deep it may enter and still counts as touching, length."""
        return self._core.slack

    def contains(self, s: Any) -> np.ndarray:
        """Whether the finger can touch at s.

        Parameters
        ----------
        s : array_like of any shape

        Returns
        -------
        ndarray of bool, of the same shape
        """
        return self._core.contains(places(s))

    def _facts(self) -> Tuple[Any, ...]:
        return (self.finger, self.arcs.tobytes(), self.gaps.tobytes(), self.share, self.slack, self.decided)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Reach) and self._facts() == other._facts()

    def __hash__(self) -> int:
        return hash(self._facts())

    def __repr__(self) -> str:
        undecided = "" if self.decided else ", undecided in places"
        arcs = "1 arc" if len(self.arcs) == 1 else f"{len(self.arcs)} arcs"
        extent = "all" if self.is_whole else f"{self.share:.4g} of it, {arcs}"
        return f"<Reach of {self.finger!r} along the boundary: {extent}{undecided}>"

    def __reduce__(self) -> Any:
        return (Reach, (self._part, self._given))
