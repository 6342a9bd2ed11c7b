"""Answers that C++ draws and proves: the part in the world, and a certificate that there is nothing else."""

from __future__ import annotations

import json
from typing import Any, Callable, Dict, Optional

from . import _core
from ._checks import least, path, text, whole
from ._documents import Listing
from ._messages import in_a_page, warn


def proof(answer: Any, file: Any, budget: Optional[int], where: str) -> Dict[str, Any]:
    """The certificate of an answer of `_core`, written as well if `file` is given. `where`: what says what is left open."""
    most = None if budget is None else whole(budget, "budget", 1)
    document, is_complete = answer.certificate(most)
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
        return proof(self._answer, file, budget, "`unresolved`, or sets without `first`, say where")

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
        return figure(self._answer, text(title, "title"), least(width, "width", 0, "a number of pixels"))

    def _repr_svg_(self) -> Optional[str]:
        return in_a_page(self.to_svg())

    def __reduce__(self) -> Any:
        return (_again, (type(self), self._part, *self._question.state()))


def _again(kind: Callable[..., Proved], part: _core.Part, fingers: Any, state: Any) -> Proved:
    """The answer to the same question, worked out again."""
    question = _core.question_from_state(part, fingers, state)
    return kind(part, question, question.solve())
