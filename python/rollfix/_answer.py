"""Answers: of one problem, and of many at once."""

from __future__ import annotations

import json
from collections.abc import Sequence as SequenceABC
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional, Tuple, Union, overload

import numpy as np

from . import _core
from ._core import Answer as CoreAnswer, InputError, Placement as Placement
from ._inputs import Finger, array, finger_from, finite, path, travel, whole

if TYPE_CHECKING:
    from ._documents import Advice
    from ._logs import Log
    from ._part import Part


class Answer(SequenceABC):  # type: ignore[type-arg]
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
    def starts(self) -> np.ndarray:
        """ndarray, (placements, fingers): all their `start`."""
        return self._core.starts

    @property
    def part(self) -> "Part":
        """Part: on which the roll was."""
        from ._part import Part

        return Part._of(self._core.part)

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
        """dict or None: where the rows fit badly, what explains them best: `cause`, `what`, `cure`, ..."""
        found: Optional[Dict[str, Any]] = self.to_dict()["diagnosis"]
        return found

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
        if self._core.other_way:
            notes.append(f"the other way round no such roll can be: {self._core.other_way}")
        if self._core.lengths_reversed:
            notes.append("the log's lengths changed their signs to match")
        if self._core.strays:
            notes.append(f"left out stray rows, of lines {', '.join(str(line) for line in self._core.strays)}")
        return tuple(notes)

    def to_dict(self, explain: bool = False) -> Dict[str, Any]:
        """The JSON document `rollfix/locate/1`, that of `rollfix locate --json`; docs/json.md lists the fields.

        Parameters
        ----------
        explain : bool
            With `impossible`: what fits and the finger can't do, and why.
        """
        document: Dict[str, Any] = json.loads(self._core.document(explain))
        return document

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
        pieces = self._core.density_pieces(whole(finger, "finger"))
        if pieces is None:
            need = "noise: give it to locate" if not self._core.has_noise else f"finger: expected 0 to {self.fingers - 1}"
            raise InputError(f"density: needs {need}")
        if s is None:
            return pieces
        return self._core.density(finger, finite(array(s, "s"), "s"))

    def advise(self, travel_range: Any = None) -> "Advice":
        """The next roll: which one tells the remaining placements apart. Of one finger.

        Parameters
        ----------
        travel_range : float or (float, float), optional
            How far the finger can roll on: a length, or (back, forward). Default: one lap.
        """
        from ._documents import Advice

        return Advice(self._core, travel(travel_range))

    # --- as a table, as a figure ---

    def to_frame(self) -> Any:
        """A pandas.DataFrame with a row for each placement; of two fingers with columns `start_a`, `start_b`, ..."""
        from ._logs import _pandas

        return _pandas().DataFrame(self._columns())

    def _columns(self) -> Dict[str, List[Any]]:
        ends = [""] if self.fingers == 1 else ["_a", "_b"]
        columns: Dict[str, List[Any]] = {"kind": [one.kind for one in self]}
        if self._core.has_noise:
            columns["probability"] = [one.probability for one in self]
        for k, end in enumerate(ends):
            columns["start" + end] = [one.start[k] for one in self]
            columns["end" + end] = [one.end[k] for one in self]
            columns["lo" + end] = [one.extent[k, 0] for one in self]
            columns["hi" + end] = [one.extent[k, 1] for one in self]
            columns["x" + end] = [one.point[k, 0] for one in self]
            columns["y" + end] = [one.point[k, 1] for one in self]
            columns["tangent" + end] = [one.tangent[k] for one in self]
            if self._core.has_noise:
                columns["mean" + end] = [None if one.mean is None else one.mean[k] for one in self]
                columns["sd" + end] = [None if one.sd is None else one.sd[k] for one in self]
        columns["residual"] = [one.residual for one in self]
        columns["error"] = [one.error for one in self]
        return columns

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

        log = None if self.log is None or self._core.strays else self.log._core
        return _draw.answer_figure(self._core, log, highlight, title, width)

    def plot(self, ax: Any = None) -> Any:
        """Draws the outline and the placements on matplotlib axes, and returns them.

        Each placement is a line along the boundary from its start (a dot) to its end; with noise as strong as it is
        probable. New axes are made where none are given.
        """
        from ._plots import plot_answer

        return plot_answer(self, ax)

    def _repr_svg_(self) -> str:
        return self.to_svg()

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
        return f"<Answer: {self.verdict}{'; start ' if shown else ''}{', '.join(shown)}{more}>"

    def __reduce__(self) -> Any:
        part, given, state = self._core.state()
        return (_answer, (part, given, state, self.log))


def _answer(part: Any, given: Any, state: bytes, log: Optional["Log"]) -> Answer:
    return Answer(_core.answer_from_state(part, given, state), log)


KINDS: np.ndarray = np.array(["crossing", "touching", "stretch", "corner"])
STATUSES: np.ndarray = np.array(["complete", "incomplete"])
VERDICTS: np.ndarray = np.array(["unique", "ambiguous", "unobservable", "inconsistent", "undecided"])


