"""Tactile logs: from files, data frames, dicts and arrays to what the C++ reads, and back."""

from __future__ import annotations

import os
import re
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._core import InputError
from ._inputs import array, path, warn, whole

COLUMNS = ("time", "u", "psi", "x", "y", "contact", "length", "turn", "distance", "dturn")
Source = Tuple[str, str, str]  # column, name in the log, unit
Columns = Union[Mapping[str, Union[str, Tuple[str, str]]], Sequence[str], str, None]
_UNSAFE = re.compile(r"[,;\t\"#\r\n]")


class Log:
    """What one finger, or two together, recorded of one roll.

    Made by `read_log` and `simulate`. Angles are radians, unwrapped or not as they were given; lengths are in the part's
    unit; `time` is in seconds. `len` is the number of rows; `log["u"]` is a column.
    """

    __slots__ = ("_core", "_columns")

    def __init__(self, core: _core.Log) -> None:
        self._core = core
        self._columns: Optional[Dict[str, np.ndarray]] = None

    def to_dict(self) -> Dict[str, np.ndarray]:
        """The columns by name, of two fingers `u_a`, `psi_a`, ..., `u_b`, ...: arrays that can't be written to."""
        if self._columns is None:
            self._columns = self._core.columns()
        return dict(self._columns)

    @property
    def columns(self) -> Tuple[str, ...]:
        """tuple of str: their names."""
        return tuple(self.to_dict())

    @property
    def kind(self) -> str:
        """str: 'contact' (u, psi), 'travelled' (length, turn) or 'increments' (distance, dturn; here added up)."""
        return self._core.kind

    @property
    def fingers(self) -> int:
        """int: 1 or 2."""
        return self._core.fingers

    @property
    def name(self) -> str:
        """str: what messages call it."""
        return self._core.name

    def to_frame(self) -> Any:
        """The columns as a pandas.DataFrame."""
        return _pandas().DataFrame(self.to_dict())

    def save(self, file: Any) -> None:
        """Writes it as CSV with 17 digits: reading it back gives the same bits."""
        with open(path(file, "file"), "w", encoding="utf-8") as out:
            out.write(self._core.text())

    def __len__(self) -> int:
        return self._core.rows

    def __getitem__(self, column: str) -> np.ndarray:
        columns = self.to_dict()
        if column not in columns:
            raise KeyError(f"{column!r}; the log has {', '.join(columns)}")
        return columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Log) and self._core.is_same(other._core)

    def __hash__(self) -> int:
        return hash((self.name, len(self)))

    def __repr__(self) -> str:
        return f"<Log {self.name!r}: {len(self)} rows of {', '.join(self.columns)}>"

    def __reduce__(self) -> Any:
        return (Log, (self._core,))


class Roll:
    """A simulated roll: what the sensors say, and how it really was.

    `part.locate(log=roll, ...)` takes it as it is.
    """

    __slots__ = ("_core",)

    def __init__(self, core: _core.Roll) -> None:
        self._core = core

    @property
    def log(self) -> Log:
        """Log: what the sensors say."""
        return Log(self._core.log)

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

    def __repr__(self) -> str:
        return f"<Roll: {len(self.log)} rows from s = {', '.join(f'{s[0]:.4f}' for s in self.s)}>"

    def __reduce__(self) -> Any:
        return (Roll, (self._core,))


def read_log(
    log: Any,
    *,
    columns: Columns = None,
    units: Optional[Mapping[str, str]] = None,
    degrees: bool = False,
    unit: str = "",
    roll: Optional[int] = None,
) -> Log:
    """A log from a file, a data frame, a dict of arrays, an array, or two of them: one of each finger.

    Parameters
    ----------
    log : path, DataFrame, mapping of arrays, structured array, ndarray, or a pair of them
        Columns by name, in any order, unknown ones ignored: `u` and `psi`, or `length` and `turn`, or `distance` and
        `dturn`; optional `time`, `x`, `y`, `contact`. Of two fingers `u_a`, `psi_a`, `u_b`, `psi_b`. An array without
        names needs `columns`.
    columns : mapping, or sequence of str for an array
        What the log calls its columns: {"u": "joint_4"}, or with the unit {"u": ("joint_4", "deg")}. Of an array the
        name of each column, in order.
    units : mapping
        In what a column is: {"time": "ms", "psi": "deg", "x": "m"}.
    degrees : bool
        All columns of angles that have no other unit are in degrees.
    unit : str
        The part's, for columns of lengths with a unit of their own.
    roll : int, optional
        Of a log in which contact is lost and found again, which roll, from 1. Default: the last, with a warning.

    Returns
    -------
    Log

    Raises
    ------
    InputError
        Naming the column, and of a table the row: missing, not a number, in what it can't be.
    """
    return Log(core_log(log, columns, units, degrees, unit, False, roll))


