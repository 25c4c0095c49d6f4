#!/usr/bin/env python3
"""Fails if a unit of work costs more instructions than the committed table allows.

Each case runs twice on one thread under valgrind, with little and with much work. The difference of the instruction
counts, divided by the difference of the work, is the cost of one unit. It does not depend on the load of the machine.

The counts belong to a compiler, to versions of Embree and TBB, and to the vector instructions of the processor. The
table has rows for each such toolchain. Without rows for the present one, the test says so and is skipped.

A change that makes a case dearer by more than the tolerance must update the table (--update) and give the reason in its
commit. A case that has become cheaper by more than the tolerance is reported too, so that the gain is kept.
"""

import argparse
import csv
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, Iterator, List, NamedTuple, Tuple

ROOT = Path(__file__).resolve().parents[2]
TABLE = Path(__file__).with_name("costs.csv")
TOLERANCE = 0.03
SKIPPED = 77

Scene = Dict[str, Any]


class Case(NamedTuple):
    """Two scenes that differ in their work, and the count in the summary that measures it."""

    name: str
    unit: str
    little: Scene
    much: Scene


def mesh_scene(mesh: str, step: float, duration: float, **keys: Any) -> Scene:
    """Returns a scene with one mesh of the project, without output before the end."""
    collider: Scene = {"name": "wall", "type": "mesh", "file": str(ROOT / "meshes" / mesh), "material": "wall"}
    collider.update(keys.pop("collider", {}))
    scene: Scene = {
        "ricochet": 1,
        "simulation": {
            "time_step": step,
            "duration": duration,
            "seed": 11,
            "integrator": keys.pop("integrator", "ballistic"),
        },
        "materials": {"wall": keys.pop("material", {"restitution": 1})},
        "colliders": [collider],
        "output": {"every": 1000000},
    }
    scene.update(keys)
    return scene


def source(count: int, **keys: Any) -> List[Scene]:
    """Returns an emitter inside the tube of the torus knot that starts `count` particles at once."""
    ball = {"name": "source", "type": "sphere", "center": [1.42, 0, 0], "radius": 0.08}
    return [{**ball, "burst": count, "speed": [2, 0.1], **keys}]


def fall(count: int, **keys: Any) -> List[Scene]:
    """Returns an emitter above the bowl that starts `count` particles at once."""
    disk = {"name": "fall", "type": "disk", "center": [0, 0, 1.5], "normal": [0, 0, -1], "radius": 0.5}
    return [{**disk, "burst": count, "speed": 0.1, **keys}]


GRAVITY = {"type": "gravity", "acceleration": [0, 0, -9.81]}


def knot_case(
    name: str, unit: str, counts: Tuple[int, int], step: float, duration: float, radius: float = 0.0, **keys: Any
) -> Case:
    """Returns a case in the torus knot whose work grows with the number of particles."""
    size = {"particle_radius": radius} if radius > 0.0 else {}
    scenes = [mesh_scene("torus_knot.obj", step, duration, **{**keys, "emitters": source(n, **size)}) for n in counts]
    return Case(name, unit, *scenes)


def bowl_case(name: str, friction: float, **emitter: Any) -> Case:
    """Returns a case in the bowl whose work grows with the duration."""
    material = {"restitution": 0.3, "friction": friction}
    keys: Scene = {"material": material, "forces": [GRAVITY], "emitters": fall(60, **emitter)}
    scenes = [mesh_scene("bowl.obj", 0.005, duration, **keys) for duration in (1.0, 1.4)]
    return Case(name, "particle_steps", *scenes)


def gas_case() -> Case:
    """Returns elastic spheres in a closed box of planes, at a packing of 0.1."""
    count, radius = 800, 0.01
    side = (count * 4.18879 * radius**3 / 0.1) ** (1.0 / 3.0)
    walls: List[Scene] = []
    for axis in range(3):
        for sign in (-1, 1):
            normal = [sign if k == axis else 0 for k in range(3)]
            point = [-0.5 * side * n for n in normal]
            plane = {"name": f"wall {axis} {sign}", "type": "plane", "normal": normal, "point": point}
            walls.append({**plane, "material": "wall"})

    def scene(steps: int) -> Scene:
        gas = mesh_scene("box.obj", 0.01, 0.01 * steps)
        gas["colliders"] = walls
        gas["particle_contacts"] = {"restitution": 1, "friction": 0}
        box = {"name": "gas", "type": "box", "center": [0, 0, 0], "size": [0.95 * side] * 3, "burst": count}
        gas["emitters"] = [{**box, "speed": [1, 0.5], "cone": 180, "particle_radius": radius}]
        return gas

    return Case("impact of two spheres in a gas", "pair_impacts", scene(2), scene(8))


