"""From what a user asks to what the C++ solves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

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
    numbers,
    place_prior,
    pose_prior,
    readings as readings_given,
    rounding as rounding_given,
    whole,
)
from ._columns import Naming
from ._core import InputError
from ._fingers import Wheel, fingers
from ._holds import HoldAnswer
from ._log_reading import is_log, log_of, pin_of, rolls_of
from ._logs import Log, Roll
from ._messages import shown
from ._noise import noise
from ._options import AnyOptions, filled, is_said
from ._rounding import offer_rounding
from ._tables import is_frame
from ._touches import TouchAnswer, paths_from, touches_from
from ._words import in_python

OF_LOGS = ("columns", "units", "degrees", "wrapped", "roll")
MOST_FINGERS = 8  # that C++ holds a part with; fewer where there are fewer logs, as C++ says


@dataclass
class Posed:
    """A question with its contacts, and the logs whose rows C++ speaks of."""

    core: _core.Question
    part: _core.Part
    logs: Tuple[Log, ...] = ()

    def solved(self) -> Any:
        """The answer, of its kind. Throws InputError."""
        try:
            return self.answer(self.core.solve())
        except InputError as error:
            raise self.refused(error) from None

    def answer(self, found: Any) -> Any:
        """What C++ found, as the user has it."""
        if isinstance(found, _core.Answer):
            return Answer(found, self.logs[0] if len(self.logs) == 1 else None)
        if isinstance(found, _core.TouchAnswer):
            return TouchAnswer(self.part, self.core, found)
        return HoldAnswer(self.part, self.core, found)

    def answer_of_one(self, found: Any) -> Any:
        """The same of what C++ found of one of many parts."""
        if isinstance(found, _core.Answer):
            return self.answer(found)
        return replace(self, core=self.core.about(found.part), part=found.part).answer(found)

    def refused(self, error: Union[InputError, str]) -> InputError:
        """What C++ says of it, in Python's words."""
        message = str(error)
        for log in self.logs:
            message = log._numbering.said(message)
        return InputError(in_python(message))


