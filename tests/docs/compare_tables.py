#!/usr/bin/env python3
"""Compares the counts in a document's tables with what the benchmarks count.

A table stands between `<!-- bench: NAME -->` and `<!-- /bench -->`. `NAME --counts` prints it with "?" for all that has to
be timed: every other cell must be the same, and no row may be missing on either side.

Usage: compare_tables.py [--update] build/release/bench docs/performance.md
--update writes the counts into the document and leaves the times as they are.
"""

import argparse
import pathlib
import re
import subprocess
import sys

# Whose counts take no more than some seconds: the counted_benchmarks of bench/CMakeLists.txt.
COUNTED = ["one_finger", "two_fingers", "points", "answers", "readings", "files", "watch"]
TIME = re.compile(r"-?\d[\d.]*( ±\d+%)?")


def counted(folder, name):
    done = subprocess.run([str(folder.resolve() / name), "--counts"], capture_output=True, text=True, check=True)
    return done.stdout.rstrip().split("\n")


def place_of(text, name):
    """Where the table is in the text."""
    match = re.search(rf"<!-- bench: {name} -->\n.*?```text\n(.*?)\n```\n<!-- /bench -->", text, re.DOTALL)
    return match.span(1) if match else None


def cells_of(line):
    return re.split(r" {2,}", line)


def is_alike(own, theirs):
    """Whether a counted cell is the document's, times aside."""
    return re.fullmatch(re.escape(own).replace(r"\?", TIME.pattern), theirs) is not None


def compare(own, theirs):
    """A row's cells with the document's times, and whether it is right."""
    if len(own) != len(theirs):
        return own, False
    alike = [is_alike(*pair) for pair in zip(own, theirs)]
    return [there if "?" in here and same else here for here, there, same in zip(own, theirs, alike)], all(alike)


def aligned(rows):
    """As the benchmarks print them: two blanks between columns, names to the left, numbers to the right."""
    widths = {}
    for row in rows:
        for column, cell in enumerate(row if len(row) > 1 else []):
            widths[column] = max(widths.get(column, 0), len(cell))
    return "\n".join("  ".join([row[0].ljust(widths[0]) if len(row) > 1 else row[0],
                                *(cell.rjust(widths[k]) for k, cell in enumerate(row[1:], 1))]) for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("document", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()

    text, failed, compared = arguments.document.read_text(), [], 0
    for name in COUNTED:
        place = place_of(text, name)
        if place is None:
            failed.append(f"there is no table of {name}")
            continue
        own, theirs = counted(arguments.programs, name), text[slice(*place)].split("\n")
        if len(own) != len(theirs):
            failed.append(f"table of {name}: {len(theirs)} lines, {len(own)} are counted")
        theirs += [""] * (len(own) - len(theirs))
        rows = [compare(cells_of(line), cells_of(documented)) for line, documented in zip(own, theirs)]
        failed += [f"document: {documented}\n counted: {line}"
                   for line, documented, (_, right) in zip(own, theirs, rows) if not right]
        compared += len(own)
        text = text[:place[0]] + aligned([cells for cells, _ in rows]) + text[place[1]:]
    if arguments.update:
        arguments.document.write_text(text)
    elif failed:
        print(f"{arguments.document}: expected what `{arguments.programs}/NAME --counts` prints; `{sys.argv[0]} --update` "
              "writes it", *failed, sep="\n", file=sys.stderr)
        return 1
    print(f"{compared} lines of {arguments.document} compared")
    return 0


if __name__ == "__main__":
    sys.exit(main())
