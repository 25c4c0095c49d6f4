"""Opens a series with VTK's own readers, the ones that ParaView uses.

paraview_reader_test.py FOLDER [--killed] [--attribute NAME]...

--attribute: the frames also contain this attribute of one component.
--killed: the run was killed, so its last frame may not be listed yet.
"""

import os
import sys
import xml.etree.ElementTree as ElementTree

try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    from vtkmodules.vtkCommonCore import vtkOutputWindow
except ImportError:
    print("skipped: VTK's Python module is not installed (apt install python3-vtk9)")
    sys.exit(77)

POINT_ARRAYS = {
    "id": ("long long", 1),
    "velocity": ("double", 3),
    "mass": ("double", 1),
    "radius": ("double", 1),
    "age": ("double", 1),
    "contacts": ("unsigned int", 1),
    "resting": ("unsigned char", 1),
    "frozen": ("unsigned char", 1),
    "unsimulated_time": ("double", 1),
}
SPHERE_ARRAYS = {"spin": ("double", 3)}  # in every frame or in none
CONTACT_ARRAYS = {
    "time": ("double", 1),
    "particle": ("long long", 1),
    "collider": ("unsigned int", 1),
    "triangle": ("long long", 1),
    "barycentric": ("double", 3),
    "normal": ("double", 3),
    "velocity_before": ("double", 3),
    "velocity_after": ("double", 3),
    "impulse": ("double", 3),
    "radius": ("double", 1),
}
MOVING_CONTACT_ARRAYS = {"surface_velocity": ("double", 3)}  # only with moving surfaces
MOVING_ARRAYS = {"collider": ("unsigned int", 1)}
CELL_ARRAYS = {"hits": ("long long", 1), "impulse": ("double", 3)}
RUN_CELL_ARRAYS = {"lasting_impulse": ("double", 3), "material": ("unsigned int", 1), "group": ("unsigned int", 1)}
EXAMPLE_GROUPS = ["", 'a "b" <&>', "x" * 3000]
LONG_NAMES = {"long": "long long"}  # both have 64 bits


def check(condition, message):
    if not condition:
        print("FAILED:", message)
        sys.exit(1)


def series(path):
    root = ElementTree.parse(path).getroot()
    return [(float(entry.get("timestep")), entry.get("file")) for entry in root.iter("DataSet")]


def read(path):
    errors = []
    reader = vtkXMLPolyDataReader()
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(path))
    reader.SetFileName(path)
    reader.Update()
    check(not errors, f"VTK reports an error in {path}")
    return reader.GetOutput()


def check_arrays(data, expected, count, path):
    check(data.GetNumberOfArrays() == len(expected), f"{path}: {data.GetNumberOfArrays()} arrays")
    for name, (kind, components) in expected.items():
        array = data.GetArray(name)
        check(array is not None, f"{path}: no array {name}")
        found = array.GetDataTypeAsString()
        check(LONG_NAMES.get(found, found) == kind, f"{path}: {name} is {found}")
        check(array.GetNumberOfComponents() == components, f"{path}: {name} components")
        check(array.GetNumberOfTuples() == count, f"{path}: {name} has {array.GetNumberOfTuples()} tuples")


def read_points(folder, time, name, arrays):
    path = os.path.join(folder, name)
    data = read(path)
    points = data.GetNumberOfPoints()
    check(data.GetFieldData().GetArray("TimeValue").GetValue(0) == time, f"{path}: TimeValue")
    check(data.GetNumberOfVerts() == (1 if points else 0), f"{path}: vertex cells")
    check_arrays(data.GetPointData(), arrays, points, path)
    if points:
        check(data.GetPoints().GetData().GetDataTypeAsString() == "double", f"{path}: points are not double")
        check(data.GetCell(0).GetNumberOfPoints() == points, f"{path}: the cell does not contain every point")
    return data, points, path


def check_frame(folder, time, name, arrays):
    data, points, path = read_points(folder, time, name, arrays)
    if points:
        ids = data.GetPointData().GetArray("id")
        check(all(ids.GetValue(i) < ids.GetValue(i + 1) for i in range(points - 1)), f"{path}: ids are not in order")
    return points


