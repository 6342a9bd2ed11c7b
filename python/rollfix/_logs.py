"""Tactile logs: from files, data frames, dicts and arrays to what the C++ reads, and back."""

from __future__ import annotations

import os
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._checks import decimal_comma, path, unit_of_length, whole
from ._clock import Clock
from ._columns import FINGERS, Columns, Naming, Units
from ._core import InputError
from ._made import Made
from ._messages import shown, warn
from ._tables import Table, is_table, path_of, text_of
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


def read_log(
    log: Any,
    *,
    columns: Columns = None,
    units: Units = None,
    degrees: bool = False,
    wrapped: Optional[bool] = None,
    unit: str = "",
    roll: Optional[int] = None,
    bad: str = "refuse",
    decimal: str = ".",
) -> Log:
    """A log from a file, a data frame, a dict of arrays, an array, or two of them: one of each finger.

    Parameters
    ----------
    log : path, DataFrame, mapping of arrays, structured array, ndarray, or a pair of them
        Columns by name, in any order, unknown ones ignored: `u` and `psi`, or `length` and `turn`, or `distance` and
        `dturn`; optional `time`, `x`, `y`, `contact`. Of two fingers `u_a`, `psi_a`, `u_b`, `psi_b`. An array without
        names needs `columns`. Times may be dates; of a frame without a column of times its index is taken where that is
        called so or holds dates.
    columns : mapping, or sequence of str for an array
        What the log calls its columns: {"u": "joint_4"}, or with the unit {"u": ("joint_4", "deg")}. Of an array the
        name of each column, in order. As text: "u=joint_4:deg,psi=yaw".
    units : mapping
        In what a column is: {"time": "ms", "psi": "deg", "x": "m"}.
    degrees : bool
        All columns of angles that have no other unit are in degrees.
    wrapped : bool, optional
        Whether u and psi jump back after a full turn. Default: the rows show it; where they are too far apart to show it,
        it is asked. Of one column in `units`: {"u": "unwrapped"}, {"psi": "deg:wrapped"}.
    unit : str
        Of the log's lengths: columns with a unit of their own are converted to it, and all of them to that of a part in
        another unit.
    roll : int, optional
        Of a log in which contact is lost and found again, which roll, from 1. Default: the last, with a warning.
    bad : 'refuse' or 'skip'
        What to do with rows that can't be read: an empty cell, NaN, a time that does not grow. Skipped ones are told of in
        a warning.
    decimal : '.' or ','
        What numbers in a file, or texts in a table, have for a decimal point; between semicolons a comma is seen.

    Returns
    -------
    Log

    Raises
    ------
    InputError
        Naming the column, and of a table the row: missing, not a number, in what it can't be.
    """
    if bad not in ("refuse", "skip"):
        raise InputError(f"bad: expected 'refuse' or 'skip', found {shown(bad)}")
    naming = Naming(columns, units, degrees, wrapped)
    return log_of(log, naming, unit_of_length(unit), roll, skip_bad=bad == "skip", decimal=decimal)


def log_of(
    log: Any, naming: Naming, unit: str, roll: Optional[int], skip_bad: bool = False, decimal: str = "."
) -> Log:
    """`unit` of the part, which `roll` of several."""
    ready = log.log if isinstance(log, Roll) else log
    if isinstance(ready, Log):
        if not naming.says_nothing:
            raise InputError("log: is read already, expected `columns`, `units`, `degrees` and `wrapped` where it was")
        return ready
    options = _reading(naming, unit, skip_bad=skip_bad, decimal=decimal)
    if isinstance(log, (tuple, list)) and log and all(is_log(one) for one in log):
        if len(log) == 2:
            return _told(_pair(log, naming, options, roll))
        if not all(isinstance(one, np.ndarray) and one.ndim == 1 for one in log):
            hint = "; rows as dicts make a table: pandas.DataFrame(rows)" if isinstance(log[0], Mapping) else ""
            raise InputError(f"log: expected one, or a pair of one of each finger, found a list of {len(log)}{hint}")
    return _told(_one(log, naming, options, roll))


def rolls_of(log: Any, naming: Naming, unit: str) -> List[Log]:
    """Every roll of a log in which contact is lost and found again, or of a list of logs, one after another."""
    if isinstance(log, (tuple, list)) and log and all(is_log(one) for one in log):
        return [roll for one in log for roll in rolls_of(one, naming, unit)]
    if isinstance(log, (Log, Roll)):
        return [log_of(log, naming, unit, None)]
    options = _reading(naming, unit, single_rows=True)
    file = path_of(log, "log")
    if file is not None:
        rolls = _of_files([file], naming, options)
    else:
        rolls = _of_table(Table(log, naming, "log", options["decimal_comma"]), options, Clock())
    return [_told(roll) for roll in rolls]


