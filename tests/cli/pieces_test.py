"""Opens frames in pieces with VTK's own parallel reader, which ParaView uses, and compares them with whole frames.

Usage: pieces_test.py WHOLE PIECES, with two folders of the same run.
"""

import os
import sys
import xml.etree.ElementTree as ElementTree

try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPPolyDataReader
    from vtkmodules.vtkCommonCore import vtkOutputWindow
except ImportError:
    print("skipped: VTK's Python module is not installed (apt install python3-vtk9)")
    sys.exit(77)


def check(condition, message):
    if not condition:
        print("FAILED:", message)
        sys.exit(1)


def series(folder):
    root = ElementTree.parse(os.path.join(folder, "particles.pvd")).getroot()
    return [(entry.get("timestep"), entry.get("file")) for entry in root.iter("DataSet")]


def rows(reader, path):
    """Returns {id: all values of that particle, bit by bit}, and the names and types of the arrays."""
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(path))
    reader.SetFileName(path)
    reader.Update()
    check(not errors, f"VTK reports an error in {path}")
    data = reader.GetOutput()
    arrays = [data.GetPointData().GetArray(k) for k in range(data.GetPointData().GetNumberOfArrays())]
    ids = data.GetPointData().GetArray("id")
    table = {}
    for i in range(data.GetNumberOfPoints()):
        table[ids.GetValue(i)] = [data.GetPoint(i)] + [repr(array.GetTuple(i)) for array in arrays]
    check(len(table) == data.GetNumberOfPoints(), f"{path}: a particle is there twice")
    return table, [(array.GetName(), array.GetDataTypeAsString()) for array in arrays if table]


def main(whole, pieces):
    vtkOutputWindow.SetGlobalWarningDisplay(0)
    expected = series(whole)
    found = series(pieces)
    check([time for time, _ in expected] == [time for time, _ in found], "the series have other times")
    particles = 0
    for (_, file), (_, index) in zip(expected, found):
        check(index == file.replace(".vtp", ".pvtp"), f"{index} is listed")
        left = rows(vtkXMLPolyDataReader(), os.path.join(whole, file))
        right = rows(vtkXMLPPolyDataReader(), os.path.join(pieces, index))
        check(left == right, f"{index} differs from {file}")
        particles += len(left[0])
    print(f"{len(found)} frames in pieces with {particles} particles equal the frames of one process")


main(*sys.argv[1:])
