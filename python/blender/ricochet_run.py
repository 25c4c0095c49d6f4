"""Blender add-on: File > Import > Ricochet run.

Imports the folder that `ricochet run` has written. The current frame of the time line selects the frame of the run.
Particles become spheres. Radius, colour, ids and every other array of the frames become attributes. Colliders and the
camera are imported with their motion. The files are read while the time line advances, so do not move the folder. Needs
Blender 3.4 or newer.
"""

import json
import os
import re

import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy_extras.io_utils import ImportHelper
from mathutils import Vector

bl_info = {
    "name": "Ricochet run",
    "author": "Ricochet",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > Ricochet run (run.json)",
    "description": "Imports particles, colliders and camera of a Ricochet run",
    "category": "Import-Export",
}

_TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "UInt32": "<u4", "UInt8": "u1"}
_ARRAY = re.compile(
    r'<DataArray type="(\w+)" Name="([^"]*)"(?: NumberOfComponents="(\d+)")? format="appended" offset="(\d+)"/>')


def read_vtp(path):
    """Returns the arrays of a .vtp file from ricochet: {section: {name: array}}. Raises ValueError for other files."""
    with open(path, "rb") as file:
        data = file.read()
    start = data.find(b'<AppendedData encoding="raw">')
    begin = data.find(b"_", start) + 1
    if start < 0 or begin == 0:
        raise ValueError(f"{path}: not a .vtp file with raw appended data")
    sections = {}
    header = data[:start].decode("utf-8", "replace")
    for match in re.finditer(r"<(PointData|CellData|Points|Verts|Lines|Polys)>(.*?)</\1>", header, re.DOTALL):
        arrays = sections.setdefault(match[1], {})
        for kind, name, components, offset in _ARRAY.findall(match[2]):
            arrays[name] = _array(data, begin + int(offset), kind, int(components or 1), path)
    if "Points" not in sections:
        raise ValueError(f"{path}: has no points")
    return sections


def _array(data, at, kind, components, path):
    size = int(np.frombuffer(data, "<u8", 1, at)[0]) if at + 8 <= len(data) else len(data)
    if kind not in _TYPES or at + 8 + size > len(data):
        raise ValueError(f"{path}: is cut off or damaged")
    values = np.frombuffer(data[at + 8:at + 8 + size], _TYPES[kind])
    return values.reshape(-1, components) if components > 1 else values


def own_file(folder, name):
    """Returns the path of a regular file in the folder. Raises ValueError for other files, because an untrusted
    run.json may name files in other folders, links and pipes."""
    path = os.path.join(folder, name)
    is_own = os.path.dirname(os.path.realpath(path)) == os.path.realpath(folder)
    if name != os.path.basename(name) or not is_own or not os.path.isfile(path):
        raise ValueError(f"{folder}: {name!r} is no file of the run")
    return path


def read_frame(path):
    """Returns the arrays of a frame like read_vtp(). Joins the pieces of a .pvtp frame, in the order of the ids."""
    if not path.endswith(".pvtp"):
        return read_vtp(path)
    with open(path, encoding="utf-8") as file:
        names = re.findall(r'<Piece Source="([^"/]*)"/>', file.read())
    if not names:
        raise ValueError(f"{path}: lists no pieces")
    if len(set(names)) < len(names):
        raise ValueError(f"{path}: lists a piece twice")
    pieces = [read_vtp(own_file(os.path.dirname(path), name)) for name in names]
    if len(pieces) == 1:
        return pieces[0]
    points = np.concatenate([piece["Points"]["Points"].reshape(-1, 3) for piece in pieces])
    arrays = {name: [piece["PointData"][name] for piece in pieces if len(piece["PointData"][name])]
              or [pieces[0]["PointData"][name]] for name in pieces[0]["PointData"]}
    joined = {name: np.concatenate(values) for name, values in arrays.items()}
    order = np.argsort(joined["id"], kind="stable")
    return {"Points": {"Points": points[order]}, "PointData": {name: values[order] for name, values in joined.items()}}


def numbered_files(folder, stem):
    """Returns the files STEM_NNNNNN.vtp or .pvtp of the folder in the order of their steps."""
    pattern = re.compile(re.escape(stem) + r"_(\d+)\.p?vtp")
    found = [(int(match[1]), name) for name in os.listdir(folder) if (match := pattern.fullmatch(name))]
    return [own_file(folder, name) for _, name in sorted(found)]


