#!/usr/bin/env python3
"""Compares two records of the same problems, made by record.py of two programs.

    tests/records/compare.py old.json.gz new.json.gz [--tolerance 1e-12] [--only '2/*'] [--show 3]

Lengths agree within the tolerance times the perimeter (modulo the perimeter where closed), angles within it (directions
modulo a full turn), other numbers relative to themselves. Fields may be added. Exit code 0: all agree."""

import argparse
import collections
import fnmatch
import gzip
import json
import math
import re
import sys
from pathlib import Path

PLACES = {"start", "end", "extent", "roots", "mean", "end_mean", "interval", "family", "contact", "arcs", "at", "hits"}
LENGTHS = PLACES | {"error", "sd", "end_sd", "point", "length", "perimeter", "depth", "family_error", "unresolved",
                    "box"}
DIRECTIONS = {"tangent", "facing", "pivot", "angles", "whole"}
ANGLES = DIRECTIONS | {"turn", "residual", "pose", "pose_mean", "pose_residual", "total_turn"}
SHARES = {"probability", "rest", "bits", "share"}  # compared as they stand, not relative to themselves
WORK = {"counts"}  # what the search did, not what it found
NUMBER = re.compile(r"-?\d+\.?\d*(?:[eE][-+]?\d+)?")


class Comparison:
    """The differences of two documents: (path, kind, old, new) each."""

    def __init__(self, document, tolerance):
        part = document.get("part") if isinstance(document, dict) else None
        part = part if isinstance(part, dict) else {}
        self.size = part.get("perimeter") or 1.0
        self.lap = self.size if part.get("closed") else None
        self.tolerance = tolerance
        self.found, self.added, self.work = [], [], False

    def differ(self, path, kind, old, new):
        self.found.append((path, kind, old, new))

    def close(self, path, old, new):
        names = [name for name in path if isinstance(name, str)]
        name = names[-1] if names else ""
        gap, scale = abs(old - new), max(abs(old), abs(new))
        if name in PLACES and self.lap:
            gap = min(gap, abs(gap - self.lap))
        if name in DIRECTIONS:
            gap = abs(math.remainder(gap, 2 * math.pi))
        if name in ("pose", "pose_mean") and path[-1] == 2:
            return abs(math.remainder(gap, 2 * math.pi)) <= self.tolerance
        if name in LENGTHS:
            scale = max(scale if name == "length" else 0, self.size)
        elif name in ANGLES:
            scale = max(scale, self.size if "pose" in name else 1)
        elif name in SHARES:
            scale = max(scale, 1)
        return gap <= self.tolerance * scale

    def walk(self, path, old, new):
        if path and path[-1] in WORK:
            self.work |= old != new
        elif old is None or new is None or isinstance(old, bool) or isinstance(new, bool):
            if old is not new:
                kind = "null -> value" if old is None else "value -> null" if new is None else "truth"
                self.differ(path, kind, old, new)
        elif isinstance(old, (int, float)) and isinstance(new, (int, float)):
            if not self.close(path, old, new):
                self.differ(path, "number", old, new)
        elif type(old) is not type(new):
            self.differ(path, "type", old, new)
        elif isinstance(old, dict):
            for name in old:
                if name in new:
                    self.walk(path + (name,), old[name], new[name])
                else:
                    self.differ(path + (name,), "field gone", old[name], None)
            self.added += [path + (name,) for name in new if name not in old]
        elif isinstance(old, list):
            self.walk_list(path, old, new)
        elif old != new:
            self.differ(path, "text", old, new)

    def walk_list(self, path, old, new):
        if len(old) != len(new):
            self.differ(path, "count", f"{len(old)} entries", f"{len(new)} entries")
            return
        before = len(self.found)
        for i, (a, b) in enumerate(zip(old, new)):
            self.walk(path + (i,), a, b)
        if len(self.found) > before and path[-1:] == ("placements",) and len(old) > 1:
            other = Comparison({}, self.tolerance)
            other.size, other.lap = self.size, self.lap
            by_start = lambda entry: entry.get("start") or [0]
            for a, b in zip(sorted(old, key=by_start), sorted(new, key=by_start)):
                other.walk((), a, b)
            if not other.found:
                self.found[before:] = [(path, "order", "as listed", "the same in another order")]

    def words(self, path, old, new):
        """Text that people read, and tables: numbers within the tolerance, all else as it stands."""
        if old == new:
            return
        numbers = list(zip(NUMBER.findall(old), NUMBER.findall(new)))
        near = lambda a, b: math.isclose(float(a), float(b), rel_tol=self.tolerance, abs_tol=self.tolerance)
        if NUMBER.sub("#", old) == NUMBER.sub("#", new) and all(near(a, b) for a, b in numbers):
            return
        lines = zip(old.splitlines() + [""], new.splitlines() + [""])
        first = next(((a, b) for a, b in lines if a != b), (old, new))
        self.differ(path, "narration" if path == ("stderr",) else "text", *first)


