"""Parts, and what is asked of them."""

from __future__ import annotations

import os
from typing import Any, Callable, Optional, Sequence, Union

from . import _core, _making
from ._checks import least, path, text
from ._core import InputError
from ._documents import Inspection
from ._fingers import Finger, fingers
from ._messages import in_a_page, warn
from ._reach import Reach
from ._rolled_on import RolledOn
from ._shape import Shape
from ._words import in_python


class Part(RolledOn):
    """An outline with everything that is computed once per shape. It can't be changed, and any number of threads can ask.

    A closed outline is stored with the material on its left: a clockwise one is reversed (`reversed` says so), keeping its
    first point, s = 0.

    Parameters
    ----------
    source : path
        A file, by its ending: .csv, .dat or .txt points, .dxf, .svg, .json (a shape, curves or a saved part); or
        'gallery:NAME,key=value,...'.
    unit : str
        That all lengths are to be in: 'mm', 'in', ...; what the file states is converted.
    open : bool
        A curve with two ends.
    smooth : float, optional
        Points of a scan, to be met within this length and not exactly.
    corner_angle : float, optional
        Of points: neighbouring chords that turn by at least this make a corner, radians; default 59 degrees.
    loop : int, optional
        Of a drawing, which loop, counted from 1 by falling area.
    layer : str
        Of a DXF: only this one.
    gap : float, optional
        Of a drawing: ends this close together meet.
    outer : bool
        Of a drawing: where more than two ends meet, take the curves around the outside.
    decimal : '.' or ','
        What numbers in a file of points have for a decimal point; between semicolons a comma is seen.
    allow_crossing : bool
        Take an outline that crosses itself.

    Raises
    ------
    InputError
        What is wrong with the file or the outline, and where.
    """

    __slots__ = ()

    def __init__(
        self,
        source: Union[str, "os.PathLike[str]"],
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
    ) -> None:
        self._core = _told(_making.of_file(
            source,
            unit=unit,
            open=open,
            smooth=smooth,
            corner_angle=corner_angle,
            loop=loop,
            layer=layer,
            gap=gap,
            outer=outer,
            decimal=decimal,
            allow_crossing=allow_crossing,
        ))

    @classmethod
    def _of(cls, core: _core.Part) -> "Part":
        part = cls.__new__(cls)
        part._core = core
        return part

    @classmethod
    def from_points(
        cls,
        xy: Any,
        closed: bool = True,
        *,
        name: str = "points",
        unit: str = "",
        smooth: Optional[float] = None,
        corner_angle: Optional[float] = None,
        allow_crossing: bool = False,
    ) -> "Part":
        """The spline through points: C2 and periodic, with corners where chords turn by `corner_angle`.

        Parameters
        ----------
        xy : array_like, (n, 2)
            Or a table with columns x and y. In order along the boundary; a closed one's first point need not come again. At least 3, of an open one 2.
        closed : bool
            False: a curve with two ends.
        name, unit, smooth, corner_angle, allow_crossing
            As of `Part`.
        """
        return cls._of(_told(_making.of_points(xy, closed, name, unit, smooth, corner_angle, allow_crossing)))

    @classmethod
    def from_curve(
        cls,
        f: Callable[[float], Any],
        df: Callable[[float], Any],
        ddf: Callable[[float], Any],
        domain: Sequence[float],
        *,
        closed: bool = True,
        name: str = "curve",
        unit: str = "",
        allow_crossing: bool = False,
    ) -> "Part":
        """A part from a parametric curve.

        The functions are called now and never again: pieces of polynomials meet `df` to 1e-13 of its size, and so the
        part can be pickled, saved and asked from any thread.

        Parameters
        ----------
        f, df, ddf : callable
            From the parameter, a float, to x and y, and their first and second derivatives by it. `df` is nowhere 0.
        domain : (first, ..., last)
            The parameter's range. Inner values are where the curve has corners.
        closed : bool
            f(last) is f(first).
        name, unit, allow_crossing
            As of `Part`.

        Raises
        ------
        InputError
            `df` is not the derivative of `f`, or `ddf` that of `df`; a curve that is not smooth; ends that do not meet.
        """
        return cls._of(_making.of_curve(f, df, ddf, domain, closed, name, unit, allow_crossing))

    @classmethod
    def gallery(cls, shape: str, **parameters: Any) -> "Part":
        """A named shape: 'circle', 'ellipse', 'cam', 'naca', 'spline', ...; `rollfix.gallery_shapes()` lists them.

        Parameters
        ----------
        shape : str
            Its name, with or without 'gallery:'.
        **parameters
            The shape's: gallery("ellipse", a=2, b=1).
        """
        return cls._of(_making.of_gallery(shape, parameters))

    # --- what it is, as a whole ---

    def inspect(self, finger: Optional[Finger] = None) -> Inspection:
        """What it is, how ambiguous rolls on it are, and where a finger can touch it: `rollfix inspect --json`."""
        given = fingers(finger, 1)
        return Inspection(_core.inspect(self._core, given[0] if given else None))

    def reach(self, finger: Finger) -> Reach:
        """Where a disk or a jaw can touch without entering the part anywhere."""
        given = fingers(finger, 1)
        if not given:
            raise InputError("finger: expected Disk(radius) or Jaw(), found None")
        return Reach(self._core, given[0])

    # --- as a file, as a figure, as a value ---

    def save(self, file: Any) -> None:
        """Writes it: .json keeps its name and all that was computed, and answers with the same bits; .svg, .png, .pdf are a figure."""
        name = path(file, "file")
        if name.lower().endswith(".json"):
            self._core.save(name)
        else:
            self._figure(None).save(name, ", the part's in .json")

    def to_svg(self, *, finger: Optional[Finger] = None, title: str = "", width: float = 640) -> str:
        """The figure of `rollfix inspect -o`; with a finger also where it can't touch."""
        svg: str = self._figure(finger, title, width).svg()
        return svg

    def _figure(self, finger: Optional[Finger], title: str = "", width: float = 640) -> Any:
        from . import _draw

        reach = None if finger is None else self.reach(finger)._core
        wide = least(width, "width", 0, "a number of pixels")
        return _draw.part_figure(self._core, reach, text(title, "title"), wide)

    def plot(self, ax: Any = None, **style: Any) -> Any:
        """Draws the outline on matplotlib axes, and returns them; `style` as of `plot`, color, linewidth, label, ..."""
        from ._plots import plot_part

        return plot_part(self, ax, style)

    def _repr_svg_(self) -> str:
        return in_a_page(self.to_svg())

    def close(self) -> None:
        """Lets go of what was computed. Asking afterwards is an InputError; a thread that is at work ends its work."""
        self._core.close()

    def __enter__(self) -> "Part":
        return self

    def __exit__(self, *error: Any) -> None:
        self.close()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Part) and (self._core is other._core or self._core.is_same(other._core))

    def __hash__(self) -> int:
        return hash((self.name, self.perimeter))

    def __repr__(self) -> str:
        if not self._core.is_open_for_use:
            return "<Part: was closed>"
        facts = [
            f"perimeter {self.perimeter:.6f}{' ' + self.unit if self.unit else ''}",
            "closed" if self.closed else "open",
            *(["given clockwise"] if self.reversed else []),
            f"{len(self.inflections)} inflections",
            f"{len(self.vertices)} vertices",
            f"{len(self.corners)} corners",
        ]
        return f"<Part {self.name!r}: {', '.join(facts)}>"

    def __reduce__(self) -> Any:
        return (_part, (self._core,))


Shape._part_of = Part._of


def _part(core: _core.Part) -> Part:
    return Part._of(core)


def _told(core: _core.Part) -> _core.Part:
    """What makes everything that is asked of it slow is worth more than a line in `notes`."""
    for note in core.notes:
        if "`smooth`" in note:
            warn(in_python(note))
    return core
