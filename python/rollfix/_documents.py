"""Results that are JSON documents: what they hold is read by their fields' names."""

from __future__ import annotations

import json
from typing import Any, Callable, Dict, List, Optional, Tuple

from . import _core
from ._checks import least, path, text as text_given, whole
from ._made import no_value
from ._messages import in_a_page, warn


class Document:
    """A JSON document of docs/json.md. Its fields are attributes; `to_dict` gives all of them."""

    __slots__ = ("_text", "_fields")

    def __init__(self, text: str) -> None:
        self._text = text
        self._fields: Optional[Dict[str, Any]] = None

    def to_dict(self) -> Dict[str, Any]:
        """The document, a new one each time."""
        fields: Dict[str, Any] = json.loads(self._text)
        return fields

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise no_value(self, name)
        fields = self.to_dict()
        if name not in fields:
            raise AttributeError(f"{type(self).__name__} has no field {name!r}; it has {', '.join(fields)}")
        return fields[name]

    def __dir__(self) -> Any:
        return sorted([*super().__dir__(), *self.to_dict()])

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and isinstance(other, Document) and other._text == self._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __reduce__(self) -> Any:
        return (type(self), (self._text,))


class Listing(Document):
    """A document whose placements are rows of a table."""

    __slots__ = ()

    def _columns(self) -> Dict[str, List[Any]]:
        raise NotImplementedError

    def to_frame(self) -> Any:
        """A pandas.DataFrame with a row for each placement."""
        from ._logs import pandas

        return pandas().DataFrame(self._columns())

    def __len__(self) -> int:
        return len(self.placements)


def proof(answer: Any, file: Any, budget: Optional[int]) -> Dict[str, Any]:
    """The certificate of an answer of `_core`, written as well if `file` is given."""
    most = None if budget is None else whole(budget, "budget", 1)
    document, is_complete, where = answer.certificate(most)
    if file is not None:
        with open(path(file, "file"), "w", encoding="utf-8") as out:
            out.write(document)
    if not is_complete:
        warn(f"certify: the certificate leaves something unproved: {where}")
    certificate: Dict[str, Any] = json.loads(document)
    return certificate


class Proved(Listing):
    """Has the answer of `_core`, and in `_FIGURE` what `_draw` calls its figure."""

    __slots__ = ("_answer", "_part", "_question")
    _FIGURE = ""
    _answer: Any

    def __init__(self, part: _core.Part, question: _core.Question, answer: Any) -> None:
        super().__init__(answer.document())
        self._answer, self._part, self._question = answer, part, question

    def certify(self, file: Any = None, budget: Optional[int] = None) -> Dict[str, Any]:
        """The proof that there is nothing else: the document that `rollfix-verify` checks with code of its own.

        Of touches and rolls on a part at rest: two contacts or more, rolls without noise. A RollfixWarning says where
        something is left unproved. docs/certificates.md says what is proved.

        Parameters
        ----------
        file : path, optional
            Also writes it there.
        budget : int, optional
            As of `Part.locate`; by default what this answer was asked with.
        """
        return proof(self._answer, file, budget)

    def to_svg(self, *, title: str = "", width: float = 0) -> str:
        """A figure of the part in the world in each placement, with what touched it."""
        svg: str = self._figure(title, width).svg()
        return svg

    def save(self, file: Any, *, title: str = "", width: float = 0) -> None:
        """Writes that figure, by its ending: .svg, .png or .pdf."""
        self._figure(title, width).save(path(file, "file"))

    def _figure(self, title: str, width: float) -> Any:
        from . import _draw

        figure = getattr(_draw, self._FIGURE)
        return figure(self._answer, text_given(title, "title"), least(width, "width", 0, "a number of pixels"))

    def _repr_svg_(self) -> Optional[str]:
        return in_a_page(self.to_svg())

    def __reduce__(self) -> Any:
        return (_again, (type(self), self._part, *self._question.state()))


def _again(kind: Callable[..., Proved], part: _core.Part, fingers: Any, state: Any) -> Proved:
    """The answer to the same question, worked out again."""
    question = _core.question_from_state(part, fingers, state)
    return kind(part, question, question.solve())


class Inspection(Document):
    """What a part is: the fields of `rollfix/inspect/1`, see docs/json.md.

    `perimeter` and its like are in `part`; `box`, `curvature`, `largest_disk`, `symmetry`, `ambiguity`, `reach`, ...
    """

    __slots__ = ()

    def __repr__(self) -> str:
        part, symmetry = self.part, self.symmetry
        look = "looks alike from everywhere" if symmetry is None else f"{symmetry}-fold" if symmetry > 1 else "no symmetry"
        return f"<Inspection of {part['name']!r}: perimeter {part['perimeter']:.6g}, {self.spirals} spirals, {look}>"


class Advice(Document):
    """Which roll tells the remaining placements apart: the fields of `rollfix/advise/1`, see docs/json.md.

    `length` is the advised roll from where the contact is now, positive along the stored outline, or None; of two fingers
    a list, how far each of them rolls. `helps`, and where no roll does `why`; `expected_placements`, `expected_travel`, `bits`, `bits_wanted`, `contenders`,
    `prospects`.
    """

    __slots__ = ("_answer", "_how")

    def __init__(
        self,
        answer: _core.Answer,
        travel: Optional[Tuple[float, float]],
        may_overlap: bool = False,
        friction: Optional[Tuple[float, float]] = None,
    ) -> None:
        self._how = (travel, may_overlap, friction)
        super().__init__(_core.next_roll(answer, *self._how).document())
        self._answer = answer

    def to_svg(self) -> str:
        """A figure of what is to be expected by length. Throws InputError where there is nothing to tell apart."""
        svg: str = self._figure().svg()
        return svg

    def save(self, file: Any) -> None:
        """Writes that figure: .svg, .png or .pdf."""
        self._figure().save(path(file, "file"))

    def _figure(self) -> Any:
        from . import _draw

        return _draw.next_roll_figure(_core.next_roll(self._answer, *self._how))

    def _repr_svg_(self) -> Optional[str]:
        return in_a_page(self.to_svg()) if self.prospects else None

    def __repr__(self) -> str:
        if not self.helps:
            return f"<Advice: {self.verdict}; {self.why}>"
        by = rolled(self.length)
        return f"<Advice: {self.verdict}; roll on by {by}, {self.expected_placements:.2f} placements remain>"

    def __reduce__(self) -> Any:
        return (_advice, (self._answer.state(), *self._how))


def rolled(length: Any) -> str:
    """How far the finger rolls on, or each of two."""
    return " and ".join(f"{one:.6g}" for one in length) if isinstance(length, list) else f"{length:.6g}"


def _advice(state: Any, *how: Any) -> Advice:
    return Advice(_core.answer_from_state(*state), *how)