def _set_attribute(mesh, name, values, domain):
    vector = values.ndim == 2
    if vector and values.shape[1] != 3:
        return
    kind = "FLOAT_VECTOR" if vector else "INT" if values.dtype.kind in "iu" else "FLOAT"
    if name == "color" and vector:  # stored as a colour attribute, which shaders and the viewport use
        attribute = mesh.attributes.new(name, "FLOAT_COLOR", domain)
        opaque = np.ones((len(values), 4), np.float32)
        opaque[:, :3] = values
        attribute.data.foreach_set("color", opaque.ravel())
        return
    attribute = mesh.attributes.new(name, kind, domain)
    dtype = np.int32 if kind == "INT" else np.float32
    attribute.data.foreach_set("vector" if vector else "value", np.ascontiguousarray(values, dtype).ravel())


def fill_particles(mesh, path):
    """Replaces the content of the mesh by one vertex for each particle of the frame."""
    sections = read_frame(path)
    points = sections["Points"]["Points"].reshape(-1, 3)
    mesh.clear_geometry()
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.astype(np.float32).ravel())
    arrays = sections.get("PointData", {})
    for name, values in arrays.items():
        # Blender reserves the name "id".
        _set_attribute(mesh, "particle_id" if name == "id" else name, values, "POINT")
    shown = arrays.get("size", arrays.get("radius", np.zeros(len(points))))
    shown = np.where(shown > 0.0, shown, mesh.get("ricochet_point_radius", 0.01))
    _set_attribute(mesh, "shown_radius", shown, "POINT")
    if "color" not in arrays:
        _set_attribute(mesh, "color", np.full((len(points), 3), 0.6), "POINT")
    mesh.update()


def fill_surface(mesh, path):
    """Replaces the content of the mesh by the triangles of the file and their arrays."""
    sections = read_vtp(path)
    mesh.clear_geometry()
    points = sections["Points"]["Points"].reshape(-1, 3)
    faces = sections["Polys"]["connectivity"].reshape(-1, 3)
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.astype(np.float32).ravel())
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.astype(np.int32).ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(len(faces), 3, np.int32))
    for name, values in sections.get("CellData", {}).items():
        _set_attribute(mesh, name, values, "FACE")
    mesh.update(calc_edges=True)


def _show_frame(item, frame):
    files = numbered_files(item["ricochet_folder"], item["ricochet_stem"])
    if not files:
        return
    path = files[min(max(frame, 0), len(files) - 1)]
    (fill_particles if item["ricochet_stem"] == "particles" else fill_surface)(item.data, path)


@persistent
def update_runs(scene, *_):
    """Updates every imported run to the frame of the scene."""
    for item in scene.objects:
        if "ricochet_stem" in item:
            try:
                _show_frame(item, scene.frame_current)
            except (OSError, ValueError) as error:
                print(f"Ricochet run: {error}")


def _material(name, color, from_attribute=False):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (*color, 1.0)
    surface.inputs["Roughness"].default_value = 0.6
    if from_attribute:
        attribute = material.node_tree.nodes.new("ShaderNodeAttribute")
        attribute.attribute_type, attribute.attribute_name = "INSTANCER", "color"
        material.node_tree.links.new(attribute.outputs["Color"], surface.inputs["Base Color"])
    return material


def _point_nodes(material):
    """Returns geometry nodes that draw a sphere at each vertex, with the radius in the attribute `shown_radius`.

    A point cloud cannot be used, because Cycles in Blender 3.4 ignores the colours of its points.
    """
    tree = bpy.data.node_groups.new("Ricochet particles", "GeometryNodeTree")
    if hasattr(tree, "interface"):  # Blender 4
        tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    nodes, links = tree.nodes, tree.links
    begin, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    radius = nodes.new("GeometryNodeInputNamedAttribute")
    radius.inputs["Name"].default_value = "shown_radius"
    sphere, smooth = nodes.new("GeometryNodeMeshIcoSphere"), nodes.new("GeometryNodeSetShadeSmooth")
    sphere.inputs["Radius"].default_value, sphere.inputs["Subdivisions"].default_value = 1.0, 3
    paint, points = nodes.new("GeometryNodeSetMaterial"), nodes.new("GeometryNodeInstanceOnPoints")
    paint.inputs["Material"].default_value = material
    links.new(sphere.outputs["Mesh"], smooth.inputs["Geometry"])
    links.new(smooth.outputs[0], paint.inputs["Geometry"])
    links.new(begin.outputs[0], points.inputs["Points"])
    links.new(paint.outputs[0], points.inputs["Instance"])
    value = next(s for s in radius.outputs if s.enabled and s.name == "Attribute")
    links.new(value, points.inputs["Scale"])
    links.new(points.outputs[0], end.inputs[0])
    return tree


