"""A part without a drawing, from a roll around it."""

from __future__ import annotations

from typing import Any, Optional, Tuple

from . import _core
from ._checks import corner_angle as corner_angle_given, flag, unit_of_length
from ._columns import Columns, Naming, Units
from ._core import InputError
from ._documents import Document
from ._fingers import Finger, fingers
from ._log_reading import log_of
from ._messages import in_a_page
from ._noise import NoiseLike, noise as noise_given
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
        return in_a_page(self._part.to_svg())

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
    units: Units = None,
    degrees: bool = False,
    wrapped: Optional[bool] = None,
) -> Taught:
    """A part without a drawing, from one full roll around it.

    Parameters
    ----------
    log
        As of `read_log`, also for `columns`, `units`, `degrees` and `wrapped`.
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
    naming, part_unit, given = Naming(columns, units, degrees, wrapped), unit_of_length(unit), fingers(finger, 1)
    options = (
        noise_given(noise),
        flag(bridge, "bridge"),
        flag(open, "open"),
        corner_angle_given(corner_angle),
        flag(allow_crossing, "allow_crossing"),
    )
    read = log_of(log, naming, part_unit, None)
    if read.kind == "contact" and not given:
        raise InputError(
            f"finger: {read.name} has u and psi, and u says where on the finger the contact is: expected the finger's shape, "
            "as in finger=Disk(10), its radius in the part's unit"
        )
    read = read._in_unit(part_unit, given)
    try:
        part, document = _core.teach(read._core, given[0] if given else None, *options)
    except InputError as error:
        raise InputError(read._said(str(error))) from None
    return Taught(Part._of(part), document)
