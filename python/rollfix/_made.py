"""Objects that `__new__` alone made: they have no value, and say so."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any


def no_value(one: Any, name: str) -> AttributeError:
    """For an attribute that is not there: of an object that nobody made one that it should have, or one that none has."""
    kind = type(one)
    if hasattr(kind, name) or name in getattr(kind, "__annotations__", ()):  # a slot; or a property, which needs one
        return AttributeError(f"{kind.__name__}: has no value: it was made by __new__ alone")
    return AttributeError(f"{kind.__name__!r} object has no attribute {name!r}")


class Made:
    """Whatever has its value from the constructor, or from another object."""

    __slots__ = ()

    if not TYPE_CHECKING:  # which would take any attribute for one that is there

        def __getattr__(self, name):
            raise no_value(self, name)
