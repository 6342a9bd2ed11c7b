"""Many parts in one file, and which of them a roll fits, or touches."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from . import _cluster, _core
from ._catalog_sources import sources_from
from ._checks import path as path_given, travel as travel_given, unit_of_length, whole
from ._core import InputError
from ._documents import Document, rolled
from ._identified import Identified
from ._log_answers import Results, checked, errors_given, several
from ._made import Made
from ._messages import did_you_mean, shown, warn
from ._noise import NoiseLike
from ._options import PartsOptions, keywords
from ._part import Part
from ._progress import Progress
from ._question import Posed, Question
from ._watch import Watch
from ._words import in_python

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(frozen=True)
class CatalogEntry(Made):
    """A part of a catalog, as its lists show it."""

    name: str  # no two have the same
    id: int  # stays the same for as long as the part is there
    perimeter: float  # in the catalog's unit
    symmetry: int  # n-fold; 0: a circle
    closed: bool
    reversed: bool  # given clockwise
    count: float  # so many of it are among what may be touched


class Catalog(Made):
    """Many parts in one file, as `Catalog.build` or `rollfix catalog build` makes it. Iterating gives their names.

    Parts are loaded when they are asked for. Any number of threads can ask. It is pickled by its path.

    Parameters
    ----------
    path : path
        The file.

    Raises
    ------
    InputError
        No such file, or not a catalog.
    """

    __slots__ = ("_core", "_entries", "_places", "__weakref__")

    def __init__(self, path: Union[str, "os.PathLike[str]"]) -> None:
        self._open(path_given(path, "path"))

    def _open(self, path: str) -> None:
        core = _core.Catalog(path)
        self._entries = tuple(CatalogEntry(*one) for one in core.entries())
        self._places = {entry.name: k for k, entry in enumerate(self._entries)}
        self._core = core

    @classmethod
    def build(
        cls,
        path: Union[str, "os.PathLike[str]"],
        sources: Any,
        *,
        unit: str = "",
        threads: int = 0,
        progress: Optional[bool] = None,
    ) -> "Catalog":
        """Makes a catalog of outlines, or adds to one. What is there already and has not changed is not read again.

        A RollfixWarning says how many could not be taken; `left_out` says why. Ctrl-C stops it; what was done stays.

        Parameters
        ----------
        path : path
            The catalog's file.
        sources : path, list or mapping
            A folder: all outlines in it and in the folders in it. A text file with one of them in each line, behind a
            tabulator how many of it there are. Or an outline. A list of them, of 'gallery:NAME,key=value,...', of `Part`, of
            arrays of points, or of pairs (one of them, count). A mapping gives parts and arrays their names.
        unit : str
            Of all parts, 'mm', 'in', ...; others are converted. Default: that of the first part that states one.
        threads : int
            0: as many as there are processors.
        progress : bool, optional
            A bar, by tqdm. Default: where tqdm is installed, in a notebook or on a terminal, after half a second.

        Returns
        -------
        Catalog
        """
        file, known = path_given(path, "path"), unit_of_length(unit)
        count = whole(threads, "threads")
        taken = sources_from(sources)
        with Progress(len(taken), progress, "files") as bar:
            left_out, _ = _core.build_catalog(file, taken, known, count, bar.report)
        if left_out:
            source, why = left_out[0]
            some = "1 source was" if len(left_out) == 1 else f"{len(left_out)} sources were"
            warn(f"{file}: {some} left out, see Catalog.left_out; {source}: {in_python(why)}")
        return cls(file)

    def remove(self, names: Union[str, Iterable[str]]) -> int:
        """Takes parts out of the file, by name. A build whose sources still name their files takes them in again.

        Parameters
        ----------
        names : str or list of str
            A name that is not there is an InputError, by which nothing is taken out.

        Returns
        -------
        int
            How many there were.
        """
        given = [names] if isinstance(names, str) else list(names)
        for name in given:
            self._place(name, "names")
        removed = _core.remove_from_catalog(self.path, given)
        self._open(self.path)
        return removed

    # --- what is in it ---

    @property
    def path(self) -> str:
        """str: the file."""
        return self._core.path

    @property
    def unit(self) -> str:
        """str: of all lengths; '' where nobody said."""
        return self._core.unit

    @property
    def entries(self) -> Tuple[CatalogEntry, ...]:
        """tuple of CatalogEntry: in the order in which they were added."""
        return self._entries

    @property
    def names(self) -> Tuple[str, ...]:
        """tuple of str: of all parts, in this order."""
        return tuple(entry.name for entry in self._entries)

    @property
    def left_out(self) -> Dict[str, str]:
        """dict: what could not be taken, and why."""
        return {source: in_python(why) for source, why in self._core.left_out()}

    def part(self, which: Union[str, int]) -> Part:
        """A part, by its name or its place in `names`, in the catalog's unit."""
        return Part._of(self._core.part(self._place(which, "which")))

    def _place(self, which: Any, argument: str) -> int:
        if isinstance(which, str):
            if which not in self._places:
                hint = did_you_mean(which, self._places)
                raise InputError(f"{argument}: {self.path} has no part {which!r}; {hint}it has {len(self)}: see names")
            return self._places[which]
        if argument == "names":
            raise InputError(f"names: expected the names of parts, found {shown(which)}")
        place = whole(which, argument, -len(self))
        if place >= len(self):
            raise InputError(f"{argument}: expected a name, or a place from 0 to {len(self) - 1}, found {place}")
        return place % len(self)

    # --- which of them is it ---

    @keywords(PartsOptions)
    def identify(
        self,
        readings: Any = None,
        turn: Any = None,
        *,
        log: Any = None,
        touches: Any = None,
        threads: int = 0,
        **options: Unpack[PartsOptions],
    ) -> Identified:
        """Every part on which the roll, or the touches, can have been, and every place on it. Ctrl-C stops it.

        Parameters
        ----------
        readings, turn, log, ...
            The roll, as of `Part.locate`, in the catalog's unit.
        touches, clear
            Instead: touches without rolling, and where nothing was felt, as of `Part.locate`, with `finger`, `noise` or
            `tolerance`, `heading`, `pose`, `mirrored` and `budget`. Each part's `answer` is a `TouchAnswer`. With `log` and
            roll='all' both: the rolls of the log, or of a list of logs, and the touches share the part's pose.
        threads : int
            0: as many as there are processors. Any number gives the same bits.

        Returns
        -------
        Identified

        Raises
        ------
        InputError
            What can't be meant; the message names the argument.
        """
        count = whole(threads, "threads")
        return self._search(self._asked({"readings": readings, "turn": turn, "log": log, "touches": touches}, options), count)

    def identify_many(
        self,
        readings: Any = None,
        *,
        logs: Any = None,
        threads: int = 0,
        client: Any = None,
        progress: Optional[bool] = None,
        errors: str = "collect",
        **options: Any,
    ) -> "ManyIdentified":
        """What `identify` finds of each of many rolls, one after the other, each on all cores.

        Parameters
        ----------
        readings : iterable
            Of each roll its readings, as of `identify`: an array (n, 2) or (n, 3) is of n rolls, one of each row. Or
        logs : iterable of logs
            as of `identify`.
        threads, **options
            As of `identify`, for all of them.
        client : distributed.Client, optional
            Of a Dask cluster, whose workers share the rolls; the catalog's file has to be there under the same path for
            every worker. What a worker had that is lost is done again by another.
        progress, errors
            As of `Part.locate_logs`.

        Returns
        -------
        ManyIdentified
            A sequence of `Identified`, and of InputError where a roll can't be worked with; `answers`, `errors`, `to_frame`.
        """
        if options.get("roll") == "all":
            raise InputError("roll: expected a number from 1, found 'all': of contacts that share a pose ask `identify`")
        if (readings is None) == (logs is None):
            raise InputError(f"readings: expected readings or `logs`, found {'neither' if logs is None else 'both'}")
        then = errors_given(errors)
        rolls = [{"log": one} for one in several(logs)] if readings is None else [{"readings": one} for one in readings]
        count = whole(threads, "threads")
        if client is not None:
            _cluster.require_client(client)
        found: List[Union[Identified, InputError]] = []
        with Progress(len(rolls), progress, "rolls") as bar:
            if client is not None:
                found = self._by_cluster(client, [self._asked_or_error(roll, options) for roll in rolls], bar)
            for roll in rolls[len(found) :]:
                asked = self._asked_or_error(roll, options)
                try:
                    found.append(asked if isinstance(asked, InputError) else self._search(asked, count))
                except InputError as error:
                    found.append(error)
                bar.report(len(found))
        return ManyIdentified(checked(found, then, "logs" if readings is None else "readings"))

    def advise(
        self, readings: Any = None, turn: Any = None, *, log: Any = None, travel: Any = None, **options: Any
    ) -> "PartsAdvice":
        """The next roll: which one tells apart the parts that remain, and the places on them.

        Parameters
        ----------
        readings, turn, log, **options
            The roll so far, as of `identify`.
        travel : float or (float, float), optional
            How far each finger can roll on, as of `Part.advise`.
        """
        range_given = travel_given(travel)
        posed = self._asked({"readings": readings, "turn": turn, "log": log}, options)
        try:
            return PartsAdvice(self._core.advise(posed.core, range_given))
        except InputError as error:
            raise posed.refused(error) from None

    def watch(self, *, noise: NoiseLike, **options: Any) -> Watch:
        """A `Watch` on whichever of the parts it is: fewer and fewer of them remain. Options as of `Part.watch`."""
        if len(self) == 0:
            raise InputError(f"{self.path}: the catalog has no parts")
        return Watch(self.part(0), noise=noise, catalog=self, **options)

    def _asked(self, contacts: Mapping[str, Any], options: Mapping[str, Any]) -> Posed:
        """Of the first part, whichever it is."""
        if len(self) == 0:
            raise InputError(f"{self.path}: the catalog has no parts")
        try:
            return Question(self._core.part(0), options).of(**contacts)
        except InputError as error:
            raise InputError(str(error).replace("make the part with unit=", "build the catalog with unit=")) from None

    def _asked_or_error(self, contacts: Mapping[str, Any], options: Mapping[str, Any]) -> Union[Posed, InputError]:
        try:
            return self._asked(contacts, options)
        except InputError as error:
            return error

    def _search(self, posed: Posed, threads: int) -> Identified:
        try:
            text, found = self._core.identify(posed.core, threads)
        except InputError as error:
            raise posed.refused(error) from None
        return self._identified(text, found, posed)

    def _identified(self, text: str, found: Iterable[Tuple[int, Any]], posed: Posed) -> Identified:
        return Identified(text, {part: posed.answer_of_one(answer) for part, answer in found})

    def _by_cluster(
        self, client: Any, asked: Sequence[Union[Posed, InputError]], bar: Progress
    ) -> List[Union[Identified, InputError]]:
        questions = [one.core for one in asked if not isinstance(one, InputError)]
        said = iter(_cluster.identify_many(client, self.path, questions, bar.report))
        return [one if isinstance(one, InputError) else self._said(next(said), one) for one in asked]

    def _said(self, said: "_cluster.Identified", posed: Posed) -> Union[Identified, InputError]:
        if isinstance(said, str):
            return posed.refused(said)
        text, states = said
        parts = {entry.id: entry.name for entry in self._entries if entry.id in states}
        answers = [(part, _core.answer_from_state(self.part(parts[part])._core, *state)) for part, state in states.items()]
        return self._identified(text, answers, posed)

    def __len__(self) -> int:
        return len(self._entries)

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __contains__(self, name: object) -> bool:
        return name in self._places

    def __repr__(self) -> str:
        parts = "1 part" if len(self) == 1 else f"{len(self)} parts"
        return f"<Catalog {self.path!r}: {parts}{', ' + self.unit if self.unit else ''}>"

    def __reduce__(self) -> Any:
        return (Catalog, (self.path,))


class ManyIdentified(Results[Identified]):
    """What was found of many rolls: a sequence of `Identified`, and of InputError where a roll can't be worked with."""

    __slots__ = ()


class PartsAdvice(Document):
    """Which roll tells the remaining parts apart: the fields of `rollfix/advise/1`, see docs/json.md, with each contender's part."""

    __slots__ = ()

    def __repr__(self) -> str:
        if not self.helps:
            return f"<PartsAdvice: {self.verdict}; {self.why}>"
        return f"<PartsAdvice: {self.verdict}; roll on by {rolled(self.length)}>"