def pin_of(log: Any, naming: Naming, unit: str) -> Any:
    """The log of a wheel without skin, as C++ holds it: x and y of its pin, and psi where it has an encoder."""
    options = _reading(naming, unit)
    if isinstance(log, (Log, Roll)):
        log = log_of(log, naming, unit, None).to_dict()
    file = path_of(log, "log")
    numbering = Numbering()
    try:
        if file is not None:
            naming.require_table("a file")
            core = _core.read_pin(file, None, dict(options, columns=naming.sources()))
        else:
            table = Table(log, naming, "log", options["decimal_comma"])
            numbering = Numbering({table.name: [1]})
            text = text_of(table.numbers(Clock()))
            core = _core.read_pin(text, table.name, dict(options, columns=table.safe_sources()))
    except InputError as error:
        raise InputError(in_python(numbering.said(str(error)))) from None
    return _told(Log(core, numbering))


def _reading(
    naming: Naming, unit: str, *, skip_bad: bool = False, decimal: str = ".", single_rows: bool = False
) -> Dict[str, Any]:
    """How C++ reads a log, but for what it calls its columns."""
    return {
        "unit": unit,
        "angles": naming.angles,
        "wrapped": naming.wrapped,
        "skip_bad": skip_bad,
        "single_rows": single_rows,
        "decimal_comma": decimal_comma(decimal),
    }


def _told(log: Log) -> Log:
    for note in log.notes:
        warn(note)
    return log


def is_log(one: Any) -> bool:
    return isinstance(one, (Log, Roll, str, os.PathLike)) or is_table(one)


def _pair(logs: Sequence[Any], naming: Naming, options: Dict[str, Any], roll: Optional[int]) -> Log:
    names = [f"log{end}" for end in FINGERS]
    paths = [path_of(one, name) for one, name in zip(logs, names)]
    if paths[0] is not None and paths[1] is not None:
        return _chosen(_of_files([paths[0], paths[1]], naming, options), roll)
    sides = [_side(one, naming.of_finger(end), options, roll, name) for one, end, name in zip(logs, FINGERS, names)]
    clock = _common_clock(sides, names)
    a, b = (one if isinstance(one, Log) else _chosen(_of_table(one, options, clock), roll) for one in sides)
    result = Log(a._core, Numbering({**a._numbering.headers, **b._numbering.headers}), clock)
    try:
        result._core = a._core.paired(b._core)
    except InputError as error:
        raise InputError(result._said(str(error))) from None
    return result


def _side(log: Any, naming: Naming, options: Dict[str, Any], roll: Optional[int], name: str) -> Union[Log, Table]:
    """Of one of two fingers; a table is not read before it is known when both begin."""
    if isinstance(log, (Log, Roll)):
        return log.log if isinstance(log, Roll) else log
    file = path_of(log, name)
    return Table(log, naming, name, options["decimal_comma"]) if file is None else _chosen(_of_files([file], naming, options), roll)


def _common_clock(sides: Sequence[Union[Log, Table]], names: Sequence[str]) -> Clock:
    clock = Clock()
    for one, name in zip(sides, names):
        if isinstance(one, Log) and "time" in one.columns:
            clock.join(one._clock, name)
    clock.start(times for one in sides if isinstance(one, Table) for times in one.times.values())
    return clock


def _one(log: Any, naming: Naming, options: Dict[str, Any], roll: Optional[int]) -> Log:
    file = path_of(log, "log")
    if file is not None:
        return _chosen(_of_files([file], naming, options), roll)
    return _chosen(_of_table(Table(log, naming, "log", options["decimal_comma"]), options, Clock()), roll)


def _of_files(paths: List[str], naming: Naming, options: Dict[str, Any]) -> List[Log]:
    naming.require_table("a file")
    try:
        rolls = _core.read_log_files(paths, dict(options, columns=naming.sources()))
    except InputError as error:
        raise InputError(in_python(str(error))) from None
    return [Log(one) for one in rolls]


def _of_table(table: Table, options: Dict[str, Any], clock: Clock) -> List[Log]:
    numbering = Numbering({table.name: [1]})
    text = text_of(table.numbers(clock))
    try:
        rolls = _core.read_log_text(text, table.name, dict(options, columns=table.safe_sources()))
    except InputError as error:
        raise InputError(in_python(numbering.said(str(error)))) from None
    return [Log(one, numbering, clock) for one in rolls]


def _chosen(rolls: List[Log], roll: Optional[int]) -> Log:
    if roll is None:
        if len(rolls) > 1:
            warn(f"log: took roll {len(rolls)} of {len(rolls)}, {rolls[-1].name}; `roll` takes another")
        return rolls[-1]
    number = whole(roll, "roll", 1)
    if number > len(rolls):
        raise InputError(f"roll: the log holds {len(rolls)}, expected a number from 1 to {len(rolls)}, found {number}")
    return rolls[number - 1]


def pandas() -> Any:
    try:
        import pandas as found
    except ImportError:
        raise ImportError("a data frame needs pandas; on Debian: apt-get install python3-pandas") from None
    return found
