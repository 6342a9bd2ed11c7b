"""What fingers have to do so that they roll as far as is asked."""

from __future__ import annotations

import io
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from . import _core
from ._checks import flag, least, number, numbers, optional_number, path, text, whole
from ._clock import Clock
from ._core import InputError
from ._documents import Document
from ._fingers import FingerLike, fingers
from ._logs import Log, _log
from ._messages import in_a_page, shown

LIMITS = ("speed", "turn", "travel", "rotation")
STAYS = ("middle", "a", "b", "part")


class Plan(Document):
    """A roll that is planned, or why it can't be done: the fields of `rollfix/plan/1`, see docs/json.md.

    `feasible`, `verdict`, `margins` with what is left of each condition, `friction_needed`, `duration`, `length`, ...
    """

    __slots__ = ("_plan", "_asked")

    def __init__(self, asked: Tuple[Any, ...]) -> None:
        part, *rest = asked
        self._plan = _core.plan_roll(part._core, *rest)
        self._asked = asked
        super().__init__(self._plan.document())

    @property
    def log(self) -> Log:
        """Log: what the sensors will say; `part.locate(log=plan.log, ...)` takes it."""
        core = self._plan.log
        return _log(core, {core.name: []}, Clock())

    @property
    def rows(self) -> Dict[str, np.ndarray]:
        """dict of ndarray, (samples,): the columns of the table, see docs/plan.md."""
        table: Any = np.genfromtxt(io.StringIO(self._plan.table(None)), delimiter=",", names=True)
        return {name: table[name] for name in table.dtype.names or ()}

    def to_csv(self, *, finger: Optional[str] = None) -> str:
        """The table as text; `finger`: 'a' or 'b', that one's alone."""
        if finger not in (None, "a", "b"):
            raise InputError(f"finger: expected 'a' or 'b', found {shown(finger)}")
        return self._plan.table(None if finger is None else "ab".index(finger))

    def to_svg(self, *, title: str = "", width: float = 0) -> str:
        """A figure of the part and the fingers at the start and at the end."""
        svg: str = self._figure(title, width).svg()
        return svg

    def save(self, file: Any, *, title: str = "", width: float = 0) -> None:
        """Writes the table, .csv, or that figure, .svg, .png or .pdf."""
        name = path(file, "file")
        if not name.lower().endswith(".csv"):
            self._figure(title, width).save(name, ", a table's in .csv")
            return
        with open(name, "w", encoding="utf-8", newline="\n") as out:
            out.write(self.to_csv())

    def _figure(self, title: str, width: float) -> Any:
        from . import _draw

        return _draw.plan_figure(self._plan, text(title, "title"), least(width, "width", 0, "a number of pixels"))

    def _repr_svg_(self) -> Optional[str]:
        return in_a_page(self.to_svg())

    def __repr__(self) -> str:
        verdict: str = self.verdict
        return f"<Plan: {verdict[6:] if verdict.startswith('plan: ') else verdict}>"

    def __reduce__(self) -> Any:
        return (Plan, (self._asked,))


def _each(value: Any, count: int, name: str, several: bool = True) -> List[Optional[float]]:
    """A number for each finger: one for all, or one of each, of which some may be None."""
    if value is None or np.ndim(value) == 0:
        one = optional_number(value, name)
        return [one] * count if several else [one] + [None] * (count - 1)
    given = list(value)
    if len(given) != count:
        raise InputError(f"{name}: expected one number, or {count}, one for each finger, found {shown(value)}")
    return [optional_number(one, name) for one in given]


def _limits(given: Optional[Mapping[str, float]]) -> Dict[str, float]:
    found = {} if given is None else dict(given)
    for name in found:
        if name not in LIMITS:
            raise InputError(f"limits: expected {', '.join(LIMITS)}, found {shown(name)}")
    return {name: number(value, f"limits[{name!r}]") for name, value in found.items()}


def planned(
    part: Any,
    finger: FingerLike,
    start: Any,
    length: Any,
    friction: Any,
    wheel: bool,
    pose: Optional[Sequence[float]],
    part_rotation: Optional[float],
    stays: str,
    duration: Optional[float],
    limits: Optional[Mapping[str, float]],
    margin: float,
    clearance: float,
    samples: int,
    contact: Any,
    may_overlap: bool,
    mirrored: bool,
) -> Plan:
    given = fingers(finger)
    if not given:
        raise InputError("finger: expected what rolls, Disk(radius), Jaw() or OutlineFinger(part), or two, found None")
    count = 2 if len(given) == 2 or np.ndim(start) > 0 else 1
    if stays not in STAYS:
        raise InputError(f"stays: expected one of {', '.join(STAYS)}, found {shown(stays)}")
    asked = (
        part,
        given,
        flag(wheel, "wheel"),
        _each(start, count, "start", several=False),
        _each(length, count, "length", several=False),
        _each(friction, count, "friction"),
        _each(contact, count, "contact"),
        numbers((0, 0, 0) if pose is None else pose, 3, "pose", "x, y and heading"),
        optional_number(part_rotation, "part_rotation"),
        stays,
        optional_number(duration, "duration"),
        _limits(limits),
        number(margin, "margin"),
        number(clearance, "clearance"),
        whole(samples, "samples", 2),
        flag(may_overlap, "may_overlap"),
        flag(mirrored, "mirrored"),
    )
    return Plan(asked)
