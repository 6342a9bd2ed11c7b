"""Many logs, or readings, spread over the workers of a Dask cluster: the same answers as here."""

from __future__ import annotations

import functools
import importlib
import os
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _core
from ._core import InputError
from ._messages import shown

SHARES = 4  # for each thread of the workers, so that none waits long for the last
State = Tuple[Tuple[Any, ...], Any]  # of a problem or an answer, without its part
Solved = Union[State, str]  # an answer's, or why there is none
Identified = Union[Tuple[str, Dict[int, State]], str]  # a document, and of its parts' ids the answers'


def solve_questions(
    client: Any, part: _core.Part, questions: Sequence[_core.Question], report: Callable[[int], None]
) -> List[Union[_core.Answer, str]]:
    """As `_core.solve_questions`."""
    found: List[Solved] = _spread(client, _solve, [question.state() for question in questions], report, part)
    return [one if isinstance(one, str) else _core.answer_from_state(part, *one) for one in found]


def solve_many(
    client: Any,
    like: _core.Question,
    part: _core.Part,
    rows: np.ndarray,
    facings: Optional[np.ndarray],
    report: Callable[[int], None],
) -> Dict[str, Any]:
    """As `_core.solve_many`."""
    numbers = list(range(len(rows)))
    shares: List[Dict[str, Any]] = _of_shares(client, _solve_rows, numbers, report, part, like.state(), rows, facings)
    return _joined(shares)


def identify_many(
    client: Any, file: str, questions: Sequence[_core.Question], report: Callable[[int], None]
) -> List[Identified]:
    """What `_core.Catalog.identify` says of each, or why it can't."""
    return _spread(client, _identify, [question.state() for question in questions], report, os.path.abspath(file))


def require_client(client: Any) -> None:
    """Throws InputError: what is no client that can be waited for. ImportError: without distributed."""
    if not isinstance(client, _distributed().Client) or client.asynchronous:
        raise InputError(f"client: expected a distributed.Client that is not asynchronous, found {shown(client)}")


def _distributed() -> Any:
    try:
        return importlib.import_module("distributed")
    except ImportError:
        raise ImportError("client: needs distributed; on Debian: apt-get install python3-distributed") from None


def _spread(client: Any, work: Callable[..., List[Any]], items: List[Any], report: Callable[[int], None], *given: Any) -> List[Any]:
    """`work(share, *given)` of shares of the items, in order."""
    return [one for share in _of_shares(client, work, items, report, *given) for one in share]


def _of_shares(client: Any, work: Callable[..., Any], items: List[Any], report: Callable[[int], None], *given: Any) -> List[Any]:
    # All that is needed goes with each task: what is scattered would be lost with the worker that holds it.
    count = max(1, min(len(items), SHARES * max(1, sum(client.nthreads().values()))))
    shares = [items[k * len(items) // count : (k + 1) * len(items) // count] for k in range(count)]
    tasks = [client.submit(work, share, *_of(share, given), pure=False) for share in shares]
    number = {task.key: k for k, task in enumerate(tasks)}
    done = 0
    try:
        for task in _distributed().as_completed(tasks):
            done += len(shares[number[task.key]])
            report(done)
        return [task.result() for task in tasks]
    finally:
        client.cancel(tasks)


def _of(share: List[Any], given: Tuple[Any, ...]) -> Tuple[Any, ...]:
    """Of arrays with an entry for each item those of the share."""
    return tuple(one[share] if isinstance(one, np.ndarray) else one for one in given)


def _joined(shares: Sequence[Dict[str, Any]]) -> Dict[str, Any]:
    """The columns of all rows from those of shares of them, in order."""
    columns: Dict[str, Any] = {"fingers": shares[0]["fingers"], "errors": {}, "offsets": np.zeros(1, dtype=np.int64)}
    before = 0
    for share in shares:
        columns["errors"].update({before + k: why for k, why in share["errors"].items()})
        columns["offsets"] = np.concatenate([columns["offsets"], columns["offsets"][-1] + share["offsets"][1:]])
        before += len(share["offsets"]) - 1
    for name in shares[0]:
        if name not in columns:
            columns[name] = np.concatenate([share[name] for share in shares])
    return columns


# By a worker:


def _solve(states: List[State], part: _core.Part) -> List[Solved]:
    found: List[Any] = _core.solve_questions([_core.question_from_state(part, *state) for state in states], 1, None)
    return [one if isinstance(one, str) else one.state()[1:] for one in found]


def _solve_rows(
    share: List[int], part: _core.Part, like: State, rows: np.ndarray, facings: Optional[np.ndarray]
) -> Dict[str, Any]:
    return _core.solve_many(_core.question_from_state(part, *like), np.ascontiguousarray(rows), facings, 1, None)


def _identify(states: List[State], file: str) -> List[Identified]:
    catalog = _opened(file)
    found: List[Identified] = []
    for state in states:
        try:
            text, answers = catalog.identify(_core.question_from_state(catalog.part(0), *state), 1)
            of_rolls: Dict[int, Any] = dict(answers)  # of contacts that share a pose nobody asks many times
            found.append((text, {part: answer.state()[1:] for part, answer in of_rolls.items()}))
        except InputError as error:
            found.append(str(error))
    return found


def _opened(file: str) -> _core.Catalog:
    facts = os.stat(file) if os.path.exists(file) else None
    return _opened_as(file, None if facts is None else (facts.st_mtime_ns, facts.st_size))


@functools.lru_cache(maxsize=2)
def _opened_as(file: str, as_it_was: Optional[Tuple[int, int]]) -> _core.Catalog:
    return _core.Catalog(file)
