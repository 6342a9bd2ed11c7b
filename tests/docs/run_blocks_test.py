#!/usr/bin/env python3
"""Does run_blocks.py see what is wrong with a document? Needs no rollfix."""

import argparse
import pathlib
import sys
import tempfile
import unittest

import run_blocks


def failures_of(text, update=False):
    """The failures that run_blocks finds in a document; with `update` also the document afterwards."""
    with tempfile.TemporaryDirectory() as directory:
        document = pathlib.Path(directory) / "document.md"
        document.write_text(text)
        options = argparse.Namespace(program=f"{directory}/rollfix", prefix=directory, compile="c++ -std=c++20",
                                     python=sys.executable, python_path=directory)
        corrections = []
        failures = run_blocks.check_document(document, options, corrections)
        if update:
            run_blocks.update_document(document, corrections)
            return failures, document.read_text()
        return failures


def sh(*lines):
    return "\n".join(["Some prose.", "", "```sh", *lines, "```", "", "More prose.", ""])


def python(*lines):
    return "\n".join(["Some prose.", "", "```python", *lines, "```", "", "More prose.", ""])


class Python(unittest.TestCase):
    def test_a_session_that_prints_what_it_says_passes(self):
        self.assertEqual(failures_of(python(">>> 1 + 1", "2") + python(">>> x = 3", ">>> x", "3")), [])

    def test_the_blocks_are_one_session(self):
        self.assertEqual(failures_of(python(">>> x = 3") + python(">>> x", "3")), [])

    def test_other_output_is_shown_with_its_line(self):
        (failure,) = failures_of(python(">>> 1 + 1", "3"))
        self.assertIn("Got:", failure)
        self.assertIn("line 4", failure)

    def test_what_is_no_python_is_found(self):
        (failure,) = failures_of(python("x = = 3"))
        self.assertIn("invalid syntax", failure)


class Commands(unittest.TestCase):
    def test_the_right_output_passes(self):
        self.assertEqual(failures_of(sh("$ echo one; echo two", "one", "two", "$ true")), [])

    def test_a_wrong_output_is_shown_with_its_line(self):
        (failure,) = failures_of(sh("$ echo one", "two"))
        self.assertIn("line 4", failure)
        self.assertIn("-two", failure)
        self.assertIn("+one", failure)

    def test_a_missing_and_a_superfluous_line_are_seen(self):
        self.assertEqual(len(failures_of(sh("$ printf 'a\\nb\\n'", "a"))), 1)
        self.assertEqual(len(failures_of(sh("$ echo a", "a", "b"))), 1)

    def test_dots_stand_for_any_lines(self):
        self.assertEqual(failures_of(sh("$ seq 9", "1", "...", "8", "9", "...")), [])
        self.assertEqual(len(failures_of(sh("$ seq 9", "1", "...", "10"))), 1)

    def test_dots_inside_a_line_stand_for_themselves(self):
        self.assertEqual(len(failures_of(sh("$ echo abc", "a..."))), 1)

    def test_a_failing_command_is_seen_unless_its_status_is_shown(self):
        self.assertIn("exits with 3", failures_of(sh("$ (echo why >&2; exit 3)"))[0])
        self.assertIn("why", failures_of(sh("$ (echo why >&2; exit 3)"))[0])
        self.assertEqual(failures_of(sh("$ (exit 3)", "$ echo $?", "3")), [])
        self.assertEqual(len(failures_of(sh("$ (exit 3)", "$ echo $?", "2"))), 1)

    def test_a_command_that_does_not_exist_is_seen(self):
        self.assertIn("exits with 127", failures_of(sh("$ no-such-program"))[0])

    def test_commands_go_on_over_lines(self):
        self.assertEqual(failures_of(sh("$ cat <<END", "> one", "> END", "one")), [])

    def test_blocks_share_a_directory(self):
        self.assertEqual(failures_of(sh("$ echo one > file") + sh("$ cat file", "one")), [])

    def test_commands_that_are_not_run_are_still_checked(self):
        self.assertEqual(failures_of(sh("git clone somewhere", "script/test")), [])
        self.assertEqual(len(failures_of(sh("script/no-such-script"))), 1)
        self.assertEqual(len(failures_of(sh("if then"))), 1)

    def test_update_writes_what_was_printed(self):
        failures, text = failures_of(sh("$ seq 2", "1", "$ echo a", "a", "$ echo b"), update=True)
        self.assertEqual(len(failures), 1)
        self.assertEqual(text, sh("$ seq 2", "1", "2", "$ echo a", "a", "$ echo b", "b"))


