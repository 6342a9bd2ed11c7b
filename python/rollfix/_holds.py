"""Three and more fingers, or fingers beside wheels, that hold and roll on a part that is free to move."""

from __future__ import annotations

from typing import Any, Dict, List

import numpy as np

from ._checks import travel as travel_given
from ._documents import Document, Proved


class PinAdvice(Document):
    """How the pin of a wheel without skin moves next: the fields of `rollfix/advise/1`, see docs/json.md.

    `pin` is how far, (x, y) in the jaw's frame, or None. `helps`, and where no motion does `why`; each of the `contenders` has
    the `length` that the jaw's contact would travel.
    """

    __slots__ = ()

    def __repr__(self) -> str:
        if not self.helps:
            return f"<PinAdvice: {self.verdict}; {self.why}>"
        by = ", ".join(f"{one:.6g}" for one in self.pin)
        return f"<PinAdvice: {self.verdict}; move the pin by ({by}), {self.expected_placements:.2f} placements remain>"


class HoldAnswer(Proved):
    """Every set of first contacts of several fingers that fits: the fields of `rollfix/locate/1`, see docs/json.md.

    `placements` has one entry for each connected set, with noise the most probable first; `starts` and `ends` have the
    places of all fingers, `poses` the part's at the first and at the last contacts. `diagnosis` lists what may be wrong
    where nothing fits, or the rows contradict the noise; None elsewhere. `status`, `verdict`, `fit`, ...
    """

    __slots__ = ()
    _FIGURE = "hold_figure"

    @property
    def starts(self) -> Any:
        """ndarray, (n, fingers): s of the first contacts."""
        return np.array([one["start"] for one in self.placements], dtype=float).reshape(len(self), -1)

    @property
    def ends(self) -> Any:
        """ndarray, (n, fingers): s of the last contacts."""
        return np.array([one["end"] for one in self.placements], dtype=float).reshape(len(self), -1)

    @property
    def poses(self) -> Any:
        """ndarray, (n, 2, 3): x, y and heading in radians at the first contacts and at the last. Of logs without x and y
        these are NaN."""
        return np.array([one["pose"] for one in self.placements], dtype=float).reshape(-1, 2, 3)

    def advise(self, *, travel: Any = None) -> PinAdvice:
        """Of a jaw beside a wheel: how its pin moves next, to tell the placements apart.

        Parameters
        ----------
        travel : float or (float, float), optional
            How far the pin can go: a length, or (back, forward) with back <= 0. Default: a tenth of the perimeter.
        """
        return PinAdvice(self._answer.next_pin(travel_given(travel)))

    def _columns(self) -> Dict[str, List[Any]]:
        """Fingers are a, b, c, ...; with noise there are more."""
        placements = self.placements
        columns: Dict[str, List[Any]] = {}
        if self.noise is not None:
            columns["probability"] = [one["probability"] for one in placements]
        for finger in range(self.fingers):
            for name in ("start", "end", "sd", "end_sd"):
                if all(name in one for one in placements):
                    columns[f"{name}_{chr(ord('a') + finger)}"] = [one[name][finger] for one in placements]
        for name, number in (("first", 0), ("last", 1)):
            for k, coordinate in enumerate(("x", "y", "heading")):
                columns[f"{name}_{coordinate}"] = self.poses[:, number, k].tolist()
        return columns

    def __repr__(self) -> str:
        if not len(self):
            return f"<HoldAnswer: {self.verdict}>"
        return f"<HoldAnswer: {self.verdict}; starts {', '.join(f'{s:.6g}' for s in self.starts[0])}>"
