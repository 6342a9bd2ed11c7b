"""Tactile logs, and simulated rolls, as values."""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from . import _core
from ._checks import path
from ._clock import Clock
from ._core import InputError
from ._made import Made
from ._words import Numbering, in_python


class Log(Made, Dict[str, np.ndarray]):
    """What one finger, or two together, recorded of one roll: its columns by name. It can't be changed.

    Made by `read_log` and `simulate`. Angles are radians, unwrapped or not as they were given; lengths are in the part's
    unit; `time` is in seconds. `len` is the number of rows; `log["u"]` is a column. Of increments `log["length"]` and
    `log["turn"]` are their sums from the first contact. A dict to whoever asks, such as `pandas.DataFrame(log)`; empty as
    such, as the columns are made when they are asked for.
    """

    __slots__ = ("_core", "_columns", "_numbering", "_clock")

    def __init__(
        self, core: _core.Log, numbering: Optional[Numbering] = None, clock: Optional[Clock] = None
    ) -> None:
        self._core = core
        self._columns: Optional[Dict[str, np.ndarray]] = None
        self._numbering = numbering or Numbering()  # of a file its lines are told
        self._clock = clock or Clock()

    def to_dict(self) -> Dict[str, np.ndarray]:
        """The columns by name, of two fingers `u_a`, `psi_a`, ..., `u_b`, ...: arrays that can't be written to."""
        if self._columns is None:
            self._columns = self._core.columns(False)
        return dict(self._columns)

    @property
    def columns(self) -> Tuple[str, ...]:
        """tuple of str: their names."""
        return tuple(self.to_dict())

    @property
    def kind(self) -> str:
        """str: 'contact' (u, psi), 'travelled' (length, turn) or 'increments' (distance, dturn)."""
        return self._core.kind

    @property
    def fingers(self) -> int:
        """int: 1 or 2."""
        return self._core.fingers

    @property
    def name(self) -> str:
        """str: what messages call it."""
        return self._numbering.said(self._core.name)

    @property
    def notes(self) -> Tuple[str, ...]:
        """tuple of str: what else stands in it that may have been meant, such as another finger, and what was left out."""
        notes = [self._said(note) for note in self._core.notes]
        skipped = self._core.skipped
        if skipped:
            some = "1 row was" if len(skipped) == 1 else f"{len(skipped)} rows were"
            notes.append(f"{self.name}: {some} left out, the first: {self._said(skipped[0])}")
        return tuple(notes)

    def to_frame(self) -> Any:
        """The columns as a pandas.DataFrame: a log of the same kind and the same bits. So is `pandas.DataFrame(log)`."""
        return pandas().DataFrame(self.to_dict())

    def save(self, file: Any) -> None:
        """Writes it as CSV with 17 digits: reading it back gives a log of the same kind and the same bits."""
        with open(path(file, "file"), "w", encoding="utf-8") as out:
            out.write(self._core.text())

    def __len__(self) -> int:
        return self._core.rows

    def __getitem__(self, column: str) -> np.ndarray:
        columns = self.to_dict()
        if column in columns:
            return columns[column]
        sums = self._core.columns(True) if self.kind == "increments" else {}
        if column not in sums:
            raise KeyError(f"{column!r}; the log has {', '.join(columns)}")
        return sums[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __contains__(self, column: object) -> bool:
        return column in self.columns

    def keys(self) -> Any:
        """The columns' names."""
        return self.to_dict().keys()

    def values(self) -> Any:
        """The columns."""
        return self.to_dict().values()

    def items(self) -> Any:
        """The columns with their names."""
        return self.to_dict().items()

    def get(self, column: str, default: Any = None) -> Any:
        """A column, or `default` where the log has none of the name."""
        return self[column] if column in self else default

    def copy(self) -> Dict[str, np.ndarray]:
        """The columns as a dict of its own."""
        return self.to_dict()

    def _refuse(self, *given: Any, **named: Any) -> Any:
        raise TypeError("a Log can't be changed: change log.copy(), a dict, and give that to read_log")

    __setitem__ = __delitem__ = _refuse
    update = pop = popitem = clear = setdefault = __ior__ = _refuse  # type: ignore[assignment]

    def plot(self, ax: Any = None, **style: Any) -> Any:
        """Draws the columns over time, or over rows, on matplotlib axes, and returns them; `style` as of `plot`."""
        from ._plots import plot_log

        return plot_log(self, ax, style)

    def __ne__(self, other: object) -> bool:
        return not self == other

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Log) and self._core.is_same(other._core)

    def __hash__(self) -> int:  # type: ignore[override]
        return hash((self.name, len(self)))

    def __repr__(self) -> str:
        return f"<Log {self.name!r}: {len(self)} rows of {', '.join(self.columns)}>"

    def __reduce__(self) -> Any:
        return (_log, (self._core, self._numbering.headers, self._clock))

    def _in_unit(self, unit: str, given: Sequence[Any]) -> "Log":
        """As a part in this unit has it; the same where one of both units is not known."""
        if not self._core.unit or not unit or self._core.unit == unit:
            return self
        try:
            return Log(self._core.in_unit(unit, given), self._numbering, self._clock)
        except InputError as error:
            raise InputError(self._said(str(error))) from None

    def _said(self, message: str) -> str:
        """What C++ says of it, in Python's words."""
        return in_python(self._numbering.said(message))


def _log(core: _core.Log, headers: Dict[str, List[int]], clock: Clock) -> Log:
    return Log(core, Numbering(headers), clock)


class Roll(Made):
    """A simulated roll: what the sensors say, and how it really was.

    `part.locate(log=roll, ...)` takes it as it is.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Roll) -> None:
        self._core = core

    @property
    def log(self) -> Log:
        """Log: what the sensors say."""
        core = self._core.log
        return Log(core, Numbering({core.name: []}))

    @property
    def s(self) -> Tuple[np.ndarray, ...]:
        """tuple of ndarray, (rows,) for each finger: where the contact really is, unwrapped: s[0][k] - s[0][0] is L."""
        return self._core.s

    @property
    def pose(self) -> np.ndarray:
        """ndarray, (rows, 3): x, y, heading of a part that is free to move; (0, 3) of a part at rest."""
        return self._core.pose

    @property
    def slip(self) -> np.ndarray:
        """ndarray, (fingers,): the contact travelled 1 + slip times as far as the finger was rolled off."""
        return self._core.slip

    @property
    def radius_error(self) -> np.ndarray:
        """ndarray, (fingers,): the disk's true radius less the one that the log's reader takes."""
        return self._core.radius_error

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Roll) and self.log == other.log and self._truth() == other._truth()

    def __hash__(self) -> int:
        return hash(self._truth()[0])

    def _truth(self) -> Tuple[bytes, ...]:
        return tuple(one.tobytes() for one in (*self.s, self.pose, self.slip, self.radius_error))

    def __repr__(self) -> str:
        return f"<Roll: {len(self.log)} rows from s = {', '.join(f'{s[0]:.4f}' for s in self.s)}>"

    def __reduce__(self) -> Any:
        return (Roll, (self._core,))


def pandas() -> Any:
    try:
        import pandas as found
    except ImportError:
        raise ImportError("a data frame needs pandas; on Debian: apt-get install python3-pandas") from None
    return found
