"""What C++ says in the words of the program and of its files, in those of Python."""

from __future__ import annotations

import math
import re
from typing import Any, Dict, List, Match, Mapping, Optional, Tuple

NUMBER = r"[-+]?[\d.]+(?:e[-+]?\d+)?"
_RADIUS = rf"(?:{NUMBER}|RADIUS)"
_FINGERS = re.compile(rf"(?:--finger|`finger`) disk,r={_RADIUS}(?: (?:--finger|`finger`) disk,r={_RADIUS})*")
_NOISE = re.compile(r"(?:--noise|`noise`) (\w+=[^,\s]+(?:,\w+=[^,\s]+)*)")
_COLUMNS = re.compile(r'(?:--columns|`columns`) (?:"(\w+=[^"]*)"|(\w+=\S*[^\s,;:.]))')
_COLUMN = re.compile(r"\b(\w+)=\1:([a-z]+)\b")
_ANGLE = re.compile(rf"`(\w+)` ({NUMBER})deg\b")
_VALUE = re.compile(rf"`(\w+)` ({NUMBER}|N)(?=[\s,;:)]|$)")
_PLAIN = (
    (r"; the part comes first and the log behind --log, .*", "; a log goes to `locate`: part.locate(log=...)"),
    (r"of readings (\d+)deg\b", r"of readings np.radians(\1)"),
    (r"; `skip_bad` leaves such rows out", "; read_log(..., bad='skip') leaves such rows out"),
    (r"`wrapped` no\b", "wrapped=False"),
    (r"`wrapped` yes\b", "wrapped=True"),
    (r"a number without a unit is in radians, degrees are written as in ([\d.]+)deg", r"of degrees make radians: np.radians(\1)"),
    (r"; degrees are written \d+deg", "; of degrees say degrees=True"),
    (r"\(degrees are written as in (\d+)deg\)", r"(of degrees make radians: np.radians(\1))"),
    (r"with `unit`, (?:as in|such as) `unit` (\w+)", r"with unit='\1'"),
    (r", or with :rad where", ", or with 'rad' where"),
    (r"(?<!\S)--mirror\b", "mirrored=True"),
    (r"(?<!\S)--robust\b", "robust=True"),
    (r"(?<!\S)--direction (\w+)\b", r"direction='\1'"),
    (r"(?<!\S)--may-overlap\b", "may_overlap=True"),
    (r"with their unit, as in (\d+)deg\b", r"in radians, as in np.radians(\1)"),
    (r"`decimal_comma`", "decimal=','"),
    (r"([)}']|=True) noise=Noise", r"\1, noise=Noise"),
    (r"`either_way`", "direction"),
    (r"`at_rest`", "roll='all'"),
    (r"`reading` LA,LB,THETA", "`readings` of (La, Lb, theta)"),
    (r"`reading`", "`readings`"),
    (r"`touch`", "`touches`"),
    (r"`fingers`", "`finger`"),
    (r"\bwheel,r=([\d.]+)", r"Wheel(\1)"),
    (r"\bdisk,r=R\b", "Disk(radius)"),
    (r"^`(\w+)`:?(?= (?:is|weighs|compares|goes|picks) |(?<=:) )", r"\1:"),
    (r"(?<!\S)--([a-z]+)", r"\1"),
)


def in_python(text: str) -> str:
    """Options as keyword arguments: '--noise slip=0.04' is noise=Noise(slip=0.04)."""
    text = _FINGERS.sub(_fingers, text)
    text = _NOISE.sub(_noise, text)
    text = _COLUMNS.sub(_columns, text)
    text = _COLUMN.sub(r'units={"\1": "\2"}', text)
    text = _ANGLE.sub(r"\1=np.radians(\2)", text)
    text = _VALUE.sub(r"\1=\2", text)
    for pattern, said in _PLAIN:
        text = re.sub(pattern, said, text)
    return text


