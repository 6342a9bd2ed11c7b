"""What a catalog is built of."""

from __future__ import annotations

import os
from typing import Any, List, Mapping, Optional, Tuple

import numpy as np

from . import _core
from ._checks import number, path as path_given
from ._core import InputError
from ._messages import shown
from ._part import Part
from ._tables import is_frame

Source = Tuple[str, str, float, Optional[_core.Part]]  # what to load, the part's name, how many there are, the part itself


def sources_from(sources: Any) -> List[Source]:
    """Every outline of them."""
    if isinstance(sources, (str, os.PathLike)):
        return _core.catalog_sources(path_given(sources, "sources"))
    if isinstance(sources, Part):
        sources = [sources]
    if not hasattr(sources, "__iter__"):
        raise InputError(f"sources: expected a folder, a list of outlines, or paths, found {shown(sources)}")
    several = list(sources.items()) if isinstance(sources, Mapping) else [("", one) for one in sources]
    taken: List[Source] = []
    for k, (name, one) in enumerate(several):
        count = 1.0
        if isinstance(one, (tuple, list)) and len(one) == 2 and _is_outline(one[0]):
            one, count = one[0], _count(one[1])
        elif isinstance(one, (tuple, list)) and len(one) == 2 and isinstance(one[0], (str, os.PathLike)):
            one, count = one[0], _count(one[1])
        if isinstance(one, (str, os.PathLike)):
            taken += [
                (argument, own, count if count != 1 else its, part)
                for argument, own, its, part in _core.catalog_sources(path_given(one, "sources"))
            ]
        elif _is_outline(one):
            part = one if isinstance(one, Part) else Part.from_points(one, name=str(name) or f"points {k}")
            called = str(name) or part.name
            taken.append((called, called, count, part._core))
        else:
            raise InputError(
                f"sources: expected a path, 'gallery:...', a Part, an array of points, or one with its count, found {shown(one)}"
            )
    if not taken:
        raise InputError("sources: expected outlines, found none")
    names = [one[1] for one in taken if one[3] is not None]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"sources: two parts are called {twice!r}: give a mapping, {{name: part}}, with names that differ")
    return taken


def _is_outline(one: Any) -> bool:
    return isinstance(one, Part) or is_frame(one) or (isinstance(one, np.ndarray) and one.ndim == 2)


def _count(given: Any) -> float:
    count = number(given, "sources")
    if not count > 0:
        raise InputError(f"sources: expected a count above 0, found {count!r}")
    return count
