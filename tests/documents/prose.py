#!/usr/bin/env python3
"""Finds sentences that break the style rules of CONTRIBUTING.md, and limits their share.

Reads comments of C++, Python, JavaScript, CMake and shell files, and docstrings. Also reads string literals that are
sentences, names of tests, and the text and tables of Markdown files.
"""

import argparse
import ast
import io
import os
import re
import sys
import tokenize
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, Iterator, List, Tuple

# Openings that stand in for a noun, or that put the condition or the possessor before the subject.
OPENING = re.compile(
    r"(What|Of|By what|By whom|By those|By which|The same of|The same;|The same with|The same for|Those|Such as|Whom|Whose|Who|Whoever|As what|"
    r"Where|Where what|That which|That of|That where|What's|None of what|Nor)\b"
)
WHAT = re.compile(r"\bwhat\b", re.IGNORECASE)
CHAIN = re.compile(
    r"\b(those that|those of|of what|by what|than what|that which|such as do|as does what|of whom|of whose|which thus)\b",
    re.IGNORECASE,
)
# Conditions in the place of a place, and nouns and prepositions of an older English.
ODD = re.compile(
    r"^(?:True|False|Null|Nothing|0) where\b|\bwhere (?:it|they|there|that|nothing|none) (?:is|are|was|were|does|do|has|have)\b"
    r"|\bthe begin\b|\bbegin of\b|, but for\b|\bnor are so\b"
)
MOST_WORDS = 25

# Largest share of sentences, in percent, that may break a rule.
LIMITS = {"opening": 0.5, "chain": 0.5, "what": 1.0, "odd": 0.5, "long": 3.0}

SKIPPED_FOLDERS = {"third_party", "build", ".git", "__pycache__", "node_modules"}
WORD = re.compile(r"[A-Za-z][A-Za-z'\-]*")
CAMEL = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
TEST = re.compile(r"^\s*(?:TEST|TEST_F|TEST_P|TYPED_TEST)\s*\(\s*(\w+)\s*,\s*(\w+)\s*\)")
STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')

Text = Tuple[int, str]


@dataclass
class Finding:
    """A sentence that breaks rules."""

    file: str
    line: int
    rules: List[str]
    sentence: str


@dataclass
class Result:
    """Counts of sentences and of broken rules."""

    sentences: int = 0
    counts: Dict[str, int] = field(default_factory=lambda: dict.fromkeys(LIMITS, 0))
    findings: List[Finding] = field(default_factory=list)

    def share(self, rule: str) -> float:
        """Returns the share of sentences that break a rule, in percent."""
        return 100.0 * self.counts[rule] / max(1, self.sentences)

    def broken_limits(self) -> List[str]:
        """Returns the rules that more sentences break than allowed."""
        return [rule for rule, limit in LIMITS.items() if self.share(rule) > limit]


def joined_blocks(lines: Iterator[Text]) -> Iterator[Text]:
    """Joins texts on consecutive lines."""
    start, last, block = 0, -1, []
    for number, text in lines:
        if block and number != last + 1:
            yield start, " ".join(block)
            block = []
        if not block:
            start = number
        block.append(text)
        last = number
    if block:
        yield start, " ".join(block)


def test_names(text: str) -> Iterator[Text]:
    """Yields the claims that names of GoogleTest tests make, as words."""
    for number, line in enumerate(text.split("\n"), 1):
        found = TEST.match(line)
        if found:
            yield number, " ".join(CAMEL.findall(found.group(2))) + "."


def literals(text: str) -> Iterator[Text]:
    """Yields string literals of C++ and JavaScript; the compiler's concatenation of neighbours is followed."""
    parts: List[Text] = []
    goes_on = False
    for number, line in enumerate(text.split("\n"), 1):
        if line.lstrip().startswith(("//", "#include", "*")):
            continue
        end = 0
        for found in STRING.finditer(line):
            if goes_on and not line[end : found.start()].strip():
                parts[-1] = (parts[-1][0], parts[-1][1] + found.group(1))
            else:
                parts.append((number, found.group(1)))
            goes_on, end = True, found.end()
        goes_on = goes_on and not line[end:].strip()
    for number, literal in parts:
        if len(WORD.findall(literal)) >= 4:
            yield number, literal.replace("\\n", " ").replace('\\"', "'")


def cpp_comments(text: str) -> Iterator[Text]:
    """Yields comments: blocks of whole lines, and those behind code."""
    whole, behind = [], []
    for number, line in enumerate(text.split("\n"), 1):
        found = re.match(r"\s*(?://[/!]?<?|/\*\*?!?|\*(?!/))\s?(.*)", line)
        if found:
            whole.append((number, found.group(1)))
            continue
        trailing = re.search(r'(?:^|[^:"])//[/!]?<?\s(.*)', line)
        if trailing and not trailing.group(1).startswith("namespace"):
            behind.append((number, trailing.group(1)))
    yield from joined_blocks(iter(whole))
    yield from behind


