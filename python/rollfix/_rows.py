"""Placements as rows of a table: `dict(placement)`, and what data frames make of an answer."""

from __future__ import annotations

import collections.abc
from typing import Any, Dict, Iterator, List, Tuple

from ._core import Placement

OF_FINGER = ("start", "end", "extent_lo", "extent_hi", "x", "y", "tangent")
OF_NOISE = ("mean", "sd", "interval_lo", "interval_hi", "end_mean", "end_sd")
POSE = ("pose_x", "pose_y", "pose_heading")  # at the first contact


def names_of(fingers: int, has_noise: bool, has_pose: bool) -> Tuple[str, ...]:
    of_each = OF_FINGER + (OF_NOISE if has_noise else ())
    ends = [""] if fingers == 1 else ["_a", "_b"]
    return (
        "kind",
        *(["probability"] if has_noise else []),
        *(name + end for end in ends for name in of_each),
        *(POSE if has_pose else ()),
        *([] if has_noise else ["contradicted"]),
        "residual",
        "error",
    )


def row_of(placement: Placement) -> Dict[str, Any]:
    """All that a row of any answer has."""
    row: Dict[str, Any] = {
        "kind": placement.kind,
        "probability": placement.probability,
        "contradicted": placement.contradicted,
        "residual": placement.residual,
        "error": placement.error,
    }
    pose = placement.pose
    row.update({name: None if pose is None else pose[0, k] for k, name in enumerate(POSE)})
    for k, end in enumerate([""] if len(placement.start) == 1 else ["_a", "_b"]):
        row["start" + end], row["end" + end] = placement.start[k], placement.end[k]
        row["extent_lo" + end], row["extent_hi" + end] = placement.extent[k]
        row["x" + end], row["y" + end] = placement.point[k]
        row["tangent" + end] = placement.tangent[k]
        lo, hi = (None, None) if placement.interval is None else placement.interval[k]
        row["interval_lo" + end], row["interval_hi" + end] = lo, hi
        for name in ("mean", "sd", "end_mean", "end_sd"):
            values = getattr(placement, name)
            row[name + end] = None if values is None else values[k]
    return row


def _keys(self: Placement) -> List[str]:
    has_noise = self.probability is not None
    return list(names_of(len(self.start), has_noise, self.pose is not None))


def _item(self: Placement, name: str) -> Any:
    if name not in _keys(self):
        raise KeyError(name)
    return row_of(self)[name]


def _iterate(self: Placement) -> Iterator[str]:
    return iter(_keys(self))


# C++ makes the class. A data frame asks whether its rows are mappings.
setattr(Placement, "keys", _keys)
setattr(Placement, "__getitem__", _item)
setattr(Placement, "__iter__", _iterate)
collections.abc.Mapping.register(Placement)