def cases() -> Iterator[Case]:
    """Yields all cases. The names are keys of the table."""
    drag: Scene = {"forces": [GRAVITY, {"type": "drag", "coefficient": 0.05}], "integrator": "midpoint"}
    spin: Scene = {"type": "spin", "axis": [0, 0, 1], "rate": 20}
    turning: Scene = {"frames": {"turn": {"motions": [spin]}}, "collider": {"frame": "turn"}}
    yield knot_case("free flight", "particle_steps", (10, 810), 0.002, 0.2)
    yield knot_case("flight with drag", "particle_steps", (10, 410), 0.002, 0.2, **drag)
    yield knot_case("bounce of a point, straight", "contacts", (1, 200), 4, 12)
    yield knot_case("bounce of a sphere, straight", "contacts", (1, 60), 4, 12, radius=0.005)
    yield knot_case("bounce of a point, parabola", "contacts", (1, 100), 0.5, 6, forces=[GRAVITY])
    yield knot_case("bounce on a mesh that turns", "contacts", (1, 50), 0.5, 6, **turning)
    yield bowl_case("step of a point that slides", 0.05)
    yield bowl_case("step of a sphere that rolls", 0.2, particle_radius=0.01)
    yield gas_case()


def instructions(program: str, scene: Scene) -> Tuple[int, Scene]:
    """Runs a scene under valgrind. Returns the instruction count and the run's summary."""
    with tempfile.TemporaryDirectory() as work:
        file = Path(work) / "scene.json"
        file.write_text(json.dumps(scene), encoding="utf-8")
        folder = Path(work) / "run"
        command = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
        command += [program, "run", str(file), "--output", str(folder), "--threads", "1", "--quiet"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        found = re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)
        if done.returncode != 0 or not found:
            raise SystemExit(f"the run under valgrind failed:\n{done.stderr[-2000:]}")
        return int(found[1].replace(",", "")), json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def cost(program: str, case: Case) -> int:
    """Returns the instructions of one unit of a case's work."""
    (few, small), (many, large) = instructions(program, case.little), instructions(program, case.much)
    return round((many - few) / (int(large[case.unit]) - int(small[case.unit])))


def toolchain(program: str, compiler: str) -> str:
    """Returns the compiler, the libraries and the vector instructions that determine the counts."""
    lines = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()
    libraries = [line for line in lines if line.startswith(("Embree", "TBB"))]
    flags = Path("/proc/cpuinfo").read_text(encoding="utf-8").split()
    vectors = "AVX2" if "avx2" in flags else "SSE4.2" if "sse4_2" in flags else "SSE2"
    return ", ".join([compiler, *libraries, vectors])


def read_table() -> Dict[Tuple[str, str], int]:
    """Returns the committed cost of each toolchain and case."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return {(row["toolchain"], row["case"]): int(row["instructions"]) for row in csv.DictReader(file)}


def write_table(table: Dict[Tuple[str, str], int]) -> None:
    """Replaces the table. Rows are sorted."""
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["toolchain", "case", "instructions"])
        writer.writerows((*key, value) for key, value in sorted(table.items()))


def verdict(measured: int, committed: int) -> str:
    """Returns an empty text if a cost is within the tolerance of the committed one, else the reason for failure."""
    if measured > committed * (1.0 + TOLERANCE):
        return "dearer: find the cause, or update the table and give the reason"
    if measured < committed * (1.0 - TOLERANCE):
        return "cheaper: update the table, so that the gain is kept"
    return ""


def main() -> int:
    """Compares or updates. Returns 0 if all costs are as committed, 1 if not, and 77 if the test is skipped."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", required=True, help="the tool, built for release")
    parser.add_argument("--compiler", required=True, help="name and version of its compiler")
    parser.add_argument("--update", action="store_true", help="write the measured costs into the table")
    parser.add_argument("case", nargs="*", help="part of a case's name; all cases if none is given")
    arguments = parser.parse_args()
    if shutil.which("valgrind") is None:
        print("skipped: valgrind is not installed")
        return SKIPPED
    table = read_table() if TABLE.exists() else {}
    tools = toolchain(arguments.program, arguments.compiler)
    if not arguments.update and not any(key[0] == tools for key in table):
        print(f"skipped: the table has no costs for {tools}; add them with --update")
        return SKIPPED
    failed = False
    for case in cases():
        if arguments.case and not any(part in case.name for part in arguments.case):
            continue
        measured = cost(arguments.program, case)
        committed = table.get((tools, case.name))
        reason = verdict(measured, committed) if committed is not None else "not in the table"
        print(f"{measured:9d}  (table: {committed})  {case.name}, one of {case.unit}  {reason}", flush=True)
        table[tools, case.name] = measured
        failed = failed or reason != ""
    if arguments.update:
        write_table(table)
        return 0
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
