#!/usr/bin/env python3
"""Computes the largest overlap of two spheres, relative to the smaller radius, in each file of positions (columns x y z
radius, or a header).

overlaps.py FILE...: prints the number of spheres in the last file, its largest overlap, and the largest of all files.
"""
import collections
import itertools
import math
import sys


def spheres(path):
    names, found = None, []
    with open(path) as text:
        for line in text:
            words = line.replace(",", " ").split()
            try:
                values = [float(word) for word in words]
            except ValueError:
                names = words[2:] if words[:2] == ["ITEM:", "ATOMS"] else words
                continue
            if names and "x" in names:
                values = [values[names.index(name)] for name in ("x", "y", "z", "radius")]
            if len(values) == 4:
                found.append(values)
    return found


def largest_overlap(found):
    width = 2 * max((sphere[3] for sphere in found), default=1)
    cells = collections.defaultdict(list)
    largest = 0.0
    for sphere in found:
        cell = [math.floor(sphere[axis] / width) for axis in range(3)]
        for step in itertools.product((-1, 0, 1), repeat=3):
            for other in cells[tuple(c + s for c, s in zip(cell, step))]:
                depth = sphere[3] + other[3] - math.dist(sphere[:3], other[:3])
                largest = max(largest, depth / min(sphere[3], other[3]))
        cells[tuple(cell)].append(sphere)
    return largest


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    overlaps = []
    for path in sys.argv[1:]:
        last = spheres(path)
        overlaps.append(largest_overlap(last))
    print(f"{len(last)} spheres, overlap at the end {overlaps[-1]:.2%}, largest {max(overlaps):.2%}")


main()
