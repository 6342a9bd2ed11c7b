#!/usr/bin/env python3
"""Does bench/instructions.py see a query that takes more instructions than before, and nothing else?"""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
import instructions  # noqa: E402


def passes(now, before):
    return instructions.judge("query", now, before)[1]


class Instructions(unittest.TestCase):
    def test_more_than_5_percent_above_fails(self):
        self.assertFalse(passes(1051, 1000))

    def test_a_little_more_passes(self):
        self.assertTrue(passes(1050, 1000))

    def test_less_passes_and_says_so(self):
        line, does_pass = instructions.judge("query", 900, 1000)
        self.assertTrue(does_pass)
        self.assertIn("--update", line)

    def test_a_query_that_is_not_in_the_file_fails(self):
        self.assertFalse(passes(1000, None))

    def test_a_query_that_is_gone_fails(self):
        self.assertFalse(passes(None, 1000))

    def test_what_is_written_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "counts.txt"
            instructions.write(file, {"one": 1, "two": 20})
            self.assertEqual(instructions.read(file), {"one": 1, "two": 20})


if __name__ == "__main__":
    unittest.main()
