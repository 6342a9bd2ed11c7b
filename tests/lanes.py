#!/usr/bin/env python3
"""Checks that every test of a build has a lane, so that script/test runs it: none is lost between them.

Usage: lanes.py CTEST BUILD_FOLDER
"""

import json
import subprocess
import sys

# As script/test has them; see tests/CMakeLists.txt.
LANES = {"quick", "witness", "whole", "slow"}


def lanes_of(test):
    properties = {entry["name"]: entry["value"] for entry in test.get("properties", [])}
    return LANES.intersection(properties.get("LABELS", []))


def main():
    ctest, build = sys.argv[1:]
    done = subprocess.run([ctest, "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True)
    # A program that this run does not need is not built, and stands there by its own name.
    tests = [test for test in json.loads(done.stdout)["tests"] if not test["name"].endswith("_NOT_BUILT")]
    lost = [test["name"] for test in tests if len(lanes_of(test)) != 1]
    for name in lost:
        print(f"{name}: expected one label of {', '.join(sorted(LANES))}")
    print(f"{len(tests)} tests, {len(lost)} without a lane")
    return 1 if lost or not tests else 0


if __name__ == "__main__":
    sys.exit(main())
