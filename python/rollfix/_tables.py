"""Logs that are no files: data frames, dicts, arrays. They become the text of a log, with all its checks."""

from __future__ import annotations

import os
import re
from typing import AbstractSet, Any, Dict, List, Mapping, Optional, Sequence, Set, Tuple

import numpy as np

from . import _core
from ._checks import array, masked_array
from ._clock import NUMBERS, Clock, Times, times_in
from ._columns import COLUMNS, FINGERS, Naming, Source, label
from ._core import InputError
from ._messages import shown

_UNSAFE = re.compile(r"[,;\t\"#\r\n]")
_UNIT = re.compile(r"\s*[\[(].*[\])]$")  # 'psi [deg]'
_KNOWN = frozenset(one + end for one in COLUMNS for end in ("", *FINGERS))
Pairs = List[Tuple[Any, Any]]  # columns by name


class Table:
    """Its columns of numbers by name. Those that are neither known nor named may hold anything, and are left out then."""

    __slots__ = ("name", "columns", "times", "sources", "_wanted")

    def __init__(self, log: Any, naming: Naming, name: str, decimal_comma: bool = False) -> None:
        self.name = name
        pairs = _pairs_of(log, naming, name)
        if decimal_comma:
            pairs = [(key, _with_points(values)) for key, values in pairs]
        self.sources = naming.sources([key for key, _ in pairs])
        self._wanted = _KNOWN.union(called for _, called, _ in self.sources)
        self.times: Dict[int, Times] = {}  # of the columns that are times
        felt = _felt(pairs, self.called("contact"))
        times = self.called("time")
        self.columns: List[Tuple[str, np.ndarray]] = []
        for key, values in pairs:
            self._take(label(key), values, felt, times)
        self._require_one_length()

    def is_wanted(self, key: str) -> bool:
        return _is_in(key, self._wanted)

    def called(self, column: str) -> Set[str]:
        """What the log calls it, of one finger or of two."""
        named = {which: name for which, name, _ in self.sources}
        return {named.get(column + end, column + end) for end in ("", *FINGERS)}

    def _take(self, key: str, values: Any, felt: Optional[np.ndarray], called_time: Set[str]) -> None:
        if _is_in(key, called_time):
            times = times_in(values, f"{self.name}: {key}")
            if times is not None:
                self._require_no_unit(key)
            self.times[len(self.columns)] = times or Times(_numbers(values, key, self.name, None), NUMBERS)
            self.columns.append((key, self.times[len(self.columns)].values))
            return
        if self.is_wanted(key):
            self.columns.append((key, _numbers(values, key, self.name, felt)))
            return
        try:
            column = array(values, key, masked_is_nan=True)
        except InputError:
            return
        if column.ndim == 1:
            self.columns.append((key, column))

    def _require_no_unit(self, key: str) -> None:
        units = [unit for _, called, unit in self.sources if unit and called == key]
        if units or _UNIT.search(key):
            raise InputError(
                f"units: the column {key!r} of {self.name} holds dates or spans of time, which say their unit themselves: "
                f"leave {repr(units[0]) if units else 'that in its name'} out"
            )

    def _require_one_length(self) -> None:
        if len({len(column) for _, column in self.columns}) > 1:
            found = ", ".join(f"{key} {len(column)}" for key, column in self.columns)
            raise InputError(f"{self.name}: expected columns of one length, found {found}")

    def numbers(self, clock: Clock) -> Dict[str, np.ndarray]:
        """All columns, times in seconds. Throws InputError where they are of another kind than those before."""
        for times in self.times.values():
            clock.agree(times.kind, self.name)
        clock.start(self.times.values())
        result: Dict[str, np.ndarray] = {}
        for k, (key, column) in enumerate(self.columns):
            if key in result and self.is_wanted(key):
                raise InputError(f"{self.name}: the column {key!r} occurs twice; rename one of them")
            result[key] = clock.seconds(self.times[k]) if k in self.times else column
        return result

    def safe_sources(self) -> List[Source]:
        return [(column, safe(called), unit) for column, called, unit in self.sources]


def _is_in(key: str, names: AbstractSet[str]) -> bool:
    """With or without the unit behind it."""
    return key in names or (key[-1:] in ("]", ")") and _UNIT.sub("", key) in names)


def safe(name: str) -> str:
    """As a header can hold it."""
    return _UNSAFE.sub("_", name)


def text_of(columns: Mapping[str, np.ndarray]) -> str:
    """As the text of a log."""
    return _core.table_text([safe(name) for name in columns], list(columns.values()))


def is_frame(log: Any) -> bool:
    return hasattr(log, "columns") and hasattr(log, "dtypes")


def is_table(log: Any) -> bool:
    """What holds whole columns by name, or an array of numbers."""
    return isinstance(log, (Mapping, np.ndarray)) or is_frame(log)


