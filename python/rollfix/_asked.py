"""Where the finger is: what is asked of a part about rolls that are over."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, Callable, Iterable, List, Literal, Optional, TypeVar, Union, cast, overload

import numpy as np

from . import _core
from ._answer import Answer
from ._checks import clockwise, flag, friction as friction_given, travel as travel_given
from ._documents import Advice
from ._holds import HoldAnswer, PinAdvice
from ._log_answers import LogAnswers, locate_logs
from ._many import ManyAnswers, locate_many
from ._options import (
    AdvisedOptions,
    AnyOptions,
    FirstOptions,
    HoldOptions,
    LogOptions,
    RestOptions,
    RollOptions,
    RowOptions,
    TouchOptions,
    keywords,
    require_only,
)
from ._question import Question, answer_to
from ._rounding import offer_rounding
from ._shape import Shape
from ._touches import TouchAnswer

if TYPE_CHECKING:
    from typing_extensions import Unpack

Method = TypeVar("Method", bound=Callable[..., Any])


def _quick(locate: Method) -> Method:
    """One reading of one finger and nothing else, the job of tight loops, takes the shortest way to C++."""

    @functools.wraps(locate)
    def quick(self: "Asked", readings: Any = None, turn: Any = None, **options: Any) -> Any:
        if not options and isinstance(readings, float) and isinstance(turn, float):
            answer = Answer._of(_core.locate_one(self._core, readings, turn))
            return answer if len(answer) else offer_rounding(answer, np.array([[readings, turn]]))
        return locate(self, readings, turn, **options)

    return cast(Method, quick)


class Asked(Shape):
    """A part that can be asked where a roll was."""

    __slots__ = ()

    @overload
    def locate(self, *, touches: Any, **options: Unpack[TouchOptions]) -> TouchAnswer: ...

    @overload
    def locate(
        self, *, log: Any, roll: Literal["all"], touches: Any = None, **options: Unpack[RestOptions]
    ) -> Union[Answer, TouchAnswer]: ...

    @overload
    def locate(self, *, log: List[Any], **options: Unpack[HoldOptions]) -> Any: ...  # three and more, or wheels: a HoldAnswer

    @overload
    def locate(
        self, readings: Any = None, turn: Any = None, *, log: Any = None, **options: Unpack[RollOptions]
    ) -> Answer: ...

    @_quick
    @keywords(AnyOptions)
    def locate(
        self, readings: Any = None, turn: Any = None, *, log: Any = None, touches: Any = None, **options: Unpack[AnyOptions]
    ) -> Union[Answer, TouchAnswer, HoldAnswer]:
        """Every place where the roll can have started. There is no other: see `Answer.status`.

        `locate(length, turn)`, `locate(readings)`, or `locate(log=..., finger=..., noise=...)`. One finger on a part at
        rest: eqs. (4) and (5). Two on a part that is free to move: eqs. (8) and (9). Three to eight: a list of logs.

        Parameters
        ----------
        readings : float with `turn`, or array_like, (2,), (3,), (n, 2) or (n, 3)
            (L, theta) of one finger: arc length travelled, along the stored outline, and turn of the tangent, radians. Of
            two (La, Lb, theta), theta being finger a's turn less finger b's. Each from the first contact; taken as exact.
        turn : float, optional
            With one length.
        log : path, DataFrame, mapping of arrays, ndarray, Log, Roll, a pair of them, or a list of three to eight
            Instead of readings: see `rollfix.read_log`, also for `columns`, `units`, `degrees`, `wrapped` and `roll`.
            A list of three and more: as many fingers on a part that is free to move, a `HoldAnswer`; of the other
            arguments it takes `finger` (one, or one for each), `noise`, `tolerance` as an angle or (length, angle), `at`,
            `mirrored`, `columns`, `units`, `degrees`, `wrapped` and `budget`. docs/two_fingers.md.
        roll : int or 'all', optional
            Which roll of a log with several, from 1. 'all': the rolls of the log, or of a list of logs, and `touches`
            share the pose of a part at rest: a `TouchAnswer`, with several contacts. docs/touch.md.
        touches : array_like, (n, 2) or (n, 3), list of tuples, or DataFrame with columns x and y
            Instead: touches of a part at rest without rolling, (x, y) or (x, y, normal) of each: the finger's centre in the
            world, and the direction out of the part, radians, "162deg" or None. The answer is every pose of the part that
            fits, a `TouchAnswer`; of the other arguments it takes `finger` (a Disk; none: a point), `noise` (position,
            angle), or `tolerance` as (length, angle), `heading`, `pose`, `mirrored`, `budget` and `clear`. With `log` and
            roll='all' both.
        clear : array_like, (n, 4), optional
            With touches, or several rolls that have x and y: (x, y, x, y), from where to where the finger's centre went
            straight and felt nothing. Poses in which the part is in the way are left out.
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
        may_overlap : bool
            Fingers at different heights: places where they would overlap are kept.
        rounding : (length, turn), optional
            Of readings: how far their digits may be off, half a unit of the last one each; widens the tolerance as that
            asks for.
        budget : int, optional
            Intervals, of two fingers boxes, to look at before giving up; default 1000000.
        squeezed : float, optional
            A finger with skin and a `Wheel` squeeze the part, and the floor's and the pin's friction are small: the wheel's
            normal points through the finger's contact, to this standard deviation, radians.

        Returns
        -------
        Answer
            Of touches, and of several rolls, a `TouchAnswer`; of three and more fingers, and beside wheels, a
            `HoldAnswer`.

        Raises
        ------
        InputError
            What can't be meant; the message names the argument.
        """
        answer: Union[Answer, TouchAnswer, HoldAnswer] = answer_to(
            self._core, {"readings": readings, "turn": turn, "log": log, "touches": touches}, options
        )
        return answer

    @keywords(AdvisedOptions)
    def advise(
        self,
        readings: Any = None,
        turn: Any = None,
        *,
        travel: Any = None,
        friction: Any = None,
        log: Any = None,
        **options: Unpack[AdvisedOptions],
    ) -> Union[Advice, PinAdvice]:
        """The next roll: which one tells the remaining placements apart; of two fingers, how far each rolls.

        Parameters
        ----------
        readings, turn, log, ...
            The roll so far, as of `locate`. Without any of them, before any contact, `finger` alone, with `noise` and
            `may_overlap`: which roll tells most at first.
        travel : float or (float, float), optional
            How far each finger can roll on: a length, or (back, forward) with back <= 0. Default: one lap. Of a `Wheel` beside a
            jaw how far its pin can go; default a tenth of a lap.
        friction : float or (float, float), optional
            Of two disks or jaws on the part: only rolls are advised that can be planned with it.

        Returns
        -------
        Advice
            Of a jaw beside a `Wheel` a `PinAdvice`.
        """
        range_given = travel_given(travel)
        may_overlap = flag(options.get("may_overlap", False), "may_overlap")
        if readings is None and turn is None and log is None:
            require_only(FirstOptions, options, "is about a roll that was, and none is given")
            answer: Any = Answer(_core.before_contact(Question(self._core, options).core()))
        else:
            answer = answer_to(self._core, {"readings": readings, "turn": turn, "log": log, "touches": None}, options)
        if isinstance(answer, HoldAnswer):
            return answer.advise(travel=travel)
        return Advice(answer._core, range_given, may_overlap, friction_given(friction))

    @keywords(RowOptions)
    def locate_many(
        self,
        readings: Any,
        *,
        facing: Any = None,
        threads: int = 0,
        client: Any = None,
        progress: Optional[bool] = None,
        **options: Unpack[RowOptions],
    ) -> ManyAnswers:
        """The answers to many problems, on all cores, as arrays. Ctrl-C stops it; an error stays with its problem.

        Parameters
        ----------
        readings : array_like, (n, 2) or (n, 3): a problem of one reading in each row; (n, m, 2) or (n, m, 3): of m each
            As of `locate`. Or a table with columns length and turn, of two fingers length_a, length_b and turn.
        finger, noise, tolerance, mirrored, direction, may_overlap, rounding, budget
            As of `locate`, for all problems.
        facing : float or array_like, (n,), optional
            Of two fingers.
        threads : int
            0: as many as there are processors. The answers have the same bits with any number.
        client : distributed.Client, optional
            Of a Dask cluster, whose workers share the problems; what a worker had that is lost is done again by another.
        progress : bool, optional
            A bar, by tqdm. Default: where tqdm is installed, in a notebook or on a terminal, after half a second.

        Returns
        -------
        ManyAnswers
        """
        clockwise(options.get("direction", "ccw"))  # not both ways at once
        return locate_many(Question(self._core, options), readings, facing, threads, client, progress)

    @keywords(LogOptions)
    def locate_logs(
        self,
        logs: Iterable[Any],
        *,
        threads: int = 0,
        client: Any = None,
        progress: Optional[bool] = None,
        errors: str = "collect",
        **options: Unpack[LogOptions],
    ) -> LogAnswers:
        """The answers to many logs, on all cores: `locate(log=one, ...)` of each, in order.

        Parameters
        ----------
        logs : iterable of logs
        finger, noise, ...
            As of `locate`, for all of them; what can't be meant raises InputError at once.
        threads, client, progress
            As of `locate_many`; reading the logs counts.
        errors : 'collect' or 'raise'
            Of a log that can't be worked with: keep its InputError in its place, or raise the first one. Where all fail
            for one reason that is raised in any case.

        Returns
        -------
        LogAnswers
        """
        return locate_logs(Question(self._core, options), logs, threads, client, progress, errors)