class Question:
    """All that is asked besides the contacts: checked once, for one question or for many. Can be pickled.

    Here is checked what each option is; what goes with what C++ says, for the program as well.
    """

    __slots__ = ("part", "_given", "_options", "_naming", "_fingers", "_wheels", "_tolerance", "_rounding")

    def __init__(self, part: _core.Part, options: Mapping[str, Any]) -> None:
        """`options`: any of AnyOptions."""
        self.part = part
        self._given = given = filled(options, AnyOptions)  # of which `of` looks at how a log is read
        self._naming = Naming(given["columns"], given["units"], given["degrees"], given["wrapped"])
        self._fingers, self._wheels = _apart(given["finger"])
        self._tolerance = _or_none(given["tolerance"], _tolerance)
        self._rounding = _or_none(given["rounding"], rounding_given)
        if given["roll"] != "all":
            given["roll"] = _or_none(given["roll"], _roll_number)
        self._options: Dict[str, Any] = {
            "noise": noise(given["noise"]),
            "budget": _or_none(given["budget"], lambda value: whole(value, "budget", 1)),
            "facing": _or_none(given["facing"], lambda value: number(value, "facing")),
            "at": _or_none(given["at"], lambda value: list(finite(np.atleast_1d(array(value, "at")), "at"))),
            "prior": _or_none(given["prior"], place_prior),
            "pose": pose_prior(given["heading"], given["pose"]),
            "squeezed": _or_none(given["squeezed"], lambda value: least(value, "squeezed", 0, "an angle")),
            "direction": _direction(given["direction"]),
            "mirrored": flag(given["mirrored"], "mirrored") or None,
            "robust": flag(given["robust"], "robust") or None,
            "may_overlap": flag(given["may_overlap"], "may_overlap") or None,
            "clear": _or_none(given["clear"], paths_from),
        }

    def core(self, **contacts: Any) -> _core.Question:
        """As C++ has it."""
        if self._wheels and "wheels" not in contacts:
            fingers(self._given["finger"])  # says where a wheel goes
        if self._rounding is not None:
            if contacts.get("readings") is None:
                raise InputError("rounding: is of readings; the digits of a log say it themselves, of touches `tolerance` does")
            contacts["roundings"] = [self._rounding] * len(contacts["readings"])
        tolerance = self._tolerance
        if isinstance(tolerance, float):  # of touches it is a length
            tolerance = (tolerance, 0.0) if contacts.get("touches") is not None else (0.0, tolerance)
        return _core.Question(self.part, **{"fingers": self._fingers, "tolerance": tolerance, **self._options, **contacts})

    def of(self, readings: Any = None, turn: Any = None, log: Any = None, touches: Any = None) -> Posed:
        """Of contacts of whichever kind: what one of them is not, or all together are not, C++ says."""
        is_all = self._given["roll"] == "all"
        if log is None and is_all:
            raise InputError("roll: 'all' takes the rolls of a log, expected `log` as well")
        if readings is None and turn is not None:
            raise InputError(f"turn: goes with a length, found {'none' if log is None else 'a log'}")
        if readings is not None and log is None and touches is None:
            return self.of_readings(readings, turn)
        contacts = {
            "readings": None if readings is None else readings_given(readings, turn),
            "touches": None if touches is None else touches_from(touches),
        }
        if log is None:
            self._require_no_log("is about a log, found none" if touches is None else "touches do not roll and have no use for it")
            return Posed(self.core(**contacts), self.part)
        if is_all:
            rolls = [self._in_unit(one) for one in rolls_of(log, self._naming, self.part.unit)]
            return self._posed(rolls, at_rest=True, **contacts)
        if self._wheels or _is_several(log):
            return self._of_fingers(log, **contacts)
        return self.of_log(log, **contacts)

    def of_log(self, log: Any, **contacts: Any) -> Posed:
        """Of one roll."""
        try:
            read = log_of(log, self._naming, self.part.unit, self._given["roll"])
        except InputError as error:
            raise InputError(str(error).replace("state it with unit=", "make the part with unit=")) from None
        return self._posed([self._in_unit(read)], **contacts)

    def of_readings(self, readings: Any, turn: Any) -> Posed:
        if turn is None:
            _require_numbers(readings)
        if self._given["degrees"]:
            raise InputError("degrees: is about a log's columns; readings are radians: np.radians converts them")
        self._require_no_log("is about a log, found readings")
        return self.of_rows(readings_given(readings, turn))

    def of_rows(self, rows: np.ndarray, facing: Optional[float] = None) -> Posed:
        """Of readings that are checked."""
        contacts: Dict[str, Any] = {"readings": rows} if facing is None else {"readings": rows, "facing": facing}
        return Posed(self.core(**contacts), self.part)

    def require_one_roll(self) -> None:
        """Throws InputError: what no roll could be asked with, whatever it is."""
        if self._given["roll"] == "all":
            raise InputError("roll: expected a number from 1, found 'all'")
        self.core(readings=np.zeros((1, 2)), facing=None).require_roll()

    def _of_fingers(self, logs: Any, **contacts: Any) -> Posed:
        """Each has a log of its own, those with skin first."""
        given = list(logs) if isinstance(logs, (list, tuple)) else [logs]
        if self._given["roll"] is not None:
            raise InputError("roll: chooses from one log, and there are several: leave it out")
        count = len(given) - len(self._wheels)
        if self._wheels and count != len(self._fingers):
            raise InputError(
                f"log: expected a list of {len(self._fingers) + len(self._wheels)}, one of each finger, of a wheel x and y "
                f"of its pin, found {shown(logs)}"
            )
        read = [self._of_finger(which, log) for which, log in enumerate(given[:count])]
        pins = [
            (pin_of(log, self._naming, self.part.unit)._in_unit(self.part.unit, [radius]), radius)
            for log, radius in zip(given[count:], self._wheels)
        ]
        posed = self._posed(read, wheels=[(pin._core, radius) for pin, radius in pins], **contacts)
        return replace(posed, logs=(*posed.logs, *(pin for pin, _ in pins)))

    def _of_finger(self, which: int, log: Any) -> Log:
        rolls = rolls_of(log, self._naming, self.part.unit)
        if len(rolls) != 1:
            raise InputError(
                f"log: expected one roll of each finger, found {len(rolls)} in log {which + 1}: contact is lost; cut it"
            )
        return self._in_unit(rolls[0], which)

    def _in_unit(self, log: Log, which: int = -1) -> Log:
        """`which`: of several fingers with logs of their own, whose it is."""
        of_one = which >= 0 and len(self._fingers) > 1
        return log._in_unit(self.part.unit, self._fingers[which : which + 1] if of_one else self._fingers)

    def _posed(self, logs: Sequence[Log], **contacts: Any) -> Posed:
        return Posed(self.core(rolls=[log._core for log in logs], **contacts), self.part, tuple(logs))

    def _require_no_log(self, why: str) -> None:
        if self._naming.says_nothing and self._given["roll"] is None:
            return
        name = next(name for name in OF_LOGS if is_said(name, self._given[name]))
        raise InputError(f"{name}: {why}")


