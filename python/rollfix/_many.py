"""The answers to many problems at once."""

from __future__ import annotations

import operator
from typing import Any, Dict, Iterator, List, Optional, Union, overload

import numpy as np

from . import _cluster, _core
from ._answer import Answer
from ._checks import READINGS, array, by_name, finite, whole
from ._core import InputError
from ._made import Made
from ._messages import shown
from ._progress import Progress
from ._question import Question

Result = Union[Answer, InputError]
KINDS: np.ndarray = np.array(["crossing", "touching", "stretch", "corner"])
STATUSES: np.ndarray = np.array(["complete", "incomplete"])
VERDICTS: np.ndarray = np.array(["unique", "ambiguous", "unobservable", "inconsistent", "undecided"])


class ManyAnswers(Made):
    """The answers to many problems, as arrays: placement number p of problem k is row `offsets[k] + p`.

    What is of a finger has an axis for it. Arrays can't be written to. `many[k]` is the whole `Answer` to problem k,
    worked out again; of a problem with an error it raises it. Iterating and slices give the errors in their place, as
    `Part.locate_logs` does. `many.rows(k)` is the slice of the rows of problem k.
    """

    __slots__ = ("_columns", "_question", "_readings", "_facing")

    def __init__(
        self, columns: Dict[str, Any], question: Question, readings: np.ndarray, facing: Optional[np.ndarray]
    ) -> None:
        self._columns = columns
        self._question = question
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
        from ._logs import pandas

        columns: Dict[str, Any] = {"problem": self.problem, "kind": self.kind}
        for k, end in enumerate([""] if self.fingers == 1 else ["_a", "_b"]):
            columns["start" + end] = self.start[:, k]
            columns["end" + end] = self.end[:, k]
            columns["x" + end] = self.point[:, k, 0]
            columns["y" + end] = self.point[:, k, 1]
            columns["tangent" + end] = self.tangent[:, k]
        columns["residual"] = self.residual
        columns["probability"] = self.probability
        return pandas().DataFrame(columns)

    def _column(self, name: str) -> np.ndarray:
        column: np.ndarray = self._columns[name]
        return column

    def _number(self, k: Any) -> int:
        try:
            number = operator.index(k)
        except TypeError:
            raise TypeError(f"expected the number of a problem, found {shown(k)}") from None
        if not -len(self) <= number < len(self):
            raise IndexError(f"expected a problem from 0 to {len(self) - 1}, found {number}")
        return number % len(self)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @overload
    def __getitem__(self, k: int) -> Answer: ...
    @overload
    def __getitem__(self, k: slice) -> List[Result]: ...
    def __getitem__(self, k: Union[int, slice]) -> Union[Answer, List[Result]]:
        if isinstance(k, slice):
            return [self._result(one) for one in range(*k.indices(len(self)))]
        return self._answer(self._number(k))

    def __iter__(self) -> Iterator[Result]:
        return (self._result(k) for k in range(len(self)))

    def _answer(self, k: int) -> Answer:
        facing = None if self._facing is None else float(self._facing[k])
        answer: Answer = self._question.of_rows(self._readings[k], facing).solved()
        return answer

    def _result(self, k: int) -> Result:
        try:
            return self._answer(k)
        except InputError as error:
            return error

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

    def __reduce__(self) -> Any:
        return (_many, (self._columns, self._question, self._readings, self._facing))


def _many(columns: Dict[str, Any], *rest: Any) -> ManyAnswers:
    for column in columns.values():
        if isinstance(column, np.ndarray):
            column.flags.writeable = False
    return ManyAnswers(columns, *rest)


def locate_many(
    question: Question, readings: Any, facing: Any, threads: int, client: Any, progress: Optional[bool]
) -> ManyAnswers:
    if client is not None:
        _cluster.require_client(client)
    question.require_one_roll()
    rows = array(by_name(readings, "readings", *READINGS), "readings", masked_is_nan=True)  # as NaN: an error stays with its problem
    if rows.ndim == 2:
        rows = rows[:, np.newaxis, :]
    if rows.ndim != 3 or rows.shape[2] not in (2, 3) or rows.shape[1] == 0:
        raise InputError(
            "readings: expected an array of shape (problems, 2) or (problems, 3), or (problems, readings, 2 or 3), "
            f"found shape {np.shape(readings)}"
        )
    rows = np.ascontiguousarray(rows).view()
    rows.flags.writeable = False
    facings = None
    if facing is not None:
        given = finite(array(facing, "facing"), "facing")
        if given.shape not in ((), (len(rows),)):
            raise InputError(f"facing: expected one angle, or one for each of {len(rows)}, found shape {given.shape}")
        facings = np.ascontiguousarray(np.broadcast_to(given, (len(rows),)))
    with Progress(len(rows), progress) as bar:
        like = question.of_rows(np.zeros(rows.shape[1:])).core
        if client is None:
            columns = _core.solve_many(like, rows, facings, whole(threads, "threads"), bar.report)
        else:
            columns = _cluster.solve_many(client, like, question.part, rows, facings, bar.report)
    return ManyAnswers(columns, question, rows, facings)
