#!/usr/bin/env python3
"""Writes one loose cloud of spheres for all compared programs.

cloud.py filling COUNT FOLDER    spheres over a bin of 0.2 m.
cloud.py hopper COUNT FOLDER     spheres over the funnel meshes/funnel.obj.

Radii are 5 mm plus or minus a fifth, and the density is 2500 kg/m^3. Positions are lattice points with random offsets.
The offsets are small enough that no program starts with an overlap. Writes cloud.csv (Ricochet), cloud.data (LAMMPS:
id, type, diameter, density, position) and cloud.txt (YADE: position and radius).
"""
import math
import pathlib
import random
import sys

PITCH = 0.0132  # in m; the largest diameter is 0.012
DENSITY = 2500.0  # kg/m^3
BIN = 0.1  # half the bin's width, in m
FUNNEL_SCALE = 0.2  # because the funnel's mesh is in metres


def places(kind, count):
    """Yields lattice points in layers from below: a square lattice over the bin, a round one in the funnel's mouth."""
    half = 7 if kind == "filling" else 8
    lowest = 0.007 if kind == "filling" else 0.30
    layer = 0
    while True:
        for i in range(-half, half):
            for j in range(-half, half):
                x, y = (i + 0.5) * PITCH, (j + 0.5) * PITCH
                if kind == "filling" or math.hypot(x, y) < 0.105:
                    yield x, y, lowest + layer * PITCH
                    count -= 1
                    if count == 0:
                        return
        layer += 1


def cloud(kind, count):
    random.seed(1)
    for x, y, z in places(kind, count):
        radius = random.uniform(0.004, 0.006)
        shift = [random.uniform(-1, 1) * (PITCH / 2 - radius) * 0.99 for _ in range(3)]
        yield x + shift[0], y + shift[1], z + shift[2], radius


def write(kind, spheres, folder):
    with open(folder / "cloud.csv", "w") as out:
        out.write("x,y,z,radius,mass\n")
        for x, y, z, r in spheres:
            out.write(f"{x:.17g},{y:.17g},{z:.17g},{r:.17g},{DENSITY * 4 / 3 * math.pi * r**3:.17g}\n")
    with open(folder / "cloud.txt", "w") as out:
        for x, y, z, r in spheres:
            out.write(f"{x:.17g} {y:.17g} {z:.17g} {r:.17g}\n")
    top = max(z for _, _, z, _ in spheres) + 0.02
    bottom = 0.0 if kind == "filling" else -0.05
    side = BIN if kind == "filling" else 0.4
    with open(folder / "cloud.data", "w") as out:
        out.write(f"spheres\n\n{len(spheres)} atoms\n1 atom types\n")
        out.write(f"{-side} {side} xlo xhi\n{-side} {side} ylo yhi\n{bottom} {top:.17g} zlo zhi\n\nAtoms # sphere\n\n")
        for number, (x, y, z, r) in enumerate(spheres):
            out.write(f"{number + 1} 1 {2 * r:.17g} {DENSITY} {x:.17g} {y:.17g} {z:.17g}\n")


def main():
    if len(sys.argv) != 4 or sys.argv[1] not in ("filling", "hopper") or not sys.argv[2].isdigit():
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    write(sys.argv[1], list(cloud(sys.argv[1], int(sys.argv[2]))), folder)


main()
