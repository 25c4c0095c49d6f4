#!/usr/bin/env python3
"""Tests of tolerances.py: constants without a reason are found, and explained ones are not."""

import unittest

import tolerances


def names_in(text):
    """Returns the names of the constants without a reason."""
    return [name for _, name in tolerances.unexplained(text)]


class Tolerances(unittest.TestCase):
    """Claims about the check."""

    def test_a_constant_without_a_reason_is_found(self):
        """Covers decimal and hexadecimal literals, namespaces and functions."""
        for value in ("1e-9", "0x1p-40", "0.5", "1.0 + 0x1p-20", "0x1p-18F"):
            self.assertEqual(names_in(f"/// Margin of a box.\nconstexpr double kMargin = {value};\n"), ["kMargin"], value)
        self.assertEqual(names_in("{\n    constexpr double kMuch = 0.1;  // of all\n"), ["kMuch"])

    def test_a_comment_of_other_code_does_not_count(self):
        """Only the comment directly above counts."""
        text = "/// Local: a limit.\nint f();\n\nconstexpr double kMargin = 1e-9;\n"
        self.assertEqual(names_in(text), ["kMargin"])

    def test_explained_constants_pass(self):
        """The comment may have several lines and several constants."""
        text = "/// Margins. Local, because only the\n/// cost depends on them.\nconstexpr double kA = 1e-9;\nconstexpr float kB = 0.5F;\n"
        self.assertEqual(names_in(text), [])
        self.assertEqual(names_in("constexpr double kHalf = 0.5;  // Local: a scale\n"), [])
        self.assertEqual(names_in("/// A mathematical constant.\nconstexpr double kTwoPi = 6.28;\n"), [])

    def test_whole_numbers_and_names_pass(self):
        """Sizes of blocks and aliases are no tolerances."""
        self.assertEqual(names_in("constexpr std::size_t kBlock = 256;\nconstexpr double kNever = kInfinity;\n"), [])


if __name__ == "__main__":
    unittest.main()
