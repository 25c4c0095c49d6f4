#!/usr/bin/env python3
"""Tests the judgement of cost.py on planted costs."""

import unittest

import cost


class Verdict(unittest.TestCase):
    """A cost is judged against the committed one."""

    def test_a_cost_within_the_tolerance_passes(self) -> None:
        for measured in (9701, 10000, 10299):
            self.assertEqual(cost.verdict(measured, 10000), "")

    def test_a_dearer_unit_of_work_fails(self) -> None:
        self.assertIn("dearer", cost.verdict(10301, 10000))

    def test_a_cheaper_unit_of_work_asks_for_an_update(self) -> None:
        self.assertIn("cheaper", cost.verdict(9699, 10000))

    def test_the_table_has_every_case_of_each_toolchain(self) -> None:
        table = cost.read_table()
        names = [case.name for case in cost.cases()]
        for tools in {key[0] for key in table}:
            self.assertEqual(sorted(names), sorted(key[1] for key in table if key[0] == tools))


if __name__ == "__main__":
    unittest.main()
