"""Which parts of a catalog a roll fits, or touches."""

from __future__ import annotations

import json
from collections.abc import Sequence as SequenceABC
from dataclasses import dataclass
from typing import Any, Dict, Iterator, List, Mapping, Optional, Tuple, Union, overload

from ._answer import Answer
from ._made import Made
from ._touches import TouchAnswer
from ._words import in_python


@dataclass(frozen=True, repr=False)
class PartFound(Made):
    """A part that the roll, or the touches, may have been on."""

    name: str  # in the catalog
    id: int  # in the catalog
    source: str  # the file, or gallery:...
    probability: Optional[float]  # that it is this part; None without noise
    verdict: str  # as `Part.locate` says of this part alone
    congruent_with: Tuple[str, ...]  # those found that can't be told from it
    answer: Any  # an Answer, of touches a TouchAnswer; its probabilities are given that it is this part

    def __repr__(self) -> str:
        probability = "" if self.probability is None else f"probability {self.probability:.4g}; "
        return f"<PartFound {self.name!r}: {probability}{self.verdict}>"


class Identified(Made, SequenceABC):  # type: ignore[type-arg]
    """Every part of a catalog that a roll fits, or touches: a sequence of `PartFound`, the likeliest first.

    Without noise they are in the catalog's order. It can't be changed, can be pickled, and equals another that says the
    same. `to_dict` gives the whole JSON document.
    """

    __slots__ = ("_text", "_answers", "_fields", "_parts")

    _text: str
    _answers: Dict[int, Union[Answer, TouchAnswer]]  # by their parts' ids

    def __init__(self, text: str, answers: Mapping[int, Union[Answer, TouchAnswer]]) -> None:
        self._text = text
        self._fields = self.to_dict()
        self._parts = tuple(
            PartFound(
                one["name"],
                one["id"],
                one["source"],
                one["probability"],
                one["verdict"],
                tuple(one["congruent_with"]),
                answers[one["id"]],
            )
            for one in self._fields["parts"]
        )
        self._answers = {one.id: one.answer for one in self._parts}

    @property
    def verdict(self) -> str:
        """str: 'unique part, unique place', 'unique part, 2 places', '3 parts', '2 congruent parts', 'none', 'undecided'.

        Of touches 'unique part, unique pose', 'unique part, 2 poses', ... With ', but the rows fit badly', or the
        like, behind it where they do.
        """
        return str(self._fields["verdict"])

    @property
    def status(self) -> str:
        """str: 'complete', or 'incomplete' where the search of some part is."""
        return str(self._fields["status"])

    @property
    def parts(self) -> Tuple[PartFound, ...]:
        """tuple of PartFound: all of them."""
        return self._parts

    @property
    def names(self) -> Tuple[str, ...]:
        """tuple of str: what they are called."""
        return tuple(one.name for one in self._parts)

    @property
    def rest(self) -> Optional[float]:
        """float or None: with noise, the probability of all parts that are not listed; of touches None where undecided."""
        rest: Optional[float] = self._fields["rest"]
        return rest

    @property
    def searched(self) -> int:
        """int: how many parts were searched, which bounds did not rule out."""
        return int(self._fields["catalog"]["searched"])

    @property
    def refused(self) -> Dict[str, str]:
        """dict: the parts on which such a roll can't have been at all, and why."""
        return {one["name"]: in_python(one["why"]) for one in self._fields["refused"]}

    def to_dict(self) -> Dict[str, Any]:
        """The JSON document `rollfix/identify/1`, that of `rollfix identify --json`; docs/json.md lists the fields."""
        document: Dict[str, Any] = json.loads(self._text)
        return document

    def to_frame(self) -> Any:
        """A pandas.DataFrame with a row for each placement: `part`, with noise `part_probability`, and as of an answer.

        A part of which none is listed, as after a single touch, has one row without a placement's numbers.
        """
        from ._logs import pandas

        columns: Dict[str, List[Any]] = {"part": []}
        if self._fields["noise"] is not None:
            columns["part_probability"] = []
        for one in self._parts:
            rows = max(len(one.answer), 1)
            columns["part"] += [one.name] * rows
            if self._fields["noise"] is not None:
                columns["part_probability"] += [one.probability] * rows
            for name, values in one.answer._columns().items():
                columns.setdefault(name, []).extend(values or [None])
        return pandas().DataFrame(columns)

    def __len__(self) -> int:
        return len(self._parts)

    @overload
    def __getitem__(self, k: int) -> PartFound: ...
    @overload
    def __getitem__(self, k: slice) -> Tuple[PartFound, ...]: ...
    def __getitem__(self, k: Union[int, slice]) -> Union[PartFound, Tuple[PartFound, ...]]:
        return self._parts[k]

    def __iter__(self) -> Iterator[PartFound]:
        return iter(self._parts)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Identified):
            return NotImplemented
        return self._text == other._text and self._answers == other._answers

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        most = 6
        shown = [
            one.name if one.probability is None else f"{one.name} ({one.probability:.3f})" for one in self._parts[:most]
        ]
        more = ", ..." if len(self) > most else ""
        return f"<Identified: {self.verdict}{'; ' if shown else ''}{', '.join(shown)}{more}>"

    def __reduce__(self) -> Any:
        return (Identified, (self._text, self._answers))
