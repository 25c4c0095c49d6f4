"""Imports a run into Blender with the operator of the add-on and renders a frame.

Usage: blender -b -P THIS -- ADDON RUN PICTURE
"""

import importlib.util
import os
import sys

import bpy
import numpy as np

addon_file, folder, picture = sys.argv[sys.argv.index("--") + 1:]


def check(condition, text):
    if not condition:
        print("FAILED:", text)
        sys.stdout.flush()
        os._exit(1)


spec = importlib.util.spec_from_file_location("ricochet_run", addon_file)
addon = importlib.util.module_from_spec(spec)
spec.loader.exec_module(addon)
addon.register()
for item in list(bpy.data.objects):
    bpy.data.objects.remove(item)
check(bpy.ops.import_scene.ricochet_run(filepath=os.path.join(folder, "run.json")) == {"FINISHED"}, "the operator")
scene = bpy.context.scene
files = addon.numbered_files(folder, "particles")
check(scene.frame_end == len(files) - 1, "a frame of the time line for every file")
particles = bpy.data.objects["Particles"]
for frame in (0, scene.frame_end // 2, scene.frame_end):
    scene.frame_set(frame)
    stored = addon.read_vtp(files[frame])
    points = stored["Points"]["Points"].reshape(-1, 3)
    mesh = particles.data
    check(len(mesh.vertices) == len(points), f"{len(points)} particles at frame {frame}")
    for name, key in (("particle_id", "id"), ("contacts", "contacts"), ("radius", "radius")):
        values = np.zeros(len(points), np.int32 if key != "radius" else np.float32)
        mesh.attributes[name].data.foreach_get("value", values)
        check(np.array_equal(values, stored["PointData"][key].astype(values.dtype)), f"{name} at frame {frame}")
    places = np.zeros(3 * len(points), np.float32)
    mesh.vertices.foreach_get("co", places)
    check(np.array_equal(places, points.astype(np.float32).ravel()), f"positions at frame {frame}")
check(len(points) > 0, "particles in the last frame")
check(scene.camera is not None, "a camera")
surfaces = [i for i in bpy.data.objects if i.type == "MESH" and i is not particles]
check(surfaces and all(len(i.data.polygons) > 0 and i.data.materials for i in surfaces), "colliders with materials")
moving = bpy.data.objects["Moving colliders"]
places = []
for frame in (0, scene.frame_end):
    scene.frame_set(frame)
    places.append([tuple(v.co) for v in moving.data.vertices])
check(places[0] != places[1] and len(places[0]) == len(places[1]), "colliders that move")
graph = bpy.context.evaluated_depsgraph_get()
shown = sum(1 for i in graph.object_instances if i.is_instance and i.parent and i.parent.original is particles)
check(shown == len(points), f"{shown} instances for {len(points)} particles")

sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
sun.data.energy, sun.rotation_euler = 1.5, (0.6, 0.3, 0.4)
scene.collection.objects.link(sun)
scene.world = scene.world or bpy.data.worlds.new("World")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.25, 0.3, 1.0)
scene.render.engine = "CYCLES"
scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 8, False
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 320, 208, 100
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
check(os.path.getsize(picture) > 2000, "a picture")
print("RICOCHET-IMPORT-OK")