def core_log(
    log: Any,
    columns: Columns,
    units: Optional[Mapping[str, str]],
    degrees: bool,
    unit: str,
    clockwise: bool,
    roll: Optional[int],
) -> _core.Log:
    ready = log.log if isinstance(log, Roll) else log
    if isinstance(ready, Log):
        if columns is not None or units or degrees or clockwise:
            raise InputError("log: is read already, expected `columns`, `units`, `degrees` and `direction` where it was")
        return ready._core
    sources = sources_of(columns, units)
    options = {"columns": sources, "unit": unit, "angles": "deg" if degrees else "", "clockwise": clockwise}
    if isinstance(log, (tuple, list)) and len(log) == 2 and all(_is_log(one) for one in log):
        if all(isinstance(one, (str, os.PathLike)) for one in log):
            return _chosen(_core.read_log_files([path(one, "log") for one in log], options), roll)
        return _pair(log, columns, options, roll)
    return _chosen(_rolls(log, columns, options, "log"), roll)


def _is_log(one: Any) -> bool:
    return isinstance(one, (Log, Roll, str, os.PathLike, Mapping, np.ndarray)) or hasattr(one, "dtypes")


def _pair(logs: Sequence[Any], columns: Columns, options: Dict[str, Any], roll: Optional[int]) -> _core.Log:
    both = []
    for log, own, other in ((logs[0], "_a", "_b"), (logs[1], "_b", "_a")):
        sources = [
            (column[: -len(own)] if column.endswith(own) else column, name, unit)
            for column, name, unit in options["columns"]
            if not column.endswith(other)
        ]
        if isinstance(log, (Log, Roll)):
            both.append((log.log if isinstance(log, Roll) else log)._core)
        else:
            both.append(_chosen(_rolls(log, columns, dict(options, columns=sources), f"log{own}"), roll))
    return both[0].paired(both[1])


def _chosen(rolls: List[_core.Log], roll: Optional[int]) -> _core.Log:
    if roll is None:
        if len(rolls) > 1:
            message = f"log: took roll {len(rolls)} of {len(rolls)}, {rolls[-1].name}; `roll` takes another"
            warn(message)
        return rolls[-1]
    number = whole(roll, "roll", 1)
    if number > len(rolls):
        raise InputError(f"roll: the log holds {len(rolls)}, expected a number from 1 to {len(rolls)}, found {number}")
    return rolls[number - 1]


def _rolls(log: Any, columns: Columns, options: Dict[str, Any], name: str) -> List[_core.Log]:
    try:
        names, arrays = table_of(log, columns, options["columns"], name)
    except _IsPath:
        return _core.read_log_files([path(log, name)], options)
    safe = [_UNSAFE.sub("_", one) for one in names]
    sources = [(column, _UNSAFE.sub("_", called), unit) for column, called, unit in options["columns"]]
    text = _core.table_text(safe, arrays)
    try:
        return _core.read_log_text(text, name, dict(options, columns=sources))
    except InputError as error:
        raise InputError(in_rows(str(error), name)) from None


def in_rows(message: str, name: str) -> str:
    """Line n of the text that a table was made into is row n - 2 of the table."""
    message = re.sub(rf"^{name}:1: the header ", f"{name}: the header ", message)
    message = re.sub(rf"^{name}:1:", f"{name}:", message)
    return re.sub(rf"\b{name}:(\d+)", lambda found: f"{name}: row {int(found[1]) - 2}", message)


class _IsPath(Exception):
    pass


