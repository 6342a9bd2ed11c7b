#!/usr/bin/env python3
"""Runs every fenced block of a Markdown document as a test.

    sh      Lines that start with `$ ` are commands (`> ` continues one); what follows is their exact output on
            stdout, where a line `...` stands for any lines. Every command must succeed, unless the next one is
            `echo $?`. All blocks of a document share one scratch directory, where `data` and `examples` are the
            repository's; the program and the built examples are found by their names. A block without `$ ` is not run: its syntax is checked, and that the scripts it names exist.
    cpp     A program (it has a main) is built and run and must exit with 0; a fragment is compiled inside a
            function, after all of the library's headers and the document's earlier includes.
            <!-- given: CODE --> on the line before a fragment puts CODE in front of it.
            <!-- from: FILE --> on the line before a block makes it an excerpt: its lines stand in that file of the
            repository, but for their indent, one after the other or with `...` between; they are not compiled.
            <!-- output --> on the line before the next block of any language makes that the program's exact output.
    python  A session: lines that start with `>>> ` (`... ` continues one) and what they print, as doctest has it; all
            blocks of a document are one session. A block without `>>> ` that imports rollfix is a program of its own
            and must exit with 0; <!-- output --> works for it as well. Of any other the syntax is checked.
    json    Must be JSON, or one JSON value per line.
Other languages are not run.

Usage: run_blocks.py [--update] --program build/release/rollfix --prefix build/release/prefix DOCUMENT...
--update writes the outputs that commands really gave into the document.
"""

import argparse
import difflib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
ALIASES = {"py": "python", "bash": "sh", "shell": "sh", "console": "sh", "zsh": "sh", "c++": "cpp", "cxx": "cpp", "jsonc": "json"}
TIMEOUT = 300  # seconds for one block


class Failure(Exception):
    """A block that does not do what the document says; the message tells where and what."""


@dataclass
class Block:
    language: str
    first_line: int  # line number of its first content line, from 1
    lines: list
    given: str = ""
    is_output: bool = False
    source: str = ""


@dataclass
class Command:
    text: str
    line: int
    expected: list = field(default_factory=list)
    expected_line: int = 0


def parse_blocks(text):
    """The fenced blocks of a Markdown document, in order."""
    blocks, lines, i = [], text.split("\n"), 0
    given, is_output, source = "", False, ""
    while i < len(lines):
        fence = re.match(r"^( *)(`{3,}|~{3,}) *([^\s`{]*)", lines[i])
        comment = re.match(r"^\s*<!--\s*(?:given:(?P<given>.*)|from:\s*(?P<source>\S+)|(?P<output>output))\s*-->\s*$", lines[i])
        if fence:
            indent, mark, language = fence.groups()
            start = i = i + 1
            while i < len(lines) and not re.match(rf"^ *{re.escape(mark)}{mark[0]}* *$", lines[i]):
                i += 1
            if i == len(lines):
                raise Failure(f"line {start}: this block has no end")
            content = [re.sub(rf"^ {{0,{len(indent)}}}", "", line) for line in lines[start:i]]
            blocks.append(Block(language.lower(), start + 1, content, given, is_output, source))
            given, is_output, source = "", False, ""
        elif comment:
            given, is_output, source = comment["given"] or "", bool(comment["output"]), comment["source"] or ""
        elif lines[i].strip():
            given, is_output, source = "", False, ""
        i += 1
    return blocks


def matches(expected, actual):
    """Whether the lines agree; an expected line `...` stands for any number of lines."""
    pattern = "".join(r"(?:.*\n)*?" if line.strip() == "..." else re.escape(line.rstrip()) + "\n" for line in expected)
    return re.fullmatch(pattern, "".join(line.rstrip() + "\n" for line in actual)) is not None


def difference(expected, actual):
    lines = difflib.unified_diff(expected, actual, "in the document", "really printed", lineterm="", n=3)
    return "\n".join("    " + line for line in lines)


def output_lines(text):
    return text[:-1].split("\n") if text.endswith("\n") else text.split("\n") if text else []


