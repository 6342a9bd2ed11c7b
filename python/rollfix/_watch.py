"""Where the finger is, while it rolls."""

from __future__ import annotations

import json
import os
import re
import threading
from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Mapping, Optional, Tuple, Union

import numpy as np

from . import _core
from ._checks import clockwise, flag, text, whole
from ._clock import Clock
from ._columns import Naming
from ._core import InputError
from ._fingers import Wheel
from ._made import Made
from ._messages import shown, warn
from ._noise import NoiseLike
from ._options import LiveOptions, filled, keywords
from ._question import Question
from ._tables import Table, is_frame, safe, text_of
from ._words import Numbering, diagnosis_in_python, in_python

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._catalog import Catalog
    from ._shape import Shape

Event = Dict[str, Any]


class Watch(Made):
    """Where the finger is, live, from a log that grows: the events of `rollfix watch`, in constant memory.

    Of two fingers on a part that is free to move, rows have the columns of both, `u_a`, `psi_a`, `u_b`, `psi_b` and so on;
    or each finger has a log of its own: `name` has two names then, and `add` is told which log rows are of.

    Any number of threads can feed it: what is given to one call of `add` is taken as a whole, before the next call's.

    Parameters
    ----------
    part : Part
    finger : Disk, Jaw or OutlineFinger, or a list of two, optional
        For logs of u and psi. One serves both of two. The second one may be a `Wheel`, which has no skin: then `name` has two
        names, rows of log 1 have `x` and `y` of its pin, and `psi` where it has an encoder; placements have the part's pose.
    noise : Noise or dict
        How far the sensors are off.
    prior : (s, sd), optional
        About where the finger starts, of two finger a.
    heading, pose
        About how the part lies, as of `Part.locate`.
    robust : bool
        Stray rows don't count.
    every : int
        An event every so many rows; 0: where there is news.
    columns, units, degrees, wrapped, direction, mirrored
        As of `Part.locate`.
    live : bool
        Rows come as they are felt: what is new is not kept back for longer than a tenth of a second.
    squeezed : float, optional
        Of a finger and a `Wheel`, as of `Part.locate`.
    may_overlap : bool
        Of two fingers at different heights, as of `Part.locate`.
    name : str or (str, str)
        What messages call the log, or the logs of both fingers.
    catalog : Catalog, optional
        Which of its parts is it? `part` is any of them then: `Catalog.watch` makes such a watch.
    """

    @keywords(LiveOptions)
    def __init__(
        self,
        part: "Shape",
        *,
        noise: NoiseLike,
        every: int = 0,
        live: bool = False,
        name: Union[str, Tuple[str, str]] = "log",
        catalog: Optional["Catalog"] = None,
        **options: Unpack[LiveOptions],
    ) -> None:
        given = filled(options, LiveOptions)
        if noise is None:
            raise InputError("noise: expected how far the sensors are off, as in Noise(contact=0.1, angle=0.01)")
        clockwise(given["direction"])  # not both ways at once
        names = _names_of(name)
        with_skin, wheel = _with_wheel(given["finger"], names)
        if given["squeezed"] is not None and wheel is None:
            raise InputError("squeezed: is about a finger with skin and a Wheel without that squeeze a part: leave it out")
        self._alone = threading.RLock()  # whoever has it feeds; a warning's handler may feed as well
        self._naming = Naming(given["columns"], given["units"], given["degrees"], given["wrapped"])
        self._clock = Clock()
        self._logs = [_Log(one) for one in names]
        self._numbering = Numbering({one: [] for one in names})
        self._is_text = False
        self._is_over = False
        self._last: Optional[Event] = None
        self._core = _core.Watch(
            part._core,
            Question(part._core, {**given, "finger": with_skin, "noise": noise}).core(),
            names,
            whole(every, "every"),
            flag(live, "live"),
            [(column, safe(called), unit) for column, called, unit in self._naming.declared()],
            self._naming.angles,
            self._naming.wrapped,
            None if catalog is None else catalog._core,
            wheel,
        )

    def add(self, rows: Any, log: int = 0) -> List[Event]:
        """The next rows. A row of one of two logs waits for its partner, the row with the same time of the other log.

        Parameters
        ----------
        rows : str, bytes, mapping, DataFrame, or array_like
            Text: whole lines of CSV, the header first. A mapping of numbers or of arrays, a list of them, or a data frame:
            columns by name, the same each time, in any order. An array, (k,) or (n, k): with `columns` the names of its
            columns. Times may be dates: then seconds count from the first one of the watch's life.
        log : int
            Of two logs, which one: 0 of finger a, 1 of finger b.

        Returns
        -------
        list of dict
            What is new: events of docs/json.md, `rollfix/watch/1`: 'begin', 'found', 'placements', 'over', ... Where rows
            are no text `row` is the number of the last one, from 0; a diagnosis says its cure as keyword arguments.
        """
        with self._alone:
            if self._is_over:
                raise InputError("rows: the watch is over; make another one")
            of = self._log(log)
            for some in rows if _is_list_of_rows(rows) else [rows]:
                self._take(some, of)
            return self._events()

    def follow(self, source: Iterable[Any]) -> Iterator[Event]:
        """The events of a source of lines or rows as they come, until it ends; then the last ones.

        `source` is anything to iterate over: an open file, `socket.makefile()`, a generator of dicts.
        """
        if isinstance(source, (str, bytes, os.PathLike)):
            is_text = isinstance(source, bytes) or len(str(source).splitlines()) > 1
            hint = "a text: give it to `add`" if is_text else f"a path: open it, as in `with open({shown(source)}) as file`"
            raise InputError(f"source: expected lines or rows to go through, found {hint}")
        if isinstance(source, Mapping) or is_frame(source):
            kind = "a data frame" if is_frame(source) else "a mapping"
            raise InputError(f"source: expected lines or rows to go through, found {kind}: give it to `add`")
        try:
            return self._followed(iter(source))
        except TypeError:
            raise InputError(f"source: expected lines or rows to go through, found {shown(source)}") from None

    def _followed(self, source: Iterator[Any]) -> Iterator[Event]:
        for rows in source:
            yield from self.add(rows)
        yield from self.finish()

    def finish(self) -> List[Event]:
        """The log is over: the last events."""
        with self._alone:
            if self._is_over:
                return []
            self._is_over = True
            self._core.finish()
            return self._events()

    def resume(self, log: int = 0) -> List[Event]:
        """After a dropped connection: the next row continues the roll, however far it is, and a header may come again."""
        with self._alone:
            of = self._log(log)
            try:
                self._core.resume(log)
            except InputError as error:
                raise InputError(self._said(str(error))) from None
            of.columns = None
            return self._events()

    @property
    def answer(self) -> Optional[Event]:
        """dict or None: the last event that has an answer: `verdict`, `placements`, `samples`, `time`, ..."""
        return self._last

    @property
    def verdict(self) -> Optional[str]:
        """str or None: as of the last answer."""
        return None if self._last is None else str(self._last["verdict"])

    @property
    def placements(self) -> List[Event]:
        """list of dict: of the last answer, the most probable first; `end_mean` is where the finger is now."""
        return [] if self._last is None else list(self._last["placements"])

    def _log(self, log: Any) -> "_Log":
        which = whole(log, "log")
        if which >= len(self._logs):
            known = "0: there is one log" if len(self._logs) == 1 else "0 or 1"
            raise InputError(f"log: expected {known}, found {which}")
        return self._logs[which]

    def _take(self, rows: Any, of: "_Log") -> None:
        if isinstance(rows, (bytes, bytearray)):
            rows = rows.decode("utf-8", "replace")
        if isinstance(rows, str):
            self._naming.require_table("a text")
            self._is_text = True
            self._push(rows, of)
            return
        table = Table(_columns_of(rows), self._naming, "rows")
        columns = _in_order(of.columns, table, table.numbers(self._clock))
        header, _, lines = text_of(columns).partition("\n")
        if of.columns is None:
            self._numbering.headers[of.name].append(of.pushed + 1)
            self._push(header, of)
            of.columns = list(columns)
        self._push(lines, of)

    def _push(self, lines: str, of: "_Log") -> None:
        of.pushed += len(lines.splitlines())
        try:
            self._core.push(lines, self._logs.index(of))
        except InputError as error:
            raise InputError(self._said(str(error)).replace("state it with unit=", "make the part with unit=")) from None

    def _said(self, message: str) -> str:
        return in_python(message if self._is_text else self._numbering.said(message))

    def _events(self) -> List[Event]:
        events, notes = self._core.take()
        for note in notes.splitlines():
            warn(self._said(re.sub("^rollfix: ", "", note)))
        found = [json.loads(line) for line in events.splitlines()]
        for event in found:
            if "line" in event and not self._is_text:
                event["row"] = self._numbering.row(event["line"])
            if "diagnosis" in event:
                event["diagnosis"] = diagnosis_in_python(event["diagnosis"])
            if "placements" in event:
                self._last = event
        return found

    def __enter__(self) -> "Watch":
        return self

    def __exit__(self, *error: Any) -> None:
        self.finish()

    def __reduce__(self) -> Any:
        raise TypeError("cannot pickle a Watch, which is at work: keep its rows, and feed another")

    def __repr__(self) -> str:
        return f"<Watch: {self.verdict or 'no contact yet'}>"


