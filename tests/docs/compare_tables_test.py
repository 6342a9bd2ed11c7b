#!/usr/bin/env python3
"""Does compare_tables.py see a count that is no longer right, and nothing else?"""

import unittest

import compare_tables

COUNTED = ["outline           W [us]  placements", "wing, 160 points       ?       12.50", "grows as points^?"]


def differs(documented):
    """Which of the lines are not what was counted."""
    rows = zip(COUNTED, documented)
    return [there for here, there in rows
            if not compare_tables.compare(compare_tables.cells_of(here), compare_tables.cells_of(there))[1]]


class CompareTables(unittest.TestCase):
    def test_takes_any_time(self):
        for time in ("4.25 ±3%", "4", "0.0001 ±12%"):
            self.assertEqual(differs([COUNTED[0], f"wing, 160 points   {time}   12.50", "grows as points^0.10"]), [])

    def test_sees_another_count(self):
        row = "wing, 160 points   4.25 ±3%   12.51"
        self.assertEqual(differs([COUNTED[0], row, "grows as points^0.10"]), [row])

    def test_sees_a_row_of_another_name(self):
        row = "wing, 200 points   4.25 ±3%   12.50"
        self.assertEqual(differs([COUNTED[0], row, "grows as points^0.10"]), [row])

    def test_sees_that_a_time_is_missing(self):
        row = "wing, 160 points   ?   12.50"
        self.assertEqual(differs([COUNTED[0], row, "grows as points^0.10"]), [row])

    def test_keeps_times_beside_new_counts(self):
        cells, _ = compare_tables.compare(["wing", "?", "12.50"], ["wing", "4.25 ±3%", "11"])
        self.assertEqual(cells, ["wing", "4.25 ±3%", "12.50"])

    def test_aligns_as_the_benchmarks_do(self):
        rows = [["outline", "W [us]", "placements"], ["wing, 160 points", "?", "12.50"], ["a line of text"]]
        self.assertEqual(compare_tables.aligned(rows).split("\n"), [*COUNTED[:2], "a line of text"])


if __name__ == "__main__":
    unittest.main()