# --- sh ---------------------------------------------------------------------------------------------------------------


def parse_commands(block):
    commands, continuing = [], False
    for number, line in enumerate(block.lines, block.first_line):
        if line.startswith("$ "):
            commands.append(Command(line[2:], number, expected_line=number + 1))
        elif not commands:
            raise Failure(f"line {number}: text before the first `$ ` of a sh block")
        elif line.startswith("> ") and continuing:
            commands[-1].text += "\n" + line[2:]
            commands[-1].expected_line = number + 1
        else:
            commands[-1].expected.append(line)
        continuing = line.startswith("$ ") or (continuing and line.startswith("> "))
    return commands


def check_unrun_commands(block):
    """A block of commands that a test can't run, such as `git clone`: what can be checked without running it."""
    text = "\n".join(block.lines) + "\n"
    syntax = subprocess.run(["bash", "-n"], input=text, capture_output=True, text=True)
    if syntax.returncode != 0:
        raise Failure(f"line {block.first_line}: not a shell command: {syntax.stderr.strip()}")
    for name in re.findall(r"(?:^|[\s;&|])(?:\./)?(script/[\w-]+)", text):
        if not os.access(REPOSITORY / name, os.X_OK):
            raise Failure(f"line {block.first_line}: there is no program {name}")


def run_commands(commands, scratch, environment):
    """Runs them in one shell; returns (stdout, stderr, status) of each."""
    logs = pathlib.Path(tempfile.mkdtemp(dir=scratch.parent))
    script = []
    for i, command in enumerate(commands):
        script.append(f"{{ {command.text}\n}} > {logs}/{i}.out 2> {logs}/{i}.err < /dev/null")
        script.append(f"__status=$?; echo $__status > {logs}/{i}.status; (exit $__status)")
    subprocess.run(["bash", "-c", "\n".join(script)], cwd=scratch, env=environment, timeout=TIMEOUT, check=False,
                   stdin=subprocess.DEVNULL)

    def read(name):
        path = logs / name
        return path.read_text(errors="replace") if path.exists() else ""

    return [(read(f"{i}.out"), read(f"{i}.err"), read(f"{i}.status").strip()) for i in range(len(commands))]


def check_commands(block, scratch, environment, corrections):
    if not any(line.startswith("$ ") for line in block.lines):
        return check_unrun_commands(block)
    commands = parse_commands(block)
    results = run_commands(commands, scratch, environment)
    failures = []
    for i, (command, (out, err, status)) in enumerate(zip(commands, results)):
        actual = output_lines(out)
        shows_status = i + 1 < len(commands) and commands[i + 1].text.strip() == "echo $?"
        if status != "0" and not shows_status:
            failures.append(f"line {command.line}: `{command.text}` exits with {status or 'nothing'}:\n"
                            + "\n".join("    " + line for line in output_lines(err) + actual))
        elif not matches(command.expected, actual):
            corrections.append((command.expected_line, len(command.expected), actual))
            failures.append(f"line {command.line}: `{command.text}` prints something else:\n"
                            + difference(command.expected, actual))
    if failures:
        raise Failure("\n".join(failures))


# --- cpp --------------------------------------------------------------------------------------------------------------


class Compiler:
    def __init__(self, command, prefix, scratch):
        self.command, self.prefix, self.scratch = command, pathlib.Path(prefix), scratch
        configs = sorted(self.prefix.glob("lib*/**/pkgconfig/*.pc"))
        if not configs:
            sys.exit(f"run_blocks.py: nothing is installed in {prefix}; run `cmake --install` first")
        environment = dict(os.environ, PKG_CONFIG_PATH=str(configs[0].parent))
        query = ["pkg-config", "--cflags", "--libs"] + [path.stem for path in reversed(configs)]
        self.flags = shlex.split(subprocess.run(query, env=environment, check=True, capture_output=True, text=True).stdout)

    def headers(self):
        root = self.prefix / "include"
        return [f'#include "{path.relative_to(root)}"' for path in sorted(root.rglob("*.hpp"))]

    def run(self, source, block, *options):
        path = self.scratch / "block.cpp"
        path.write_text(source)
        done = subprocess.run(self.command + [str(path), *options, *self.flags], capture_output=True, text=True,
                              timeout=TIMEOUT)
        if done.returncode != 0:
            raise Failure(f"line {block.first_line}: this C++ does not compile:\n{done.stderr.strip()}")


