#!/usr/bin/env python3
"""Fails if an identifier occurs that was replaced by a term of docs/glossary.md.

Each line of retired_names.txt holds a retired identifier and the one to use instead.
"""

import argparse
import re
import sys
from pathlib import Path
from typing import Dict, Iterator

NAME = re.compile(r"[A-Za-z_]\w*")


def read_table(path: Path) -> Dict[str, str]:
    """Returns the replacement of each retired identifier."""
    return dict(line.split() for line in path.read_text(encoding="utf-8").splitlines() if line)


def findings(text: str, table: Dict[str, str]) -> Iterator[str]:
    """Yields a message for each retired identifier in a text, with its line."""
    for number, line in enumerate(text.splitlines(), 1):
        for name in NAME.findall(line):
            if name in table:
                yield f"{number}: found {name}, expected {table[name]}"


def main() -> int:
    """Prints the findings. Returns 1 if there are any."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folders", nargs="+", type=Path)
    table = read_table(Path(__file__).with_name("retired_names.txt"))
    found = [
        f"{file}:{message}"
        for folder in parser.parse_args().folders
        for file in sorted(folder.rglob("*"))
        if file.suffix in (".h", ".cpp")
        for message in findings(file.read_text(encoding="utf-8"), table)
    ]
    print("\n".join(found) if found else f"No retired identifier of {len(table)} occurs")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
