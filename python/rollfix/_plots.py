"""What notebooks show, and figures by matplotlib."""

from __future__ import annotations

import base64
import html
from typing import TYPE_CHECKING, Any, Dict

import numpy as np

from ._core import InputError
from ._messages import shown

if TYPE_CHECKING:
    from ._answer import Answer
    from ._logs import Log
    from ._part import Part

MOST_ROWS = 30


def plot_part(part: "Part", ax: Any, style: Dict[str, Any]) -> Any:
    ax = _axes(ax)
    outline = part.samples()
    ax.plot(outline["x"], outline["y"], **{"label": part.name, **style})
    _in_the_plane(ax, part)
    return ax


def plot_log(log: "Log", ax: Any, style: Dict[str, Any]) -> Any:
    """All columns but the times, of increments their sums, by the time or by the row."""
    ax = _axes(ax)
    has_time = "time" in log.columns
    along = log["time"] if has_time else np.arange(len(log))
    sums = {"distance": "length", "dturn": "turn"}
    for name in log.columns:
        if name == "time":
            continue
        base, _, finger = name.partition("_")
        shown_name = sums.get(base, base) + (f"_{finger}" if finger else "")
        ax.plot(along, log[shown_name], **{"label": shown_name, **style})
    ax.set_xlabel("time [s]" if has_time else "row")
    ax.set_title(log.name)
    ax.legend()
    return ax


def plot_answer(answer: "Answer", ax: Any, style: Dict[str, Any]) -> Any:
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
            own = {"linewidth": 2, "alpha": 0.25 + 0.75 * probability, "color": f"C{number % 10}", **style}
            (drawn,) = ax.plot(line[:, 0], line[:, 1], **own)
            ax.plot(*placement.point[k], "o", markersize=5, color=drawn.get_color(), alpha=drawn.get_alpha())
            name = f"{number}" if answer.fingers == 1 else f"{number}{'ab'[k]}"
            ax.annotate(name, placement.point[k], textcoords="offset points", xytext=(5, 5), fontsize=8)
    ax.set_title(answer.verdict)
    _in_the_plane(ax, part)
    return ax


def _in_the_plane(ax: Any, part: "Part") -> None:
    ax.set_aspect("equal")
    ax.set_xlabel(f"x{_unit(part.unit)}")
    ax.set_ylabel(f"y{_unit(part.unit)}")


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