class _Log:
    """One of the logs that rows are taken of."""

    __slots__ = ("columns", "name", "pushed")

    def __init__(self, name: str) -> None:
        self.name = name
        self.pushed = 0  # lines
        self.columns: Optional[List[str]] = None  # their names, once a table came


def _names_of(name: Any) -> List[str]:
    several = list(name) if isinstance(name, (list, tuple)) else [name]
    for one in several:
        if not text(one, "name"):
            raise InputError("name: expected what messages call the log, found ''")
    if len(several) > 2 or not several or len(set(several)) < len(several):
        raise InputError(f"name: expected one, or two different ones of both fingers' logs, found {shown(name)}")
    return several


def _with_wheel(finger: Any, names: List[str]) -> Tuple[Any, Optional[float]]:
    """The fingers with skin, and the radius of the wheel behind one of them."""
    given = list(finger) if isinstance(finger, (list, tuple)) else [finger]
    if not any(isinstance(one, Wheel) for one in given):
        return finger, None
    if len(given) != 2 or isinstance(given[0], Wheel) or not isinstance(given[1], Wheel) or len(names) != 2:
        raise InputError(
            "finger: expected one finger with skin and behind it one Wheel, with a log of each, as in "
            f"finger=[Jaw(), Wheel(0.4)], name=('jaw', 'pin'), found {shown(finger)}"
        )
    return given[0], given[1].radius


