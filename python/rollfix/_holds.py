"""Three and more fingers, or fingers beside wheels, that hold and roll on a part that is free to move."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from . import _core
from ._checks import flag, least, numbers, place_prior, pose_prior, travel as travel_given, whole
from ._columns import Naming
from ._core import InputError
from ._documents import Document
from ._fingers import Wheel, fingers
from ._logs import Log, _is_log, pin_of, rolls_of
from ._messages import shown
from ._noise import noise as noise_given
from ._proved import Proved


class PinAdvice(Document):
    """How the pin of a wheel without skin moves next: the fields of `rollfix/advise/1`, see docs/json.md.

    `pin` is how far, (x, y) in the jaw's frame, or None. `helps`, and where no motion does `why`; each of the `contenders` has
    the `length` that the jaw's contact would travel.
    """

    __slots__ = ()

    def __repr__(self) -> str:
        if not self.helps:
            return f"<PinAdvice: {self.verdict}; {self.why}>"
        by = ", ".join(f"{one:.6g}" for one in self.pin)
        return f"<PinAdvice: {self.verdict}; move the pin by ({by}), {self.expected_placements:.2f} placements remain>"


class HoldAnswer(Proved):
    """Every set of first contacts of several fingers that fits: the fields of `rollfix/locate/1`, see docs/json.md.

    `placements` has one entry for each connected set, with noise the most probable first; `starts` and `ends` have the
    places of all fingers, `poses` the part's at the first and at the last contacts. `diagnosis` lists what may be wrong
    where nothing fits, or the rows contradict the noise; None elsewhere. `status`, `verdict`, `fit`, ...
    """

    __slots__ = ()
    _FIGURE = "hold_figure"

    def __init__(self, asked: Tuple[Any, ...]) -> None:
        part, logs, *rest, wheels, squeezed, prior, pose, robust, may_overlap = asked
        rest += [[(one._core, radius) for one, radius in wheels], squeezed, prior, pose, robust, may_overlap]
        self._answer = _core.locate_hold(part._core, [one._core for one in logs], *rest)
        self._asked = asked
        super().__init__(self._answer.document())

    @property
    def starts(self) -> Any:
        """ndarray, (n, fingers): s of the first contacts."""
        return np.array([one["start"] for one in self.placements], dtype=float).reshape(len(self), -1)

    @property
    def ends(self) -> Any:
        """ndarray, (n, fingers): s of the last contacts."""
        return np.array([one["end"] for one in self.placements], dtype=float).reshape(len(self), -1)

    @property
    def poses(self) -> Any:
        """ndarray, (n, 2, 3): x, y and heading in radians at the first contacts and at the last. Of logs without x and y
        these are NaN."""
        return np.array([one["pose"] for one in self.placements], dtype=float).reshape(-1, 2, 3)

    def advise(self, *, travel: Any = None) -> PinAdvice:
        """Of a jaw beside a wheel: how its pin moves next, to tell the placements apart.

        Parameters
        ----------
        travel : float or (float, float), optional
            How far the pin can go: a length, or (back, forward) with back <= 0. Default: a tenth of the perimeter.
        """
        return PinAdvice(self._answer.next_pin(travel_given(travel)))

    def _columns(self) -> Dict[str, List[Any]]:
        """Fingers are a, b, c, ...; with noise there are more."""
        placements = self.placements
        columns: Dict[str, List[Any]] = {}
        if self.noise is not None:
            columns["probability"] = [one["probability"] for one in placements]
        for finger in range(self.fingers):
            for name in ("start", "end", "sd", "end_sd"):
                if all(name in one for one in placements):
                    columns[f"{name}_{chr(ord('a') + finger)}"] = [one[name][finger] for one in placements]
        for name, number in (("first", 0), ("last", 1)):
            for k, coordinate in enumerate(("x", "y", "heading")):
                columns[f"{name}_{coordinate}"] = self.poses[:, number, k].tolist()
        return columns

    def __repr__(self) -> str:
        if not len(self):
            return f"<HoldAnswer: {self.verdict}>"
        return f"<HoldAnswer: {self.verdict}; starts {', '.join(f'{s:.6g}' for s in self.starts[0])}>"

    def __reduce__(self) -> Any:
        return (HoldAnswer, (self._asked,))


def is_hold(log: Any, finger: Any) -> bool:
    """Whether logs of three or more fingers are meant, or a wheel is among them."""
    if any(isinstance(one, Wheel) for one in (finger if isinstance(finger, (list, tuple)) else [finger])):
        return log is not None
    return isinstance(log, (list, tuple)) and len(log) > 2 and all(_is_log(one) and not _is_row(one) for one in log)


def _is_row(one: Any) -> bool:
    """Of a table that is given row by row."""
    if isinstance(one, Log):
        return False
    if isinstance(one, Mapping):
        return all(np.ndim(value) == 0 for value in one.values())
    return isinstance(one, np.ndarray) and one.ndim == 1


def held(part: Any, logs: Sequence[Any], **options: Any) -> HoldAnswer:
    """The answer to logs of three and more fingers, or of fingers beside wheels, checked. `options`: all of HoldOptions."""
    finger, noise, tolerance, at = (options[name] for name in ("finger", "noise", "tolerance", "at"))
    budget, squeezed, prior = options["budget"], options["squeezed"], options["prior"]
    naming = Naming(options["columns"], options["units"], options["degrees"], options["wrapped"])
    if noise is not None and tolerance is not None:
        raise InputError("tolerance: `noise` already says how far rows are off: leave one out")
    wheels: Sequence[Wheel] = []
    if is_hold([], finger):
        finger, wheels = _apart(finger, logs)
    pins = [(pin_of(log, naming, part.unit), one.radius) for log, one in zip(logs[len(logs) - len(wheels):], wheels)]
    logs = logs[: len(logs) - len(wheels)]
    given = fingers(finger, most=len(logs))
    if not given:
        raise InputError("finger: expected the fingers that rolled, as in finger=Disk(radius), found none")
    if len(given) not in (1, len(logs)):
        raise InputError(f"finger: expected one, or {len(logs)}, one for each log, found {len(given)}")
    read = [_one_roll(log, number, naming, part.unit) for number, log in enumerate(logs, 1)]
    of_each = given * len(logs) if len(given) == 1 else given
    return HoldAnswer((
        part,
        tuple(log._in_unit(part.unit, [one]) for log, one in zip(read, of_each)),
        given,
        noise_given(noise),
        _tolerance(tolerance),
        [] if at is None else [float(one) for one in np.atleast_1d(at)],
        flag(options["mirrored"], "mirrored"),
        None if budget is None else whole(budget, "budget", 1),
        tuple((pin._in_unit(part.unit, [radius]), radius) for pin, radius in pins),
        None if squeezed is None else least(squeezed, "squeezed", 0, "an angle"),
        None if prior is None else place_prior(prior),
        pose_prior(options["heading"], options["pose"]),
        flag(options["robust"], "robust"),
        flag(options["may_overlap"], "may_overlap"),
    ))  # fmt: skip


def _apart(finger: Any, logs: Any) -> Tuple[Any, Sequence[Wheel]]:
    """Fingers with skin, which come first, and wheels."""
    given = list(finger) if isinstance(finger, (list, tuple)) else [finger]
    count = sum(not isinstance(one, Wheel) for one in given)
    if count == 0 or any(isinstance(one, Wheel) for one in given[:count]):
        raise InputError(
            "finger: expected fingers with skin first, then wheels, and logs in the same order, as in "
            f"log=[jaw, pin], finger=[Jaw(), Wheel(0.4)], found {shown(finger)}"
        )
    if not isinstance(logs, (list, tuple)) or len(logs) != len(given):
        raise InputError(
            f"log: expected a list of {len(given)}, one of each finger, of a wheel x and y of its pin, found {shown(logs)}"
        )
    return given[:count], given[count:]


def _one_roll(log: Any, number: int, naming: Naming, unit: str) -> Log:
    rolls = rolls_of(log, naming, unit)
    if len(rolls) != 1:
        raise InputError(f"log: expected one roll of each finger, found {len(rolls)} in log {number}: contact is lost; cut it")
    return rolls[0]


def _tolerance(given: Any) -> Optional[Tuple[float, float]]:
    """A single number is an angle, as of one roll."""
    if given is None:
        return None
    if np.ndim(given) == 0:
        return 0.0, least(given, "tolerance", 0, "an angle")
    if np.ndim(given) != 1:
        raise InputError(f"tolerance: expected an angle, or (length, angle), found {shown(given)}")
    length, angle = numbers(given, 2, "tolerance", "(length, angle)")
    return length, angle
