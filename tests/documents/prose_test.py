#!/usr/bin/env python3
"""Tests of prose.py: sentences with planted faults are found in every kind of text, and good sentences are not."""

import unittest

import prose


def rules_in(path, text):
    """Returns the broken rules of a text, as a file of this name."""
    result = prose.Result()
    prose.examine(path, text, result)
    return [rule for finding in result.findings for rule in finding.rules]


class Prose(unittest.TestCase):
    """Claims about the checker."""

    def test_headless_clauses_are_found_in_comments(self):
        """Covers whole lines, trailing comments and documentation comments."""
        for text in ("// Skips what sleeps on walls.\n", "int a;  ///< of what the walls are\n", "/// Finds what moves here.\n"):
            self.assertIn("what", rules_in("a.cpp", text), text)

    def test_odd_openings_are_found(self):
        """A condition or possessor must not stand before the subject."""
        for text in ("// Of all the particles here.\n", "// Where it ends the step stops.\n", "// Those in contact are kept.\n"):
            self.assertEqual(rules_in("a.h", text), ["opening"], text)

    def test_odd_conditions_are_found(self):
        """The word "where" is for places only."""
        for text in ("/// True where it touches a wall.\n", "// It stays at the begin of the step.\n", "// The step ends where there is a wall.\n"):
            self.assertEqual(rules_in("a.h", text), ["odd"], text)
        self.assertEqual(rules_in("a.h", "}  // namespace of what\n"), [])

    def test_long_sentences_are_found_across_lines(self):
        """Lines of one comment form one text."""
        words = " ".join(["word"] * 13)
        self.assertEqual(rules_in("a.h", f"// {words}\n// {words}.\n"), ["long"])

    def test_names_of_tests_are_read_as_sentences(self):
        """A name in camel case is split into words."""
        self.assertIn("what", rules_in("a.cpp", "TEST(Suite, KeepsWhatItHasFound) {}\n"))

    def test_literals_and_docstrings_are_read(self):
        """Messages and docstrings are prose, too."""
        self.assertIn("what", rules_in("a.cpp", 'fail("this is what the file lacks");\n'))
        self.assertIn("what", rules_in("a.py", 'def f():\n    """Returns what the file lacks."""\n'))

    def test_tables_and_lists_are_read(self):
        """Cells and items are texts of their own, and code is not read."""
        self.assertIn("what", rules_in("a.md", "| key | what the key of it does |\n|---|---|\n"))
        self.assertIn("opening", rules_in("a.md", "text\n- Of the two keys one wins.\n"))
        self.assertEqual(rules_in("a.md", "```\nOf what is this a line\n```\n"), [])

    def test_plain_sentences_pass(self):
        """Neither subjects first nor questions in backquotes are findings."""
        self.assertEqual(rules_in("a.h", "/// Returns the time of impact, in seconds, or nothing.\n"), [])
        self.assertEqual(rules_in("a.md", "The option `--what` prints the state of the run.\n"), [])

    def test_shares_are_limited(self):
        """One finding in a hundred sentences is above the limit of openings."""
        result = prose.Result()
        prose.examine("a.h", "// The step ends here.\n\n" * 99 + "// Of the step nothing is left.\n", result)
        self.assertEqual(result.broken_limits(), ["opening"])


if __name__ == "__main__":
    unittest.main()