def _fingers(found: Match[str]) -> str:
    disks = [f"Disk({radius})" for radius in re.findall(rf"r=({_RADIUS})", found[0])]
    return f"finger={disks[0]}" if len(disks) == 1 else f"finger=({', '.join(disks)})"


def _noise(found: Match[str]) -> str:
    fields = [field.split("=", 1) for field in found[1].split(",")]
    return f"noise=Noise({', '.join(f'{name}={_in_radians(value)}' for name, value in fields)})"


def _in_radians(value: str) -> str:
    return f"{math.radians(float(value[:-3])):.3g}" if re.fullmatch(f"{NUMBER}deg", value) else value


def _columns(found: Match[str]) -> str:
    fields = [re.fullmatch(r"(\w+)=(.*?)(?::([^:]*))?", field) for field in (found[1] or found[2]).split(",")]
    if None in fields:
        return found[0]
    parts: List[Tuple[str, str, Optional[str]]] = [(one[1], one[2], one[3]) for one in fields if one is not None]
    if all(column == name and unit for column, name, unit in parts):
        return "units={" + ", ".join(f'"{column}": "{unit}"' for column, _, unit in parts) + "}"
    named = [f'"{column}": ("{name}", "{unit}")' if unit else f'"{column}": "{name}"' for column, name, unit in parts]
    return f"columns={{{', '.join(named)}}}"


def diagnosis_in_python(found: Optional[Mapping[str, Any]]) -> Optional[Dict[str, Any]]:
    """A diagnosis of the JSON document, its cure as keyword arguments; also of what else it may be."""
    return None if found is None else {name: _value_in_python(value) for name, value in found.items()}


def _value_in_python(value: Any) -> Any:
    if isinstance(value, str):
        return in_python(value)
    if isinstance(value, list):
        return [diagnosis_in_python(one) if isinstance(one, dict) else one for one in value]
    return value


class Numbering:
    """The rows of logs that did not come from files, from 0: C++ counts lines, of the text that a table is made into.

    By name of a log: the lines, from 1, that are headers and no rows.
    """

    __slots__ = ("headers",)

    def __init__(self, headers: Optional[Dict[str, List[int]]] = None) -> None:
        self.headers = headers or {}

    def row(self, line: int, name: Optional[str] = None) -> int:
        """Of the log of this name, without one the first."""
        headers = self.headers[next(iter(self.headers)) if name is None else name]
        return line - 1 - sum(header <= line for header in headers)

    def said(self, message: str) -> str:
        """With rows for lines wherever the message tells of such a log."""
        told = [name for name in self.headers if re.search(_at(name) + r"(?:[:,]| |$)", message)]
        if not told:
            return message
        for name in told:
            message = self._rows_of(name, message)
        about = min(told, key=lambda name: message.index(name))
        message = re.sub(r"\b(in|since) line (\d+)", lambda f: f"{f[1]} row {self.row(int(f[2]), about)}", message)
        return re.sub(r"(number) such as 1\.25(?: \(radians\) or 73deg)?", r"\1", message)

    def _rows_of(self, name: str, message: str) -> str:
        def span(found: Match[str]) -> str:
            return f"{name}, rows {self.row(int(found[1]), name)} to {self.row(int(found[2]), name)}"

        def place(found: Match[str]) -> str:
            log, line, colon = name + found[1], int(found[2]), found[3]
            if line in self.headers[name]:
                return log + colon
            row = self.row(line, name)
            return f"{log}: row {row}:" if colon else f"row {row} of {log}"

        message = re.sub(_at(name) + r", lines (\d+) to (\d+)", span, message)
        message = re.sub(_at(name) + r"((?:, rows \d+ to \d+)?):(\d+)\b(:?)", place, message)
        return re.sub(_at(name) + r", row (\d+)", lambda found: f"{name}: row {int(found[1]) - 1}", message)


def _at(name: str) -> str:
    return rf"(?<![\w./]){re.escape(name)}"
