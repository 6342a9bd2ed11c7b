"""From what a user asks to what the C++ solves."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Tuple

import numpy as np

from . import _core
from ._core import InputError
from ._inputs import (
    FingerLike,
    NoiseLike,
    array,
    clockwise,
    fingers,
    finite,
    noise as noise_given,
    number,
    numbers,
    pose_prior,
    readings as readings_given,
    whole,
)
from ._logs import Columns, Log, core_log


def basic_problem(
    part: _core.Part, finger: Optional[FingerLike], noise: NoiseLike, tolerance: Optional[float], mirrored: bool, budget: Any
) -> _core.Problem:
    problem = _core.Problem(part)
    if finger is not None:
        problem.set_fingers(fingers(finger))
    if noise is not None:
        problem.set_noise(noise_given(noise))
    if tolerance is not None:
        problem.tolerance = number(tolerance, "tolerance")
        if problem.tolerance < 0:
            raise InputError(f"tolerance: expected an angle of at least 0, found {tolerance!r}")
    problem.mirrored = bool(mirrored)
    if budget is not None:
        problem.budget = whole(budget, "budget", 1)
    return problem


def problem_of(
    part: _core.Part,
    readings: Any,
    turn: Any,
    log: Any,
    finger: Optional[FingerLike] = None,
    noise: NoiseLike = None,
    tolerance: Optional[float] = None,
    facing: Optional[float] = None,
    at: Any = None,
    prior: Any = None,
    heading: Any = None,
    pose: Any = None,
    mirrored: bool = False,
    direction: str = "ccw",
    robust: bool = False,
    columns: Columns = None,
    units: Optional[Mapping[str, str]] = None,
    degrees: bool = False,
    roll: Optional[int] = None,
    rounding: Optional[Tuple[float, float]] = None,
    budget: Optional[int] = None,
) -> Tuple[_core.Problem, Optional[Log]]:
    if (readings is None) == (log is None):
        found = "neither" if log is None else "both: they can't be of the same roll"
        raise InputError(f"readings: expected readings or `log`, found {found}")
    problem = basic_problem(part, finger, noise, tolerance, mirrored, budget)
    if direction == "either":
        problem.either_way, direction = True, "ccw"
    taken: Optional[Log] = None
    if log is not None:
        taken = _set_log(part, problem, turn, log, columns, units, degrees, direction, roll, rounding)
    else:
        _set_readings(problem, readings, turn, direction, rounding)
        for value, name in ((at, "at"), (columns, "columns"), (units, "units"), (roll, "roll")):
            if value is not None:
                raise InputError(f"{name}: is about a log, found readings")
        if degrees:
            raise InputError("degrees: is about a log's columns; readings are radians: numpy.radians converts them")
    if facing is not None:
        problem.facing = number(facing, "facing")
    if at is not None:
        problem.at = list(finite(np.atleast_1d(array(at, "at")), "at"))
    if prior is not None:
        s, sd = numbers(prior, 2, "prior", "(s, sd)")
        problem.set_prior((s, sd))
    problem.set_pose(pose_prior(heading, pose))
    problem.robust = bool(robust)
    return problem, taken


def _set_log(
    part: _core.Part,
    problem: _core.Problem,
    turn: Any,
    log: Any,
    columns: Columns,
    units: Optional[Mapping[str, str]],
    degrees: bool,
    direction: str,
    roll: Optional[int],
    rounding: Any,
) -> Log:
    if turn is not None:
        raise InputError("turn: goes with a length, found a log")
    if rounding is not None:
        raise InputError("rounding: is of readings; a log's digits say it themselves")
    core = core_log(log, columns, units, degrees, part.unit, clockwise(direction), roll)
    if (clockwise(direction) or problem.either_way) and core.kind == "contact":
        raise InputError("direction: the log has u and psi, which say the direction themselves: leave it out")
    problem.set_log(core)
    return Log(core)


def _set_readings(problem: _core.Problem, readings: Any, turn: Any, direction: str, rounding: Any) -> None:
    rows = readings_given(readings, turn)
    if clockwise(direction):
        rows = rows * np.array([-1.0] * (rows.shape[1] - 1) + [1.0])
    problem.set_readings(rows)
    if rounding is not None:
        length, angle = numbers(rounding, 2, "rounding", "(length, turn)")
        problem.set_roundings([(length, angle)] * len(rows))


_LOG_OPTIONS: Dict[str, Any] = {
    "finger": None,
    "noise": None,
    "tolerance": None,
    "facing": None,
    "at": None,
    "prior": None,
    "heading": None,
    "pose": None,
    "mirrored": False,
    "direction": "ccw",
    "robust": False,
    "columns": None,
    "units": None,
    "degrees": False,
    "roll": None,
    "rounding": None,
    "budget": None,
}


def log_options(options: Dict[str, Any]) -> List[Any]:
    unknown = [name for name in options if name not in _LOG_OPTIONS]
    if unknown:
        raise TypeError(f"locate_logs() got an unexpected keyword argument {unknown[0]!r}")
    return [options.get(name, default) for name, default in _LOG_OPTIONS.items()]
