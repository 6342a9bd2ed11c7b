"""Where the finger is, while it rolls."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._core import InputError
from ._inputs import Finger, Noise, clockwise, fingers, noise as noise_given, numbers, pose_prior, warn, whole
from ._logs import COLUMNS, Columns, in_rows, sources_of, table_of, _UNSAFE, _IsPath

if TYPE_CHECKING:
    from ._part import Part

Event = Dict[str, Any]


class Watch:
    """Where the finger is, live, from a log that grows: the events of `rollfix watch`, in constant memory. One finger.

    Parameters
    ----------
    part : Part
    finger : Disk, Jaw or OutlineFinger, optional
        For logs of u and psi.
    noise : Noise or dict
        How far the sensors are off.
    prior : (s, sd), optional
        About where the finger starts.
    heading, pose
        About how the part lies, as of `Part.locate`.
    robust : bool
        Stray rows don't count.
    every : int
        An event every so many rows; 0: where there is news.
    columns, units, degrees, direction, mirrored
        As of `Part.locate`.
    live : bool
        Rows come as they are felt: what is new is not kept back for longer than a tenth of a second.
    name : str
        What messages call the log.
    """

    def __init__(
        self,
        part: "Part",
        *,
        finger: Optional[Finger] = None,
        noise: Union[Noise, Dict[str, float]],
        prior: Optional[Tuple[float, float]] = None,
        heading: Optional[Tuple[float, float]] = None,
        pose: Optional[Sequence[float]] = None,
        robust: bool = False,
        every: int = 0,
        columns: Columns = None,
        units: Optional[Mapping[str, str]] = None,
        degrees: bool = False,
        direction: str = "ccw",
        mirrored: bool = False,
        live: bool = False,
        name: str = "log",
    ) -> None:
        sds = noise_given(noise)
        if sds is None:
            raise InputError("noise: expected how far the sensors are off, as in Noise(contact=0.1, angle=0.01)")
        mean = None
        if prior is not None:
            s, sd = numbers(prior, 2, "prior", "(s, sd)")
            mean = (s, sd)
        self._columns = columns
        self._sources = sources_of(columns, units)
        self._names: Optional[List[str]] = None
        self._is_text = False
        self._is_over = False
        self._name = name
        self._last: Optional[Event] = None
        safe = [(column, _UNSAFE.sub("_", called), unit) for column, called, unit in self._sources]
        self._core = _core.Watch(
            part._core,
            fingers(finger, 1),
            sds,
            mean,
            pose_prior(heading, pose),
            bool(robust),
            whole(every, "every"),
            name,
            safe,
            "deg" if degrees else "",
            clockwise(direction),
            bool(mirrored),
            bool(live),
        )

    def add(self, rows: Any) -> List[Event]:
        """The next rows.

        Parameters
        ----------
        rows : str, mapping, DataFrame, or array_like
            Text: whole lines of CSV, the header first. A mapping of numbers or of arrays, or a data frame: columns by
            name, the same each time. An array, (k,) or (n, k): with `columns` the names of its columns.

        Returns
        -------
        list of dict
            What is new: events of docs/json.md, `rollfix/watch/1`: 'begin', 'found', 'placements', 'over', ...
        """
        if self._is_over:
            raise InputError("rows: the watch is over; make another one")
        self._push(self._text_of(rows))
        return self._events()

    def follow(self, source: Iterable[Any]) -> Iterator[Event]:
        """The events of a source of lines or rows as they come, until it ends; then the last ones.

        `source` is anything to iterate over: an open file, `socket.makefile()`, a generator of dicts.
        """
        for rows in source:
            yield from self.add(rows.decode("utf-8", "replace") if isinstance(rows, bytes) else rows)
        yield from self.finish()

    def finish(self) -> List[Event]:
        """The log is over: the last events."""
        if self._is_over:
            return []
        self._is_over = True
        self._core.finish()
        return self._events()

    def resume(self) -> List[Event]:
        """After a dropped connection: the next row continues the roll, however far it is, and a header may come again."""
        self._core.resume()
        self._names = None
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

    def _push(self, text: str) -> None:
        try:
            self._core.push(text)
        except InputError as error:
            raise InputError(str(error) if self._is_text else in_rows(str(error), self._name)) from None

    def _text_of(self, rows: Any) -> str:
        if isinstance(rows, str):
            self._is_text = True
            return rows
        if isinstance(rows, Mapping):
            rows = {key: np.atleast_1d(value) for key, value in rows.items()}
        elif not hasattr(rows, "dtypes") and getattr(getattr(rows, "dtype", None), "names", None) is None:
            rows = np.atleast_2d(np.asarray(rows, dtype=float))
        try:
            names, arrays = table_of(rows, self._columns, self._sources, "rows")
        except _IsPath:
            raise InputError(f"rows: expected lines or rows, found {rows!r}") from None
        safe = [_UNSAFE.sub("_", name) for name in names]
        header, _, lines = _core.table_text(safe, arrays).partition("\n")
        if self._names is None:
            self._names = names
            return header + "\n" + lines
        if names != self._names:
            raise InputError(f"rows: expected the columns {', '.join(self._names)} as before, found {', '.join(names)}")
        return lines

    def _events(self) -> List[Event]:
        events, notes = self._core.take()
        for note in notes.splitlines():
            warn(note)
        found = [json.loads(line) for line in events.splitlines()]
        for event in found:
            if "placements" in event:
                self._last = event
        return found

    def __enter__(self) -> "Watch":
        return self

    def __exit__(self, *error: Any) -> None:
        self.finish()

    def __repr__(self) -> str:
        return f"<Watch: {self.verdict or 'no contact yet'}>"
