#!/usr/bin/env python3
"""Tests of retired_names.py."""

import unittest

import retired_names

TABLE = {"LoadBook": "ImpulseRecorder", "take_up": "apply_correction"}


class RetiredNames(unittest.TestCase):
    """Claims about the check of identifiers."""

    def test_retired_identifiers_are_found_in_code_and_comments(self):
        """The message names the line and the replacement."""
        text = "LoadBook book;\n\n/// See take_up().\n"
        expected = ["1: found LoadBook, expected ImpulseRecorder", "3: found take_up, expected apply_correction"]
        self.assertEqual(list(retired_names.findings(text, TABLE)), expected)

    def test_identifiers_that_contain_a_retired_one_are_allowed(self):
        """Only whole identifiers count."""
        self.assertEqual(list(retired_names.findings("int take_upper = LoadBooks();\n", TABLE)), [])


if __name__ == "__main__":
    unittest.main()
