"""What the program can Python can: the table in docs/python.md is true and whole."""

import pathlib
import re
import subprocess

import pytest

import rollfix

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = (REPOSITORY / "docs/python.md").read_text()
TABLE = DOCUMENT[DOCUMENT.index("## What the program can") : DOCUMENT.index("## Notebooks")]
ROWS = re.findall(r"^\| `([^`]+)` \| (.+) \|$", TABLE, re.MULTILINE)
OF_THE_PROGRAM_ALONE = {"completion", "demo", "man", "paper"}


def of_python(name):
    found = rollfix
    for part in name.split("."):
        found = getattr(found, part)
    return found


@pytest.mark.parametrize("command, names", ROWS)
def test_what_stands_beside_a_command_is_there(command, names, program):
    for name in re.findall(r"`([^`]+)`", names):
        assert of_python(name).__doc__, name
    words = [word for word in command.split() if not word.startswith("--")]
    help_text = subprocess.run([program.path, *words, "--help"], capture_output=True, text=True, check=True).stdout
    for option in re.findall(r"--[\w-]+", command):
        assert option in help_text


def test_every_command_stands_in_the_table(program):
    help_text = subprocess.run([program.path, "--help"], capture_output=True, text=True, check=True).stdout
    commands = re.search(r"Commands:\n((?:  .*\n)+)", help_text)[1]
    names = {line.split()[0] for line in commands.splitlines() if re.match(r"  \w", line)}
    assert names and names - {command.split()[0] for command, _ in ROWS} <= OF_THE_PROGRAM_ALONE
