#!/usr/bin/env python3
"""Compares two builds of the tool byte by byte: every output file of shipped and random scenes.

Runs each scene with both programs: plain, with --verify, and in two halves by --resume. Compares frames, colliders, contacts,
the summary without times and memory, exit codes, and warnings. Checkpoints are left out, because they hold the time that a run has
taken; the resumed runs stand for them. A change that must not
change results keeps the program of the commit before it and shows that nothing differs.
"""

import argparse
import concurrent.futures
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

ROOT = Path(__file__).resolve().parents[2]

# Fields of the summary that differ between two runs of the same program.
VOLATILE = re.compile(r"(seconds|time_wall|wall|memory|bytes|per_second|threads|version|build|host|date|rate_of_work)", re.IGNORECASE)

def without_volatile(value: Any) -> Any:
    """Returns a summary without the fields that measure the run itself."""
    if isinstance(value, dict):
        return {key: without_volatile(entry) for key, entry in value.items() if not VOLATILE.search(key)}
    if isinstance(value, list):
        return [without_volatile(entry) for entry in value]
    return value


def contents(folder: Path) -> Dict[str, bytes]:
    """Returns all files of a run folder by name, the summary without its volatile fields."""
    files = {}
    for file in sorted(folder.rglob("*")):
        if file.is_file() and file.suffix != ".bin":
            data = file.read_bytes()
            if file.name == "summary.json":
                data = json.dumps(without_volatile(json.loads(data)), indent=1).encode()
            files[str(file.relative_to(folder))] = data
    return files


def run(program: str, scene: Path, folder: Path, options: List[str], limit: float) -> Tuple[int, str]:
    """Runs a scene. Returns the exit code and the warnings; the exit code is -1 where the time limit ended the run."""
    command = [program, "run", str(scene), "--output", str(folder), "--quiet", "--threads", "1", *options]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit, check=False)
    except subprocess.TimeoutExpired:
        return -1, ""
    return done.returncode, done.stderr.replace(str(folder), "FOLDER").replace(program, "ricochet")


def shown(data: bytes, at: int) -> str:
    """Returns the bytes around a difference."""
    return repr(data[max(0, at - 30) : at + 30])


def difference(old: Dict[str, bytes], new: Dict[str, bytes]) -> Optional[str]:
    """Returns the first difference between two run folders, or None."""
    if old.keys() != new.keys():
        return f"files {sorted(old.keys() ^ new.keys())} exist in one of them only"
    for name, data in old.items():
        if data != new[name]:
            at = next((k for k, (a, b) in enumerate(zip(data, new[name])) if a != b), min(len(data), len(new[name])))
            return f"{name} differs at byte {at}: {shown(data, at)} and {shown(new[name], at)}"
    return None


class Comparison:
    """Two programs and the limits of their runs."""

    def __init__(self, old: str, new: str, limit: float, planted: List[str]) -> None:
        self.programs = ((old, []), (new, planted))
        self.limit = limit

    def of_runs(self, scene: Path, options: List[str], more: List[List[str]]) -> Optional[str]:
        """Returns the first difference between runs of both programs, with further commands on the same folder."""
        found = []
        for program, planted in self.programs:
            with tempfile.TemporaryDirectory() as work:
                folder = Path(work) / "run"
                said = [run(program, scene, folder, [*extra, *planted], self.limit) for extra in (options, *more)]
                if any(code == -1 for code, _ in said):
                    return "skipped: the time limit ended the run"
                found.append((said, contents(folder) if folder.exists() else {}))
        if found[0][0] != found[1][0]:
            return f"exit codes or messages differ: {found[0][0]} and {found[1][0]}"
        code, message = found[0][0][0]
        if code == 2:  # bad input, such as a mesh that does not exist here
            return f"skipped: both programs refuse the scene: {message.strip()}"
        return difference(found[0][1], found[1][1])

    def of_scene(self, name: str, scene: Path, duration: str) -> List[str]:
        """Returns the differences of all kinds of runs of one scene."""
        length = float(duration or re.findall(r'"duration":\s*([\d.eE+-]+)', scene.read_text(encoding="utf-8"))[0])
        set_length = lambda time: ["--set", "output.contacts=true", "--set", f"simulation.duration={time!r}"]  # noqa: E731
        kinds = {
            "plain": (set_length(length), []),
            "verified": ([*set_length(length), "--verify"], []),
            "resumed": (set_length(0.5 * length), [["--resume", "--extend", repr(length)]]),
        }
        results = []
        for kind, (options, more) in kinds.items():
            found = self.of_runs(scene, options, more)
            if found:
                results.append(f"{name}, {kind}: {found}")
        return results


def shipped_scenes() -> List[Tuple[str, Path, str]]:
    """Returns the shipped scenes and their durations, as the golden tests run them."""
    text = (ROOT / "tests" / "golden" / "shipped_scenes.h").read_text(encoding="utf-8")
    found = re.findall(r'\{"([\w/]+)", "([\d.]*)"\}', text)
    return [(name, ROOT / "scenes" / f"{name}.json", duration) for name, duration in found]


def random_scenes(printer: str, first: int, count: int, folder: Path) -> List[Tuple[str, Path, str]]:
    """Writes random scenes beside links to the meshes that they name."""
    scenes = folder / "scenes"
    scenes.mkdir()
    os.symlink(ROOT / "meshes", folder / "meshes")
    result = []
    for number in range(first, first + count):
        scene = scenes / f"random_{number}.json"
        scene.write_bytes(subprocess.run([printer, str(number)], capture_output=True, check=True).stdout)
        result.append((f"random scene {number}", scene, ""))
    return result


def main() -> int:
    """Prints each difference. Returns 1 if there is one, and 2 for wrong arguments."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--old", required=True, help="program of the commit before the change")
    parser.add_argument("--new", required=True, help="program of the working tree")
    parser.add_argument("--printer", help="print_random_scene of the working tree's build, for random scenes")
    parser.add_argument("--random", type=int, default=0, metavar="N", help="number of random scenes")
    parser.add_argument("--first", type=int, default=0, metavar="N", help="number of the first random scene")
    parser.add_argument("--shipped", action="store_true", help="all shipped scenes")
    parser.add_argument("--only", default="", metavar="NAME", help="the shipped scenes whose name contains this")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--limit", type=float, default=600.0, metavar="S", help="longest time of one run, in seconds")
    parser.add_argument("--planted", metavar="KEY=VALUE", help="a setting of the new program alone, to test this script")
    options = parser.parse_args()
    if options.random and not options.printer:
        parser.error("--random needs --printer")
    programs = [os.path.abspath(shutil.which(program) or program) for program in (options.old, options.new)]
    planted = ["--set", options.planted] if options.planted else []
    comparison = Comparison(programs[0], programs[1], options.limit, planted)
    with tempfile.TemporaryDirectory() as folder:
        scenes = [s for s in shipped_scenes() if options.only in s[0]] if options.shipped or options.only else []
        scenes += random_scenes(options.printer, options.first, options.random, Path(folder)) if options.random else []
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            found = [line for lines in pool.map(lambda s: comparison.of_scene(*s), scenes) for line in lines]
    skipped = [line for line in found if ": skipped" in line]
    for line in found:
        print(line, flush=True)
    print(f"{len(scenes)} scenes, three runs each: {len(found) - len(skipped)} differences, {len(skipped)} skipped")
    return 1 if len(found) > len(skipped) else 0


if __name__ == "__main__":
    sys.exit(main())
