"""From files, data frames, dicts and arrays to the logs that C++ reads."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

import numpy as np

from . import _core
from ._checks import decimal_comma, unit_of_length, whole
from ._clock import Clock
from ._columns import FINGERS, Columns, Naming, Units
from ._core import InputError
from ._logs import Log, Roll
from ._messages import shown, warn
from ._tables import Table, is_table, path_of, text_of
from ._words import Numbering, in_python


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
