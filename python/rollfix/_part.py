"""Parts, and what is asked of them."""

from __future__ import annotations

import functools
import os
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, TypeVar, Union, cast

import numpy as np

from . import _core, _making
from ._answer import Answer
from ._checks import clockwise, least, path, text, travel as travel_given
from ._columns import Columns, Units
from ._core import InputError
from ._documents import Advice, Inspection
from ._fingers import Finger, FingerLike, fingers
from ._many import ManyAnswers, Result, locate_logs, locate_many
from ._messages import in_a_page
from ._noise import Noise, NoiseLike
from ._logs import Roll
from ._question import Question, solved
from ._reach import Reach
from ._shape import Shape
from ._simulate import simulated
from ._watch import Watch

Method = TypeVar("Method", bound=Callable[..., Answer])


def _quick(locate: Method) -> Method:
    """One reading of one finger and nothing else, the job of tight loops, takes the shortest way to C++."""

    @functools.wraps(locate)
    def quick(self: "Part", readings: Any = None, turn: Any = None, **options: Any) -> Answer:
        if not options and isinstance(readings, float) and isinstance(turn, float):
            return Answer._of(_core.locate_one(self._core, readings, turn))
        return locate(self, readings, turn, **options)

    return cast(Method, quick)


class Part(Shape):
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
        allow_crossing: bool = False,
    ) -> None:
        self._core = _making.of_file(
            source,
            unit=unit,
            open=open,
            smooth=smooth,
            corner_angle=corner_angle,
            loop=loop,
            layer=layer,
            gap=gap,
            allow_crossing=allow_crossing,
        )

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
        return cls._of(_making.of_points(xy, closed, name, unit, smooth, corner_angle, allow_crossing))

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

    # --- where is the finger ---

    @_quick
    def locate(
        self,
        readings: Any = None,
        turn: Any = None,
        *,
        log: Any = None,
        finger: Optional[FingerLike] = None,
        noise: NoiseLike = None,
        tolerance: Optional[float] = None,
        facing: Optional[float] = None,
        at: Any = None,
        prior: Optional[Tuple[float, float]] = None,
        heading: Optional[Tuple[float, float]] = None,
        pose: Optional[Sequence[float]] = None,
        mirrored: bool = False,
        direction: str = "ccw",
        robust: bool = False,
        columns: Columns = None,
        units: Units = None,
        degrees: bool = False,
        wrapped: Optional[bool] = None,
        roll: Optional[int] = None,
        rounding: Optional[Tuple[float, float]] = None,
        budget: Optional[int] = None,
    ) -> Answer:
        """Every place where the roll can have started. There is no other: see `Answer.status`.

        `locate(length, turn)`, `locate(readings)`, or `locate(log=..., finger=..., noise=...)`. One finger on a part at
        rest: eqs. (4) and (5). Two on a part that is free to move: eqs. (8) and (9).

        Parameters
        ----------
        readings : float with `turn`, or array_like, (2,), (3,), (n, 2) or (n, 3)
            (L, theta) of one finger: arc length travelled, along the stored outline, and turn of the tangent, radians. Of
            two (La, Lb, theta), theta being finger a's turn less finger b's. Each from the first contact; taken as exact.
        turn : float, optional
            With one length.
        log : path, DataFrame, mapping of arrays, ndarray, Log, Roll, or a pair of them
            Instead of readings: see `rollfix.read_log`, also for `columns`, `units`, `degrees`, `wrapped` and `roll`.
        finger : Disk, Jaw, OutlineFinger, or two of them
            For logs of u and psi; and what it can't reach is dropped. One serves both of two.
        noise : Noise or dict, optional
            All rows are weighed, and placements have probabilities. None: exact but for rounded digits.
        tolerance : float, optional
            How far the turn may be off, radians. Default: from the noise, or the log's digits; of readings 1e-9.
        facing : float, optional
            Of readings of two fingers: how far finger a's contact normal is turned from finger b's at the first contacts,
            radians. Then one reading suffices. A log has it itself.
        at : array_like, optional
            Instants of a log to search with, seconds. Default: its last row, of two fingers the middle one as well.
        prior : (s, sd), optional
            With noise: about where the finger (of two finger a) started.
        heading : (angle, sd), optional
            With noise and a log of u and psi: about how the part is turned in the world, radians.
        pose : (x, y, heading, sd, sd_heading), optional
            The same with where it lies.
        mirrored : bool
            The part lies face down: what is felt is the outline's mirror image.
        direction : 'ccw', 'cw' or 'either'
            Which way round the part lengths count as positive; either: both are tried, and each placement's `direction`
            says which. Of u and psi it is not asked.
        robust : bool
            With noise: stray rows don't count.
        rounding : (length, turn), optional
            Of readings: how far their digits may be off, half a unit of the last one each; widens the tolerance as that
            asks for.
        budget : int, optional
            Intervals, of two fingers boxes, to look at before giving up; default 1000000.

        Returns
        -------
        Answer

        Raises
        ------
        InputError
            What can't be meant; the message names the argument.
        """
        if (readings is None) == (log is None):
            found = "neither" if log is None else "both: they can't be of the same roll"
            raise InputError(f"readings: expected readings or `log`, found {found}")
        question = Question(
            self._core,
            finger=finger,
            noise=noise,
            tolerance=tolerance,
            facing=facing,
            at=at,
            prior=prior,
            heading=heading,
            pose=pose,
            mirrored=mirrored,
            direction=direction,
            robust=robust,
            columns=columns,
            units=units,
            degrees=degrees,
            wrapped=wrapped,
            roll=roll,
            rounding=rounding,
            budget=budget,
        )
        if log is None:
            return solved(question.of_readings(readings, turn))
        return solved(*question.of_log(log, turn))

    def advise(
        self,
        readings: Any = None,
        turn: Any = None,
        *,
        travel: Any = None,
        log: Any = None,
        finger: Optional[FingerLike] = None,
        noise: NoiseLike = None,
        tolerance: Optional[float] = None,
        facing: Optional[float] = None,
        at: Any = None,
        prior: Optional[Tuple[float, float]] = None,
        heading: Optional[Tuple[float, float]] = None,
        pose: Optional[Sequence[float]] = None,
        mirrored: bool = False,
        direction: str = "ccw",
        robust: bool = False,
        columns: Columns = None,
        units: Units = None,
        degrees: bool = False,
        wrapped: Optional[bool] = None,
        roll: Optional[int] = None,
        rounding: Optional[Tuple[float, float]] = None,
        budget: Optional[int] = None,
    ) -> Advice:
        """The next roll: which one tells the remaining placements apart. Of one finger.

        Parameters
        ----------
        readings, turn, log, ...
            The roll so far, as of `locate`.
        travel : float or (float, float), optional
            How far the finger can roll on: a length, or (back, forward) with back <= 0. Default: one lap.

        Returns
        -------
        Advice
        """
        range_given = travel_given(travel)
        answer = self.locate(
            readings,
            turn,
            log=log,
            finger=finger,
            noise=noise,
            tolerance=tolerance,
            facing=facing,
            at=at,
            prior=prior,
            heading=heading,
            pose=pose,
            mirrored=mirrored,
            direction=direction,
            robust=robust,
            columns=columns,
            units=units,
            degrees=degrees,
            wrapped=wrapped,
            roll=roll,
            rounding=rounding,
            budget=budget,
        )
        return Advice(answer._core, range_given)

    def locate_many(
        self,
        readings: Any,
        *,
        finger: Optional[FingerLike] = None,
        noise: NoiseLike = None,
        tolerance: Optional[float] = None,
        facing: Any = None,
        mirrored: bool = False,
        direction: str = "ccw",
        rounding: Optional[Tuple[float, float]] = None,
        budget: Optional[int] = None,
        threads: int = 0,
        progress: Optional[bool] = None,
    ) -> ManyAnswers:
        """The answers to many problems, on all cores, as arrays. Ctrl-C stops it; an error stays with its problem.

        Parameters
        ----------
        readings : array_like, (n, 2) or (n, 3): a problem of one reading in each row; (n, m, 2) or (n, m, 3): of m each
            As of `locate`. Or a table with columns length and turn, of two fingers length_a, length_b and turn.
        finger, noise, tolerance, mirrored, direction, rounding, budget
            As of `locate`, for all problems.
        facing : float or array_like, (n,), optional
            Of two fingers.
        threads : int
            0: as many as there are processors. The answers have the same bits with any number.
        progress : bool, optional
            A bar, by tqdm. Default: where tqdm is installed, stderr is a terminal, and it lasts more than a second.

        Returns
        -------
        ManyAnswers
        """
        clockwise(direction)  # not both ways at once
        question = Question(
            self._core,
            finger=finger,
            noise=noise,
            tolerance=tolerance,
            mirrored=mirrored,
            direction=direction,
            rounding=rounding,
            budget=budget,
        )
        return locate_many(question, readings, facing, threads, progress)

    def locate_logs(
        self,
        logs: Iterable[Any],
        *,
        finger: Optional[FingerLike] = None,
        noise: NoiseLike = None,
        tolerance: Optional[float] = None,
        at: Any = None,
        prior: Optional[Tuple[float, float]] = None,
        heading: Optional[Tuple[float, float]] = None,
        pose: Optional[Sequence[float]] = None,
        mirrored: bool = False,
        direction: str = "ccw",
        robust: bool = False,
        columns: Columns = None,
        units: Units = None,
        degrees: bool = False,
        wrapped: Optional[bool] = None,
        roll: Optional[int] = None,
        budget: Optional[int] = None,
        threads: int = 0,
        progress: Optional[bool] = None,
    ) -> List[Result]:
        """The answers to many logs, on all cores: `locate(log=one, ...)` of each, in order.

        Parameters
        ----------
        logs : iterable of logs
        finger, noise, ...
            As of `locate`, for all of them; what can't be meant raises InputError at once.
        threads, progress
            As of `locate_many`.

        Returns
        -------
        list of Answer, or of InputError where a log can't be worked with
        """
        question = Question(
            self._core,
            finger=finger,
            noise=noise,
            tolerance=tolerance,
            at=at,
            prior=prior,
            heading=heading,
            pose=pose,
            mirrored=mirrored,
            direction=direction,
            robust=robust,
            columns=columns,
            units=units,
            degrees=degrees,
            wrapped=wrapped,
            roll=roll,
            budget=budget,
        )
        return locate_logs(question, logs, threads, progress)

    def watch(
        self,
        *,
        noise: Union[Noise, Mapping[str, float]],
        finger: Optional[Finger] = None,
        prior: Optional[Tuple[float, float]] = None,
        heading: Optional[Tuple[float, float]] = None,
        pose: Optional[Sequence[float]] = None,
        robust: bool = False,
        every: int = 0,
        columns: Columns = None,
        units: Units = None,
        degrees: bool = False,
        wrapped: Optional[bool] = None,
        direction: str = "ccw",
        mirrored: bool = False,
        live: bool = False,
        name: str = "log",
    ) -> Watch:
        """A `Watch` on this part."""
        return Watch(
            self,
            noise=noise,
            finger=finger,
            prior=prior,
            heading=heading,
            pose=pose,
            robust=robust,
            every=every,
            columns=columns,
            units=units,
            degrees=degrees,
            wrapped=wrapped,
            direction=direction,
            mirrored=mirrored,
            live=live,
            name=name,
        )

    def simulate(
        self,
        finger: Optional[FingerLike] = None,
        *,
        start: Any,
        length: Any = None,
        rotation: Optional[float] = None,
        samples: int = 101,
        contact: Any = 0.0,
        part_rotation: float = 0.0,
        noise: NoiseLike = None,
        seed: int = 0,
    ) -> Roll:
        """What the sensors of a roll say, and how it really was.

        Parameters
        ----------
        finger : Disk, Jaw, OutlineFinger; two of them; None: a wheel with a gyroscope
            Two roll on a part that is free to move. A wheel logs `distance` and `dturn`.
        start : float, of two fingers (s, t)
            The first contacts.
        length : float, of two fingers (La, Lb)
            Until the contact has travelled this far; below 0: backwards. Or
        rotation : float
            of one finger: until it has turned by this, radians.
        samples : int
            Rows of the log.
        contact : float, of two fingers a pair
            Of a disk its angle u at the first contact, radians; of another finger the place on it.
        part_rotation : float
            Of two fingers: by how much the part turns meanwhile, radians.
        noise : Noise or dict, optional
        seed : int
            Everything that is drawn follows from it, the same on all platforms.

        Returns
        -------
        Roll
        """
        return Roll(
            simulated(
                self._core, finger, start, length, rotation, samples, contact, part_rotation, noise, seed
            )
        )

    # --- as a file, as a figure, as a value ---

    def save(self, file: Any) -> None:
        """Writes it: .json keeps all that was computed, and answers with the same bits; .svg, .png, .pdf are a figure."""
        name = path(file, "file")
        if name.lower().endswith(".json"):
            self._core.save(name)
        else:
            self._figure(None).save(name)

    def to_svg(self, *, finger: Optional[Finger] = None, title: str = "", width: float = 640) -> str:
        """The figure of `rollfix inspect -o`; with a finger also where it can't touch."""
        svg: str = self._figure(finger, title, width).svg()
        return svg

    def _figure(self, finger: Optional[Finger], title: str = "", width: float = 640) -> Any:
        from . import _draw

        reach = None if finger is None else self.reach(finger)._core
        wide = least(width, "width", 0, "a number of pixels")
        return _draw.part_figure(self._core, reach, text(title, "title"), wide)

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


def _part(core: _core.Part) -> Part:
    return Part._of(core)
