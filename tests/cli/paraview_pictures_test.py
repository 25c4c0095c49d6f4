"""Checks pictures of a run drawn by ParaView.

Usage: paraview_pictures_test.py RECIPE SCRIPT EMPTY
"""

import sys

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


def colors(path):
    """Returns the number of different colours, and the number of pixels with much more red than blue."""
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)
    assert len(pixels) == 960 * 540, f"{path}: {len(pixels)} pixels"
    codes = pixels[:, 0] * 65536 + pixels[:, 1] * 256 + pixels[:, 2]
    return len(set(codes.tolist())), int((pixels[:, 0] > pixels[:, 2] + 60).sum())


recipe, script, empty = (colors(path) for path in sys.argv[1:4])
print(f"colours and red pixels: {recipe}, {script}, without particles {empty}")
assert recipe[0] > 1000 and script[0] > 1000, "the particles are not drawn in the colours of their speed"
assert recipe[1] > 300 and script[1] > 300, "the fastest particles are not red"
assert empty[1] < 150, "without particles, more than the x-axis in the corner is red"
