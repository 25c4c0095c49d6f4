"""Draws a picture of a run with ParaView. The script does the steps of the section "ParaView" in docs/output-files.md.

    pvbatch python/paraview/run_picture.py DIR picture.png [--time SECONDS] [--color ARRAY] [--size WIDTH HEIGHT]

DIR is the folder of a run (`ricochet run ... --output DIR`). Particles are drawn as spheres with the radius in the
array `size`, or in `radius` if the frames have no `size`. Points get a two-hundredth of the run's width as radius.
--color is the name of an array of the frames; the default is velocity. The scene's camera is used, if the scene has
one. Without --time, the last frame is drawn.
"""

import argparse
import json
import os
import sys

from paraview import simple


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("run", metavar="DIR")
    parser.add_argument("picture", metavar="PNG")
    parser.add_argument("--time", type=float, help="simulated seconds (the last frame)")
    parser.add_argument("--color", metavar="ARRAY", default="velocity", help="array of the frames (velocity)")
    parser.add_argument("--size", type=int, nargs=2, metavar=("WIDTH", "HEIGHT"), default=(960, 540))
    arguments = parser.parse_args()
    if not os.path.exists(os.path.join(arguments.run, "particles.pvd")):
        parser.error(f"{arguments.run}: no particles.pvd in it, expected the folder of a run")
    return arguments


def radius_array(particles):
    """Returns the name of the array with the sizes of particles, or None if all particles are points."""
    arrays = particles.PointData
    for name in ("size", "radius"):
        if name in arrays.keys() and arrays[name].GetRange()[1] > 0.0:
            return name
    return None


def show_particles(particles, view, color):
    shown = simple.Show(particles, view)
    shown.SetRepresentationType("Point Gaussian")
    name = radius_array(particles)
    if name:
        shown.GaussianRadius = 1.0
        shown.ScaleByArray = 1
        shown.SetScaleArray = ["POINTS", name]
        shown.UseScaleFunction = 0
    else:
        box = particles.GetDataInformation().GetBounds()
        shown.GaussianRadius = max(box[2 * axis + 1] - box[2 * axis] for axis in range(3)) / 200.0
    if color not in particles.PointData.keys():
        sys.exit(f"error: no array {color} in the frames; there are: {', '.join(sorted(particles.PointData.keys()))}")
    if particles.PointData[color].GetNumberOfComponents() > 1:
        simple.ColorBy(shown, ("POINTS", color, "Magnitude"))
    else:
        simple.ColorBy(shown, ("POINTS", color))
    shown.RescaleTransferFunctionToDataRange(False, True)
    shown.SetScalarBarVisibility(view, True)


def show_colliders(run, view):
    """Shows the colliders. Each collider at rest has its own file. One file contains all moving colliders. Planes are
    drawn as outlines, because filled planes would hide the other objects."""
    colliders = json.load(open(os.path.join(run, "run.json")))["colliders"]
    files = [(collider["file"], collider["type"]) for collider in colliders if not collider.get("moves")]
    files.append(("moving.pvd", "mesh"))
    for name, kind in files:
        path = os.path.join(run, name)
        if not os.path.exists(path):
            continue
        shown = simple.Show(simple.OpenDataFile(path), view)
        shown.SetRepresentationType("Outline" if kind == "plane" else "Surface")
        shown.ColorArrayName = [None, ""]
        shown.Opacity = 1.0 if kind == "plane" else 0.4


def place_camera(run, view):
    document = json.load(open(os.path.join(run, "run.json")))
    camera = document.get("camera")
    if not camera:
        simple.ResetCamera(view)
        return
    view.CameraPosition = camera["position"]
    view.CameraFocalPoint = camera["target"]
    view.CameraViewUp = document["up"]
    view.CameraViewAngle = camera["fov"]


def main():
    arguments = read_arguments()
    particles = simple.OpenDataFile(os.path.join(arguments.run, "particles.pvd"))
    times = list(particles.TimestepValues)
    time = times[-1] if arguments.time is None else min(times, key=lambda t: abs(t - arguments.time))
    particles.UpdatePipeline(time)
    has_particles = particles.GetDataInformation().GetNumberOfPoints() > 0
    if not has_particles:
        print(f"warning: there are no particles at {time} s", file=sys.stderr)
    view = simple.CreateRenderView()
    view.ViewSize = list(arguments.size)
    view.ViewTime = time
    if has_particles:
        show_particles(particles, view, arguments.color)
    show_colliders(arguments.run, view)
    place_camera(arguments.run, view)
    simple.SaveScreenshot(arguments.picture, view, ImageResolution=list(arguments.size))


main()
