#!/usr/bin/env python3
"""Compiles and runs the example at the head of each public header, as it is installed.

A head is the comment before a header's first #include; lines that begin with `//     ` are its example, all of which stand in
one program, each in a function of its own. A line such as

    found.placements.size();  // 4

is a claim: the value is printed (numbers with six digits, text in quotes) and has to be what the comment says.

Usage: header_examples.py --prefix build/release/prefix [--compile "c++ -std=c++20"] [--keep FILE]
"""

import argparse
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import run_blocks

CLAIM = re.compile(r"^(?P<expression>.*\S);\s+// (?P<said>\"[^\"]*\"|true|false|-?[0-9.]+(e[+-]?[0-9]+)?)$")
WITHOUT = {"cpp20.hpp", "error.hpp", "rollfix.hpp", "version.hpp"}  # of which others' examples make use
PREAMBLE = """#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <sstream>
#include <string>
using namespace rollfix;
static int failures = 0;
template <class Value>
static void claim(const char* where, const Value& value, const std::string& said) {
  std::ostringstream shown;
  shown << std::boolalpha << std::setprecision(6);
  if constexpr (std::is_convertible_v<Value, std::string>) {
    shown << '"' << value << '"';
  } else {
    shown << value;
  }
  if (shown.str() == said) return;
  std::cerr << where << ": the example says " << said << ", found " << shown.str() << "\\n";
  ++failures;
}
"""


def example_of(header):
    """Numbers and texts of an example's lines."""
    head = header.read_text().split("#include")[0].split("\n")
    return [(k + 1, line[len("//     "):]) for k, line in enumerate(head) if line.startswith("//     ")]


def function_of(name, lines):
    body = []
    for number, line in lines:
        where = f"include/rollfix/{name}:{number}"
        claim = CLAIM.match(line)
        if claim:
            said = claim["said"].replace("\\", "\\\\").replace('"', '\\"')
            line = f'claim("{where}", ({claim["expression"]}), "{said}");'
        body += [f'#line {number} "{name}"', line]
    return ["static void example_of_" + name.replace(".", "_") + "() {", *body, "}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--prefix", required=True)
    parser.add_argument("--compile", default="c++ -std=c++20")
    parser.add_argument("--keep", help="where to leave the program's source")
    options = parser.parse_args()
    headers = sorted((pathlib.Path(options.prefix) / "include/rollfix").glob("*.hpp"))
    with tempfile.TemporaryDirectory() as folder:
        compiler = run_blocks.Compiler(shlex.split(options.compile), options.prefix, pathlib.Path(folder))
        source, names = compiler.headers() + [PREAMBLE], []
        for header in headers:
            lines = example_of(header)
            if header.name not in WITHOUT:
                if not lines:
                    sys.exit(f"include/rollfix/{header.name}: expected an example in its head, found none")
                source += function_of(header.name, lines)
                names.append("example_of_" + header.name.replace(".", "_"))
        source += ["int main() {", "  try {", *(f"    {name}();" for name in names), "  } catch (const std::exception& error) {",
                   '    std::cerr << "an example throws: " << error.what() << "\\n";', "    return 1;", "  }",
                   "  return failures == 0 ? 0 : 1;", "}"]
        path = pathlib.Path(options.keep or f"{folder}/examples.cpp")
        path.write_text("\n".join(source) + "\n")
        program = f"{folder}/examples"
        if subprocess.run([*compiler.command, "-w", str(path), "-o", program, *compiler.flags]).returncode != 0:
            sys.exit("an example does not compile, see above")
        # What an example writes goes into the scratch folder.
        environment = dict(os.environ, TMPDIR=folder)
        sys.exit(subprocess.run([program], cwd=run_blocks.REPOSITORY, env=environment).returncode)


if __name__ == "__main__":
    main()
