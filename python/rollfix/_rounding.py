"""Digits that a conversion to radians hides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional

import numpy as np

from ._messages import warn

if TYPE_CHECKING:
    from ._answer import Answer

MOST_DECIMALS = 5  # of degrees that somebody typed or a sensor gave
SAME = 1e-12  # of a number: rounding of doubles


def decimals_of(values: np.ndarray) -> Optional[int]:
    """How many decimals give these numbers back; None where it takes more than a few."""
    for count in range(MOST_DECIMALS + 1):
        if np.all(np.abs(np.round(values, count) - values) <= SAME * np.maximum(1, np.abs(values))):
            return count
    return None


def offer_rounding(answer: "Answer", readings: np.ndarray) -> "Answer":
    """Where nothing fits exact readings that come of rounded degrees: says how to take them as rounded."""
    turns, lengths = readings[:, -1], readings[:, :-1]
    degrees = decimals_of(np.degrees(turns))
    if answer.verdict != "inconsistent" or degrees is None or decimals_of(turns) is not None:
        return answer
    along = decimals_of(lengths)
    length = "0" if along is None else f"{0.5 * 10.0 ** -along:.0e}"
    turn = f"np.radians({0.5 * 10.0 ** -degrees:.0e})"
    warn(
        f"readings: no place fits them exactly, and the turns are degrees with {degrees} decimals: "
        f"rounding=({length}, {turn}) takes them as rounded"
    )
    return answer
