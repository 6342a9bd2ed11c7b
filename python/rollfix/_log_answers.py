"""The answers to many logs."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence as SequenceABC
from typing import Any, Dict, Generic, Iterable, Iterator, List, Optional, Sequence, Tuple, TypeVar, Union, overload

import numpy as np

from . import _cluster, _core
from ._answer import Answer
from ._checks import whole
from ._core import InputError
from ._logs import Log, Roll
from ._made import Made
from ._messages import shown
from ._progress import Progress
from ._question import Posed, Question
from ._tables import is_frame, is_table

One = TypeVar("One")  # what is found of each


class Results(Made, SequenceABC, Generic[One]):  # type: ignore[type-arg]
    """What was found of each of many, in order, or the InputError of what can't be worked with: a sequence of both.

    `answers` are those without, `errors` the others by number. It can't be changed, and can be pickled.
    """

    __slots__ = ("_all",)

    def __init__(self, found: Iterable[Union[One, InputError]]) -> None:
        self._all = tuple(found)

    @property
    def answers(self) -> Tuple[One, ...]:
        """tuple: of all that could be worked with."""
        return tuple(one for one in self._all if not isinstance(one, InputError))

    @property
    def errors(self) -> Dict[int, InputError]:
        """dict: of the others, number and reason."""
        return {k: one for k, one in enumerate(self._all) if isinstance(one, InputError)}

    def to_frame(self) -> Any:
        """A pandas.DataFrame with a row for each placement, and the `number` of what it is of; errors have none."""
        from ._logs import pandas

        frames = [
            one.to_frame().assign(number=k) for k, one in enumerate(self._all) if not isinstance(one, InputError)  # type: ignore[attr-defined]
        ]
        whole_frame = pandas().concat(frames, ignore_index=True) if frames else pandas().DataFrame({"number": []})
        return whole_frame[["number", *(name for name in whole_frame.columns if name != "number")]]

    def __len__(self) -> int:
        return len(self._all)

    @overload
    def __getitem__(self, k: int) -> Union[One, InputError]: ...
    @overload
    def __getitem__(self, k: slice) -> Tuple[Union[One, InputError], ...]: ...
    def __getitem__(self, k: Any) -> Any:
        return self._all[k]

    def __iter__(self) -> Iterator[Union[One, InputError]]:
        return iter(self._all)

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and [_value(one) for one in self] == [_value(one) for one in other]  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash(tuple(map(_value, self._all)))

    def __repr__(self) -> str:
        errors = len(self.errors)
        failed = f", {errors} error{'s' if errors > 1 else ''}" if errors else ""
        return f"<{type(self).__name__}: {len(self) - errors} answers{failed}>"

    def __reduce__(self) -> Any:
        return (type(self), (self._all,))


class LogAnswers(Results[Answer]):
    """The answers to many logs, as of `Part.locate_logs`: a sequence of `Answer`, and of InputError where there is none."""

    __slots__ = ()


def _value(one: Any) -> Any:
    return str(one) if isinstance(one, InputError) else one


def checked(found: Sequence[Any], errors: str, what: str) -> Sequence[Any]:
    """Throws InputError: where errors are to be raised the first one; where nothing could be worked with for one reason, that."""
    failed = [(k, one) for k, one in enumerate(found) if isinstance(one, InputError)]
    if errors == "raise" and failed:
        raise InputError(f"{what}: number {failed[0][0]}: {failed[0][1]}")
    if len(found) > 1 and len(failed) == len(found) and len({_kind(str(error)) for _, error in failed}) == 1:
        raise InputError(f"{what}: all {len(found)} fail alike; the first: {failed[0][1]}")
    return found


def errors_given(errors: Any) -> str:
    if errors not in ("collect", "raise"):
        raise InputError(f"errors: expected 'collect' or 'raise', found {shown(errors)}")
    return str(errors)


def _kind(message: str) -> str:
    """Without what the log is called, and without numbers."""
    return re.sub(r"[-+]?[\d.]+(e[-+]?\d+)?", "N", message.partition(": ")[2] or message)


def locate_logs(
    question: Question, logs: Any, threads: int, client: Any, progress: Optional[bool], errors: str
) -> LogAnswers:
    count, then = whole(threads, "threads"), errors_given(errors)
    if client is not None:
        _cluster.require_client(client)
    given = several(logs)
    question.require_one_roll()
    asked: List[Union[Posed, InputError]] = []
    with Progress(len(given), progress, "logs read") as bar:
        for log in given:
            asked.append(_asked(question, log))
            bar.report(len(asked))
    questions = [one.core for one in asked if not isinstance(one, InputError)]
    with Progress(len(questions), progress, "logs") as bar:
        if client is None:
            found = iter(_core.solve_questions(questions, count, bar.report))
        else:
            found = iter(_cluster.solve_questions(client, question.part, questions, bar.report))
    all_found = [one if isinstance(one, InputError) else _of_log(next(found), one) for one in asked]
    return LogAnswers(checked(all_found, then, "logs"))


def several(logs: Any) -> List[Any]:
    is_one = isinstance(logs, (str, bytes, os.PathLike, Log, Roll)) or is_table(logs)
    if is_one and not (isinstance(logs, np.ndarray) and logs.ndim == 3):
        kind = "a data frame" if is_frame(logs) else f"a {type(logs).__name__}"
        raise InputError(f"logs: expected a list of logs, found {kind}: give [log], or ask locate(log=log)")
    if not hasattr(logs, "__iter__"):
        raise InputError(f"logs: expected a list of logs, found {shown(logs)}")
    return list(logs)


def _asked(question: Question, log: Any) -> Union[Posed, InputError]:
    try:
        return question.of_log(log)
    except InputError as error:
        return error


def _of_log(found: Any, posed: Posed) -> Any:
    return posed.refused(found) if isinstance(found, str) else posed.answer(found)