def check_contacts(folder, time, name):
    moves = os.path.exists(os.path.join(folder, "moving.pvd"))
    arrays = {**CONTACT_ARRAYS, **(MOVING_CONTACT_ARRAYS if moves else {})}
    data, points, path = read_points(folder, time, name, arrays)
    times = data.GetPointData().GetArray("time")
    check(all(times.GetValue(i) <= times.GetValue(i + 1) for i in range(points - 1)), f"{path}: times are not in order")
    return points


def check_collider(folder, name):
    path = os.path.join(folder, name)
    data = read(path)
    check(data.GetNumberOfPolys() > 0, f"{path}: no triangles")
    cells = data.GetCellData()
    more = {array: kind for array, kind in RUN_CELL_ARRAYS.items() if cells.GetArray(array)}
    check_arrays(cells, {**CELL_ARRAYS, **more}, data.GetNumberOfPolys(), path)
    if "group" in more:
        check_groups(data, path)
    return data.GetNumberOfPolys()


def check_groups(data, path):
    names = data.GetFieldData().GetAbstractArray("group_names")
    check(names is not None, f"{path}: groups without names")
    names = [names.GetValue(i) for i in range(names.GetNumberOfValues())]
    numbers = data.GetCellData().GetArray("group")
    numbers = [int(numbers.GetValue(i)) for i in range(numbers.GetNumberOfTuples())]
    check(max(numbers) < len(names), f"{path}: {len(names)} names for group {max(numbers)}")
    if "tetrahedron" in path:
        check(names == EXAMPLE_GROUPS and numbers == [0, 2, 1, 1], f"{path}: groups {numbers} of {names}")
        check(data.GetFieldData().GetAbstractArray("none").GetNumberOfValues() == 0, f"{path}: a text without values")


def check_moving(folder, time, name):
    path = os.path.join(folder, name)
    data = read(path)
    check(data.GetFieldData().GetArray("TimeValue").GetValue(0) == time, f"{path}: TimeValue")
    check(data.GetNumberOfPolys() > 0, f"{path}: no triangles")
    check_arrays(data.GetCellData(), MOVING_ARRAYS, data.GetNumberOfPolys(), path)
    return data.GetNumberOfPolys()


def listed_files(folder, name, killed):
    files = series(os.path.join(folder, name + ".pvd"))
    check(files, f"the series {name} is empty")
    times = [time for time, _ in files]
    check(all(a < b for a, b in zip(times, times[1:])), f"times do not rise: {times}")
    listed = [file for _, file in files]
    on_disk = sorted(file for file in os.listdir(folder) if file.startswith(name + "_") and file.endswith(".vtp"))
    check(listed == on_disk[: len(listed)], f"listed {listed}, found {on_disk}")
    check(len(on_disk) - len(listed) <= (1 if killed else 0), f"{len(on_disk)} files, {len(listed)} listed")
    return files


def main(folder, killed, attributes):
    vtkOutputWindow.SetGlobalWarningDisplay(0)
    frames = listed_files(folder, "particles", killed)
    first = read(os.path.join(folder, frames[0][1])).GetPointData()
    arrays = {**POINT_ARRAYS, **(SPHERE_ARRAYS if first.GetArray("spin") else {})}
    arrays |= {name: ("double", 1) for name in attributes}
    counts = [check_frame(folder, time, name, arrays) for time, name in frames]
    if os.path.exists(os.path.join(folder, "contacts.pvd")):
        files = listed_files(folder, "contacts", killed)
        print(f"{sum(check_contacts(folder, *file[:2]) for file in files)} contacts in {len(files)} files")
    if os.path.exists(os.path.join(folder, "moving.pvd")):
        files = listed_files(folder, "moving", killed)
        print(f"{len(files)} files of moving colliders of {[check_moving(folder, *file) for file in files]} triangles")
    triangles = [check_collider(folder, name) for _, name in series(os.path.join(folder, "colliders.pvd"))]
    print(f"{len(frames)} frames with {counts} particles, colliders of {triangles} triangles, last time {frames[-1][0]!r}")


options = sys.argv[2:]
main(
    sys.argv[1],
    "--killed" in options,
    [name for flag, name in zip(options, options[1:]) if flag == "--attribute"],
)
