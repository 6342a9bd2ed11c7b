"""What a log calls its columns, and in what they are."""

from __future__ import annotations

from typing import Any, Collection, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from . import _core
from ._checks import flag
from ._core import InputError
from ._messages import did_you_mean, shown

COLUMNS = ("time", "u", "psi", "x", "y", "contact", "length", "turn", "distance", "dturn")
FINGERS = ("_a", "_b")
Source = Tuple[str, str, str]  # column, name in the log, unit
Name = Union[str, int, Tuple[Any, ...]]
Columns = Union[Mapping[str, Name], Sequence[str], str, None]
Units = Optional[Mapping[str, str]]


class Naming:
    """What `columns`, `units`, `degrees` and `wrapped` say, checked."""

    __slots__ = ("names", "units", "of_array", "angles", "wrapped")

    def __init__(
        self, columns: Columns = None, units: Units = None, degrees: bool = False, wrapped: Optional[bool] = None
    ) -> None:
        self.names: Dict[str, Any] = {}  # what the log calls a column: a name, or (name, unit)
        self.of_array: Optional[Tuple[str, ...]] = None  # the columns of an array in order
        self.units = _units(units)
        self.angles = "deg" if flag(degrees, "degrees") else ""
        self.wrapped = None if wrapped is None else flag(wrapped, "wrapped")
        if isinstance(columns, str):
            self.names = {column: (name, unit) for column, name, unit in _core.parse_columns(columns)}
        elif isinstance(columns, Mapping):
            self.names = dict(columns)
        elif isinstance(columns, (list, tuple)) and all(isinstance(one, str) for one in columns):
            self.of_array = tuple(columns)
        elif columns is not None:
            raise InputError(
                "columns: expected a mapping such as {'u': 'joint_4'}, or of an array the names of its columns, "
                f"found {shown(columns)}"
            )
        for column in self.names:
            _require_known(column, "columns")

    @property
    def says_nothing(self) -> bool:
        return self.wrapped is None and not (self.names or self.units or self.of_array or self.angles)

    def sources(self, keys: Optional[Collection[Any]] = None) -> List[Source]:
        """For C++. `keys`: what a table calls its columns; a file's are text."""
        found: Dict[str, Tuple[str, str]] = {}
        for column, given in self.names.items():
            own, unit = _name_and_unit(column, given, keys)
            found[column] = (label(own), unit)
        for column, unit in self.units.items():
            name, said = found.get(column, (column, ""))
            if said not in ("", unit):
                raise InputError(f"units: {column} is in {unit!r}, but `columns` says {said!r}: leave one of them out")
            found[column] = (name, unit)
        return [(column, name, unit) for column, (name, unit) in found.items()]

    def declared(self) -> List[Source]:
        """For C++, of tables that are still to come."""
        result = Naming()
        result.units = self.units
        result.names = {column: _text_and_unit(given) for column, given in self.names.items()}
        return result.sources()

    def of_finger(self, own: str) -> "Naming":
        """What is said of both fingers, and of this one: '_a' or '_b'."""
        other = FINGERS[1 - FINGERS.index(own)]
        result = Naming()
        result.angles, result.of_array, result.wrapped = self.angles, self.of_array, self.wrapped
        for said, mine in ((self.names, result.names), (self.units, result.units)):
            for column, value in said.items():
                if not column.endswith(other):
                    mine[column[: -len(own)] if column.endswith(own) else column] = value
        return result

    def require_table(self, name: str) -> None:
        if self.of_array is not None:
            raise InputError(
                f"columns: the columns of {name} have names, expected which is which, as in columns={{'u': 'joint_4'}}; "
                "a list is for an array, which has none"
            )


def label(name: Name) -> str:
    """A column's name as text that is no number, which C++ would take for a row of them."""
    if isinstance(name, tuple):
        return " ".join(str(one) for one in name).strip()
    return name.strip() if isinstance(name, str) else f"column {name}"


def _text_and_unit(given: Any) -> Any:
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], str):
        return (label(given[0]), given[1])
    return label(given) if _is_name(given) else given


def _name_and_unit(column: str, given: Any, keys: Optional[Collection[Any]]) -> Tuple[Name, str]:
    if keys is not None and _is_name(given) and given in keys:
        return given, ""
    if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], str) and _is_name(given[0]):
        name, unit = given
    else:
        name, unit = given, ""
    if not _is_name(name) or isinstance(name, tuple) and (keys is None or name not in keys):
        raise InputError(f"columns: {column!r} is {shown(given)}, expected a name or (name, unit)")
    if keys is None and not isinstance(name, str):
        raise InputError(f"columns: {column!r} is {shown(given)}, but the columns of a file have names: expected one")
    return name, unit


def _is_name(value: Any) -> bool:
    try:
        hash(value)
    except TypeError:
        return False
    return isinstance(value, (str, tuple)) or (hasattr(value, "__index__") and not isinstance(value, bool))


def _units(units: Units) -> Dict[str, str]:
    if units is None:
        return {}
    if not isinstance(units, Mapping):
        raise InputError(
            f"units: expected a mapping such as {{'psi': 'deg', 'time': 'ms'}}, found {shown(units)}; "
            "degrees=True is for all angles"
        )
    for column, unit in units.items():
        _require_known(column, "units")
        if not isinstance(unit, str):
            raise InputError(f"units: {column!r} is {shown(unit)}, expected a unit such as 'deg', 'mm' or 'ms'")
    return dict(units)


def _require_known(column: Any, argument: str) -> None:
    plain = column[:-2] if isinstance(column, str) and column[-2:] in FINGERS else column
    if plain not in COLUMNS:
        raise InputError(
            f"{argument}: there is no column {column!r}; {did_you_mean(column, COLUMNS)}Known are {', '.join(COLUMNS)}"
        )
