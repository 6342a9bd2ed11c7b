"""What notebooks show."""

from __future__ import annotations

import base64
import html
from typing import TYPE_CHECKING, Any

import numpy as np

from ._core import InputError
from ._messages import shown

if TYPE_CHECKING:
    from ._answer import Answer

MOST_ROWS = 30


def plot_answer(answer: "Answer", ax: Any = None) -> Any:
    ax = _axes(ax)
    part = answer.part
    outline = part.samples()
    ax.plot(outline["x"], outline["y"], color="0.75", linewidth=1)
    for number, placement in enumerate(answer):
        probability = 1.0 if placement.probability is None else placement.probability
        for k in range(answer.fingers):
            travelled = answer.readings[-1, k]
            s = placement.start[k] + np.linspace(0, travelled, 100)
            line = part.point(s)
            strength = 0.25 + 0.75 * probability
            (drawn,) = ax.plot(line[:, 0], line[:, 1], linewidth=2, alpha=strength, color=f"C{number % 10}")
            ax.plot(*placement.point[k], "o", markersize=5, color=drawn.get_color(), alpha=strength)
            name = f"{number}" if answer.fingers == 1 else f"{number}{'ab'[k]}"
            ax.annotate(name, placement.point[k], textcoords="offset points", xytext=(5, 5), fontsize=8)
    ax.set_aspect("equal")
    ax.set_title(answer.verdict)
    ax.set_xlabel(f"x{_unit(part.unit)}")
    ax.set_ylabel(f"y{_unit(part.unit)}")
    return ax


def _axes(given: Any) -> Any:
    if given is None:
        import matplotlib.pyplot as plt

        return plt.subplots()[1]
    if all(hasattr(given, name) for name in ("plot", "annotate", "set_aspect", "set_title")):
        return given
    several = f"an array of {given.size}: give one of them" if isinstance(given, np.ndarray) else shown(given)
    raise InputError(f"ax: expected matplotlib axes, found {several}")


def answer_html(answer: "Answer") -> str:
    """The verdict, the figure and the table."""
    columns = answer._columns()
    head = "".join(f"<th>{html.escape(name)}</th>" for name in columns)
    rows = []
    for k in range(min(len(answer), MOST_ROWS)):
        cells = "".join(f"<td>{_cell(values[k])}</td>" for values in columns.values())
        rows.append(f"<tr><th>{k}</th>{cells}</tr>")
    more = f"<p>... and {len(answer) - MOST_ROWS} more</p>" if len(answer) > MOST_ROWS else ""
    picture = base64.b64encode(answer.to_svg().encode()).decode()
    table = f"<table><thead><tr><th></th>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>" if rows else ""
    notes = "".join(f"<p>{html.escape(note)}</p>" for note in answer.notes)
    return (
        f"<p><b>{html.escape(answer.verdict)}</b></p>{notes}{table}{more}"
        f'<img alt="{html.escape(answer.verdict)}" src="data:image/svg+xml;base64,{picture}">'
    )


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "" if value is None else html.escape(value) if isinstance(value, str) else f"{value:.6g}"


def _unit(unit: str) -> str:
    return f" [{unit}]" if unit else ""
