"""From what a user asks to what the C++ solves."""

from __future__ import annotations

from typing import Any, Callable, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from . import _core
from ._answer import Answer
from ._checks import (
    array,
    clockwise,
    finite,
    flag,
    least,
    number,
    place_prior,
    pose_prior,
    readings as readings_given,
    rounding as rounding_given,
    whole,
)
from ._columns import Naming
from ._core import InputError
from ._fingers import fingers
from ._logs import Log, Roll, log_of
from ._noise import weighing
from ._options import RollOptions, filled
from ._tables import is_frame
from ._words import in_python


class Question:
    """All that is asked besides the rolls themselves: checked once, for one roll or for many. Can be pickled."""

    __slots__ = (
        "_part", "_fingers", "_noise", "_tolerance", "_facing", "_at", "_prior", "_pose", "_mirrored", "_clockwise",
        "_either", "_robust", "_may_overlap", "_naming", "_roll", "_rounding", "_budget", "_of_logs",
    )  # fmt: skip

    def __init__(self, part: _core.Part, options: Mapping[str, Any]) -> None:
        """`options`: any of RollOptions."""
        given = filled(options, RollOptions)
        self._part = part
        self._fingers = fingers(given["finger"])
        self._noise = weighing(given["noise"])
        self._tolerance = _or_none(given["tolerance"], lambda value: least(value, "tolerance", 0, "an angle"))
        self._facing = _or_none(given["facing"], lambda value: number(value, "facing"))
        self._at = _or_none(given["at"], lambda value: list(finite(np.atleast_1d(array(value, "at")), "at")))
        self._prior = _or_none(given["prior"], place_prior)
        self._pose = pose_prior(given["heading"], given["pose"])
        self._mirrored = flag(given["mirrored"], "mirrored")
        direction = given["direction"]
        self._either = isinstance(direction, str) and direction == "either"
        self._clockwise = not self._either and clockwise(direction, either=True)
        self._robust = flag(given["robust"], "robust")
        self._may_overlap = flag(given["may_overlap"], "may_overlap")
        self._naming = Naming(given["columns"], given["units"], given["degrees"], given["wrapped"])
        self._roll = _or_none(given["roll"], lambda value: whole(value, "roll", 1))
        self._rounding = _or_none(given["rounding"], rounding_given)
        self._budget = _or_none(given["budget"], lambda value: whole(value, "budget", 1))
        self._require_noise("prior" if self._prior is not None else "pose" if given["pose"] is not None else "heading")
        self._of_logs = [name for name in ("at", "columns", "units", "roll") if given[name] is not None]

    @property
    def part(self) -> _core.Part:
        return self._part

    def _require_noise(self, of_prior: str) -> None:
        if self._noise is not None:
            return
        if self._prior is not None or self._pose is not None:
            raise InputError(f"{of_prior}: is weighed against noisy rows, expected `noise` as well")
        if self._robust:
            raise InputError("robust: is about noise, expected `noise` as well")

    def _problem(self, facing: Optional[float] = None) -> _core.Problem:
        problem = _core.Problem(self._part)
        if self._fingers:
            problem.set_fingers(self._fingers)
        if self._noise is not None:
            problem.set_noise(self._noise)
        problem.tolerance = self._tolerance
        problem.mirrored = self._mirrored
        problem.either_way = self._either
        problem.facing = self._facing if facing is None else facing
        problem.budget = self._budget
        if self._at is not None:
            problem.at = self._at
        problem.set_prior(self._prior)
        problem.set_pose(self._pose)
        problem.robust = self._robust
        problem.may_overlap = self._may_overlap
        return problem

    def of_log(self, log: Any, turn: Any = None) -> Tuple[_core.Problem, Log]:
        if turn is not None:
            raise InputError("turn: goes with a length, found a log")
        if self._rounding is not None:
            raise InputError("rounding: is of readings; a log's digits say it themselves")
        if self._facing is not None:
            raise InputError("facing: goes with readings; a log of two fingers has it in u and psi")
        try:
            read = log_of(log, self._naming, self._part.unit, self._clockwise, self._roll)
        except InputError as error:
            raise InputError(str(error).replace("state it with unit=", "make the part with unit=")) from None
        if read.kind == "contact":
            require_finger(self._fingers, read)
            if self._clockwise or self._either:
                raise InputError("direction: the log has u and psi, which say the direction themselves: leave it out")
        read = read._in_unit(self._part.unit, self._fingers)
        problem = self._problem()
        problem.set_log(read._core)
        return problem, read

    def of_readings(self, readings: Any, turn: Any) -> _core.Problem:
        if turn is None:
            _require_numbers(readings)
        if self._of_logs:
            raise InputError(f"{self._of_logs[0]}: is about a log, found readings")
        if self._naming.angles:
            raise InputError("degrees: is about a log's columns; readings are radians: np.radians converts them")
        return self.of_rows(readings_given(readings, turn))

    def of_rows(self, rows: np.ndarray, facing: Optional[float] = None) -> _core.Problem:
        """Of readings that are checked."""
        problem = self._problem(facing)
        problem.set_readings(self.along_outline(rows))
        if self._rounding is not None:
            problem.set_roundings([self._rounding] * len(rows))
        return problem

    def like_rows(self, count: int) -> _core.Problem:
        """For many problems of so many readings each."""
        problem = self._problem()
        if self._rounding is not None:
            problem.set_roundings([self._rounding] * count)
        return problem

    def along_outline(self, rows: np.ndarray) -> np.ndarray:
        """Lengths counter-clockwise, as C++ has them."""
        if not self._clockwise:
            return rows
        signs: np.ndarray = np.array([-1.0] * (rows.shape[-1] - 1) + [1.0])
        return np.multiply(rows, signs)


def require_one_roll(readings: Any, log: Any) -> None:
    """Throws InputError: not exactly one of both."""
    if (readings is None) == (log is None):
        found = "neither" if log is None else "both: they can't be of the same roll"
        raise InputError(f"readings: expected readings or `log`, found {found}")


def _or_none(value: Any, check: Callable[[Any], Any]) -> Any:
    return None if value is None else check(value)


def require_finger(given: Sequence[Any], log: Log) -> None:
    if not given:
        raise InputError(
            f"finger: {log.name} has u and psi, and u says where on the finger the contact is: expected the finger's "
            "shape, as in finger=Disk(10), its radius in the part's unit"
        )


def solved(problem: _core.Problem, log: Optional[Log] = None) -> Answer:
    try:
        return Answer(problem.solve(), log)
    except InputError as error:
        raise refused(error, log) from None


def refused(error: InputError, log: Optional[Log]) -> InputError:
    """What C++ says of a problem, in Python's words."""
    return InputError(in_python(str(error)) if log is None else log._said(str(error)))


def _require_numbers(readings: Any) -> None:
    """Throws InputError: a log, where readings are expected."""
    both: List[Any] = list(readings) if isinstance(readings, (list, tuple)) else [readings]
    for one in both[:2]:
        if isinstance(one, (str, dict, Log, Roll)) or hasattr(one, "__fspath__") or is_frame(one):
            raise InputError(f"readings: expected an array of numbers, found {_kind(one)}: give a log by name, as log=...")


def _kind(log: Any) -> str:
    names = {str: "a text", dict: "a dict", Log: "a Log", Roll: "a Roll"}
    return names.get(type(log), "a data frame" if is_frame(log) else "a path")