class ManyAnswers:
    """The answers to many problems, as arrays: placement number p of problem k is row `offsets[k] + p`.

    What is of a finger has an axis for it. Arrays can't be written to. `many[k]` is the whole `Answer` to problem k,
    worked out again; `many.rows(k)` is the slice of its rows.
    """

    __slots__ = ("_columns", "_problem", "_readings", "_facing")

    def __init__(self, columns: Dict[str, Any], problem: Any, readings: np.ndarray, facing: Optional[np.ndarray]) -> None:
        self._columns = columns
        self._problem = problem
        self._readings = readings
        self._facing = facing

    @property
    def fingers(self) -> int:
        """int: 1 or 2."""
        count: int = self._columns["fingers"]
        return count

    @property
    def offsets(self) -> np.ndarray:
        """ndarray of int64, (problems + 1,): the first row of each problem, and the number of rows."""
        return self._column("offsets")

    @property
    def counts(self) -> np.ndarray:
        """ndarray of int64, (problems,): how many placements each has; 0 where there is an error."""
        return np.diff(self.offsets)

    @property
    def errors(self) -> Dict[int, str]:
        """dict: of the problems that can't be worked with, number and reason."""
        return dict(self._columns["errors"])

    @property
    def status(self) -> np.ndarray:
        """ndarray of str, (problems,): 'complete', 'incomplete', or 'error'."""
        found: np.ndarray = STATUSES[self._column("status")]
        if self._columns["errors"]:
            found[list(self._columns["errors"])] = "error"
        return found

    @property
    def verdict(self) -> np.ndarray:
        """ndarray of str, (problems,): 'unique', 'ambiguous', 'unobservable', 'inconsistent', 'undecided'."""
        names: np.ndarray = VERDICTS[self._column("verdict")]
        return names

    @property
    def tolerance(self) -> np.ndarray:
        """ndarray, (problems,): radians; NaN where there is an error."""
        return self._column("tolerance")

    @property
    def problem(self) -> np.ndarray:
        """ndarray of int64, (rows,): the problem that each row is of."""
        return np.repeat(np.arange(len(self)), self.counts)

    @property
    def kind(self) -> np.ndarray:
        """ndarray of str, (rows,): 'crossing', 'touching', 'stretch', 'corner'."""
        names: np.ndarray = KINDS[self._column("kind")]
        return names

    @property
    def start(self) -> np.ndarray:
        """ndarray, (rows, fingers): s of the first contacts, in [0, P)."""
        return self._column("start")

    @property
    def end(self) -> np.ndarray:
        """ndarray, (rows, fingers): s of the contacts at the last reading."""
        return self._column("end")

    @property
    def extent(self) -> np.ndarray:
        """ndarray, (rows, fingers, 2): the connected set of starts that fit."""
        return self._column("extent")

    @property
    def point(self) -> np.ndarray:
        """ndarray, (rows, fingers, 2): x, y of the first contacts."""
        return self._column("point")

    @property
    def tangent(self) -> np.ndarray:
        """ndarray, (rows, fingers): direction of the boundary there, radians."""
        return self._column("tangent")

    @property
    def error(self) -> np.ndarray:
        """ndarray, (rows,): bound on |start - exact root|; infinite where it is not simple."""
        return self._column("error")

    @property
    def residual(self) -> np.ndarray:
        """ndarray, (rows,): largest deviation of the turn at `start`, radians."""
        return self._column("residual")

    @property
    def probability(self) -> np.ndarray:
        """ndarray, (rows,): with noise; else NaN."""
        return self._column("probability")

    @property
    def whole_loop(self) -> np.ndarray:
        """ndarray of bool, (rows,): the extent is all of a closed boundary."""
        return self._column("whole_loop").astype(bool)

    def rows(self, k: int) -> slice:
        """The rows of problem k."""
        k = self._number(k)
        return slice(int(self.offsets[k]), int(self.offsets[k + 1]))

    def to_frame(self) -> Any:
        """A pandas.DataFrame with a row for each placement, and the number of its problem."""
        from ._logs import _pandas

        columns: Dict[str, Any] = {"problem": self.problem, "kind": self.kind}
        for k, end in enumerate([""] if self.fingers == 1 else ["_a", "_b"]):
            columns["start" + end] = self.start[:, k]
            columns["end" + end] = self.end[:, k]
            columns["x" + end] = self.point[:, k, 0]
            columns["y" + end] = self.point[:, k, 1]
            columns["tangent" + end] = self.tangent[:, k]
        columns["residual"] = self.residual
        columns["probability"] = self.probability
        return _pandas().DataFrame(columns)

    def _column(self, name: str) -> np.ndarray:
        column: np.ndarray = self._columns[name]
        return column

    def _number(self, k: int) -> int:
        if not -len(self) <= k < len(self):
            raise IndexError(f"expected a problem from 0 to {len(self) - 1}, found {k}")
        return k % len(self)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, k: int) -> Answer:
        k = self._number(k)
        problem = self._problem(None if self._facing is None else float(self._facing[k]))
        problem.set_readings(self._readings[k])
        return Answer(problem.solve())

    def __iter__(self) -> Iterator[Answer]:
        return (self[k] for k in range(len(self)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ManyAnswers):
            return NotImplemented
        mine, theirs = self._columns, other._columns
        return all(
            mine[name].tobytes() == theirs[name].tobytes() if isinstance(mine[name], np.ndarray) else mine[name] == theirs[name]
            for name in mine
        )

    def __repr__(self) -> str:
        errors = f", {len(self._columns['errors'])} errors" if self._columns["errors"] else ""
        return f"<ManyAnswers: {len(self)} problems, {len(self.start)} placements{errors}>"