def answer_to(part: _core.Part, contacts: Mapping[str, Any], options: Mapping[str, Any]) -> Any:
    """The answer to a question of whichever kind. `contacts`: readings, turn, log and touches."""
    answer = Question(part, options).of(**contacts).solved()
    if contacts["readings"] is None or len(answer) > 0:
        return answer
    is_exact = all(options.get(name) is None for name in ("noise", "tolerance", "rounding"))
    return offer_rounding(answer, answer.readings) if is_exact else answer


def _or_none(value: Any, check: Callable[[Any], Any]) -> Any:
    return None if value is None else check(value)


def _roll_number(given: Any) -> int:
    if isinstance(given, str):
        raise InputError(f"roll: expected a number from 1, or 'all', found {given!r}")
    return whole(given, "roll", 1)


def _direction(given: Any) -> Optional[str]:
    if isinstance(given, str) and given == "either":
        return given
    return "cw" if clockwise(given, either=True) else None  # who says nothing says counter-clockwise


def _tolerance(given: Any) -> Union[float, Tuple[float, float]]:
    """An angle, of touches a length; or both."""
    if np.ndim(given) == 0:
        return least(given, "tolerance", 0, "an angle, of touches a length,")
    length, angle = numbers(given, 2, "tolerance", "an angle or (length, angle)")
    return length, angle


def _apart(finger: Any) -> Tuple[List[Any], List[float]]:
    """Fingers with skin, which come first, and the wheels' radii."""
    given = list(finger) if isinstance(finger, (list, tuple)) else [finger]
    wheels = [one.radius for one in given if isinstance(one, Wheel)]
    if not wheels:
        return fingers(finger, most=MOST_FINGERS), []
    count = len(given) - len(wheels)
    if count == 0 or any(isinstance(one, Wheel) for one in given[:count]):
        raise InputError(
            "finger: expected fingers with skin first, then wheels, and logs in the same order, as in "
            f"log=[jaw, pin], finger=[Jaw(), Wheel(0.4)], found {shown(finger)}"
        )
    return fingers(given[:count], most=MOST_FINGERS), wheels


def _is_several(log: Any) -> bool:
    """Whether logs of three or more fingers are meant."""
    return isinstance(log, (list, tuple)) and len(log) > 2 and all(is_log(one) and not _is_row(one) for one in log)


def _is_row(one: Any) -> bool:
    """Of a table that is given row by row."""
    if isinstance(one, Log):
        return False
    if isinstance(one, Mapping):
        return all(np.ndim(value) == 0 for value in one.values())
    return isinstance(one, np.ndarray) and one.ndim == 1


def _require_numbers(readings: Any) -> None:
    """Throws InputError: a log, where readings are expected."""
    both: List[Any] = list(readings) if isinstance(readings, (list, tuple)) else [readings]
    for one in both[:2]:
        if isinstance(one, (str, dict, Log, Roll)) or hasattr(one, "__fspath__") or is_frame(one):
            raise InputError(f"readings: expected an array of numbers, found {_kind(one)}: give a log by name, as log=...")


def _kind(log: Any) -> str:
    names = {str: "a text", dict: "a dict", Log: "a Log", Roll: "a Roll"}
    return names.get(type(log), "a data frame" if is_frame(log) else "a path")
