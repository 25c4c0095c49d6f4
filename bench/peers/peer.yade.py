# The scene of the working folder in YADE: the funnel if funnel.obj is beside cloud.txt, else a bin.
# Hertz and Mindlin, E 1e7 Pa, e 0.5, friction 0.5.
import math
import os
import time

from yade import O, Vector3, utils

YOUNG, POISSON, FRICTION, RESTITUTION = 1e7, 0.3, 0.5, 0.5
STEP, STEPS, EVERY = 5e-5, 20000, 2000


def walls():
    if not os.path.exists("funnel.obj"):
        return [utils.wall(0, 2), utils.wall(-0.1, 0), utils.wall(0.1, 0), utils.wall(-0.1, 1), utils.wall(0.1, 1)]
    corners, facets = [], []
    with open("funnel.obj") as mesh:
        for line in mesh:
            words = line.split()
            if words and words[0] == "v":
                corners.append(0.2 * Vector3(*map(float, words[1:4])))
            elif words and words[0] == "f":
                face = [corners[int(word.split("/")[0]) - 1] for word in words[1:]]
                facets += [utils.facet([face[0], face[k], face[k + 1]]) for k in range(1, len(face) - 1)]
    return facets


def write_places():
    with open("yade.%06d.txt" % O.iter, "w") as out:
        for body in O.bodies:
            if hasattr(body.shape, "radius"):
                x, y, z = body.state.pos
                if z > -0.05:
                    out.write("%.12g %.12g %.12g %.12g\n" % (x, y, z, body.shape.radius))


grain = O.materials.append(
    FrictMat(young=YOUNG, poisson=POISSON, frictionAngle=math.atan(FRICTION), density=2500))  # noqa: F821
with open("cloud.txt") as cloud:
    for line in cloud:
        x, y, z, r = map(float, line.split())
        O.bodies.append(utils.sphere((x, y, z), r, material=grain))
O.bodies.append(walls())
O.engines = [
    ForceResetter(),  # noqa: F821
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb(), Bo1_Wall_Aabb()], verletDist=0.0005),  # noqa: F821
    InteractionLoop(  # noqa: F821
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],  # noqa: F821
        [Ip2_FrictMat_FrictMat_MindlinPhys(en=RESTITUTION, es=RESTITUTION)],  # noqa: F821
        [Law2_ScGeom_MindlinPhys_Mindlin()]),  # noqa: F821
    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),  # noqa: F821
    PyRunner(command="write_places()", iterPeriod=EVERY),  # noqa: F821
]
O.dt = STEP
O.run(STEPS, wait=True)
write_places()
print("done", O.iter, time.process_time())