def check_program(block, compiler, scratch, environment):
    """Builds and runs a whole program; returns what it prints."""
    program = scratch.parent / "program"
    compiler.run("\n".join(block.lines) + "\n", block, "-o", str(program))
    done = subprocess.run([str(program)], cwd=scratch, env=environment, capture_output=True, text=True, timeout=TIMEOUT)
    if done.returncode != 0:
        raise Failure(f"line {block.first_line}: this program exits with {done.returncode}:\n{done.stderr}{done.stdout}")
    return done.stdout


def is_preamble(line):
    return re.match(r"\s*(#include|using namespace|namespace \w+ *=)", line) is not None


def check_fragment(block, compiler, preamble):
    """Compiles lines that stand in some function of the reader's."""
    preamble += [line for line in block.lines if is_preamble(line)]
    body = ["" if is_preamble(line) else line for line in block.lines]
    source = compiler.headers() + ["#include <iostream>"] + preamble
    source += ["[[maybe_unused]] static void fragment() {", block.given, f'#line {block.first_line} "document"', *body, "}"]
    compiler.run("\n".join(source) + "\n", block, "-fsyntax-only", "-w")


def check_excerpt(block):
    path = REPOSITORY / block.source
    if not path.exists():
        raise Failure(f"line {block.first_line}: there is no {block.source}")
    whole = [line.strip() for line in path.read_text().split("\n")]
    excerpt = [line.strip() for line in block.lines]
    if not matches(["...", *excerpt, "..."], whole):
        missing = [line for line in excerpt if line != "..." and line not in whole]
        what = f"has no line `{missing[0]}`" if missing else "has these lines, but not one after the other"
        raise Failure(f"line {block.first_line}: {block.source} {what}")


# --- python -----------------------------------------------------------------------------------------------------------


def run_python(code, options, scratch, environment, block):
    environment = dict(environment, PYTHONPATH=str(pathlib.Path(options.python_path).resolve()), MPLBACKEND="Agg",
                       PYTHONDONTWRITEBYTECODE="1")
    done = subprocess.run([options.python, "-c", code], cwd=scratch, env=environment, capture_output=True, text=True,
                          timeout=TIMEOUT)
    if done.returncode != 0:
        raise Failure(f"line {block.first_line}: this Python fails:\n{done.stdout}{done.stderr}")
    return done.stdout


SESSION = """
import doctest, sys
flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
test = doctest.DocTestParser().get_doctest(TEXT, {"__name__": "__main__"}, "document", "document", 0)
runner = doctest.DocTestRunner(optionflags=flags)
runner.run(test)
sys.exit(1 if runner.failures else 0)
"""


def without_python(blocks):
    """Neither the blocks of Python nor their outputs."""
    kept, follows_python = [], False
    for block in blocks:
        follows_python = block.language == "python" or (block.is_output and follows_python)
        if not follows_python:
            kept.append(block)
    return kept


def check_session(blocks, options, scratch, environment):
    """All sessions of a document, one after the other; numbers of lines are the document's."""
    lines = []
    for block in blocks:
        lines += [""] * (block.first_line - 1 - len(lines)) + block.lines
    run_python("TEXT = " + repr("\n".join(lines) + "\n") + SESSION, options, scratch, environment, blocks[0])


# --- documents --------------------------------------------------------------------------------------------------------


def check_json(block):
    text = "\n".join(block.lines)
    try:
        json.loads(text)
    except ValueError as whole:
        try:
            for line in filter(str.strip, block.lines):
                json.loads(line)
        except ValueError:
            raise Failure(f"line {block.first_line}: not JSON: {whole}") from None