def documents(text):
    """One JSON document, or one per line; None where it is none."""
    for parse in (lambda: json.loads(text), lambda: [json.loads(line) for line in text.splitlines()]):
        try:
            return parse()
        except ValueError:
            pass
    return None


def compare(old, new, tolerance):
    a, b = documents(old["out"]), documents(new["out"])
    first = a[0] if isinstance(a, list) and a else a
    comparison = Comparison(first, tolerance)
    if old["code"] != new["code"]:
        comparison.differ(("exit code",), f"{old['code']} -> {new['code']}", old["err"] or "-", new["err"] or "-")
    elif isinstance(a, (dict, list)) and isinstance(b, (dict, list)):
        comparison.walk((), a, b)
    else:
        comparison.words(("stdout",), old["out"], new["out"])
    if old["code"] == new["code"]:
        comparison.words(("stderr",), old["err"], new["err"])
    for name in sorted({**old.get("files", {}), **new.get("files", {})}):
        compare_files(comparison, name, old.get("files", {}).get(name, ""), new.get("files", {}).get(name, ""))
    return comparison


def compare_files(comparison, name, old, new):
    """Documents field by field, figures by their words."""
    a, b = documents(old), documents(new)
    if isinstance(a, dict) and isinstance(b, dict):
        comparison.walk((name,), a, b)
    else:
        comparison.words((name,), old, new)


def pattern(path):
    return "".join("[]" if isinstance(step, int) else "." + step for step in path).lstrip(".")


def spelled(path):
    return "".join(f"[{step}]" if isinstance(step, int) else "." + step for step in path).lstrip(".")


def read_record(name):
    return {row["id"]: row for row in json.loads(gzip.decompress(Path(name).read_bytes()))}


class Mended:
    """What differs because a fault was mended: patterns of problems and, where given, of what differs; the reason."""

    def __init__(self, name):
        self.entries = json.loads(Path(name).read_text()) if Path(name).exists() else []
        self.uses = collections.Counter()

    def covers(self, problem, path, kind):
        for i, entry in enumerate(self.entries):
            what = f"{pattern(path)}: {kind}"
            if fnmatch.fnmatchcase(problem, entry["problem"]) and fnmatch.fnmatchcase(what, entry.get("differs", "*")):
                self.uses[i] += 1
                return True
        return False

    def listing(self):
        for i, entry in enumerate(self.entries):
            print(f"  mended, {self.uses[i]} differences of {entry['problem']}: {entry['reason']}")


def shortened(value):
    text = json.dumps(value) if not isinstance(value, str) else value.strip()
    return text if len(text) <= 150 else text[:147] + "..."


def report(kinds, show):
    for (what, kind), cases in sorted(kinds.items(), key=lambda item: -len(item[1])):
        problems = {case[0]: case for case in reversed(cases)}  # the first of each
        print(f"\n{what}: {kind}  ({len(cases)} times in {len(problems)} problems)")
        for problem, path, old, new, command in sorted(problems.values(), key=lambda case: case[0])[:show]:
            print(f"  {problem} {spelled(path)}: {' '.join(command)}\n    - {shortened(old)}\n    + {shortened(new)}")


def verdict(comparison, left, tolerance):
    if left:
        return "differ"
    if comparison.found:
        return "differ as listed in mended.json"
    return f"agree to {tolerance:g}" + (", other work" if comparison.work else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--tolerance", type=float, default=1e-12)
    parser.add_argument("--only", default="*", help="problems whose name fits this pattern")
    parser.add_argument("--mended", default=Path(__file__).with_name("mended.json"))
    parser.add_argument("--show", type=int, default=3, help="examples of each kind of difference")
    options = parser.parse_args()
    old, new, mended = read_record(options.old), read_record(options.new), Mended(options.mended)
    tally, kinds, added = collections.Counter(), collections.defaultdict(list), collections.Counter()
    for problem in sorted(set(old) | set(new)):
        if not fnmatch.fnmatchcase(problem, options.only):
            continue
        a, b = old.get(problem), new.get(problem)
        if not a or not b or a["digest"] != b["digest"]:
            tally["not comparable: asked in one record only, or asked otherwise"] += 1
            continue
        if all(a.get(name) == b.get(name) for name in ("code", "out", "err", "files")):
            tally["identical to the bit"] += 1
            continue
        comparison = compare(a, b, options.tolerance)
        added.update(pattern(path) for path in comparison.added)
        left = [found for found in comparison.found if not mended.covers(problem, found[0], found[1])]
        for path, kind, was, now in left:
            kinds[pattern(path), kind].append((problem, path, was, now, a["command"]))
        tally[verdict(comparison, left, options.tolerance)] += 1
    report(kinds, options.show)
    print()
    for what, count in added.most_common():
        print(f"  field added: {what} ({count} times)")
    mended.listing()
    for what, count in tally.most_common():
        print(f"{count:6} {what}")
    return 1 if any(what.startswith(("differ", "not")) and "mended" not in what for what in tally) else 0


if __name__ == "__main__":
    sys.exit(main())
