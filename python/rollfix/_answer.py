"""The answer to one problem."""

from __future__ import annotations

import json
from collections.abc import Sequence as SequenceABC
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional, Sequence, Tuple, Union, overload

import numpy as np

from . import _core
from ._checks import flag, friction as friction_given, least, path, places, text, travel as travel_given, whole
from ._core import Answer as CoreAnswer, InputError, Placement as Placement
from ._documents import Advice, proof
from ._fingers import Finger, finger_from
from ._made import Made
from ._messages import in_a_page
from ._rows import names_of, row_of
from ._shape import Shape
from ._words import diagnosis_in_python, in_python

if TYPE_CHECKING:
    from ._logs import Log
    from ._part import Part


class Answer(Made, SequenceABC):  # type: ignore[type-arg]
    """Every place where the roll can have started: a sequence of `Placement`, and what is known of all together.

    It can't be changed, can be pickled, and equals another answer of the same bits. The names are those of the JSON
    document, which `to_dict` gives whole.
    """

    __slots__ = ("_core", "_log", "_placements")

    _core: CoreAnswer
    _log: "Log"  # where there was one
    _placements: Tuple[Placement, ...]  # once somebody asked

    def __init__(self, core: CoreAnswer, log: Optional["Log"] = None) -> None:
        self._core = core
        if log is not None:
            self._log = log

    @staticmethod
    def _of(core: CoreAnswer, new: Any = object.__new__) -> "Answer":
        answer: Answer = new(Answer)
        answer._core = core
        return answer

    # --- what it says ---

    @property
    def verdict(self) -> str:
        """str: 'unique', 'ambiguous (4)', 'unobservable' (every place fits), 'inconsistent' (none does), 'undecided'.

        With ', but the rows fit badly' behind it where they do: see `diagnosis`.
        """
        return self._core.verdict

    @property
    def status(self) -> str:
        """str: 'complete' (there is no other place) or 'incomplete' (see `unresolved`)."""
        return self._core.status

    @property
    def placements(self) -> Tuple[Placement, ...]:
        """tuple of Placement: ordered by start; with noise the most probable first."""
        try:
            return self._placements
        except AttributeError:
            self._placements = tuple(self._core.placement(k) for k in range(len(self._core)))
            return self._placements

    @property
    def best(self) -> Optional[Placement]:
        """Placement or None: the most probable; without noise the first that nothing contradicts, of the fewest doubts."""
        return self.placements[0] if len(self) > 0 else None

    @property
    def starts(self) -> np.ndarray:
        """ndarray, (placements, fingers): all their `start`."""
        return self._core.starts

    @property
    def part(self) -> "Part":
        """Part: on which the roll was."""
        part: "Part" = Shape._part_of(self._core.part)
        return part

    @property
    def fingers(self) -> int:
        """int: 1 or 2."""
        return self._core.fingers

    @property
    def finger(self) -> Tuple[Finger, ...]:
        """tuple of Finger: as given."""
        return tuple(finger_from(one) for one in self._core.finger_arguments)

    @property
    def readings(self) -> np.ndarray:
        """ndarray, (readings, fingers + 1): lengths, along the stored outline, and turn, that were searched with."""
        return self._core.readings

    @property
    def pivots(self) -> np.ndarray:
        """ndarray: by how much each reading's turn is open to both sides, radians: of a contact on a corner of the finger,
        else 0."""
        return self._core.pivots[:, 0]

    @property
    def tolerance(self) -> float:
        """float: the largest deviation of the turn with which a place fits, radians."""
        return self._core.tolerance

    @property
    def facing(self) -> Optional[float]:
        """float or None: of two fingers, the angle of the facing equation, radians."""
        return self._core.facing

    @property
    def mirrored(self) -> bool:
        """bool: the part lies face down."""
        return self._core.mirrored

    @property
    def pose_time(self) -> np.ndarray:
        """ndarray, (rows,): of a log with times, those of the placements' `pose`, seconds."""
        return self._core.pose_time

    @property
    def diagnosis(self) -> Optional[Dict[str, Any]]:
        """dict or None: where the rows fit badly, what explains them best: `cause`, `what`, `cure`, ...

        As in the JSON document, but the cure is in Python: finger=Disk(10.1) for --finger disk,r=10.1.
        """
        return diagnosis_in_python(self.to_dict()["diagnosis"])

    @property
    def fit(self) -> Optional[Dict[str, Any]]:
        """dict or None: with noise, how well the rows fit: `chi_square`, `freedom`, `sigmas`, ..."""
        found: Optional[Dict[str, Any]] = self.to_dict().get("fit")
        return found

    @property
    def dropped(self) -> Dict[str, int]:
        """dict: how many placements were taken out, by reason: 'reach', 'overlap', 'improbable'."""
        found: Dict[str, int] = self.to_dict()["dropped"]
        return found

    @property
    def unresolved(self) -> List[Any]:
        """list: intervals (of two fingers boxes) of starts that the search could not decide."""
        found: List[Any] = self.to_dict()["unresolved"]
        return found

    @property
    def log(self) -> Optional["Log"]:
        """Log or None: what was asked with."""
        return getattr(self, "_log", None)

    @property
    def notes(self) -> Tuple[str, ...]:
        """tuple of str: what to know about how it was understood."""
        notes = list(self.part.notes)
        if self._core.part.reversed:
            notes.append("the outline was given clockwise and is stored counter-clockwise (a hole the other way round)")
        notes += self._core.notes
        if self._core.strays:
            notes.append(f"left out stray rows{self._strays()}")
        return (*map(in_python, notes), *self._why_empty())

    def _strays(self) -> str:
        lines: Sequence[int] = self._core.strays
        of_file = self.log is None or not self.log._numbering.headers
        rows = lines if of_file or self.log is None else [self.log._numbering.row(line) for line in lines]
        return f"{', of lines' if of_file else ':'} {', '.join(map(str, rows))}"

    def _why_empty(self) -> Iterator[str]:
        """What took the last placements out."""
        if len(self) > 0:
            return
        whys = {
            "reach": "the finger can't touch there",
            "overlap": "the fingers would overlap; of fingers at different heights say may_overlap=True",
            "improbable": "they are too improbable",
        }
        for reason, count in self.dropped.items():
            if count:
                fitting = "1 place that fits was" if count == 1 else f"{count} places that fit were"
                yield f"{fitting} dropped: {whys.get(reason, reason)}"

    def to_dict(self, explain: bool = False) -> Dict[str, Any]:
        """The JSON document `rollfix/locate/1`, that of `rollfix locate --json`; docs/json.md lists the fields.

        Parameters
        ----------
        explain : bool
            With `impossible`: what fits and the finger can't do, and why.
        """
        document: Dict[str, Any] = json.loads(self._core.document(explain))
        return document

    def certify(self, file: Any = None, budget: Optional[int] = None) -> Dict[str, Any]:
        """The proof that there is no other place: the document that `rollfix-verify` checks with code of its own.

        Of an answer to its readings, without noise, the part face up, one way round. A RollfixWarning says where something
        is left unproved. docs/certificates.md says what is proved.

        Parameters
        ----------
        file : path, optional
            Also writes it there.
        budget : int, optional
            As of `Part.locate`.
        """
        for found, what in (
            (self._core.has_noise, "noise"),
            (self._core.either_way, "direction='either'"),
            (self.mirrored, "mirrored=True"),
        ):
            if found:
                raise InputError(f"certify: a certificate is of one way round without noise, found {what}")
        return proof(self._core, file, budget)

    def density(self, s: Any = None, finger: int = 0) -> Any:
        """The posterior of where the first contact was. Needs noise.

        Parameters
        ----------
        s : array_like of any shape, optional
            Places.
        finger : int
            0 or 1.

        Returns
        -------
        ndarray of the shape of `s`
            Probability per length there.
        tuple of ndarray, (n, 2) and (n,)
            Without `s`: intervals in order, hi may exceed P, and the probability in each, evenly spread. A corner's
            pivot is an interval of no width.
        """
        if not self._core.has_noise:
            raise InputError("density: needs `noise`: give it to `locate`")
        which = whole(finger, "finger")
        if which >= self.fingers:
            known = "0, as there is one finger" if self.fingers == 1 else "0 or 1"
            raise InputError(f"finger: expected {known}, found {which}")
        if s is None:
            return self._core.density_pieces(which)
        return self._core.density(which, places(s))

    def advise(self, travel: Any = None, *, may_overlap: bool = False, friction: Any = None) -> "Advice":
        """The next roll: which one tells the remaining placements apart; of two fingers, how far each rolls.

        Parameters
        ----------
        travel : float or (float, float), optional
            How far each finger can roll on: a length, or (back, forward). Default: one lap.
        may_overlap : bool
            Of two disks at different heights, which pass one another.
        friction : float or (float, float), optional
            Of two disks or jaws on the part: only rolls are advised that can be planned with it.
        """
        return Advice(self._core, travel_given(travel), flag(may_overlap, "may_overlap"), friction_given(friction))

    # --- as a table, as a figure ---

    def to_frame(self) -> Any:
        """A pandas.DataFrame with a row for each placement; of two fingers with columns `start_a`, `start_b`, ...

        `pandas.DataFrame(answer)` is the same, its columns by name.

        `extent_lo`, `extent_hi`: within the tolerance. With noise `interval_lo`, `interval_hi`: 95 %. `hi` may exceed P.
        """
        from ._logs import pandas

        return pandas().DataFrame(self._columns())

    def _columns(self) -> Dict[str, List[Any]]:
        rows = [row_of(one) for one in self]
        return {name: [row[name] for row in rows] for name in names_of(self.fingers, self._core.has_noise, self._has_pose)}

    @property
    def _has_pose(self) -> bool:
        return any(one.pose is not None for one in self)

    def to_svg(self, *, highlight: Optional[int] = None, title: str = "", width: float = 0) -> str:
        """The figure of the placements, as SVG: that of `rollfix locate -o`.

        Parameters
        ----------
        highlight : int, optional
            Of one finger the placement drawn stronger, of two the one whose rolls are drawn.
        title : str
            Instead of the part's name.
        width : float
            Pixels.
        """
        svg: str = self._figure(highlight, title, width).svg()
        return svg

    def save(self, file: Any, *, highlight: Optional[int] = None, title: str = "", width: float = 0) -> None:
        """Writes the figure, by its ending: .svg, .png or .pdf."""
        self._figure(highlight, title, width).save(path(file, "file"))

    def _figure(self, highlight: Optional[int], title: str, width: float) -> Any:
        from . import _draw

        if highlight is not None and not 0 <= whole(highlight, "highlight", -len(self)) < len(self):
            raise InputError(f"highlight: expected the number of one of {len(self)} placements, from 0, found {highlight}")
        wide = least(width, "width", 0, "a number of pixels")
        log = None if self.log is None or self._core.strays else self.log._core
        return _draw.answer_figure(self._core, log, highlight, text(title, "title"), wide)

    def plot(self, ax: Any = None, **style: Any) -> Any:
        """Draws the outline and the placements on matplotlib axes, and returns them.

        Each placement is a line along the boundary from its start (a dot) to its end; with noise as strong as it is
        probable. New axes are made where none are given. `style`: as of matplotlib's `plot`, for these lines.
        """
        from ._plots import plot_answer

        return plot_answer(self, ax, style)

    def _repr_svg_(self) -> str:
        return in_a_page(self.to_svg())

    def _repr_html_(self) -> str:
        from ._plots import answer_html

        return answer_html(self)

    # --- as a sequence, as a value ---

    def __len__(self) -> int:
        return len(self._core)

    @overload
    def __getitem__(self, k: int) -> Placement: ...
    @overload
    def __getitem__(self, k: slice) -> Tuple[Placement, ...]: ...
    def __getitem__(self, k: Union[int, slice]) -> Union[Placement, Tuple[Placement, ...]]:
        return self.placements[k]

    def __iter__(self) -> Iterator[Placement]:
        return iter(self.placements)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Answer):
            return NotImplemented
        return (
            self._core.bytes() == other._core.bytes()
            and self.finger == other.finger
            and self._core.part.is_same(other._core.part)
        )

    def __hash__(self) -> int:
        return hash(self._core.bytes())

    def __repr__(self) -> str:
        most = 6
        shown = [", ".join(f"{s:.4f}" for s in one.start) for one in self.placements[:most]]
        if self.fingers == 2:
            shown = [f"({one})" for one in shown]
        if self._core.has_noise:
            shown = [f"{one} ({p.probability:.3f})" for one, p in zip(shown, self.placements)]
        more = ", ..." if len(self) > most else ""
        against = sum(one.contradicted for one in self.placements)
        contradicted = f"; {against} of {len(self)} contradicted" if against else ""
        return f"<Answer: {self.verdict}{'; start ' if shown else ''}{', '.join(shown)}{more}{contradicted}>"

    def __reduce__(self) -> Any:
        part, given, state = self._core.state()
        return (_answer, (part, given, state, self.log))


def _answer(part: Any, given: Any, state: bytes, log: Optional["Log"]) -> Answer:
    return Answer(_core.answer_from_state(part, given, state), log)
