"""How parts are made: of files, points, functions, and by name."""

from __future__ import annotations

import re
from typing import Any, Callable, Dict, Mapping, Optional, Sequence

import numpy as np

from . import _core
from ._checks import (
    array,
    by_name,
    corner_angle as corner_angle_given,
    decimal_comma,
    finite,
    flag,
    names_in,
    optional_number,
    path,
    text,
    unit_of_length,
    whole,
)
from ._core import InputError
from ._messages import shown
from ._words import in_python


def of_file(
    source: Any,
    *,
    unit: str = "",
    open: bool = False,
    smooth: Optional[float] = None,
    corner_angle: Optional[float] = None,
    loop: Optional[int] = None,
    layer: str = "",
    gap: Optional[float] = None,
    outer: bool = False,
    decimal: str = ".",
    allow_crossing: bool = False,
) -> _core.Part:
    options: Dict[str, Any] = {
        "unit": unit_of_length(unit),
        "open": flag(open, "open"),
        "smooth": optional_number(smooth, "smooth"),
        "corner_angle": corner_angle_given(corner_angle),
        "loop": None if loop is None else whole(loop, "loop", 1),
        "layer": text(layer, "layer"),
        "gap": optional_number(gap, "gap"),
        "outer": flag(outer, "outer"),
        "decimal_comma": decimal_comma(decimal),
        "allow_crossing": flag(allow_crossing, "allow_crossing"),
    }
    hint = _points_hint(source)
    if hint:
        raise InputError(f"source: expected a path, found {hint}")
    try:
        return _core.load_part(path(source, "source"), options)
    except InputError as error:
        raise InputError(in_python(str(error))) from None


def _points_hint(source: Any) -> str:
    """Of what is no path and holds an outline all the same: how a part is made of it."""
    if hasattr(source, "exterior") and hasattr(source.exterior, "coords"):
        return "a polygon: Part.from_points(polygon.exterior.coords), a hole Part.from_points(polygon.interiors[0].coords)"
    if hasattr(source, "modelspace") and hasattr(source, "saveas"):
        return "a drawing in memory: write it, drawing.saveas('part.dxf'), and give Part('part.dxf')"
    is_list = isinstance(source, (list, tuple)) and not any(isinstance(one, str) for one in source)
    if is_list or isinstance(source, (np.ndarray, Mapping)) or names_in(source):
        return "points: Part.from_points(xy) makes a part of them"
    return ""


def of_points(
    xy: Any,
    closed: bool,
    name: str,
    unit: str,
    smooth: Optional[float],
    corner_angle: Optional[float],
    allow_crossing: bool,
) -> _core.Part:
    points = array(by_name(xy, "xy", ("x", "y"), ("X", "Y")), "xy")
    if points.ndim != 2 or points.shape[1] != 2:
        raise InputError(f"xy: expected points, an array of shape (n, 2), found shape {np.shape(xy)}")
    options: Dict[str, Any] = {
        "unit": unit_of_length(unit),
        "open": not flag(closed, "closed"),
        "smooth": optional_number(smooth, "smooth"),
        "corner_angle": corner_angle_given(corner_angle),
        "allow_crossing": flag(allow_crossing, "allow_crossing"),
    }
    called = text(name, "name")
    try:
        return _core.part_from_points(finite(points, "xy"), called, options)
    except InputError as error:
        raise InputError(in_python(_in_points(str(error), called))) from None


def _in_points(message: str, name: str) -> str:
    """Point k of the array, from 0, is line k + 1 of the text that C++ reads."""
    message = re.sub(r"\blines (\d+) and (\d+) hold", lambda f: f"rows {int(f[1]) - 1} and {int(f[2]) - 1} hold", message)
    return re.sub(rf"^{re.escape(name)}:(\d+):", lambda found: f"{name}: row {int(found[1]) - 1}:", message)


def of_curve(
    f: Callable[[float], Any],
    df: Callable[[float], Any],
    ddf: Callable[[float], Any],
    domain: Sequence[float],
    closed: bool,
    name: str,
    unit: str,
    allow_crossing: bool,
) -> _core.Part:
    from ._curves import pieces_of

    is_closed, is_known = flag(closed, "closed"), unit_of_length(unit)
    pieces = pieces_of(f, df, ddf, domain)
    size = float(max(np.ptp(np.vstack(pieces), axis=0)))
    if is_closed:
        gap = float(np.hypot(*(pieces[-1][-1] - pieces[0][0])))
        if gap > 1e-9 * size:
            raise InputError(f"f: ends {gap:.3g} from where it starts; give closed=False for a curve with two ends")
        pieces[-1][-1] = pieces[0][0]
    crossing = flag(allow_crossing, "allow_crossing")
    return _core.part_from_pieces(pieces, text(name, "name"), is_closed, is_known, crossing, 0.0)


def of_gallery(shape: str, parameters: Mapping[str, Any]) -> _core.Part:
    if not isinstance(shape, str):
        raise InputError(f"shape: expected a name, found {shown(shape)}")
    name = shape if shape.startswith("gallery:") else "gallery:" + shape
    given = "".join(f",{key}={_written(value)}" for key, value in parameters.items())
    return of_file(name + given)


def _written(value: Any) -> str:
    return repr(float(value)) if isinstance(value, np.floating) else str(value)


def gallery_shapes() -> Dict[str, Dict[str, Any]]:
    """The shapes of `Part.gallery`: by name the `formula`, and the `parameters` with default, meaning and values."""
    return {
        name: {
            "formula": formula,
            "parameters": {
                key: {"default": default, "meaning": meaning, "values": values}
                for key, (default, meaning, values) in parameters.items()
            },
        }
        for name, formula, parameters in _core.gallery_shapes()
    }
