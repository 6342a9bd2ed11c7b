"""Which search answers: of one roll, of contacts with a part at rest, of several fingers on a part that moves."""

from __future__ import annotations

from typing import Any, Dict, Mapping, Union

from ._answer import Answer
from ._core import InputError
from ._holds import HoldAnswer, held, is_hold
from ._columns import Naming
from ._logs import rolls_of
from ._options import HoldOptions, RestOptions, TouchOptions, filled, names_of, require_only
from ._question import Question, require_one_roll, solved
from ._rounding import offer_rounding
from ._touches import TouchAnswer, located


def answer_to(part: Any, given: Mapping[str, Any], options: Mapping[str, Any]) -> Union[Answer, TouchAnswer, HoldAnswer]:
    """The answer to a question of whichever kind. `given`: readings, turn, log and touches."""
    sources, options = dict(given), dict(options)
    if options.get("roll") == "all":
        rolls = all_rolls(part.unit, sources, options)
        del options["roll"]
        if sources["touches"] is not None or len(rolls) > 1 or len(rolls[0]) == 1:
            return located(part, sources["touches"], rolls=rolls, **filled(_taken(options, RestOptions), RestOptions))
        sources["log"] = rolls[0]
        options = {name: value for name, value in options.items() if name not in ("columns", "units", "degrees", "wrapped")}
    if isinstance(options.get("roll"), str):
        raise InputError(f"roll: expected a number from 1, or 'all', found '{options['roll']}'")
    if is_hold(sources["log"], options.get("finger")):
        others = {name: value for name, value in sources.items() if name != "log"}
        why = "is not taken with three and more fingers or a wheel"
        require_only(HoldOptions, {**others, **options}, why)
        return held(part, sources["log"], **filled(_taken(options, HoldOptions), HoldOptions))
    if options.pop("squeezed", None) is not None:
        raise InputError("squeezed: is about a finger with skin and a Wheel without that squeeze a part: leave it out")
    if sources["touches"] is not None:
        return _of_touches(part, sources, options)
    if options.pop("clear", None) is not None:
        raise InputError("clear: is about touches and several rolls: give `touches`, or rolls with roll='all', or leave it out")
    return _of_one_roll(part, sources, options)


def _taken(options: Mapping[str, Any], kind: Any) -> Dict[str, Any]:
    """Those that this kind takes; the others say nothing."""
    return {name: options[name] for name in names_of(kind) if name in options}


def all_rolls(unit: str, sources: Mapping[str, Any], options: Mapping[str, Any]) -> Any:
    """The rolls of roll='all', in a part's unit; what is of one roll is refused."""
    others = {name: value for name, value in {**sources, **options}.items() if name not in ("log", "touches", "roll")}
    of_others = {name: others.pop(name) for name in ("squeezed",) if name in others}
    require_only(RestOptions, of_others, "is not taken with roll='all'")
    require_only(RestOptions, others, "is of one roll, found roll='all'")
    if sources["log"] is None:
        raise InputError("roll: 'all' takes the rolls of a log, expected `log` as well")
    naming = Naming(
        options.get("columns"), options.get("units"), options.get("degrees", False), options.get("wrapped")
    )
    return rolls_of(sources["log"], naming, unit)


def _of_touches(part: Any, sources: Mapping[str, Any], options: Mapping[str, Any]) -> TouchAnswer:
    if sources["log"] is not None:
        raise InputError("log: shares a pose with `touches` where roll='all': add it")
    others = {"readings": sources["readings"], "turn": sources["turn"], **options}
    require_only(TouchOptions, others, "touches do not roll and have no use for it")
    return located(part, sources["touches"], **filled(_taken(options, TouchOptions), TouchOptions))


def _of_one_roll(part: Any, sources: Mapping[str, Any], options: Mapping[str, Any]) -> Answer:
    require_one_roll(sources["readings"], sources["log"])
    question = Question(part._core, options)
    if sources["log"] is not None:
        return solved(*question.of_log(sources["log"], sources["turn"]))
    answer = solved(question.of_readings(sources["readings"], sources["turn"]))
    is_exact = all(options.get(name) is None for name in ("noise", "tolerance", "rounding"))
    return offer_rounding(answer, answer.readings) if is_exact and not len(answer) else answer
