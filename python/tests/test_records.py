"""The problems of the C++ tests, put to the program and to the package: the same JSON, to the bit."""

import math
import pathlib
import re
import sys

import pytest

import rollfix

RECORDS = pathlib.Path(__file__).resolve().parents[2] / "tests/records"
sys.path.insert(0, str(RECORDS))
sys.dont_write_bytecode = True  # the records are no package of ours

# What Python has under other names, or not at all.
PART_OPTIONS = {"--open": "open", "--smooth": "smooth", "--corner-angle": "corner_angle", "--loop": "loop",
                "--layer": "layer", "--gap": "gap", "--unit": "unit", "--allow-crossing": "allow_crossing"}
SWITCHES = {"--open", "--allow-crossing", "--mirror", "--robust", "--explain", "--json"}


def angle(text):
    return math.radians(float(text[:-3])) if text.endswith("deg") else float(text)


def finger(text, folder):
    if text == "jaw":
        return rollfix.Jaw()
    disk = re.fullmatch(r"disk,r=([-+.e\d]+)", text)
    if disk:
        return rollfix.Disk(float(disk[1]))
    name = text[:-5] if text.endswith(",open") else text
    return rollfix.OutlineFinger(rollfix.Part(path(name, folder), open=text.endswith(",open")))


def path(name, folder):
    return name if name.startswith("gallery:") else str(folder / name)


def noise(text):
    fields = dict(field.split("=") for field in text.split(","))
    return {name: angle(value) for name, value in fields.items()}


def options_of(words):
    """PART and the options, each with its values; nothing of words that are not understood."""
    part, options, k = None, {}, 1
    words = [piece for word in words for piece in (word.split("=", 1) if re.match(r"--[a-z-]+=", word) else [word])]
    while k < len(words):
        if not words[k].startswith("--"):
            part = words[k]
        elif words[k] in SWITCHES:
            options[words[k]] = [True]
        else:
            options.setdefault(words[k], []).append(words[k + 1])
            k += 1
        k += 1
    return part, options


def part_of(name, options, folder):
    given = {}
    for option, keyword in PART_OPTIONS.items():
        if option not in options:
            continue
        value = options[option][0]
        given[keyword] = value if keyword in ("layer", "unit") or value is True else angle(value) \
            if keyword == "corner_angle" else int(value) if keyword == "loop" else float(value)
    return rollfix.Part(path(name, folder), **given)


def half_unit(text):
    """How far the digits may be off, as the program takes it: whole numbers are exact."""
    decimals = re.fullmatch(r"[-+]?\d*\.(\d+)(?:e([-+]?\d+))?", text.replace("deg", ""))
    return 0.5 * 10.0 ** (int(decimals[2] or 0) - len(decimals[1])) if decimals and float(text.replace("deg", "")) else 0


def rounding(readings):
    """Of a length: what lets a finger stop where it meets something, though its digits say farther."""
    finest = [min(filter(None, map(half_unit, text.split(","))), default=0) for text in readings]
    return max(half * text.count(",") for half, text in zip(finest, readings))


def arguments_of(options, document, folder):
    """As of `Part.locate`. The numbers of readings are those that the program understood."""
    given = {}
    if "--log" in options:
        logs = [str(folder / name) for name in options["--log"]]
        given["log"] = logs[0] if len(logs) == 1 else tuple(logs)
    else:
        given["readings"] = [reading["length"] + [reading["turn"]] for reading in document["readings"]]
        if "--noise" not in options:
            given["tolerance"] = document["tolerance"]
            given["rounding"] = (rounding(options["--reading"]), 0)
        if document.get("facing") is not None:
            given["facing"] = document["facing"]
    if "--finger" in options:
        given["finger"] = [finger(text, folder) for text in options["--finger"]]
    for option, keyword, read in (("--noise", "noise", noise), ("--columns", "columns", str), ("--roll", "roll", int),
                                  ("--tolerance", "tolerance", angle), ("--direction", "direction", str),
                                  ("--budget", "budget", lambda text: int(float(text)))):
        if option in options:
            given[keyword] = read(options[option][0])
    for option, keyword in (("--at", "at"), ("--prior", "prior"), ("--heading", "heading"), ("--pose", "pose")):
        if option in options:
            given[keyword] = [angle(text) for text in options[option][0].split(",")]
    given["mirrored"] = "--mirror" in options
    given["robust"] = "--robust" in options
    return given


def is_for_python(problem):
    words = problem.words
    return (words[0] == "locate" and "--json" in words and "--march" not in words and problem.stdin is None
            and not any(re.search(r"\d(mm|cm|in)\b|/h|sqrt", word) for word in words) and "-" not in words)


def chosen(slow):
    from problems import all_problems

    groups = ("1/", "2/")  # what has readings and rolls
    fitting = [problem for problem in all_problems() if problem.id.startswith(groups) and is_for_python(problem)]
    return fitting if slow else fitting[3::37]


def pytest_generate_tests(metafunc):
    problems = chosen(metafunc.config.getoption("--slow"))
    metafunc.parametrize("problem", problems, ids=[problem.id for problem in problems])


def test_python_says_what_the_program_says(problem, program, tmp_path):
    for name, data in problem.files.items():
        (tmp_path / name).write_bytes(data)
    name, options = options_of(problem.words)
    try:
        expected = program(*problem.words, cwd=tmp_path)
    except RuntimeError as refused:
        with pytest.raises((rollfix.InputError, KeyError, ValueError)):
            part = part_of(name, options, tmp_path)
            readings = [[angle(number) for number in text.split(",")] for text in options.get("--reading", [])]
            document = {"readings": [{"length": row[:-1], "turn": row[-1]} for row in readings], "tolerance": 1e-6}
            part.locate(**arguments_of(options, document, tmp_path))
        assert str(refused)
        return
    given = arguments_of(options, expected, tmp_path)
    if given.get("direction") == "cw" and "readings" in given:
        given["readings"] = [[-length for length in row[:-1]] + row[-1:] for row in given["readings"]]
    found = part_of(name, options, tmp_path).locate(**given).to_dict(explain="--explain" in options)
    expected["part"]["name"] = found["part"]["name"]  # the package is asked by a whole path
    assert found == expected