class OtherBlocks(unittest.TestCase):
    def test_json_is_parsed(self):
        self.assertEqual(failures_of('```json\n{"a": [1]}\n```\n'), [])
        self.assertEqual(failures_of('```json\n{"a": 1}\n{"a": 2}\n```\n'), [])
        self.assertEqual(len(failures_of('```json\n{"a": }\n```\n')), 1)

    def test_other_names_of_a_tested_language_are_refused(self):
        self.assertEqual(len(failures_of("```bash\n$ true\n```\n")), 1)
        self.assertEqual(len(failures_of("```C++\nint i;\n```\n")), 1)

    def test_text_is_left_alone(self):
        self.assertEqual(failures_of("```text\n$ false\n```\n\n```\n$ false\n```\n"), [])

    def test_a_block_in_a_list_is_found(self):
        self.assertEqual(len(failures_of("* item\n\n  ```sh\n  $ false\n  ```\n")), 1)

    def test_a_block_without_end_is_seen(self):
        self.assertIn("no end", failures_of("```sh\n$ true\n")[0])

    def test_an_excerpt_stands_in_its_file(self):
        name = "tests/docs/run_blocks_test.py"

        def excerpt(*lines, file=name):
            return failures_of("\n".join([f"<!-- from: {file} -->", "```cpp", *lines, "```", ""]))

        self.assertEqual(excerpt("class OtherBlocks(unittest.TestCase):", "def test_json_is_parsed(self):"), [])
        self.assertEqual(excerpt("import argparse", "...", "import unittest"), [])
        self.assertIn("has no line `int i;`", excerpt("class OtherBlocks(unittest.TestCase):", "int i;")[0])
        self.assertIn("one after the other", excerpt("import argparse", "import unittest")[0])
        self.assertIn("there is no", excerpt("int i;", file="tests/docs/none.cpp")[0])

    def test_an_output_without_a_program_is_seen(self):
        self.assertEqual(len(failures_of("<!-- output -->\n```text\nresult\n```\n")), 1)


class Programs(unittest.TestCase):
    """C++ blocks, with a library that is nothing but a header."""

    def check(self, text):
        with tempfile.TemporaryDirectory() as directory:
            prefix = pathlib.Path(directory)
            (prefix / "include/tiny").mkdir(parents=True)
            (prefix / "include/tiny/tiny.hpp").write_text("#include <cstdio>\ninline int answer() { return 42; }\n")
            (prefix / "lib/pkgconfig").mkdir(parents=True)
            (prefix / "lib/pkgconfig/tiny.pc").write_text(
                f"Name: tiny\nDescription: tiny\nVersion: 1\nCflags: -I{prefix}/include\n")
            (prefix / "document.md").write_text(text)
            options = argparse.Namespace(program=f"{directory}/rollfix", prefix=directory, compile="c++ -std=c++20",
                                     python=sys.executable, python_path=directory)
            return run_blocks.check_document(prefix / "document.md", options, [])

    def test_a_program_is_run_and_its_output_compared(self):
        program = '```cpp\n#include "tiny/tiny.hpp"\nint main() { std::printf("%d\\n", answer()); }\n```\n'
        self.assertEqual(self.check(program), [])
        self.assertEqual(self.check(program + "It prints\n\n<!-- output -->\n```text\n42\n```\n"), [])
        self.assertEqual(len(self.check(program + "<!-- output -->\n```text\n43\n```\n")), 1)

    def test_a_program_that_fails_is_seen(self):
        self.assertIn("exits with 7", self.check("```cpp\nint main() { return 7; }\n```\n")[0])

    def test_a_fragment_is_compiled_with_what_is_given(self):
        self.assertEqual(self.check("```cpp\n#include <vector>\nstd::vector<int> all{answer()};\n```\n"), [])
        fragment = "```cpp\nx = answer();\n```\n"
        self.assertIn("x", self.check(fragment)[0])
        self.assertEqual(self.check("<!-- given: int x = 0; -->\n" + fragment), [])


if __name__ == "__main__":
    unittest.main()
