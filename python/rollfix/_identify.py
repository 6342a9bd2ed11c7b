"""Which part of a catalog it is, searched by the workers of a cluster."""

from __future__ import annotations

import functools
import importlib
import os
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from . import _core
from ._answer import Answer
from ._catalog import Catalog, CatalogEntry
from ._checks import path, whole
from ._columns import Columns, Units
from ._core import InputError
from ._fingers import FingerLike
from ._identified import Identified
from ._logs import Log
from ._messages import shown
from ._noise import NoiseLike
from ._question import refused

SHARES = 4  # for each thread of the workers, so that none waits long for the last
# Of a shard its lines; by the ids of the parts found, their answers' states; whether nothing in it fits well.
Found = Tuple[str, Dict[int, Any], bool]
Rival = Tuple[int, float, float, float, float]  # of a part what others are held against: its place, peak, volume, noise


def identify(
    catalog: Any,
    readings: Any = None,
    turn: Any = None,
    *,
    client: Any = None,
    shards: Optional[int] = None,
    log: Any = None,
    finger: Optional[FingerLike] = None,
    noise: NoiseLike = None,
    tolerance: Optional[float] = None,
    facing: Optional[float] = None,
    at: Any = None,
    heading: Optional[Tuple[float, float]] = None,
    pose: Optional[Sequence[float]] = None,
    mirrored: bool = False,
    direction: str = "ccw",
    robust: bool = False,
    may_overlap: bool = False,
    columns: Columns = None,
    units: Units = None,
    degrees: bool = False,
    wrapped: Optional[bool] = None,
    roll: Optional[int] = None,
    rounding: Optional[Tuple[float, float]] = None,
    budget: Optional[int] = None,
    threads: int = 0,
) -> Identified:
    """Every part of a catalog on which the roll can have been, on one machine or on a Dask cluster: the same, to the bit.

    Parameters
    ----------
    catalog : Catalog or path
        With a client its file has to be there under the same path for every worker.
    readings, turn, log, ...
        The roll, as of `Part.locate`, in the catalog's unit.
    client : distributed.Client, optional
        Its workers search shares of the catalog. What a worker had that is lost is searched again by another.
    shards : int, optional
        How many shares. Default: four for each thread of the workers.
    threads : int
        0: as many as there are processors; with a client one for each share.

    Returns
    -------
    Identified

    Raises
    ------
    InputError
        What can't be meant; the message names the argument.
    """
    asked = catalog if isinstance(catalog, Catalog) else Catalog(path(catalog, "catalog"))
    options = dict(
        finger=finger, noise=noise, tolerance=tolerance, facing=facing, at=at, heading=heading, pose=pose,
        mirrored=mirrored, direction=direction, robust=robust, may_overlap=may_overlap, columns=columns, units=units, degrees=degrees,
        wrapped=wrapped,
        roll=roll, rounding=rounding, budget=budget,
    )  # fmt: skip
    count = whole(threads, "threads")
    shares = None if shards is None else whole(shards, "shards", 1)
    if client is None and shares is not None:
        raise InputError("shards: is how many shares a cluster works on, expected `client` as well")
    distributed = None if client is None else _distributed(client)
    problem, read = asked._asked(readings, turn, log, options)
    if distributed is None:
        return asked._search(problem, read, None, count)
    try:
        return _by_cluster(distributed, client, asked, problem, read, shares, max(1, count), noise is not None)
    except InputError as error:
        raise refused(error, read) from None


def _distributed(client: Any) -> Any:
    try:
        module: Any = importlib.import_module("distributed")
    except ImportError:
        raise ImportError("client: needs distributed; on Debian: apt-get install python3-distributed") from None
    if not isinstance(client, module.Client) or client.asynchronous:
        raise InputError(f"client: expected a distributed.Client that is not asynchronous, found {shown(client)}")
    return module


def _by_cluster(
    distributed: Any,
    client: Any,
    catalog: Catalog,
    problem: _core.Problem,
    log: Optional[Log],
    shards: Optional[int],
    threads: int,
    noisy: bool,
) -> Identified:
    workers = sum(client.nthreads().values())
    of = shards or max(1, min(SHARES * max(1, workers), len(catalog)))
    # The roll goes with each task: what is scattered would be lost with the worker that holds it.
    given = (os.path.abspath(catalog.path), problem.state())

    def ask(work: Callable[..., Any], *how: Any) -> List[Any]:
        tasks = [client.submit(work, *given, k + 1, of, threads, *how, pure=False) for k in range(of)]
        try:
            return [task.result() for task in distributed.as_completed(tasks)]
        finally:
            client.cancel(tasks)

    # With noise every share holds its parts against the likeliest of all, and looks at them with more noise only where
    # nothing in any share fits well: either takes many times as long otherwise.
    rivals = [rival for rival in ask(_likeliest) if rival is not None] if noisy else []
    rival = _core.best_rival(sorted(rivals))
    shares: List[Found] = ask(_search, rival, True)
    if all(is_narrow for _, _, is_narrow in shares):
        shares = ask(_search, rival, False)
    states = {part: state for _, found, _ in shares for part, state in found.items()}
    merged = catalog._merged([text for text, _, _ in shares], lambda entry: _answer(catalog, entry, states[entry.id], log))
    whys = [one["why"] for one in merged.to_dict()["refused"]]
    if whys and len(whys) == merged.searched:
        raise InputError(whys[0])  # as where it is one search
    return merged


def _likeliest(file: str, state: Any, shard: int, shards: int, threads: int) -> Optional[Rival]:
    """By a worker."""
    catalog = _opened(file)
    return catalog.likeliest(_core.problem_from_state(catalog.part(0), *state), shard, shards, threads)


def _answer(catalog: Catalog, entry: CatalogEntry, state: Any, log: Optional[Log]) -> Answer:
    return Answer(_core.answer_from_state(catalog.part(entry.name)._core, *state), log)


def _search(
    file: str, state: Any, shard: int, shards: int, threads: int, rival: Optional[Rival], narrowly: bool
) -> Found:
    """By a worker."""
    catalog = _opened(file)
    problem = _core.problem_from_state(catalog.part(0), *state)
    _, lines, found, is_narrow = catalog.identify(problem, shard, shards, threads, narrowly, rival)
    return lines, {part: answer.state()[1:] for part, answer in found}, is_narrow


def _opened(file: str) -> _core.Catalog:
    facts = os.stat(file) if os.path.exists(file) else None
    return _opened_as(file, None if facts is None else (facts.st_mtime_ns, facts.st_size))


@functools.lru_cache(maxsize=2)
def _opened_as(file: str, as_it_was: Optional[Tuple[int, int]]) -> _core.Catalog:
    return _core.Catalog(file)