def table_of(log: Any, columns: Columns, sources: List[Source], name: str) -> Tuple[List[str], List[np.ndarray]]:
    """Names and columns of numbers. Columns that are neither known nor named may hold anything."""
    if isinstance(log, Mapping):
        pairs = [(str(key), log[key]) for key in log]
    elif hasattr(log, "columns") and hasattr(log, "dtypes"):  # a data frame
        pairs = [(str(key), log[key]) for key in log.columns]
    elif getattr(getattr(log, "dtype", None), "names", None):
        pairs = [(key, log[key]) for key in log.dtype.names]
    elif isinstance(log, np.ndarray) or isinstance(log, (list, tuple)):
        pairs = _columns_of_array(array(log, name), columns, name)
    elif hasattr(log, "read") or not isinstance(log, (str,)) and not hasattr(log, "__fspath__"):
        raise InputError(
            f"{name}: expected a path, a data frame, a dict of arrays, or an array with `columns`, found {type(log).__name__}"
        )
    else:
        raise _IsPath
    wanted = {called for _, called, _ in sources} | {one + end for one in COLUMNS for end in ("", "_a", "_b")}
    names: List[str] = []
    arrays: List[np.ndarray] = []
    for key, values in pairs:
        is_wanted = key in wanted or re.sub(r"\s*[\[(].*[\])]$", "", key) in wanted
        column = _numbers_of(values, key, name, is_wanted)
        if column is None:
            continue
        names.append(key)
        arrays.append(column)
    sizes = {len(one) for one in arrays}
    if len(sizes) > 1:
        shown = ", ".join(f"{key} {len(one)}" for key, one in zip(names, arrays))
        raise InputError(f"{name}: expected columns of one length, found {shown}")
    return names, arrays


def _numbers_of(values: Any, key: str, name: str, is_wanted: bool) -> Optional[np.ndarray]:
    column = np.asarray(values)
    if column.dtype.kind in "mM":  # a clock, which says its unit itself
        if not is_wanted:
            return None
        since = column - column[0] if column.dtype.kind == "M" and len(column) else column
        return np.ascontiguousarray(since / np.timedelta64(1, "s"), dtype=np.float64)
    try:
        numbers = array(values, f"{name}: the column {key!r}")
    except InputError:
        if is_wanted:
            raise
        return None
    if numbers.ndim != 1:
        raise InputError(f"{name}: the column {key!r} has shape {numbers.shape}, expected one number in each row")
    return numbers


def _columns_of_array(rows: np.ndarray, columns: Columns, name: str) -> List[Tuple[str, np.ndarray]]:
    if columns is None or isinstance(columns, (str, Mapping)):
        raise InputError(
            f"{name}: an array has no names, expected `columns` with that of each column, as in columns=('time', 'u', 'psi')"
        )
    if rows.ndim != 2 or rows.shape[1] != len(columns):
        raise InputError(
            f"{name}: expected an array of shape (n, {len(columns)}), as `columns` has names, found {rows.shape}"
        )
    return [(key, np.ascontiguousarray(rows[:, k])) for k, key in enumerate(columns)]


def sources_of(columns: Columns, units: Optional[Mapping[str, str]]) -> List[Source]:
    """What each column is called, and in what it is."""
    sources: Dict[str, Tuple[str, str]] = {}
    if isinstance(columns, str):
        sources = {column: (name, unit) for column, name, unit in _core.parse_columns(columns)}
    elif isinstance(columns, Mapping):
        for column, called in columns.items():
            if isinstance(called, str):
                sources[column] = (called, "")
            elif isinstance(called, tuple) and len(called) == 2 and all(isinstance(one, str) for one in called):
                sources[column] = called
            else:
                raise InputError(f"columns: {column!r} is {called!r}, expected a name or (name, unit)")
    for column, unit in (units or {}).items():
        if not isinstance(unit, str):
            raise InputError(f"units: {column!r} is {unit!r}, expected a unit such as 'deg', 'mm' or 'ms'")
        sources[column] = (sources.get(column, (column, ""))[0], unit)
    for column in sources:
        _require_known(column)
    return [(column, name, unit) for column, (name, unit) in sources.items()]


def _require_known(column: str) -> None:
    if column in COLUMNS or (column[-2:] in ("_a", "_b") and column[:-2] in COLUMNS):
        return
    import difflib

    near = difflib.get_close_matches(str(column), COLUMNS, 1)
    question = f"did you mean {near[0]!r}? " if near else ""
    raise InputError(f"columns: there is no column {column!r}; {question}Known are {', '.join(COLUMNS)}")


def _pandas() -> Any:
    try:
        import pandas
    except ImportError:
        raise ImportError("a data frame needs pandas; on Debian: apt-get install python3-pandas") from None
    return pandas
