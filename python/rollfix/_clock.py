"""Dates and times become seconds."""

from __future__ import annotations

import datetime
from typing import Any, Iterable, List, Optional

import numpy as np

from ._core import InputError
from ._messages import shown

DATES, ZONED, NUMBERS = "dates and times", "dates and times with a time zone", "numbers"


class Times:
    """A log's column of times: instants, as datetime64 in UTC where they have a zone, or seconds."""

    __slots__ = ("values", "kind")

    def __init__(self, values: np.ndarray, kind: str) -> None:
        self.values = values
        self.kind = kind


class Clock:
    """Instants as seconds since the first one that came: of one log, of two together, of all rows of a watch."""

    __slots__ = ("zero", "kind", "_name")

    def __init__(self) -> None:
        self.zero: Optional[np.datetime64] = None
        self.kind: Optional[str] = None
        self._name = ""

    def agree(self, kind: str, name: str) -> None:
        """Throws InputError where one log has dates and another numbers: what the numbers count from is not known."""
        if self.kind is None:
            self.kind, self._name = kind, name
        if kind != self.kind:
            other = "the rows before have" if name == self._name else f"{self._name} has"
            raise InputError(
                f"{name}: its times are {kind}, and {other} {self.kind}: expected the same in both, to compare them"
            )

    def join(self, other: "Clock", name: str) -> None:
        """That of a log which is read already."""
        self.agree(other.kind or NUMBERS, name)
        if self.zero is not None and self.zero != other.zero:
            raise InputError(
                f"{name}: was read on its own, so that its times start at another 0: give both as they were, in a pair"
            )
        self.zero = other.zero

    def start(self, several: Iterable[Times]) -> None:
        """At the first instant of the earliest of these, unless it goes already."""
        firsts = [one.values[~np.isnat(one.values)][:1] for one in several if one.kind != NUMBERS]
        instants = np.concatenate([*firsts, np.empty(0, "datetime64[ns]")])
        if self.zero is None and len(instants):
            self.zero = instants.min()

    def seconds(self, times: Times) -> np.ndarray:
        if times.kind == NUMBERS:
            return times.values
        zero = np.datetime64("NaT") if self.zero is None else self.zero
        return _seconds(times.values - zero)


def _seconds(spans: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(spans / np.timedelta64(1, "s"), dtype=np.float64)


def times_in(values: Any, what: str) -> Optional[Times]:
    """Of dates, or of spans of time, which are seconds; None of what is neither."""
    zoned = getattr(getattr(values, "dtype", None), "tz", None) is not None
    if zoned:
        return Times(values.to_numpy(dtype="datetime64[ns]"), ZONED)
    column = np.asarray(values)
    if column.dtype.kind == "m":
        return Times(_seconds(column), NUMBERS)
    if column.dtype.kind == "M":
        return Times(column.astype("datetime64[ns]"), DATES)
    if column.dtype.kind != "O" or column.ndim != 1:
        return None
    first = next((one for one in column if isinstance(one, (datetime.date, np.datetime64, datetime.timedelta))), None)
    if first is None:
        return None
    if isinstance(first, datetime.timedelta):
        return Times(_seconds(_each(column, what, datetime.timedelta, "timedelta64[ns]")), NUMBERS)
    is_zoned = getattr(first, "tzinfo", None) is not None
    for row, one in enumerate(column):
        if isinstance(one, datetime.datetime) and one == one and (one.tzinfo is not None) != is_zoned:
            raise InputError(f"{what}: row {row} is {one}, expected all with a time zone or all without")
    instants = _each(column, what, (datetime.date, np.datetime64), "datetime64[ns]")
    return Times(instants, ZONED if is_zoned else DATES)


def _each(column: np.ndarray, what: str, kind: Any, dtype: str) -> np.ndarray:
    found: List[Any] = []
    for row, one in enumerate(column):
        if one is None or one != one:  # NaT and NaN
            found.append("NaT")
        elif not isinstance(one, kind):
            expected = "a date" if "date" in dtype else "a span of time"
            raise InputError(f"{what}: row {row} is {shown(one)}, expected {expected} as before")
        else:
            found.append(_plain(one))
    return np.array(found, dtype=dtype)


def _plain(one: Any) -> Any:
    """As numpy takes it: pandas' keep their nanoseconds, what has a zone comes to UTC."""
    for name in ("to_datetime64", "to_timedelta64"):
        if hasattr(one, name):
            return getattr(one, name)()
    if isinstance(one, datetime.datetime) and one.tzinfo is not None:
        return one.astimezone(datetime.timezone.utc).replace(tzinfo=None)
    return one
