#!/usr/bin/env python3
"""Finds floating-point constants of the library whose comment does not say why they are local.

Tolerances that decide the motion are in core/tolerances.h and the files that it includes. The comment of any other
constant contains the word "Local" and a reason, or calls it a mathematical or physical constant.
"""

import re
import sys
from pathlib import Path
from typing import Iterator, Tuple

CONSTANT = re.compile(r"\s*(?:template\s*<[^>]*>\s*)?(?:inline |static )*constexpr [\w:]+ k[A-Z]\w*")
FLOATING = re.compile(r"constexpr (?:double|float) (k[A-Z]\w*)(?:<\w+>)?\s*=[^;]*(?:\d\.\d|\de[-+]?\d|\dp[-+]?\d)")
REASON = re.compile(r"\b(?:Local|[Cc]onstants?)\b")


def unexplained(text: str) -> Iterator[Tuple[int, str]]:
    """Yields line numbers and names of the constants without a reason. A comment counts for all constants below it."""
    lines = text.split("\n")
    for number, line in enumerate(lines):
        found = FLOATING.search(line.split("//")[0])
        if not found:
            continue
        begin = number
        while begin > 0 and (CONSTANT.match(lines[begin - 1]) or re.match(r"\s*template\s*<", lines[begin - 1])):
            begin -= 1
        while begin > 0 and lines[begin - 1].lstrip().startswith("//"):
            begin -= 1
        comments = [text.partition("//")[2] for text in lines[begin : number + 1]]
        if not REASON.search(" ".join(comments)):
            yield number + 1, found.group(1)


def main() -> int:
    """Prints the constants without a reason below a source folder. Returns 1 if there are any."""
    root = Path(sys.argv[1])
    count = 0
    for path in sorted(root.rglob("*")):
        if path.suffix not in (".h", ".cpp") or path.is_relative_to(root / "core" / "tolerances"):
            continue
        for line, name in unexplained(path.read_text(encoding="utf-8")):
            print(f"{path}:{line}: {name} is not in core/tolerances, and its comment does not say why it is local")
            count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
