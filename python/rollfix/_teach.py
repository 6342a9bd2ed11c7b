"""A part without a drawing, from a roll around it."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Tuple

from . import _core
from ._documents import Document
from ._inputs import Finger, NoiseLike, fingers, noise as noise_given, optional_number
from ._logs import Columns, core_log
from ._part import Part


class Taught(Document):
    """A part that was taught by a roll around it: the fields of `rollfix/teach/1`, see docs/json.md.

    `part` is it; `taught` says how: `closing`, `gap`, `turn_gap`, ...; `notes` the same in words.
    """

    __slots__ = ("_part",)

    def __init__(self, part: Part, text: str) -> None:
        super().__init__(text)
        self._part = part

    @property
    def part(self) -> Part:
        """Part: what was rolled around."""
        return self._part

    @property
    def notes(self) -> Tuple[str, ...]:
        """tuple of str: what had to be done."""
        return self._part.notes

    def _repr_svg_(self) -> str:
        return self._part.to_svg()

    def __repr__(self) -> str:
        return f"<Taught: {self.taught['closing']}, {self._part!r}>"

    def __reduce__(self) -> Any:
        return (Taught, (self._part, self._text))


def teach(
    log: Any,
    finger: Optional[Finger] = None,
    *,
    noise: NoiseLike = None,
    bridge: bool = False,
    open: bool = False,
    corner_angle: Optional[float] = None,
    allow_crossing: bool = False,
    unit: str = "",
    columns: Columns = None,
    units: Optional[Mapping[str, str]] = None,
    degrees: bool = False,
) -> Taught:
    """A part without a drawing, from one full roll around it.

    Parameters
    ----------
    log
        As of `read_log`, also for `columns`, `units` and `degrees`.
    finger : Disk, optional
        For logs of u and psi.
    noise : Noise or dict, optional
        None: only what the digits and the rows' distance leave open.
    bridge : bool
        A gap that drift does not explain is bridged by a piece.
    open : bool
        The roll runs along an open curve: nothing is closed.
    corner_angle : float, optional
        Neighbouring rows that turn by at least this make a corner, radians.
    allow_crossing : bool
        Take a course that crosses itself.
    unit : str
        The part's.

    Returns
    -------
    Taught
    """
    core = core_log(log, columns, units, degrees, unit, False, None)
    given = fingers(finger, 1)
    part, text = _core.teach(
        core,
        given[0] if given else None,
        noise_given(noise),
        bool(bridge),
        bool(open),
        optional_number(corner_angle, "corner_angle"),
        bool(allow_crossing),
    )
    return Taught(Part._of(part), text)