def _in_order(names: Optional[List[str]], table: Table, columns: Dict[str, np.ndarray]) -> Dict[str, np.ndarray]:
    """As the columns came the first time; of those that nobody reads one may be missing or new."""
    if names is None:
        return columns
    if {one for one in columns if table.is_wanted(one)} != {one for one in names if table.is_wanted(one)}:
        raise InputError(f"rows: expected the columns {', '.join(names)} as before, found {', '.join(columns) or 'none'}")
    nothing = np.full(len(next(iter(columns.values()))), np.nan)
    return {name: columns.get(name, nothing) for name in names}


def _is_list_of_rows(rows: Any) -> bool:
    return isinstance(rows, (list, tuple)) and len(rows) > 0 and all(isinstance(one, Mapping) for one in rows)


def _columns_of(rows: Any) -> Any:
    """One row by names, of whatever kind, is a table of one row."""
    if hasattr(rows, "_asdict"):  # a namedtuple, as of itertuples
        rows = rows._asdict()
    elif hasattr(rows, "index") and hasattr(rows, "to_dict") and not is_frame(rows):  # a Series, as of iterrows
        rows = rows.to_dict()
    if isinstance(rows, Mapping):
        return {key: value if np.ndim(value) else [value] for key, value in rows.items()}
    if is_frame(rows) or getattr(getattr(rows, "dtype", None), "names", None):
        return rows
    if np.ndim(rows) == 0:
        raise InputError(f"rows: expected lines of text, columns by name, or an array, found {shown(rows)}")
    return rows if np.ndim(rows) > 1 else [rows]
