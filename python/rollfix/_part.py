"""Parts, and what is asked of them."""

from __future__ import annotations

import functools
import os
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, TypeVar, Union, cast

import numpy as np

from . import _core
from ._answer import Answer, ManyAnswers
from ._core import InputError, Reach
from ._documents import Advice, Inspection
from ._inputs import (
    Finger,
    FingerLike,
    NoiseLike,
    array,
    clockwise,
    fingers,
    finite,
    noise as noise_given,
    number,
    numbers,
    optional_number,
    path,
    travel as travel_given,
    whole,
)
from ._logs import Columns, Roll
from ._problems import basic_problem, log_options, problem_of
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


class Part:
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

    __slots__ = ("_core", "__weakref__")

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
        options: Dict[str, Any] = {
            "unit": unit,
            "open": open,
            "smooth": optional_number(smooth, "smooth"),
            "corner_angle": optional_number(corner_angle, "corner_angle"),
            "loop": None if loop is None else whole(loop, "loop", 1),
            "layer": layer,
            "gap": optional_number(gap, "gap"),
            "allow_crossing": allow_crossing,
        }
        self._core = _core.load_part(path(source, "source"), options)

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
            In order along the boundary; a closed one's first point need not come again. At least 3, of an open one 2.
        closed : bool
            False: a curve with two ends.
        name, unit, smooth, corner_angle, allow_crossing
            As of `Part`.
        """
        points = array(xy, "xy")
        if points.ndim != 2 or points.shape[1] != 2:
            raise InputError(f"xy: expected points, an array of shape (n, 2), found shape {np.shape(xy)}")
        options: Dict[str, Any] = {
            "unit": unit,
            "open": not closed,
            "smooth": optional_number(smooth, "smooth"),
            "corner_angle": optional_number(corner_angle, "corner_angle"),
            "allow_crossing": allow_crossing,
        }
        return cls._of(_core.part_from_points(finite(points, "xy"), name, options))

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
        from ._curves import pieces_of

        pieces = pieces_of(f, df, ddf, domain)
        size = float(max(np.ptp(np.vstack(pieces), axis=0)))
        if closed:
            gap = float(np.hypot(*(pieces[-1][-1] - pieces[0][0])))
            if gap > 1e-9 * size:
                raise InputError(f"f: ends {gap:.3g} from where it starts; give closed=False for a curve with two ends")
            pieces[-1][-1] = pieces[0][0]
        return cls._of(_core.part_from_pieces(pieces, name, closed, unit, allow_crossing, 0.0))

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
        if not isinstance(shape, str):
            raise InputError(f"shape: expected a name, found {shape!r}")
        name = shape if shape.startswith("gallery:") else "gallery:" + shape
        given = "".join(
            f",{key}={value if isinstance(value, str) else repr(float(value)) if isinstance(value, np.floating) else value}"
            for key, value in parameters.items()
        )
        return cls(name + given)

    # --- what it is ---

    @property
    def name(self) -> str:
        """str: what it was called."""
        return self._core.name

    @property
    def unit(self) -> str:
        """str: of its lengths; '' where nobody said."""
        return self._core.unit

    @property
    def perimeter(self) -> float:
        """float: P, the boundary's length."""
        return self._core.perimeter

    @property
    def closed(self) -> bool:
        """bool: False of a curve with two ends. (Whether `close` was called is not this.)"""
        return self._core.closed

    @property
    def reversed(self) -> bool:
        """bool: given clockwise and stored counter-clockwise, a hole the other way round."""
        return self._core.reversed

    @property
    def total_turn(self) -> float:
        """float: of the tangent along the whole boundary, radians."""
        return self._core.total_turn

    @property
    def turns(self) -> int:
        """int: how often the tangent turns round along a closed boundary; 0 of an open one."""
        return self._core.turns

    @property
    def inflections(self) -> np.ndarray:
        """ndarray: places s where the curvature changes sign."""
        return self._core.inflections

    @property
    def vertices(self) -> np.ndarray:
        """ndarray: places s where the curvature's slope changes sign."""
        return self._core.vertices

    @property
    def corners(self) -> np.ndarray:
        """ndarray, (n, 2): s and turn of each corner, radians; above 0: convex."""
        return self._core.corners

    @property
    def notes(self) -> Tuple[str, ...]:
        """tuple of str: what was left out, joined or chosen when it was made."""
        return tuple(self._core.notes)

    def point(self, s: Any) -> np.ndarray:
        """Positions at s.

        Parameters
        ----------
        s : array_like of any shape
            Any number on a closed part; on an open one clamped to [0, P].

        Returns
        -------
        ndarray, s.shape + (2,)
        """
        return self._core.point(array(s, "s"))

    def turning(self, s: Any) -> np.ndarray:
        """The turning function Theta(s): the tangent's angle, radians, unwrapped; accurate to 1e-12. Just after s.

        Parameters
        ----------
        s : array_like of any shape

        Returns
        -------
        ndarray of the same shape
        """
        return self._core.turning(array(s, "s"))

    def curvature(self, s: Any) -> np.ndarray:
        """kappa(s) = dTheta/ds, positive where convex. Shapes as of `turning`."""
        return self._core.curvature(array(s, "s"))

    def tangent(self, s: Any) -> np.ndarray:
        """Theta(s) in (-pi, pi]. Shapes as of `turning`."""
        return self._core.tangent(array(s, "s"))

    def samples(self) -> Dict[str, np.ndarray]:
        """The boundary as numbers, as densely as its shape asks for: `s`, `x`, `y`, `tangent` (unwrapped), `curvature`."""
        return self._core.samples()

    def inspect(self, finger: Optional[Finger] = None) -> Inspection:
        """What it is, how ambiguous rolls on it are, and where a finger can touch it: `rollfix inspect --json`."""
        given = fingers(finger, 1)
        return Inspection(_core.inspect(self._core, given[0] if given else None))

    def reach(self, finger: Finger) -> Reach:
        """Where a disk or a jaw can touch without entering the part anywhere."""
        given = fingers(finger, 1)
        if not given:
            raise InputError("finger: expected Disk(radius) or Jaw(), found None")
        return _core.reach_of(self._core, given[0])

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
        units: Optional[Mapping[str, str]] = None,
        degrees: bool = False,
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
            Instead of readings: see `rollfix.read_log`, also for `columns`, `units`, `degrees` and `roll`.
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
        problem, taken = problem_of(
            self._core,
            readings,
            turn,
            log,
            finger,
            noise,
            tolerance,
            facing,
            at,
            prior,
            heading,
            pose,
            mirrored,
            direction,
            robust,
            columns,
            units,
            degrees,
            roll,
            rounding,
            budget,
        )
        return Answer(problem.solve(), taken)

    def advise(self, readings: Any = None, turn: Any = None, *, travel: Any = None, **options: Any) -> Advice:
        """The next roll: which one tells the remaining placements apart. Of one finger.

        Parameters
        ----------
        readings, turn, **options
            The roll so far, as of `locate`.
        travel : float or (float, float), optional
            How far the finger can roll on: a length, or (back, forward) with back <= 0. Default: one lap.

        Returns
        -------
        Advice
        """
        return Advice(self.locate(readings, turn, **options)._core, travel_given(travel))

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
            As of `locate`.
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
        rows = array(readings, "readings")
        if rows.ndim == 2:
            rows = rows[:, np.newaxis, :]
        if rows.ndim != 3 or rows.shape[2] not in (2, 3) or rows.shape[1] == 0:
            raise InputError(
                "readings: expected an array of shape (problems, 2) or (problems, 3), or (problems, readings, 2 or 3), "
                f"found shape {np.shape(readings)}"
            )
        if clockwise(direction):
            rows = rows * np.array([-1.0] * (rows.shape[2] - 1) + [1.0])
        rows = np.ascontiguousarray(rows)
        rows.flags.writeable = False
        facings = None
        if facing is not None:
            given = finite(array(facing, "facing"), "facing")
            if given.shape not in ((), (len(rows),)):
                raise InputError(f"facing: expected one angle, or one for each of {len(rows)}, found shape {given.shape}")
            facings = np.ascontiguousarray(np.broadcast_to(given, (len(rows),)))

        def problem_of(one_facing: Optional[float]) -> _core.Problem:
            problem = basic_problem(self._core, finger, noise, tolerance, mirrored, budget)
            if rounding is not None:
                length, angle = numbers(rounding, 2, "rounding", "(length, turn)")
                problem.set_roundings([(length, angle)] * rows.shape[1])
            problem.facing = one_facing
            return problem

        from ._progress import Progress

        with Progress(len(rows), progress) as bar:
            columns = _core.solve_many(problem_of(None), rows, facings, whole(threads, "threads"), bar.report)
        return ManyAnswers(columns, problem_of, rows, facings)

    def locate_logs(
        self, logs: Iterable[Any], *, threads: int = 0, progress: Optional[bool] = None, **options: Any
    ) -> List[Union[Answer, InputError]]:
        """The answers to many logs, on all cores: `locate(log=one, **options)` of each, in order.

        Returns
        -------
        list of Answer, or of InputError where a log can't be worked with
        """
        problems: List[Any] = []
        chosen = log_options(options)
        for log in logs:
            try:
                problems.append(problem_of(self._core, None, None, log, *chosen))
            except InputError as error:
                problems.append(error)
        asked = [one for one in problems if not isinstance(one, InputError)]
        from ._progress import Progress

        with Progress(len(asked), progress) as bar:
            found = iter(_core.solve_problems([one[0] for one in asked], whole(threads, "threads"), bar.report))
        results: List[Union[Answer, InputError]] = []
        for one in problems:
            if isinstance(one, InputError):
                results.append(one)
                continue
            solved = next(found)
            results.append(InputError(solved) if isinstance(solved, str) else Answer(solved, one[1]))
        return results

    def watch(self, **options: Any) -> Watch:
        """A `Watch` on this part."""
        return Watch(self, **options)

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
        rows, seeded, sds = whole(samples, "samples", 1), whole(seed, "seed"), noise_given(noise)
        if finger is None:
            if length is None or rotation is not None:
                raise InputError("length: expected how far the wheel drives")
            return Roll(_core.simulate_drive(self._core, number(start, "start"), number(length, "length"), rows, sds, seeded))
        given = fingers(finger)
        if np.ndim(start) == 0:
            if len(given) == 2:
                raise InputError(f"start: expected one for each of two fingers, found {start!r}")
            return Roll(
                _core.simulate_one(
                    self._core,
                    given[0],
                    number(start, "start"),
                    optional_number(length, "length"),
                    optional_number(rotation, "rotation"),
                    rows,
                    number(contact, "contact"),
                    sds,
                    seeded,
                )
            )
        starts = numbers(start, 2, "start", "one for each of two fingers")
        if rotation is not None or length is None:
            raise InputError("length: expected one for each of two fingers; `rotation` is of one")
        return Roll(
            _core.simulate_two(
                self._core,
                given,
                starts,
                numbers(length, 2, "length", "one for each of two fingers"),
                number(part_rotation, "part_rotation"),
                rows,
                numbers(np.broadcast_to(array(contact, "contact"), (2,)), 2, "contact", "one or two angles"),
                sds,
                seeded,
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

        return _draw.part_figure(self._core, None if finger is None else self.reach(finger), title, width)

    def _repr_svg_(self) -> str:
        return self.to_svg()

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
