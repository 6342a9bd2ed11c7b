"""Contacts that share the pose of a part at rest, touches and rolls: the poses that fit."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping

import numpy as np

from ._checks import array, numbers
from ._core import InputError
from ._documents import Document, Proved
from ._messages import shown
from ._noise import angle_from
from ._tables import is_frame

COLUMNS = ("x", "y", "normal", "position_sd", "normal_sd")


class TouchAdvice(Document):
    """Which touch tells the remaining poses apart: the fields of `rollfix/advise/1`, see docs/json.md.

    `helps`, `why` not; `approach` with `from` and `direction`; `expected_poses`, `bits`, `contenders`, ...
    """

    __slots__ = ()

    def __repr__(self) -> str:
        if not self.helps:
            return f"<TouchAdvice: {self.why}>"
        (x, y), direction = self.approach["from"], np.degrees(self.approach["direction"])
        return (
            f"<TouchAdvice: from x {x:.6g}, y {y:.6g} go in direction {direction:.6g} deg until it touches; "
            f"{self.bits:.2f} of {self.bits_wanted:.2f} bits gained>"
        )


class TouchAnswer(Proved):
    """Every pose of the part that fits touches, rolls, or both: the fields of `rollfix/locate/1`, see docs/json.md.

    `placements` has one entry for each connected set of poses, with noise the most probable first; `poses` has the best
    pose of each as an array. `status`, `verdict`, `fit`, `diagnosis`, `touches`, ...
    """

    __slots__ = ()
    _FIGURE = "touch_figure"

    @property
    def poses(self) -> Any:
        """ndarray, (n, 3): x, y and heading in radians, of the pose that fits best in each set. Of rolls without x and
        y these are NaN."""
        return np.array([one["pose"][0] for one in self.placements], dtype=float).reshape(-1, 3)

    def advise(self, approaches: Any = None) -> TouchAdvice:
        """The next touch: which approach tells the remaining poses apart. The fields of `rollfix/advise/1`.

        Parameters
        ----------
        approaches : array_like, (n, 4), optional
            (x, y, dx, dy): where the finger's centre can start, and which way it goes. Default: many, all around.
        """
        rows = [] if approaches is None else approaches
        if not hasattr(rows, "__iter__") or isinstance(rows, (str, bytes)):
            raise InputError(f"approaches: expected a list of (x, y, dx, dy), found {shown(approaches)}")
        ways = [numbers(way, 4, "approaches", "(x, y, dx, dy)") for way in rows]
        if any(way[2:] == [0, 0] for way in ways):
            raise InputError("approaches: expected directions (dx, dy) that are not (0, 0)")
        return TouchAdvice(self._answer.next_touch(np.array(ways, dtype=float).reshape(-1, 4)))

    def _columns(self) -> Dict[str, List[Any]]:
        placements = self.placements
        columns = {name: self.poses[:, k].tolist() for k, name in enumerate(("x", "y", "heading"))}
        for name in ("kind", "probability"):
            columns[name] = [one[name] for one in placements]
        return columns

    def __repr__(self) -> str:
        if not len(self):
            return f"<TouchAnswer: {self.verdict}>"
        x, y, heading = self.poses[0]
        if np.isnan(x):
            return f"<TouchAnswer: {self.verdict}; heading {np.degrees(heading):.6g} deg>"
        return f"<TouchAnswer: {self.verdict}; x {x:.6g}, y {y:.6g}, heading {np.degrees(heading):.6g} deg>"


def paths_from(clear: Any) -> Any:
    """(n, 4): from x, y to x, y."""
    if not hasattr(clear, "__iter__") or isinstance(clear, (str, bytes)):
        raise InputError(f"clear: expected a list of (x, y, x, y), found {shown(clear)}")
    rows = [numbers(path, 4, "clear", "(x, y, x, y), from where to where nothing was felt") for path in clear]
    return np.array(rows, dtype=float).reshape(-1, 4)


def touches_from(touches: Any) -> Any:
    """(n, 5): x, y, normal and both standard deviations; NaN for what is not there."""
    if is_frame(touches):
        return _rows_of_columns({name: touches[name] for name in touches.columns})
    if isinstance(touches, Mapping):
        return _rows_of_columns(touches)
    if isinstance(touches, np.ndarray) and touches.ndim <= 2:
        touches = [tuple(row) for row in np.atleast_2d(touches)]
    if not hasattr(touches, "__iter__") or isinstance(touches, (str, bytes)):
        raise InputError(f"touches: expected a list of (x, y) or (x, y, normal), found {shown(touches)}")
    rows: List[List[float]] = []
    for number, touch in enumerate(touches, 1):
        values = list(touch) if hasattr(touch, "__iter__") and not isinstance(touch, (str, bytes)) else []
        if not 2 <= len(values) <= len(COLUMNS):
            raise InputError(f"touches: expected (x, y) or (x, y, normal), found {shown(touch)} (touch {number})")
        plain = [_number(value, COLUMNS[k], number) for k, value in enumerate(values)]
        row = array(plain, "touches")
        is_normal_alone = all(value is None for value in values[:2]) and len(row) > 2 and np.isfinite(row[2])
        if not (is_normal_alone or np.isfinite(row[:2]).all()):
            raise InputError(f"touches: expected finite x and y, found {shown(touch)} (touch {number})")
        rows.append([*row, *[float("nan")] * (len(COLUMNS) - len(row))])
    return np.array(rows, dtype=float).reshape(-1, len(COLUMNS))


def _number(value: Any, column: str, number: int) -> Any:
    """NaN for None, which is what was not measured; of an angle also a text such as "162deg"."""
    if value is None:
        return float("nan")
    if not (isinstance(value, str) and column in ("normal", "normal_sd")):
        return value
    angle = angle_from(value)
    if angle is None:
        raise InputError(
            f"touches: {column}: expected radians as a number, or a text such as '162deg', "
            f"found {value!r} (touch {number})"
        )
    return angle


def _rows_of_columns(given: Mapping[Any, Any]) -> Any:
    named = {str(name).strip().lower(): values for name, values in given.items()}
    if "x" not in named or "y" not in named:
        raise InputError(f"touches: expected columns x and y, found {', '.join(map(str, given)) or 'none'}")
    columns = {}
    for column in COLUMNS:
        if column in named:
            values = np.atleast_1d(np.asarray(named[column], dtype=object)).tolist()
            columns[column] = array([_number(value, column, k) for k, value in enumerate(values, 1)], "touches")
    counts = {name: np.size(values) for name, values in columns.items()}
    if len(set(counts.values())) > 1:
        told = ", ".join(f"{name} {count}" for name, count in counts.items())
        raise InputError(f"touches: expected columns of one length, found {told}")
    empty = np.full(counts["x"], np.nan)
    return np.ascontiguousarray(np.column_stack([columns.get(column, empty) for column in COLUMNS]))