def check_document(path, options, corrections):
    """Every failure in one document, as text."""
    failures = []
    with tempfile.TemporaryDirectory(prefix="rollfix-docs-") as directory:
        scratch = pathlib.Path(directory) / "scratch"
        scratch.mkdir()
        for name in ("data", "examples"):
            if (REPOSITORY / name).exists():
                (scratch / name).symlink_to(REPOSITORY / name)
        environment = dict(os.environ, NO_COLOR="1", LC_ALL="C.UTF-8", TERM="dumb", COLUMNS="100")
        build = pathlib.Path(options.program).resolve().parent
        environment["PATH"] = f"{build}:{build}/examples:{environment['PATH']}"
        compiler, preamble, printed = None, [], None
        try:
            blocks = parse_blocks(path.read_text())
        except Failure as failure:
            return [str(failure)]
        sessions = [block for block in blocks if block.language == "python" and any(
            line.startswith(">>> ") for line in block.lines)]
        if not options.python:
            blocks = without_python(blocks)
        for block in blocks:
            try:
                if block.is_output:
                    if printed is None:
                        raise Failure(f"line {block.first_line}: <!-- output --> without a program before it")
                    if not matches(block.lines, output_lines(printed)):
                        corrections.append((block.first_line, len(block.lines), output_lines(printed)))
                        raise Failure(f"line {block.first_line}: the program prints something else:\n"
                                      + difference(block.lines, output_lines(printed)))
                elif block.source:
                    check_excerpt(block)
                elif block.language in ALIASES:
                    raise Failure(f"line {block.first_line}: write `{ALIASES[block.language]}`, not `{block.language}`, "
                                  "so that the block is tested")
                elif block.language == "sh":
                    check_commands(block, scratch, environment, corrections)
                elif block.language == "cpp":
                    compiler = compiler or Compiler(shlex.split(options.compile), options.prefix, scratch.parent)
                    if re.search(r"\bint main\(", "\n".join(block.lines)):
                        printed = None
                        printed = check_program(block, compiler, scratch, environment)
                    else:
                        check_fragment(block, compiler, preamble)
                elif block.language == "json":
                    check_json(block)
                elif block.language == "python" and sessions[:1] == [block]:
                    check_session(sessions, options, scratch, environment)
                elif block.language == "python" and block not in sessions:
                    printed = None
                    code = "\n".join(block.lines)
                    runs = re.search(r"^(import|from) rollfix\b", code, re.MULTILINE)
                    printed = run_python(code if runs else f"compile({code!r}, 'document', 'exec')", options, scratch,
                                         environment, block)
            except Failure as failure:
                failures.append(str(failure))
            except subprocess.TimeoutExpired:
                failures.append(f"line {block.first_line}: took longer than {TIMEOUT} s")
    return failures


def update_document(path, corrections):
    lines = path.read_text().split("\n")
    for first_line, count, actual in sorted(corrections, reverse=True):
        indent = re.match(r" *", lines[first_line - 2])[0]
        lines[first_line - 1 : first_line - 1 + count] = [(indent + line).rstrip() for line in actual]
    path.write_text("\n".join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("documents", nargs="+", type=pathlib.Path)
    parser.add_argument("--program", default=str(REPOSITORY / "build/release/rollfix"))
    parser.add_argument("--prefix", default=str(REPOSITORY / "build/release/prefix"))
    parser.add_argument("--python", default="/usr/bin/python3", help="the interpreter; empty: Python is left out")
    parser.add_argument("--python-path", default=str(REPOSITORY / "build/release/python"), help="where rollfix is")
    parser.add_argument("--compile", default="c++ -std=c++20", help="the compiler and its options")
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()

    failed = False
    for document in options.documents:
        corrections = []
        failures = check_document(document, options, corrections)
        for failure in failures:
            print(f"{document}: {failure}\n")
        if options.update and corrections:
            update_document(document, corrections)
            print(f"{document}: {len(corrections)} outputs updated")
        failed = failed or bool(failures)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
