"""How errors and warnings are told: in one line, at the user's own line, with what may have been meant."""

from __future__ import annotations

import difflib
import os
import re
import sys
import warnings
from typing import Any, Iterable

from ._core import InputError


def _told(error: InputError) -> str:
    return " ".join(line.strip() for line in ValueError.__str__(error).splitlines())


# A path or a value may hold line ends, whoever told of it; C++ makes the type, so it can't be a method of a class here.
setattr(InputError, "__str__", _told)


class RollfixWarning(UserWarning):
    """Something was chosen for the user, such as one of a log's several rolls. The message says how to choose."""


def warn(message: str) -> None:
    """A RollfixWarning at the line of the user's that led to it."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == os.path.dirname(__file__):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, RollfixWarning, stacklevel=level)


def shown(value: Any) -> str:
    """A value as messages show it: in one line that is not too long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."


def did_you_mean(name: Any, known: Iterable[str]) -> str:
    near = difflib.get_close_matches(str(name), list(known), 1)
    return f"did you mean {near[0]!r}? " if near else ""


def in_a_page(svg: str) -> str:
    """A figure as a page of HTML can hold it: without the declaration that a file of its own begins with."""
    return re.sub(r"^\s*<\?xml[^>]*\?>\s*", "", svg)