def python_texts(text: str) -> Iterator[Text]:
    """Yields comments and all strings of a Python file that are sentences."""
    comments = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            comments.append((token.start[0], token.string.lstrip("#! ")))
    yield from joined_blocks(iter(comments))
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and len(WORD.findall(node.value)) >= 4:
            yield node.lineno, node.value
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            yield node.lineno, node.name[5:].replace("_", " ").capitalize() + "."


def hash_comments(text: str) -> Iterator[Text]:
    """Yields comments of CMake and shell files."""
    found = ((n, re.match(r"\s*#+!?\s?(.*)", line)) for n, line in enumerate(text.split("\n"), 1))
    yield from joined_blocks((n, match.group(1)) for n, match in found if match)


def markdown(text: str) -> Iterator[Text]:
    """Yields paragraphs, items of lists and cells of tables."""
    block, start, fenced = [], 0, False
    for number, line in enumerate(text.split("\n") + [""], 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            continue
        stripped = line.strip()
        is_table = stripped.startswith("|")
        ends = fenced or not stripped or is_table or line.startswith("    ") or stripped.startswith(("#", "!"))
        if (ends or re.match(r"([-*]|\d+\.)\s", stripped)) and block:
            yield start, " ".join(block)
            block = []
        if is_table and not re.fullmatch(r"[|:\- ]+", stripped):
            for cell in re.split(r"(?<!\\)\|", stripped.strip("|")):
                yield number, cell.strip() + "."
        if ends:
            continue
        if not block:
            start = number
        block.append(re.sub(r"^([-*]|\d+\.)\s+", "", stripped))


def texts_of(path: str, text: str) -> Iterator[Text]:
    """Yields all texts of a file with the numbers of their lines."""
    ending = os.path.splitext(path)[1]
    if ending == ".md":
        yield from markdown(text)
    elif ending == ".py":
        yield from python_texts(text)
    elif ending in (".h", ".cpp", ".js"):
        yield from cpp_comments(text)
        yield from literals(text)
        yield from test_names(text)
    else:
        yield from hash_comments(text)


def sentences_of(block: str) -> Iterator[str]:
    """Splits a text into sentences of at least three words. Code in backquotes counts as one word."""
    plain = re.sub(r"`[^`]*`", "Code", block)
    plain = re.sub(r"\]\([^)]*\)", "]", plain)
    for sentence in re.split(r"(?<=[.:;!?])\s+", plain):
        if len(WORD.findall(sentence)) >= 3:
            yield sentence


def broken_rules(sentence: str) -> List[str]:
    """Returns the rules that a sentence breaks."""
    checks = {
        "opening": OPENING.match(sentence),
        "chain": CHAIN.search(sentence),
        "what": WHAT.search(sentence),
        "odd": ODD.search(sentence),
        "long": len(WORD.findall(sentence)) > MOST_WORDS,
    }
    return [rule for rule, broken in checks.items() if broken]


def examine(path: str, text: str, result: Result) -> None:
    """Adds the sentences of one file to a result."""
    for line, block in texts_of(path, text):
        for sentence in sentences_of(block):
            result.sentences += 1
            rules = broken_rules(sentence)
            for rule in rules:
                result.counts[rule] += 1
            if rules:
                result.findings.append(Finding(path, line, rules, sentence))


def files_below(path: str) -> Iterator[str]:
    """Yields a file, or the files of a folder that hold prose."""
    if os.path.isfile(path):
        yield path
        return
    for folder, folders, names in os.walk(path):
        folders[:] = sorted(name for name in folders if name not in SKIPPED_FOLDERS)
        for name in sorted(names):
            is_script = "." not in name and os.path.basename(folder) == "scripts"
            if is_script or os.path.splitext(name)[1] in (".h", ".cpp", ".js", ".py", ".md", ".cmake", ".sh") or name == "CMakeLists.txt":
                yield os.path.join(folder, name)


def main() -> int:
    """Prints findings and shares. Returns 1 if a share is above its limit and --check is given."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--summary", action="store_true", help="print only the shares")
    parser.add_argument("--check", action="store_true", help="exit code 1 if a share is above its limit")
    parser.add_argument("--skip", action="append", default=[], metavar="PATH", help="leave a file or folder out")
    parser.add_argument("paths", nargs="+")
    options = parser.parse_args()
    result = Result()
    for path in options.paths:
        for file in files_below(path):
            if not any(Path(file).is_relative_to(skipped) for skipped in options.skip):
                examine(file, Path(file).read_text(encoding="utf-8", errors="replace"), result)
    broken = result.broken_limits()
    for finding in result.findings:
        if not options.summary and (not options.check or set(finding.rules) & set(broken)):
            print(f"{finding.file}:{finding.line}: {','.join(finding.rules)}: {finding.sentence[:200]}")
    shares = ", ".join(f"{rule} {result.counts[rule]} ({result.share(rule):.1f} %, limit {LIMITS[rule]} %)" for rule in LIMITS)
    print(f"{result.sentences} sentences; {shares}")
    return 1 if options.check and broken else 0


if __name__ == "__main__":
    sys.exit(main())
