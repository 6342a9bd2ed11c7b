"""Logs of two fingers whose clocks tick at different times."""

from __future__ import annotations

from typing import Any, Dict, Optional

import numpy as np

from ._checks import number
from ._clock import Clock
from ._core import InputError
from ._fingers import Disk, Finger
from ._log_reading import read_log
from ._logs import Log, Roll
from ._messages import shown

SUMS = {"distance": "length", "dturn": "turn"}


def resample(a: Any, b: Any, *, offset: float = 0.0, finger: Optional[Finger] = None) -> Log:
    """One log of two fingers from two that were sampled at different times: interpolated where both were rolling.

    The rows are at the times of the log with fewer of them, from the instant at which both had begun. Both are
    interpolated linearly, angles unwrapped: rows should be so close together that this is no error beside the noise.

    Parameters
    ----------
    a, b : Log, Roll, or what `read_log` takes
        Of one finger each, of one kind, with times.
    offset : float
        By how much b's clock is ahead of a's, seconds. Of times that were dates the dates count as well.
    finger : Finger, optional
        What rolls. Of a jaw or an outline u is a length, which does not wrap. Default: a disk.

    Returns
    -------
    Log
        For `part.locate(log=resample(a, b), finger=...)`.
    """
    logs = [_of_one(one, name) for one, name in ((a, "a"), (b, "b"))]
    if logs[0].kind != logs[1].kind:
        raise InputError(f"b: expected a log of the same kind as a, {logs[0].kind}, found {logs[1].kind}")
    if logs[0]._core.unit != logs[1]._core.unit:
        raise InputError(f"b: expected lengths in a's unit, {logs[0]._core.unit!r}, found {logs[1]._core.unit!r}")
    own = [logs[0]["time"], logs[1]["time"] - number(offset, "offset") + _between(logs[0]._clock, logs[1]._clock)]
    first, last = max(time[0] for time in own), min(time[-1] for time in own)
    sparse = min(own, key=lambda time: int(np.count_nonzero((time >= first) & (time <= last))))
    times = np.concatenate([[first], sparse[(sparse > first) & (sparse <= last)]])
    if not first < last or len(times) < 2:
        raise InputError(
            f"b: expected times that overlap those of a, {own[0][0]:.6g} to {own[0][-1]:.6g} s, found {own[1][0]:.6g} to "
            f"{own[1][-1]:.6g} s; offset= says by how much its clock is ahead"
        )
    columns: Dict[str, np.ndarray] = {"time": times}
    for log, time, end in zip(logs, own, ("_a", "_b")):
        columns.update({name + end: column for name, column in _at(log, time, times, _has_angles(finger)).items()})
    if logs[0].kind != "contact":  # measured from the first contacts, which are at the first of the times
        columns = {name: column[1:] for name, column in columns.items()}
    wrapped = False if logs[0].kind == "contact" else None
    return read_log(columns, unit=logs[0]._core.unit, wrapped=wrapped)


def _of_one(given: Any, name: str) -> Log:
    log = given.log if isinstance(given, Roll) else given if isinstance(given, Log) else read_log(given)
    if log.fingers != 1:
        raise InputError(f"{name}: expected a log of one finger, found one of two, whose times are the same already")
    if "time" not in log:
        raise InputError(f"{name}: expected a column of times, found {', '.join(log.columns)}")
    return log


def _has_angles(finger: Any) -> bool:
    if finger is not None and not isinstance(finger, Finger):
        raise InputError(f"finger: expected Disk(radius), Jaw() or OutlineFinger(part), found {shown(finger)}")
    return finger is None or isinstance(finger, Disk)


def _between(a: Clock, b: Clock) -> float:
    """Seconds from the zero of one clock to that of the other."""
    if a.zero is None and b.zero is None:
        return 0.0
    if a.zero is None or b.zero is None:
        raise InputError("b: one log's times are dates and the other's are numbers: expected the same in both")
    return float((b.zero - a.zero) / np.timedelta64(1, "s"))


def _at(log: Log, time: np.ndarray, times: np.ndarray, has_angles: bool) -> Dict[str, np.ndarray]:
    found: Dict[str, np.ndarray] = {}
    for name in log.columns:
        if name == "time":
            continue
        column = log[SUMS.get(name, name)]
        if name == "psi" or (name == "u" and has_angles):
            column = np.unwrap(column)
        values = np.interp(times, time, column)
        if name in ("length", "turn", *SUMS):
            values = values - values[0]
        found[name] = np.diff(values, prepend=0.0) if name in SUMS else values
    return found