def _add_camera(context, camera):
    data = bpy.data.cameras.new("Ricochet camera")
    item = bpy.data.objects.new("Ricochet camera", data)
    position, target = Vector(camera["position"]), Vector(camera["target"])
    item.location = position
    item.rotation_euler = (target - position).to_track_quat("-Z", "Y").to_euler()
    data.sensor_fit = "VERTICAL"
    data.angle = np.radians(camera.get("fov", 35.0))
    distance = (target - position).length
    data.clip_start, data.clip_end = distance * 1e-3, distance * 1e3
    context.collection.objects.link(item)
    context.scene.camera = item


def _add_mesh(context, name, folder, stem=None):
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    if stem:
        item["ricochet_folder"], item["ricochet_stem"] = folder, stem
    context.collection.objects.link(item)
    return item


def _add_colliders(context, folder, run):
    materials = {}
    moving = numbered_files(folder, "moving")
    for collider in run.get("colliders", []):
        if moving and collider.get("moves"):
            continue
        item = _add_mesh(context, collider["name"], folder)
        fill_surface(item.data, own_file(folder, collider["file"]))
        number = collider.get("material", 0)
        if number not in materials:
            materials[number] = _material(f"Ricochet material {number}", (0.45, 0.42, 0.38))
        item.data.materials.append(materials[number])
    if moving:
        item = _add_mesh(context, "Moving colliders", folder, "moving")
        item.data.materials.append(_material("Ricochet moving", (0.35, 0.4, 0.45)))


def import_run(context, path, point_radius=0.0):
    """Imports a run. path: the run's folder, or the run.json in it. point_radius: radius of particles without a size,
    in m; 0 chooses a visible radius."""
    folder = os.path.abspath(path if os.path.isdir(path) else os.path.dirname(path))
    with open(own_file(folder, "run.json"), encoding="utf-8") as file:
        run = json.load(file)
    frames = numbered_files(folder, "particles")
    if not frames:
        raise ValueError(f"{folder}: has no frames")
    _add_colliders(context, folder, run)
    if run.get("camera"):
        _add_camera(context, run["camera"])
    particles = _add_mesh(context, "Particles", folder, "particles")
    if point_radius <= 0.0:
        points = read_frame(frames[-1])["Points"]["Points"].reshape(-1, 3)
        point_radius = 0.002 * float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) > 1 else 0.01
    particles.data["ricochet_point_radius"] = point_radius
    modifier = particles.modifiers.new("Points", "NODES")
    modifier.node_group = _point_nodes(_material("Ricochet particles", (0.6, 0.6, 0.6), from_attribute=True))
    context.scene.frame_start, context.scene.frame_end = 0, len(frames) - 1
    update_runs(context.scene)
    return particles


class ImportRicochetRun(bpy.types.Operator, ImportHelper):
    """Import the run.json of a folder that `ricochet run` has written"""

    bl_idname = "import_scene.ricochet_run"
    bl_label = "Import Ricochet run"
    bl_options = {"UNDO"}
    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="run.json", options={"HIDDEN"})
    point_radius: bpy.props.FloatProperty(name="Radius of points", description="0: a visible one", min=0.0)

    def execute(self, context):
        try:
            import_run(context, self.filepath, self.point_radius)
        except (OSError, ValueError, KeyError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def _menu(self, _):
    self.layout.operator(ImportRicochetRun.bl_idname, text="Ricochet run (run.json)")


def register():
    bpy.utils.register_class(ImportRicochetRun)
    bpy.types.TOPBAR_MT_file_import.append(_menu)
    bpy.app.handlers.frame_change_pre.append(update_runs)


def unregister():
    bpy.app.handlers.frame_change_pre.remove(update_runs)
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    bpy.utils.unregister_class(ImportRicochetRun)