def _pairs_of(log: Any, naming: Naming, name: str) -> Pairs:
    if isinstance(log, Mapping) or is_frame(log) or getattr(getattr(log, "dtype", None), "names", None):
        naming.require_table(name)
    if isinstance(log, Mapping):
        return list(log.items())
    if is_frame(log):
        pairs = [(key, log.iloc[:, k]) for k, key in enumerate(log.columns)]
        return _index_as_time(log.index, pairs, naming) + pairs
    if getattr(getattr(log, "dtype", None), "names", None):
        return [(key, log[key]) for key in log.dtype.names]
    if isinstance(log, (np.ndarray, list, tuple)):
        return _columns_of_array(log, naming, name)
    raise InputError(
        f"{name}: expected a path, a data frame, a dict of arrays, or an array with `columns`, found {_what(log)}"
    )


def _what(log: Any) -> str:
    return shown(log) if isinstance(log, (str, bytes)) or log is None else type(log).__name__


def _index_as_time(index: Any, pairs: Pairs, naming: Naming) -> Pairs:
    """A frame's index, where it is called as the times are, or holds instants, and no column is the times."""
    given = naming.names.get("time")
    called = given[0] if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], str) else given
    called = "time" if called is None else called
    if any(_is_in(label(key), {label(called)}) for key, _ in pairs):
        return []
    for level, key in enumerate(index.names):
        if key is not None and _is_in(label(key), {label(called)}):
            return [(key, index.get_level_values(level))]
    is_of_instants = getattr(index.dtype, "kind", "") in "mM" or getattr(index.dtype, "tz", None) is not None
    return [("time", index)] if is_of_instants and given is None else []


def _columns_of_array(log: Any, naming: Naming, name: str) -> Pairs:
    rows = array(log, name, masked_is_nan=True)
    by_number = len(naming.names) > 0 and all(_is_number(given) for given in naming.names.values())
    if not naming.of_array and not by_number:
        raise InputError(
            f"{name}: an array has no names, expected `columns` with that of each column, as in columns=('time', 'u', 'psi')"
        )
    names: Sequence[Any] = naming.of_array or range(rows.shape[-1] if rows.ndim == 2 else 0)
    if rows.ndim != 2 or rows.shape[1] != len(names):
        count = len(naming.of_array or ()) or "columns"
        raise InputError(f"{name}: expected an array of shape (n, {count}), as `columns` has names, found {rows.shape}")
    return [(key, np.ascontiguousarray(rows[:, k])) for k, key in enumerate(names)]


def _is_number(given: Any) -> bool:
    return isinstance(given, int) or isinstance(given, tuple) and len(given) == 2 and isinstance(given[0], int)


def _felt(pairs: Pairs, called: Set[str]) -> Optional[np.ndarray]:
    """Of each row whether all fingers touch; None where that is not said. Other rows may hold anything."""
    felt: Optional[np.ndarray] = None
    for key, values in pairs:
        if _is_in(label(key), called):
            try:
                touches = array(values, "contact", masked_is_nan=True) != 0
            except InputError:
                continue  # told when it is taken
            felt = touches if felt is None or felt.shape != touches.shape else felt & touches
    return felt


def _with_points(values: Any) -> Any:
    """Texts with points for commas."""
    cells = np.asarray(values)
    if cells.dtype.kind not in "OU":
        return values
    return np.array([one.replace(",", ".") if isinstance(one, str) else one for one in cells.tolist()], dtype=object)


def _numbers(values: Any, key: str, name: str, felt: Optional[np.ndarray]) -> np.ndarray:
    try:
        column = array(values, key, masked_is_nan=True)
    except InputError:
        column = _cell_by_cell(values, key, name, felt)
    if column.ndim != 1:
        raise InputError(f"{name}: the column {key!r} has shape {column.shape}, expected one number in each row")
    return column


def _cell_by_cell(values: Any, key: str, name: str, felt: Optional[np.ndarray]) -> np.ndarray:
    masked = masked_array(values)
    cells = np.asarray(values if masked is None else masked.astype(object).filled(None))
    if cells.dtype.kind not in "OUS" or cells.ndim != 1:
        kind = {"c": "complex numbers", "M": "dates and times", "m": "spans of time"}.get(cells.dtype.kind, "no numbers")
        raise InputError(f"{name}: the column {key!r} holds {kind} ({cells.dtype}), expected numbers")
    column = np.full(len(cells), np.nan)
    for row, cell in enumerate(cells):
        try:
            column[row] = float(cell)
        except (TypeError, ValueError):
            if felt is None or row >= len(felt) or felt[row]:
                expected = f"expected a number{_decimal_comma(cell)}"
                raise InputError(f"{name}: row {row}: {key} is {shown(cell)}, {expected}") from None
    return column


def _decimal_comma(cell: Any) -> str:
    has_comma = isinstance(cell, str) and re.fullmatch(r"\s*[-+]?\d*,\d+\s*", cell)
    return " with a decimal point; read_log(..., decimal=',') takes commas" if has_comma else ""


def path_of(log: Any, name: str) -> Optional[str]:
    """Of a file; None of what is none."""
    if not isinstance(log, (str, os.PathLike)):
        return None
    found = os.fspath(log)
    if not isinstance(found, str):
        raise InputError(f"{name}: expected a path in text, found {shown(found)}")
    if len(found.splitlines()) > 1 and not os.path.exists(found):
        lines = len(found.splitlines())
        raise InputError(f"{name}: expected the path of a file, found {lines} lines of text: write them to one")
    return found
