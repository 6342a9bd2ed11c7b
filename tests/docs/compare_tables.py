#!/usr/bin/env python3
"""Compares the counts in a document's tables with what the benchmark counts.

`rollfix_bench 0` prints the tables with "?" for all that has to be timed; every other word of a table in the document's
`text` blocks must be the same, and no row may be missing on either side.

Usage: compare_tables.py [--update] build/release/rollfix_bench docs/performance.md
--update writes the counts into the document and leaves the times as they are.
"""

import argparse
import pathlib
import re
import subprocess
import sys

WORD = re.compile(r"\(\s*(?:\d+|\?)%\)|\S+")


def words(line):
    return list(WORD.finditer(line))


def filled(counted, documented):
    """The line that was counted, with the document's times for the question marks; None if they are not alike."""
    line, pairs = counted, list(zip(words(counted), words(documented)))
    if len(words(documented)) < len(words(counted)):
        return None
    for ours, theirs in pairs:
        if "?" not in ours.group():
            continue
        if not re.search(r"\d", theirs.group()):
            return None
        width = max(len(ours.group()), len(theirs.group()))
        line = line[:ours.end() - width] + theirs.group().rjust(width) + line[ours.end():]
    return line


def tables_of(lines):
    """Where each row is, by its table's first line and its own name: {(title, name): index}."""
    rows, title = {}, None
    for index, line in enumerate(lines):
        if line.startswith("outline "):
            title = " ".join(line.split())
        elif title and (match := re.match(r"(\S+(?: \S+)*)\s{2,}", line)):
            rows[title, match.group(1)] = index
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=pathlib.Path)
    parser.add_argument("document", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()

    command = [str(arguments.bench.resolve()), "0"]
    counted = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split("\n")
    lines = arguments.document.read_text().split("\n")
    expected, found, wrong = tables_of(counted), tables_of(blocks_only(lines)), []
    for key in sorted(expected.keys() ^ found.keys()):
        wrong.append(f"row \"{key[1]}\" is {'not in the document' if key in expected else 'not counted any more'}: {key[0]}")
    for key in expected.keys() & found.keys():
        line, right = lines[found[key]], filled(counted[expected[key]], lines[found[key]])
        if right is None or right.split() != line.split():
            wrong.append(f"line {found[key] + 1}: {line.strip()}\n  counted: {counted[expected[key]].strip()}")
        if right is not None:
            lines[found[key]] = right
    if arguments.update:
        arguments.document.write_text("\n".join(lines))
    elif wrong:
        print(f"{arguments.document}: expected the counts of `{' '.join(command)}`; `{sys.argv[0]} --update` writes them",
              *sorted(wrong), sep="\n", file=sys.stderr)
        return 1
    if not expected:
        print("no table was counted", file=sys.stderr)
        return 1
    print(f"{len(expected)} rows of {arguments.document} compared")
    return 0


def blocks_only(lines):
    """The lines, those outside of fenced blocks made empty."""
    inside, kept = False, []
    for line in lines:
        inside = inside != line.startswith("```")
        kept.append(line if inside else "")
    return kept


if __name__ == "__main__":
    sys.exit(main())
