"""paraview_pictures_test.py RECIPE SCRIPT EMPTY: what pictures of a run that ParaView has drawn must show."""

import sys

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


def colors(path):
    """How many colours there are, and how many pixels that are redder than they are blue by far."""
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
assert recipe[1] > 300 and script[1] > 300, "the fastest are not red"
assert empty[1] < 150, "there is more that is red than the x-axis in the corner where there are no particles"
