"""What can be said of a question by name, each option once: who takes which, and what it is where nothing is said."""

from __future__ import annotations

import functools
import inspect
from typing import TYPE_CHECKING, Any, Callable, Dict, Mapping, Optional, Sequence, Tuple, TypedDict, TypeVar, Union, cast

from ._columns import Columns, Units
from ._core import InputError
from ._fingers import FingerLike
from ._noise import NoiseLike

if TYPE_CHECKING:
    from typing_extensions import Unpack as Unpack

Method = TypeVar("Method", bound=Callable[..., Any])


class Measured(TypedDict, total=False):
    """Of whatever touches a part."""

    finger: Optional[FingerLike]
    noise: NoiseLike
    mirrored: bool
    budget: Optional[int]


class Lies(TypedDict, total=False):
    """About how the part lies."""

    heading: Optional[Tuple[float, float]]
    pose: Optional[Sequence[float]]


class Read(TypedDict, total=False):
    """How a log is read."""

    columns: Columns
    units: Units
    degrees: bool
    wrapped: Optional[bool]


class TouchOptions(Measured, Lies, total=False):
    """Of touches without rolling."""

    tolerance: Union[float, Tuple[float, float], None]
    clear: Any


class RestOptions(Measured, Lies, Read, total=False):
    """Of several rolls, and touches, of a part at rest."""

    tolerance: Union[float, Tuple[float, float], None]
    robust: bool
    clear: Any


class HoldOptions(Measured, Lies, Read, total=False):
    """Of three and more fingers, and of fingers beside wheels."""

    tolerance: Union[float, Tuple[float, float], None]
    at: Any
    prior: Optional[Tuple[float, float]]
    squeezed: Optional[float]
    robust: bool
    may_overlap: bool


class RowOptions(Measured, total=False):
    """Of many rolls, all of them readings."""

    tolerance: Optional[float]
    direction: str
    may_overlap: bool
    rounding: Optional[Tuple[float, float]]


class Rolling(Lies, Read, total=False):
    """Of a roll on a part, or on any of many, also while it goes on."""

    finger: Optional[FingerLike]
    mirrored: bool
    direction: str
    robust: bool
    may_overlap: bool


class LiveOptions(Rolling, total=False):
    """Of a roll that goes on."""

    prior: Optional[Tuple[float, float]]
    squeezed: Optional[float]


class Rolled(Rolling, total=False):
    """Of a roll that is over."""

    noise: NoiseLike
    budget: Optional[int]
    at: Any


class LogOptions(Rolled, total=False):
    """Of rolls with logs."""

    roll: Optional[int]
    tolerance: Optional[float]
    prior: Optional[Tuple[float, float]]


class RollOptions(LogOptions, total=False):
    """Of one roll, as a log or as readings."""

    facing: Optional[float]
    rounding: Optional[Tuple[float, float]]


class PartsOptions(Rolled, total=False):
    """Of a roll on any of many parts, where it can't be said where it started; or of touches, or of several rolls."""

    roll: Union[int, str, None]
    tolerance: Any
    facing: Optional[float]
    rounding: Optional[Tuple[float, float]]
    clear: Any


class AdvisedOptions(RollOptions, total=False):
    """Of a roll that goes on as is advised."""

    squeezed: Optional[float]


class FirstOptions(TypedDict, total=False):
    """Of the first roll, before any contact."""

    finger: Optional[FingerLike]
    noise: NoiseLike
    may_overlap: bool


class AnyOptions(Measured, Lies, Read, total=False):
    """Of all that `locate` takes."""

    tolerance: Any
    facing: Optional[float]
    at: Any
    prior: Optional[Tuple[float, float]]
    direction: str
    robust: bool
    may_overlap: bool
    roll: Union[int, str, None]
    rounding: Optional[Tuple[float, float]]
    clear: Any
    squeezed: Optional[float]


# Every option, in the order in which they are shown.
DEFAULTS: Dict[str, Any] = {
    "finger": None, "noise": None, "tolerance": None, "facing": None, "at": None, "prior": None, "heading": None, "pose": None,
    "mirrored": False, "direction": "ccw", "robust": False, "may_overlap": False, "columns": None, "units": None,
    "degrees": False, "wrapped": None, "roll": None, "rounding": None, "clear": None, "squeezed": None, "budget": None,
}  # fmt: skip


@functools.lru_cache(maxsize=None)
def names_of(options: Any) -> Tuple[str, ...]:
    """Of one of the classes above."""
    return tuple(name for name in DEFAULTS if name in options.__annotations__)


def filled(given: Mapping[str, Any], options: Any) -> Dict[str, Any]:
    """All options, with those that are not given. Throws TypeError: one that is not known."""
    everything = dict(_defaults_of(options))
    for name, value in given.items():
        if name not in everything:
            raise TypeError(f"got an unexpected keyword argument {name!r}")
        everything[name] = value
    return everything


@functools.lru_cache(maxsize=None)
def _defaults_of(options: Any) -> Mapping[str, Any]:
    return {name: DEFAULTS[name] for name in names_of(options)}


def require_only(options: Any, given: Mapping[str, Any], why: str) -> None:
    """Throws InputError: something that `options` does not take is given all the same."""
    taken = names_of(options)
    for name, value in given.items():
        if name not in taken and is_said(name, value):
            raise InputError(f"{name}: {why}: leave it out")


def is_said(name: str, value: Any) -> bool:
    default = DEFAULTS.get(name)
    if default is None:
        return value is not None
    return bool(value) if default is False else bool(value != default)


def keywords(options: Any) -> Callable[[Method], Method]:
    """Shows a method's options to `help` and to whoever completes names, and refuses others."""

    def shown(method: Method) -> Method:
        @functools.wraps(method)
        def known(self: Any, *args: Any, **given: Any) -> Any:
            if not given.keys() <= names:
                unknown = next(name for name in given if name not in names)
                raise TypeError(f"{method.__name__}() got an unexpected keyword argument {unknown!r}")
            return method(self, *args, **given)

        signature = inspect.signature(method)
        stated = [one for one in signature.parameters.values() if one.kind is not one.VAR_KEYWORD]
        more = [
            inspect.Parameter(
                name,
                inspect.Parameter.KEYWORD_ONLY,
                default=DEFAULTS[name],
                annotation=getattr(options.__annotations__[name], "__forward_arg__", None),
            )
            for name in names_of(options)
        ]
        known.__signature__ = signature.replace(parameters=stated + more)  # type: ignore[attr-defined]
        names = frozenset(known.__signature__.parameters)  # type: ignore[attr-defined]
        return cast(Method, known)

    return shown
