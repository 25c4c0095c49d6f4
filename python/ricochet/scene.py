"""The things of a scene, each with its keys as keyword arguments: made by python/generate_scene.py from the
tool's schema, not to be edited. Each is a dictionary with the keys of a scene file."""

from __future__ import annotations

from typing import Any, Dict


class Thing(Dict[str, Any]):
    """A dictionary with the keys that were given."""

    _fixed: Dict[str, Any] = {}

    def __init__(self, **keys: Any) -> None:
        super().__init__(self._fixed)
        self.update((key, value) for key, value in keys.items() if value is not None)

    def __repr__(self) -> str:
        keys = ", ".join(f"{key}={value!r}" for key, value in self.items() if key not in self._fixed)
        return f"{type(self).__name__}({keys})"


class Scene(Thing):
    """A whole scene.

    simulation: Time and impacts.
    forces: Forces on the particles.
    particle_forces: Forces between the particles.
    flows: Flows by name, for several forces to share.
    materials: Materials by name.
    colliders: What particles bounce off.
    frames: Moving frames of reference by name.
    emitters: Where particles are born.
    particles: Particles that are there from the start, one by one or from a table.
    springs: Springs between particles; ropes, chains and cloth with particles of their own.
    particle_contacts: Spheres meet each other.
    heat: What changes the temperature of particles.
    attributes: Values of your own that particles carry, by name.
    reference_camera: For emitters' rates per screen area.
    bounds: Where particles are retired.
    output: What is written.
    camera: For pictures.
    picture: Light and surroundings of pictures.
    """

    _fixed = {"ricochet": 1}


class Attractor(Thing):
    """A point that attracts.

    position: Where it stands. Unit: m. Required.
    strength: Gravitational constant times mass; negative repels. Unit: m^3/s^2. Required.
    softening: Length over which it is smeared out. Unit: m. Default: 0.
    """


class Attribute(Thing):
    """A value of your own that every particle carries, is written to frames and goes into no force.

    components: 1, or 3 for a vector. Default: 1.
    default: What particles have that nobody gives another value.
    """


class Body(Thing):
    """What makes a frame a rigid body that the impulses of particles move, and the scene's forces. The frame stands in the world and has no motions; its translation and rotation say where it starts. Bodies meet neither each other nor colliders at rest.

    mass: Its mass. Either this or `density`. Unit: kg.
    density: Its mass over its volume: that of the closed colliders that stand in the frame, which must not overlap.
        Unit: kg/m^3.
    center: Its centre of mass, in the frame's coordinates. Unit: m.
    inertia: Its moments of inertia about the axes of the frame through its centre of mass: [xx, yy, zz]. Unit: kg
        m^2.
    inertia_products: The elements xy, xz and yz of its inertia: minus the sums of mass times x y, x z and y z.
        Unit: kg m^2. Default: [0, 0, 0].
    joint: What holds it. Default: "free".
    axis: Direction of a hinge's or slider's axis, of any length, in the frame's axes at 0 s. Default: [0, 0, 1].
    velocity: Of the centre of mass of a free body at 0 s. Unit: m/s. Default: [0, 0, 0].
    angular_velocity: Of a free body at 0 s. Unit: rad/s. Default: [0, 0, 0].
    rate: At 0 s: how fast a body turns on its hinge, by the right-hand rule, or moves along its slider. Unit: rad/s
        or m/s. Default: 0.
    spring: Of a hinge or slider: the moment or force towards `spring_rest` over the angle or the way from there.
        Unit: N m/rad or N/m. Default: 0.
    spring_rest: Where the spring does not pull; 0 is where the body is at 0 s. Unit: rad or m. Default: 0.
    damping: Of a hinge or slider: the moment or force against the motion over its speed. Unit: N m s/rad or N s/m.
        Default: 0.
    drive: A constant moment about a hinge's axis, or force along a slider's. Unit: N m or N. Default: 0.
    friction: Dry friction of a hinge or slider: at most this moment or force, against the motion. Unit: N m or N.
        Default: 0.
    motor_rate: What a motor on the hinge or slider aims at. Unit: rad/s or m/s. Default: 0.
    motor_most: The largest moment or force of the motor; 0: there is none. Unit: N m or N. Default: 0.
    feels_forces: The scene's forces act on it, as on a particle of its mass and without a radius at its centre of
        mass. Default: true.
    """


class Bounds(Thing):
    """A box in world coordinates; particles that leave it are retired.

    lower: Its corner with the smallest coordinates. Unit: m. Required.
    upper: Its corner with the largest coordinates, each above `lower`'s. Unit: m. Required.
    """


class Camera(Thing):
    """Where `ricochet render` looks from, unless it is told otherwise.

    position: Where it stands. Unit: m.
    target: The point in the middle of the picture. Unit: m.
    path: Instead of `position`: where it goes, a curve of [x, y, z]. Unit: m.
    target_path: Instead of `target`: a curve of [x, y, z]. Unit: m.
    frame: One of the names in `frames`, in whose coordinates the camera stands, looks and is up.
    up: What is up in the picture.
    field_of_view: Angle from the lower to the upper edge. Unit: degrees. Default: 35.
    focal_length: Instead of `field_of_view`: of a lens before a film 24 mm high. Unit: mm.
    aperture: Diameter of the lens: what is nearer or farther than `focus_distance` blurs. 0: everything is sharp.
        Unit: m. Default: 0.
    focus_distance: Along the view to what is sharp; 0: as far as the target. Unit: m. Default: 0.
    """


class PointCloud(Thing):
    """All at one point.

    turning: How fast places turn about the parent, along the axis. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration towards its place of what has been pushed off it, for each metre that it is off. Unit: 1/s^2.
        Default: 0.
    damping: Acceleration against the velocity relative to its place, for each m/s. Unit: 1/s. Default: 0.
    parent_ends: What the children do from their parent's end on. Default: "free".
    center: Its centre. Unit: m. Default: [0, 0, 0].
    """

    _fixed = {"type": "point"}


class DiskCloud(Thing):
    """Uniform on a flat disk.

    turning: How fast places turn about the parent, along the axis. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration towards its place of what has been pushed off it, for each metre that it is off. Unit: 1/s^2.
        Default: 0.
    damping: Acceleration against the velocity relative to its place, for each m/s. Unit: 1/s. Default: 0.
    parent_ends: What the children do from their parent's end on. Default: "free".
    center: Its centre. Unit: m. Default: [0, 0, 0].
    normal: Normal of the disk, of any length. Required.
    radius: Its radius. Unit: m. Required.
    """

    _fixed = {"type": "disk"}


class BoxCloud(Thing):
    """Uniform in a box along the axes.

    turning: How fast places turn about the parent, along the axis. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration towards its place of what has been pushed off it, for each metre that it is off. Unit: 1/s^2.
        Default: 0.
    damping: Acceleration against the velocity relative to its place, for each m/s. Unit: 1/s. Default: 0.
    parent_ends: What the children do from their parent's end on. Default: "free".
    center: Its centre. Unit: m. Default: [0, 0, 0].
    size: Full edge lengths. Unit: m. Required.
    """

    _fixed = {"type": "box"}


class SphereCloud(Thing):
    """Uniform in a ball, or on its surface.

    turning: How fast places turn about the parent, along the axis. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration towards its place of what has been pushed off it, for each metre that it is off. Unit: 1/s^2.
        Default: 0.
    damping: Acceleration against the velocity relative to its place, for each m/s. Unit: 1/s. Default: 0.
    parent_ends: What the children do from their parent's end on. Default: "free".
    center: Its centre. Unit: m. Default: [0, 0, 0].
    radius: Its radius. Unit: m. Required.
    surface: true: only on the surface, launched outward. Default: false.
    """

    _fixed = {"type": "sphere"}


class ConeCloud(Thing):
    """Uniform in a cone, launched along the line from its tip.

    turning: How fast places turn about the parent, along the axis. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration towards its place of what has been pushed off it, for each metre that it is off. Unit: 1/s^2.
        Default: 0.
    damping: Acceleration against the velocity relative to its place, for each m/s. Unit: 1/s. Default: 0.
    parent_ends: What the children do from their parent's end on. Default: "free".
    apex: Its tip. Unit: m. Default: [0, 0, 0].
    axis: From the tip into the cone, of any length. Required.
    angle: Between the axis and the side. Unit: degrees. Required.
    height: Its height. Unit: m. Required.
    """

    _fixed = {"type": "cone"}


class PlaneCollider(Thing):
    """An infinite plane.

    name: For messages, reports and emitters; no two colliders share one.
    material: One of the names in `materials`.
    looks: How pictures show it.
    frame: One of the names in `frames`: the collider stands in it and moves with it. Only with the response
        "exact".
    motion: A frame of its own: poses in the order of time, at least one, each `{"time": ..., "position": ...,
        "rotation": ..., "scale": ...}`, within `frame` where that is given too. The collider's own position and
        rotation are within that.
    point: A point of the plane. Unit: m. Default: [0, 0, 0].
    normal: Its normal, of any length. Required.
    """

    _fixed = {"type": "plane"}


class MeshCollider(Thing):
    """A triangle mesh from a file, open or closed.

    name: For messages, reports and emitters; no two colliders share one.
    material: One of the names in `materials`.
    looks: How pictures show it.
    frame: One of the names in `frames`: the collider stands in it and moves with it. Only with the response
        "exact".
    motion: A frame of its own: poses in the order of time, at least one, each `{"time": ..., "position": ...,
        "rotation": ..., "scale": ...}`, within `frame` where that is given too. The collider's own position and
        rotation are within that.
    file: The mesh: OBJ, PLY, STL, OFF or glTF (.gltf, .glb). Required.
    up: Axis of the file that points up; z does in scenes. Where y does, (x, y, z) is read as (x, -z, y), before the
        scale.
    position: Where its origin is put; scale and rotation come first. Unit: m. Default: [0, 0, 0].
    rotation: Turns it.
    scale: Factor, or one for each of its own axes; a negative one mirrors. Default: 1.
    group_materials: Materials of parts of an OBJ, glTF or ASCII STL mesh: names that the file gives to its faces,
        each with one of the names in `materials`. A face goes by its `usemtl` name (the material's); where that is
        not listed by its `g` name (the whole line, then word by word; of glTF the mesh's, of ASCII STL the
        solid's), then by its `o` name (the node's). Faces without a listed name take the collider's material.
    deformation: Its vertices move: `file` says the faces only. Only with the response "exact", and without `frame`
        and `motion`.
    """

    _fixed = {"type": "mesh"}


class SphereCollider(Thing):
    """A ball about its own origin; an ellipsoid when the scale differs by axis.

    name: For messages, reports and emitters; no two colliders share one.
    material: One of the names in `materials`.
    looks: How pictures show it.
    frame: One of the names in `frames`: the collider stands in it and moves with it. Only with the response
        "exact".
    motion: A frame of its own: poses in the order of time, at least one, each `{"time": ..., "position": ...,
        "rotation": ..., "scale": ...}`, within `frame` where that is given too. The collider's own position and
        rotation are within that.
    radius: Its radius. Unit: m. Required.
    position: Where its origin is put; scale and rotation come first. Unit: m. Default: [0, 0, 0].
    rotation: Turns it.
    scale: Factor, or one for each of its own axes; a negative one mirrors. Default: 1.
    """

    _fixed = {"type": "sphere"}


class CylinderCollider(Thing):
    """A cylinder with flat caps about its own z axis, its middle at the origin.

    name: For messages, reports and emitters; no two colliders share one.
    material: One of the names in `materials`.
    looks: How pictures show it.
    frame: One of the names in `frames`: the collider stands in it and moves with it. Only with the response
        "exact".
    motion: A frame of its own: poses in the order of time, at least one, each `{"time": ..., "position": ...,
        "rotation": ..., "scale": ...}`, within `frame` where that is given too. The collider's own position and
        rotation are within that.
    radius: Its radius. Unit: m. Required.
    height: Its height. Unit: m. Required.
    position: Where its origin is put; scale and rotation come first. Unit: m. Default: [0, 0, 0].
    rotation: Turns it.
    scale: Factor, or one for each of its own axes; a negative one mirrors. Default: 1.
    """

    _fixed = {"type": "cylinder"}


class BoxCollider(Thing):
    """A box about its own origin.

    name: For messages, reports and emitters; no two colliders share one.
    material: One of the names in `materials`.
    looks: How pictures show it.
    frame: One of the names in `frames`: the collider stands in it and moves with it. Only with the response
        "exact".
    motion: A frame of its own: poses in the order of time, at least one, each `{"time": ..., "position": ...,
        "rotation": ..., "scale": ...}`, within `frame` where that is given too. The collider's own position and
        rotation are within that.
    size: Full edge lengths. Unit: m. Required.
    position: Where its origin is put; scale and rotation come first. Unit: m. Default: [0, 0, 0].
    rotation: Turns it.
    scale: Factor, or one for each of its own axes; a negative one mirrors. Default: 1.
    """

    _fixed = {"type": "box"}


class ColliderLooks(Thing):
    """How pictures show a collider; it does nothing to the run.

    color: Red, green and blue, linear light.
    roughness: From 0, which mirrors what is around, to 1, which is matt. Default: 1.
    glass: It is seen through. Default: false.
    hidden: It is not shown. Default: false.
    pattern: Of a plane: a faint chequer (lines on pages) gives the eye a scale. Default: true.
    """


class Convection(Thing):
    """Heat that the medium takes from spheres: by a coefficient, or by the correlation of Ranz and Marshall, Nu = 2 + 0.6 Re^(1/2) Pr^(1/3), at the speed relative to the flow. The defaults are those of air at 20 degrees C.

    coefficient: The h of dT/dt = -h A (T - Ta) / (m c). It stands alone. Unit: W/(m^2 K).
    conductivity: Thermal conductivity of the medium. Unit: W/(m K). Default: 0.0257.
    fluid_density: Density of the medium. Unit: kg/m^3. Default: 1.204.
    viscosity: Dynamic viscosity of the medium. Unit: Pa s. Default: 1.82e-05.
    prandtl: Prandtl number of the medium. Default: 0.713.
    flow: How the medium moves: a flow, or the name of one in `flows`.
    """


class Curve(Thing):
    """A number keyed in time, in the unit of the key that holds the curve.

    keys: The keys in the order of time, at least one, each `{"time": ..., "value": ...}`. Required.
    interpolation: What holds between two keys. Default: "linear".
    ends: What holds before the first and after the last key. Default: "hold".
    """


class CurveKey(Thing):
    """A number at a time.

    time: When; later than the key before. Unit: s. Required.
    value: The curve's value then. Required.
    """


class CurvesOverLife(Thing):
    """Factors for what a particle was born with, as its age goes on; evaluated where a state is written, never stored. In `over_life` a key's `time` is the part of the lifetime that has passed, from 0 to 1; in `over_age` it is the age in s.

    color: Of the colour, for red, green and blue.
    opacity: Of the opacity.
    size: Of the size drawn.
    attributes: Of attributes of one component, by name.
    vector_attributes: Of attributes of three components, by name.
    """


class SeriesDeformation(Thing):
    """A numbered series of meshes.

    ends: What holds before the first and after the last key. Default: "hold".
    files: OBJ, PLY or OFF files with the faces of the collider's `file`; their numbers are consecutive. Required.
    frame_rate: Frames a second. Unit: 1/s. Default: 25.
    start: When the first file holds; of a cache, when frame 0 does. Unit: s. Default: 0.
    """

    _fixed = {"type": "series"}


class KeysDeformation(Thing):
    """Meshes at times of their own.

    ends: What holds before the first and after the last key. Default: "hold".
    keys: In the order of time. Required.
    """

    _fixed = {"type": "keys"}


class CacheDeformation(Thing):
    """A point cache beside the mesh, in the PC2 format.

    ends: What holds before the first and after the last key. Default: "hold".
    file: The cache: as many points as the collider's `file` has vertices, in their order. Its start and the frames
        between its samples are those that its header says. Required.
    frame_rate: Frames a second. Unit: 1/s. Default: 25.
    start: When the first file holds; of a cache, when frame 0 does. Unit: s. Default: 0.
    """

    _fixed = {"type": "cache"}


class Drawing(Thing):
    """What the particles of an emitter are drawn as, where that is not what all are.

    particles: What particles are drawn as. Required.
    sprite: A PNG file, with alpha or without: its longer edge is as long as the particle is thick.
    mesh: A mesh file: the middle of its box is the particle's, its farthest vertex the radius away.
    turn: How sprites are turned.
    turning: How fast sprites, and meshes of particles without a spin, turn on as they age. Unit: rad/s.
    """


class PointEmitter(Thing):
    """All at one point.

    name: For messages and reports; no two emitters share one.
    burst: Particles born at once at `start`. Default: 0.
    rate: Particles a second from `start` to `stop`; drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles a frame of `simulation.frame_rate`, evenly spread inside it; drawn
        anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles a frame for every pixel that the shape covers in the
        `reference_camera`'s picture. Unit: 1/pixel. Default: 0.
    start: When it begins. Unit: s. Default: 0.
    stop: When the rate ends. Unit: s.
    limit: Most particles ever born here; of type child: of one parent's life.
    seed: Start of its own random numbers.
    direction: Where particles are launched to.
    cone: Half angle of a cone about the direction, uniform in solid angle. Unit: degrees. Default: 0.
    speed: Along the direction. Unit: m/s. Default: 0.
    velocity: Added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: One of the names in `frames`: shape, direction and velocity are in its coordinates, and particles are let
        go with its velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light); what spreads beyond is clamped.
    opacity: How much it covers what is behind, 0 to 1; what spreads beyond is clamped.
    particle_size: Radius that is drawn; collisions use particle_radius. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Of which of `particle_contacts.materials` the particles are.
    drawing: What its particles are drawn as.
    over_life: Factors over the lifetime; keys from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    """

    _fixed = {"type": "point"}


class DiskEmitter(Thing):
    """Uniform on a flat disk.

    name: For messages and reports; no two emitters share one.
    burst: Particles born at once at `start`. Default: 0.
    rate: Particles a second from `start` to `stop`; drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles a frame of `simulation.frame_rate`, evenly spread inside it; drawn
        anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles a frame for every pixel that the shape covers in the
        `reference_camera`'s picture. Unit: 1/pixel. Default: 0.
    start: When it begins. Unit: s. Default: 0.
    stop: When the rate ends. Unit: s.
    limit: Most particles ever born here; of type child: of one parent's life.
    seed: Start of its own random numbers.
    direction: Where particles are launched to.
    cone: Half angle of a cone about the direction, uniform in solid angle. Unit: degrees. Default: 0.
    speed: Along the direction. Unit: m/s. Default: 0.
    velocity: Added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: One of the names in `frames`: shape, direction and velocity are in its coordinates, and particles are let
        go with its velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light); what spreads beyond is clamped.
    opacity: How much it covers what is behind, 0 to 1; what spreads beyond is clamped.
    particle_size: Radius that is drawn; collisions use particle_radius. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Of which of `particle_contacts.materials` the particles are.
    drawing: What its particles are drawn as.
    over_life: Factors over the lifetime; keys from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    normal: Normal of the disk, of any length. Required.
    radius: Its radius. Unit: m. Required.
    """

    _fixed = {"type": "disk"}


class BoxEmitter(Thing):
    """Uniform in a box along the axes.

    name: For messages and reports; no two emitters share one.
    burst: Particles born at once at `start`. Default: 0.
    rate: Particles a second from `start` to `stop`; drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles a frame of `simulation.frame_rate`, evenly spread inside it; drawn
        anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles a frame for every pixel that the shape covers in the
        `reference_camera`'s picture. Unit: 1/pixel. Default: 0.
    start: When it begins. Unit: s. Default: 0.
    stop: When the rate ends. Unit: s.
    limit: Most particles ever born here; of type child: of one parent's life.
    seed: Start of its own random numbers.
    direction: Where particles are launched to.
    cone: Half angle of a cone about the direction, uniform in solid angle. Unit: degrees. Default: 0.
    speed: Along the direction. Unit: m/s. Default: 0.
    velocity: Added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: One of the names in `frames`: shape, direction and velocity are in its coordinates, and particles are let
        go with its velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light); what spreads beyond is clamped.
    opacity: How much it covers what is behind, 0 to 1; what spreads beyond is clamped.
    particle_size: Radius that is drawn; collisions use particle_radius. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Of which of `particle_contacts.materials` the particles are.
    drawing: What its particles are drawn as.
    over_life: Factors over the lifetime; keys from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    size: Full edge lengths. Unit: m. Required.
    """

    _fixed = {"type": "box"}


class SphereEmitter(Thing):
    """Uniform in a ball, or on its surface.

    name: For messages and reports; no two emitters share one.
    burst: Particles born at once at `start`. Default: 0.
    rate: Particles a second from `start` to `stop`; drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles a frame of `simulation.frame_rate`, evenly spread inside it; drawn
        anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles a frame for every pixel that the shape covers in the
        `reference_camera`'s picture. Unit: 1/pixel. Default: 0.
    start: When it begins. Unit: s. Default: 0.
    stop: When the rate ends. Unit: s.
    limit: Most particles ever born here; of type child: of one parent's life.
    seed: Start of its own random numbers.
    direction: Where particles are launched to.
    cone: Half angle of a cone about the direction, uniform in solid angle. Unit: degrees. Default: 0.
    speed: Along the direction. Unit: m/s. Default: 0.
    velocity: Added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: One of the names in `frames`: shape, direction and velocity are in its coordinates, and particles are let
        go with its velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light); what spreads beyond is clamped.
    opacity: How much it covers what is behind, 0 to 1; what spreads beyond is clamped.
    particle_size: Radius that is drawn; collisions use particle_radius. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Of which of `particle_contacts.materials` the particles are.
    drawing: What its particles are drawn as.
    over_life: Factors over the lifetime; keys from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    radius: Its radius. Unit: m. Required.
    surface: true: only on the surface, launched outward. Default: false.
    """

    _fixed = {"type": "sphere"}


class MeshEmitter(Thing):
    """Uniform by area on a mesh, just off its surface on the side that the triangles' normals point to, and launched along them.

    name: For messages and reports; no two emitters share one.
    burst: Particles born at once at `start`. Default: 0.
    rate: Particles a second from `start` to `stop`; drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles a frame of `simulation.frame_rate`, evenly spread inside it; drawn
        anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles a frame for every pixel that the shape covers in the
        `reference_camera`'s picture. Unit: 1/pixel. Default: 0.
    start: When it begins. Unit: s. Default: 0.
    stop: When the rate ends. Unit: s.
    limit: Most particles ever born here; of type child: of one parent's life.
    seed: Start of its own random numbers.
    direction: Where particles are launched to.
    cone: Half angle of a cone about the direction, uniform in solid angle. Unit: degrees. Default: 0.
    speed: Along the direction. Unit: m/s. Default: 0.
    velocity: Added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: One of the names in `frames`: shape, direction and velocity are in its coordinates, and particles are let
        go with its velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light); what spreads beyond is clamped.
    opacity: How much it covers what is behind, 0 to 1; what spreads beyond is clamped.
    particle_size: Radius that is drawn; collisions use particle_radius. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Of which of `particle_contacts.materials` the particles are.
    drawing: What its particles are drawn as.
    over_life: Factors over the lifetime; keys from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    file: The mesh: OBJ, PLY, STL, OFF or glTF (.gltf, .glb).
    collider: The name of a mesh collider: its surface, in the frame that it stands in.
    up: Axis of the file that points up; z does in scenes. Where y does, (x, y, z) is read as (x, -z, y), before the
        scale.
    position: Where its origin is put; scale and rotation come first. Unit: m. Default: [0, 0, 0].
    rotation: Turns it.
    scale: Factor, or one for each of its own axes; a negative one mirrors. Default: 1.
    volume: true: uniform in the inside, launched in any direction; the mesh must be closed. Default: false.
    """

    _fixed = {"type": "mesh"}


class ConeEmitter(Thing):
    """Uniform in a cone, launched along the line from its tip.

    name: For messages and reports; no two emitters share one.
    burst: Particles born at once at `start`. Default: 0.
    rate: Particles a second from `start` to `stop`; drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles a frame of `simulation.frame_rate`, evenly spread inside it; drawn
        anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles a frame for every pixel that the shape covers in the
        `reference_camera`'s picture. Unit: 1/pixel. Default: 0.
    start: When it begins. Unit: s. Default: 0.
    stop: When the rate ends. Unit: s.
    limit: Most particles ever born here; of type child: of one parent's life.
    seed: Start of its own random numbers.
    direction: Where particles are launched to.
    cone: Half angle of a cone about the direction, uniform in solid angle. Unit: degrees. Default: 0.
    speed: Along the direction. Unit: m/s. Default: 0.
    velocity: Added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: One of the names in `frames`: shape, direction and velocity are in its coordinates, and particles are let
        go with its velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light); what spreads beyond is clamped.
    opacity: How much it covers what is behind, 0 to 1; what spreads beyond is clamped.
    particle_size: Radius that is drawn; collisions use particle_radius. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Of which of `particle_contacts.materials` the particles are.
    drawing: What its particles are drawn as.
    over_life: Factors over the lifetime; keys from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    apex: Its tip. Unit: m. Default: [0, 0, 0].
    axis: From the tip into the cone, of any length. Required.
    angle: Between the axis and the side. Unit: degrees. Required.
    height: Its height. Unit: m. Required.
    """

    _fixed = {"type": "cone"}


class ChildEmitter(Thing):
    """Where another emitter's particles are, launched from their position and velocity; `burst`, `start`, `stop`, `rate_per_frame` and `rate_per_area` do not apply.

    name: For messages and reports; no two emitters share one.
    burst: Particles born at once at `start`. Default: 0.
    rate: Particles a second from `start` to `stop`; drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles a frame of `simulation.frame_rate`, evenly spread inside it; drawn
        anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles a frame for every pixel that the shape covers in the
        `reference_camera`'s picture. Unit: 1/pixel. Default: 0.
    start: When it begins. Unit: s. Default: 0.
    stop: When the rate ends. Unit: s.
    limit: Most particles ever born here; of type child: of one parent's life.
    seed: Start of its own random numbers.
    direction: Where particles are launched to.
    cone: Half angle of a cone about the direction, uniform in solid angle. Unit: degrees. Default: 0.
    speed: Along the direction. Unit: m/s. Default: 0.
    velocity: Added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: One of the names in `frames`: shape, direction and velocity are in its coordinates, and particles are let
        go with its velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light); what spreads beyond is clamped.
    opacity: How much it covers what is behind, 0 to 1; what spreads beyond is clamped.
    particle_size: Radius that is drawn; collisions use particle_radius. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Of which of `particle_contacts.materials` the particles are.
    drawing: What its particles are drawn as.
    over_life: Factors over the lifetime; keys from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    parent: Name of the emitter whose particles are the parents. Required.
    on: When parents give birth. Default: "life".
    count: Children of one death, impact or birth, rounded to whole numbers. Default: 1.
    threshold_impulse: Least impulse of an impact that gives birth. Unit: N s. Default: 0.
    share: true: the parent ends and its children share its mass and momentum; `mass` is then the weight of a share,
        radii follow at the same density, and `speed` says how fast they fly apart.
    recursive: true: the children are parents too, in turn, up to `simulation.max_depth`. Default: false.
    inherit_velocity: Part of the parent's velocity that a child begins with; 1 when sharing. Default: 1.
    inherit_color: Part of the parent's colour in the child's own `color`; without a `color` the parent's is taken.
        Default: 0.
    cloud: The children go with their parent wherever it flies and bounces, each at a place of its own about it.
    """

    _fixed = {"type": "child"}


class UniformFlow(Thing):
    """A wind: the same velocity everywhere.

    factor: Multiplies the velocity. Default: 1.
    velocity: Velocity. Unit: m/s. Required.
    gust: Lets it rise and fall: `amplitude` (part of the speed), `frequency` (Hz) and `phase` (turns, 0 unless
        given).
    """

    _fixed = {"type": "uniform"}


class VortexFlow(Thing):
    """A straight vortex without end.

    factor: Multiplies the velocity. Default: 1.
    point: A point of the axis. Unit: m. Default: [0, 0, 0].
    axis: Direction of the axis, of any length; right-hand rule. Required.
    circulation: Speed times circumference, outside the core; negative turns in the other direction. Unit: m^2/s.
        Required.
    core_radius: Radius of the core, in which the speed falls to 0 on the axis. Unit: m. Required.
    profile: How the speed depends on the distance. Default: "rankine".
    """

    _fixed = {"type": "vortex"}


class RadialFlow(Thing):
    """A source, or a sink, with a soft core.

    factor: Multiplies the velocity. Default: 1.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    strength: Volume that comes out in a second; negative for a sink. Unit: m^3/s. Required.
    core_radius: Radius of the core, in which the speed falls to 0. Unit: m. Required.
    """

    _fixed = {"type": "radial"}


class RotationFlow(Thing):
    """Turns like a rigid body.

    factor: Multiplies the velocity. Default: 1.
    point: A point of the axis. Unit: m. Default: [0, 0, 0].
    angular_velocity: Along the axis; right-hand rule. Unit: rad/s. Required.
    """

    _fixed = {"type": "rotation"}


class ShearFlow(Thing):
    """A velocity that grows linearly along a direction.

    factor: Multiplies the velocity. Default: 1.
    point: A point where the fluid is at rest. Unit: m. Default: [0, 0, 0].
    rate: Velocity gained per metre. Unit: 1/s. Required.
    gradient: Direction along which it grows, of any length. Required.
    """

    _fixed = {"type": "shear"}


class TurbulenceFlow(Thing):
    """Eddies of several sizes without divergence (curl noise).

    factor: Multiplies the velocity. Default: 1.
    speed: Root mean square of the speed. Unit: m/s. Required.
    length: Size of the largest eddies. Unit: m. Required.
    octaves: Sizes of eddies, each half as large as the one before. Default: 3.
    gain: Speed of the eddies of a size over that of the size before. Default: 0.5.
    rate: How often in a second the largest eddies are replaced by others; 0 is frozen. Unit: 1/s. Default: 0.
    seed: Which turbulence; independent of the simulation's seed. Default: 0.
    """

    _fixed = {"type": "turbulence"}


class SphereFlow(Thing):
    """Flow of an ideal fluid past a ball; nothing moves inside it.

    factor: Multiplies the velocity. Default: 1.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    radius: Its radius. Unit: m. Required.
    velocity: Velocity far away from it. Unit: m/s. Required.
    """

    _fixed = {"type": "sphere"}


class GridFlow(Thing):
    """Samples on a regular grid, interpolated linearly along each axis.

    factor: Multiplies the velocity. Default: 1.
    file: A VTK image (.vti) with point data; not compressed. Required.
    array: Name of the array, with three components.
    outside: What holds beyond the grid. Default: "clamp".
    """

    _fixed = {"type": "grid"}


class SumFlow(Thing):
    """Several flows at once.

    factor: Multiplies the velocity. Default: 1.
    parts: Flows; their velocities add up. Required.
    """

    _fixed = {"type": "sum"}


class GravityForce(Thing):
    """The same acceleration everywhere.

    particles: Ids of the particles that feel it.
    acceleration: Acceleration. Unit: m/s^2. Required.
    """

    _fixed = {"type": "gravity"}


class DragForce(Thing):
    """Linear drag F = -c w; w is the velocity relative to the flow.

    particles: Ids of the particles that feel it.
    coefficient: The c of F = -c w. Unit: kg/s. Required.
    flow: How the fluid moves: a flow, or the name of one in `flows`.
    """

    _fixed = {"type": "drag"}


class QuadraticDragForce(Thing):
    """Drag of fast bodies: F = -c |w| w, or -1/2 rho C_d pi r^2 |w| w by the particle's radius (none for points); w is the velocity relative to the flow.

    particles: Ids of the particles that feel it.
    coefficient: The c of F = -c |w| w. Unit: kg/m.
    drag_coefficient: The C_d, for particles with a radius.
    fluid_density: Density of the fluid; the default is air's at 20 degrees C. Unit: kg/m^3. Default: 1.204.
    flow: How the fluid moves: a flow, or the name of one in `flows`.
    """

    _fixed = {"type": "quadratic_drag"}


class StokesDragForce(Thing):
    """Drag of slow small spheres: F = -6 pi mu r w by the particle's radius (none for points).

    particles: Ids of the particles that feel it.
    viscosity: Dynamic viscosity of the fluid; the default is air's at 20 degrees C. Unit: Pa s. Default: 1.82e-05.
    flow: How the fluid moves: a flow, or the name of one in `flows`.
    """

    _fixed = {"type": "stokes_drag"}


class SchillerNaumannDragForce(Thing):
    """Drag of spheres at any speed, by the particle's radius (none for points): C_d = 24 / Re (1 + 0.15 Re^0.687) below Re = 1000, 0.44 above.

    particles: Ids of the particles that feel it.
    fluid_density: Density of the fluid; the default is air's at 20 degrees C. Unit: kg/m^3. Default: 1.204.
    viscosity: Dynamic viscosity of the fluid; the default is air's at 20 degrees C. Unit: Pa s. Default: 1.82e-05.
    flow: How the fluid moves: a flow, or the name of one in `flows`.
    """

    _fixed = {"type": "schiller_naumann_drag"}


class BuoyancyForce(Thing):
    """Lift of the fluid that a particle displaces: F = -rho 4/3 pi r^3 g (none for points).

    particles: Ids of the particles that feel it.
    fluid_density: Density of the fluid. Unit: kg/m^3. Required.
    gravity: The g. Unit: m/s^2. Required.
    """

    _fixed = {"type": "buoyancy"}


class ThermalBuoyancyForce(Thing):
    """Lift of parcels of gas by their attribute `temperature`: a = -g T / Ta, with gravity as a force of its own g (1 - T / Ta) in all. None for particles of 0 K.

    particles: Ids of the particles that feel it.
    ambient_temperature: The Ta of the gas around. Unit: K. Default: 293.15.
    gravity: The g. Unit: m/s^2. Required.
    """

    _fixed = {"type": "thermal_buoyancy"}


class PointGravityForce(Thing):
    """Gravity of point masses, a = -G M d / (|d|^2 + softening^2)^(3/2).

    particles: Ids of the particles that feel it.
    attractors: Objects with `position` (m), `strength` (G M, m^3/s^2) and `softening` (m, 0 unless given).
        Required.
    """

    _fixed = {"type": "point_gravity"}


class RadialForce(Thing):
    """Towards a centre by a power of the distance: |F| = strength (s / reference)^exponent with s^2 = distance^2 + softening^2 (times distance / s).

    particles: Ids of the particles that feel it.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    strength: Force at the reference distance; negative pushes away. Unit: N. Required.
    exponent: 1 for a spring, -2 for Coulomb's law. Default: -2.
    softening: Length within which it weakens. Unit: m. Default: 0.
    reference: The distance at which the strength is meant. Unit: m. Default: 1.
    """

    _fixed = {"type": "radial"}


class SwirlForce(Thing):
    """Around an axis: grows linearly within the core, falls as one over the distance outside.

    particles: Ids of the particles that feel it.
    point: A point of the axis. Unit: m. Default: [0, 0, 0].
    axis: Direction of the axis, of any length; right-hand rule. Required.
    acceleration: At the rim of the core; negative turns in the other direction. Unit: m/s^2. Required.
    core_radius: Radius of the core. Unit: m. Required.
    """

    _fixed = {"type": "swirl"}


class FieldForce(Thing):
    """The vectors of a flow, taken as accelerations or forces.

    particles: Ids of the particles that feel it.
    flow: How the fluid moves: a flow, or the name of one in `flows`. Required.
    as: What the vectors mean. Default: "acceleration".
    """

    _fixed = {"type": "field"}


class LorentzForce(Thing):
    """Charged particles in uniform fields: F = q (E + v x B).

    particles: Ids of the particles that feel it.
    charge: Of every particle. Unit: C. Required.
    electric: The E. Unit: V/m. Default: [0, 0, 0].
    magnetic: The B. Unit: T. Default: [0, 0, 0].
    """

    _fixed = {"type": "lorentz"}


class AnchorForce(Thing):
    """A spring and damper to a fixed point; the damper acts along the spring.

    particles: Ids of the particles that feel it.
    position: The fixed point. Unit: m. Required.
    stiffness: Spring constant. Unit: N/m. Required.
    rest_length: Length at which it does not pull. Unit: m. Default: 0.
    damping: Force over the speed along the spring. Unit: kg/s. Default: 0.
    """

    _fixed = {"type": "anchor"}


class GravityForceBetweenParticles(Thing):
    """Newton's law between every two particles, by their masses.

    particles: Ids of particles that take part.
    emitter: Name of an emitter: what it gives birth to takes part.
    constant: Of gravitation; negative repels. Scenes with units of their own often have 1. Unit: m^3/(kg s^2).
        Default: 6.6743e-11.
    softening: Length over which each particle is smeared out: the force is weaker within it. Without it two that
        come near each other need steps as short as their passage. Unit: m. Default: 0.
    method: How all are added up. Default: "auto".
    opening: Of the tree: groups are taken together from where their radius over their distance is smaller than
        this. Smaller is more exact and slower. Default: 0.5.
    """

    _fixed = {"type": "gravity"}


class ChargeForceBetweenParticles(Thing):
    """Coulomb's law between every two particles, by a charge that they carry as an attribute.

    particles: Ids of particles that take part.
    emitter: Name of an emitter: what it gives birth to takes part.
    attribute: The attribute, of one component, that holds the charge in C. Default: "charge".
    constant: Coulomb's; negative attracts like charges. Unit: N m^2/C^2. Default: 8987551786.2.
    softening: Length over which each particle is smeared out: the force is weaker within it. Without it two that
        come near each other need steps as short as their passage. Unit: m. Default: 0.
    method: How all are added up. Default: "auto".
    opening: Of the tree: groups are taken together from where their radius over their distance is smaller than
        this. Smaller is more exact and slower. Default: 0.5.
    """

    _fixed = {"type": "charge"}


class LennardJonesForceBetweenParticles(Thing):
    """The force of neutral atoms: repulsion by the 12th, attraction by the 6th power of the distance, cut off smoothly. The least potential is near a distance of 1.12 diameters.

    particles: Ids of particles that take part.
    emitter: Name of an emitter: what it gives birth to takes part.
    depth: How deep the least potential is, without the cutoff. Unit: J. Default: 1.
    diameter: Distance of the centres at which the potential is 0. Unit: m. Default: 1.
    cutoff: Diameters beyond which there is no force. Default: 2.5.
    """

    _fixed = {"type": "lennard_jones"}


class CohesionForceBetweenParticles(Thing):
    """Spheres that stick: a spring between their surfaces that lets go at a gap, F = k g (1 - g / range)^2, and pushes back where they overlap.

    particles: Ids of particles that take part.
    emitter: Name of an emitter: what it gives birth to takes part.
    stiffness: The k: the spring's near contact. Unit: N/m. Required.
    range: Gap between the surfaces at which they let go. Unit: m. Required.
    damping: Along the line of the centres, within the range. Unit: N s/m. Default: 0.
    """

    _fixed = {"type": "cohesion"}


class Frame(Thing):
    """A moving frame of reference, for emitters and colliders. It stands in its parent like this: translation, rotation, then the motions in their order.

    parent: One of the names in `frames`: what it stands in.
    translation: Where its origin is in the parent's axes. Unit: m. Default: [0, 0, 0].
    rotation: Turns it.
    motions: How it moves.
    body: Makes it a rigid body that particles and forces move.
    """


class RotationFrameMotion(Thing):
    """A turn about an axis through the frame's origin, by the right-hand rule.

    axis: Direction of the axis, of any length. Required.
    angle: The angle: a curve. Unit: degrees. Required.
    """

    _fixed = {"type": "rotation"}


class SpinFrameMotion(Thing):
    """A steady turn about an axis through the frame's origin.

    axis: Direction of the axis, of any length. Required.
    rate: By the right-hand rule; the angle is 0 at 0 s. Unit: degrees/s. Required.
    """

    _fixed = {"type": "spin"}


class SwingFrameMotion(Thing):
    """A turn to and fro about an axis through the frame's origin.

    axis: Direction of the axis, of any length. Required.
    amplitude: The largest angle. Unit: degrees. Required.
    frequency: How often a second. Unit: Hz. Required.
    phase: Of the sine at 0 s. Unit: degrees. Default: 0.
    """

    _fixed = {"type": "swing"}


class OscillationFrameMotion(Thing):
    """A way to and fro.

    amplitude: The largest offset of the origin. Unit: m. Required.
    frequency: How often a second. Unit: Hz. Required.
    phase: Of the sine at 0 s. Unit: degrees. Default: 0.
    """

    _fixed = {"type": "oscillation"}


class TranslationFrameMotion(Thing):
    """A translation along a curve.

    way: Where the origin goes: a curve of [x, y, z]. Unit: m. Required.
    """

    _fixed = {"type": "translation"}


class ScaleFrameMotion(Thing):
    """A scale along the frame's axes, about its origin: of what comes after it and of all that stands on the frame. Colliders in it are meshes and boxes.

    factor: The factor: a curve of numbers, or of [x, y, z]. Required.
    """

    _fixed = {"type": "scale"}


class Gust(Thing):
    """The wind is multiplied by 1 + amplitude sin(2 pi (frequency t + phase)).

    amplitude: Part of the wind's speed; above 1 the wind turns round at times. Required.
    frequency: How often it rises and falls. Unit: Hz. Required.
    phase: Where in its cycle it starts. Unit: turns. Default: 0.
    """


class Heat(Thing):
    """What changes the attribute `temperature` (K) of all particles, which must be declared. A particle has one temperature throughout.

    specific_heat: Of the particles. Unit: J/(kg K). Required.
    ambient_temperature: Of the medium, and of what the particles shine at. Unit: K. Default: 293.15.
    convection: Heat that the medium takes.
    emissivity: Heat that spheres radiate, and take in, over that of black bodies. Default: 0.
    impact_fraction: Part of the energy that impacts lose along the normal, by restitution, that heats the particle.
        Default: 0.
    friction_fraction: Part of the energy that friction takes, in impacts and in contact, that heats the particle.
        Default: 0.
    """


class KeyPose(Thing):
    """Where a collider's frame is at a time; between two keys it moves, turns and is scaled steadily.

    time: When; later than the key before. Unit: s. Required.
    position: Of the frame's origin. Unit: m. Default: [0, 0, 0].
    rotation: How it is turned then.
    scale: Factor, or one for each of the frame's axes: of meshes and boxes, whose vertices it moves. Default: 1.
    """


class Material(Thing):
    """What a surface does to what hits it.

    restitution: Speed of the rebound over speed of the approach, along the normal. Default: 1.
    restitution_threshold: Below this speed of approach the restitution falls linearly to 0. Unit: m/s. Default: 0.
    friction: Coulomb's coefficient, for impacts and for sliding. Default: 0.
    rolling_friction: Moment that resists rolling, over radius times normal force; for particles with a radius.
        Default: 0.
    spinning_friction: Moment that resists spinning about the normal, over normal force; for particles with a
        radius. Unit: m. Default: 0.
    diffuse: Accommodation: fraction of the impacts that are reflected by the cosine law. Default: 0.
    wall_temperature: Diffuse reflections leave with the thermal speeds of a wall of this temperature. Unit: K.
    absorption: Fraction of the impacts that remove the particle. Default: 0.
    surface_motion: How the surface's own material moves.
    """


class MeshKey(Thing):
    """The vertices of a mesh at a time.

    time: When; later than the key before. Unit: s. Required.
    file: OBJ, PLY or OFF, with the faces of the collider's `file`. Required.
    """


class Output(Thing):
    """What a run writes.

    format: Of the frames. Default: "vtp".
    every: Steps from one frame to the next. The last state is always written. Default: 1.
    checkpoint_every: Steps from one checkpoint to the next, each made with the frame that follows. An interrupted
        run leaves one in any case; `ricochet run --resume` goes on from it. Default: 0.
    pieces: Each process of a run that several share writes its own part of the frames, with a .pvtp index over
        them, and of the checkpoints. Otherwise the first process gathers and writes them. Default: false.
    contacts: Write every impact, as points with their columns, once a frame. Default: false.
    """


class PairOfMaterials(Thing):
    """What spheres of two materials do to each other.

    first: One of the materials. Required.
    second: Another one, or the same. Required.
    restitution: Speed of parting over speed of approach along the normal.
    friction: Coulomb coefficient between spheres.
    rolling_friction: Moment that resists turning relative to each other, over the reduced radius times the normal
        impulse.
    """


class Particle(Thing):
    """Particles that are there from the start.

    position: Where it starts. Unit: m. Required.
    velocity: How it starts. Unit: m/s. Default: [0, 0, 0].
    mass: Its mass. Unit: kg. Default: 1.
    radius: Its radius. Unit: m. Default: 0.
    spin: Its angular velocity; for particles with a radius. Unit: rad/s. Default: [0, 0, 0].
    lifetime: Time after which it is retired. Unit: s.
    pinned: true: it never moves, for springs to hang on. Default: false.
    color: Red, green and blue, 0 to 1 (linear light).
    opacity: How much it covers what is behind.
    size: Radius that is drawn. Unit: m.
    attributes: Values of the scene's `attributes`, by name; no spread.
    material: Of which of `particle_contacts.materials` it is.
    """


class ParticleContacts(Thing):
    """What spheres do when they meet each other.

    restitution: Speed of parting over speed of approach along the normal. Default: 1.
    friction: Coulomb coefficient between spheres. Default: 0.
    rolling_friction: Moment that resists turning relative to each other, over the reduced radius times the normal
        impulse. Default: 0.
    method: How spheres that meet are moved. Default: "auto".
    impact_budget: Most impacts of one sphere on others in one step. A sphere that spends it stays where it is for
        the rest of the step, and the time left out is counted. Default: 1000.
    materials: Materials of spheres by name, and what spheres of one do to each other. Emitters and particles say of
        which they are by `material`; the particles' column `material` is its number, in this order.
    pairs: What spheres of two materials do to each other.
    """


class ParticleTable(Thing):
    """Particles from a file.

    file: A .csv file: a header line that names the columns (x, y, z and, where wanted, vx, vy, vz, mass, radius,
        spin_x, spin_y, spin_z, lifetime), then one line a particle. Required.
    """


class Penalty(Thing):
    """Settings of the penalty response.

    stiffness: Spring constant of contacts. Unit: N/m.
    contact_steps: Sub-steps that an undamped contact lasts, where no stiffness is given. Default: 20.
    substeps: Equal parts that every step is cut into. Default: 10.
    friction_speed: Friction grows linearly with the slip up to this speed. Unit: m/s. Default: 0.001.
    """


class Picture(Thing):
    """Light and surroundings of `ricochet render`, unless it is told otherwise.

    light: What lights it.
    background: Red, green and blue behind everything, linear light.
    transparent: Nothing behind everything: an alpha channel in PNG files. Default: false.
    particles: What particles are drawn as.
    sprite: A PNG file, with alpha or without: its longer edge is as long as the particle is thick.
    mesh: A mesh file: the middle of its box is the particle's, its farthest vertex the radius away.
    turn: How sprites are turned.
    turning: How fast sprites, and meshes of particles without a spin, turn on as they age. Unit: rad/s.
    shutter: How long it is open, up to the picture's time: moving particles blur. 0: not at all. Unit: s. Default:
        0.
    black_body: Particles shine as black bodies of their attribute `temperature` (K): at this one as brightly as a
        white surface in the sun. Unit: K.
    stretch: Squash and stretch of spheres and meshes, at the same volume.
    ground: A level ground at this height along the upward axis. Unit: m.
    particle_radius: Radius by which all particles are drawn. Collisions do not know it. Unit: m.
    time: The moment that a single picture shows: the nearest frame. Films show all. Unit: s.
    """


class PinBox(Thing):
    """A box along the axes; vertices in it, or on its surface, are pinned.

    lower: Its corner with the smallest coordinates. Unit: m. Required.
    upper: Its corner with the largest coordinates. Unit: m. Required.
    """


class Project(Thing):
    """Settings of the project response.

    offset: Thickness of the layer on surfaces in which a particle counts as in contact, and to whose top it is put
        back. Unit: m. Default: 1e-06.
    """


class ReferenceCamera(Thing):
    """On whose screen emitters are measured; part of the scene, not of any picture.

    position: Where it stands. Unit: m. Required.
    target: The point in the middle of its picture. Unit: m. Required.
    field_of_view: Angle from the lower to the upper edge. Unit: degrees. Default: 35.
    image_height: Pixels from the lower to the upper edge. Default: 720.
    """


class Rollback(Thing):
    """Settings of the rollback response.

    time_tolerance: How closely bisection brackets the time of contact. Unit: s. Default: 1e-09.
    global: The whole system goes back to the earliest contact, as in textbooks, and not each particle for itself.
        Costs grow with particles times contacts. Default: false.
    """


class Rotation(Thing):
    """A turn about an axis through the own origin, by the right-hand rule.

    axis: Direction of the axis, of any length. Required.
    degrees: Angle. Unit: degrees. Required.
    """


class ScaleCurve(Thing):
    """Factors keyed in time: a curve whose values are numbers or [x, y, z], all above 0.

    keys: The keys in the order of time, at least one, each `{"time": ..., "value": ...}`. Required.
    interpolation: What holds between two keys. Default: "linear".
    ends: What holds before the first and after the last key. Default: "hold".
    """


class ScaleCurveKey(Thing):
    """A factor at a time.

    time: When; later than the key before. Unit: s. Required.
    value: The factor then, or one for each axis. Required.
    """


class SimulationOptions(Thing):
    """How time is stepped and how impacts are answered.

    time_step: Length of a step. Unit: s. Default: 0.016666666666666666.
    duration: Simulated time. The number of steps is ceil(duration / time_step - 1e-6), at least 1 where it is above
        0; the last one ends there. Unit: s. Default: 1.
    integrator: How particles move inside a step. Of these only `forward_euler`, `midpoint`, `rk4` and
        `dormand_prince` have a meaning where a flow carries the particles.
    tolerance: What one sub-step of dormand_prince may be wrong by.
    response: How impacts are answered. Default: "exact".
    motion: What moves the particles. Default: "forces".
    flow: What carries the particles where `motion` is `flow`: a flow, or the name of one in `flows`.
    walls: What happens to particles that the flow carries into a wall. Default: "slide".
    seed: Start of all random numbers: the same seed gives the same run, to the bit. Default: 0.
    resting_speed: A rebound slower than this becomes resting or sliding contact, where the bounces lose energy and
        something presses the particle on. Unit: m/s. Default: 0.001.
    frame_rate: Frames a second of emitters' rates per frame; neither the output's nor the time step's. Unit: 1/s.
        Default: 24.
    max_depth: Highest generation of particles born of particles; births beyond are refused and counted. Default:
        16.
    most_particles: Most particles alive at a time; births beyond are refused and counted. A fixed number, so that a
        run is the same on every machine; it must fit the memory all the same. Default: 100000000.
    bounce_budget: Most impacts of one particle in one step; beyond 64 intervals of contact every four count as one.
        A particle that spends it stays where it is for the rest of the step, and the time left out is counted.
        Default: 1000.
    rollback: Of the rollback response.
    project: Of the project response.
    penalty: Of the penalty response.
    """


class SphereMaterial(Thing):
    """What spheres of this material do to each other.

    restitution: Speed of parting over speed of approach along the normal.
    friction: Coulomb coefficient between spheres.
    rolling_friction: Moment that resists turning relative to each other, over the reduced radius times the normal
        impulse.
    """


class Spring(Thing):
    """A spring between two particles.

    first: Number of the particle at one end. Required.
    second: Number of the particle at the other end. Required.
    rest_length: Length at which it neither pulls nor pushes. Unit: m.
    stiffness: Force over stretch. Unit: N/m. Required.
    damping: Force against the rate at which a spring changes its length, over that rate. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a part of the rest length, beyond which a spring breaks for good.
    """


class ListSprings(Thing):
    """Springs one by one, between particles by their numbers from 0: first those of `particles`, then those of the ropes, chains, cloths and sheets, each in its order.

    springs: The springs. Required.
    """

    _fixed = {"type": "list"}


class RopeSprings(Thing):
    """Particles at equal distances along a line, with springs between neighbours.

    from: Position of its first particle. Unit: m. Required.
    to: Position of its last particle. Unit: m. Required.
    nodes: Its particles. Required.
    length: Length at rest. A longer rope than the distance of its ends starts as a catenary, a shorter one straight
        and under tension. Unit: m.
    mass: Its whole mass. Unit: kg. Required.
    radius: Radius of its particles. Unit: m. Default: 0.
    stiffness: Of every segment. Unit: N/m.
    axial_stiffness: Of the material, E A: a segment's stiffness is this over its length at rest. Unit: N.
    damping: Force against the rate at which a spring changes its length, over that rate. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a part of the rest length, beyond which a spring breaks for good.
    sag: Direction in which it hangs at first where it is longer than the distance of its ends.
    pinned: Which ends never move. Default: "none".
    """

    _fixed = {"type": "rope"}


class ChainSprings(Thing):
    """A rope by its links; one longer than the distance of its ends starts as a catenary.

    from: Position of its first particle. Unit: m. Required.
    to: Position of its last particle. Unit: m. Required.
    links: Springs in a row; it has one particle more. Required.
    link_length: Length of a link at rest. Unit: m. Required.
    mass: Its whole mass. Unit: kg. Required.
    radius: Radius of its particles. Unit: m. Default: 0.
    stiffness: Of every segment. Unit: N/m.
    axial_stiffness: Of the material, E A: a segment's stiffness is this over its length at rest. Unit: N.
    damping: Force against the rate at which a spring changes its length, over that rate. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a part of the rest length, beyond which a spring breaks for good.
    sag: Direction in which it hangs at first where it is longer than the distance of its ends.
    pinned: Which ends never move. Default: "none".
    """

    _fixed = {"type": "chain"}


class ClothSprings(Thing):
    """A particle at every vertex of a mesh, a spring along every edge; at rest as the mesh is. A particle has a third of the mass of every triangle around it.

    file: The mesh: OBJ, PLY, STL, OFF or glTF (.gltf, .glb). Required.
    up: Axis of the file that points up; z does in scenes. Where y does, (x, y, z) is read as (x, -z, y), before the
        scale.
    position: Where its origin is put; scale and rotation come first. Unit: m. Default: [0, 0, 0].
    rotation: Turns it.
    scale: Factor, or one for each of its own axes; a negative one mirrors. Default: 1.
    mass: Its whole mass. Unit: kg.
    mass_per_area: Mass over area. Unit: kg/m^2.
    radius: Radius of its particles. Unit: m. Default: 0.
    stiffness: Of the springs along the edges. Unit: N/m. Required.
    bending_stiffness: Of springs that join the corners across every edge between two triangles, and so resist
        bending. Unit: N/m. Default: 0.
    damping: Force against the rate at which a spring changes its length, over that rate. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a part of the rest length, beyond which a spring breaks for good.
    pinned: Numbers, from 0, of vertices that never move.
    pin_boxes: Boxes in which vertices never move.
    """

    _fixed = {"type": "cloth"}


class SheetSprings(Thing):
    """A cloth without a file: a flat sheet of cells of two triangles each. Vertex (i, j) has the number j (cells_u + 1) + i.

    corner: One of its corners. Unit: m. Required.
    side_u: From there along one side to its end. Unit: m. Required.
    side_v: From there along the other side. Unit: m. Required.
    cells_u: Cells along the one side. Required.
    cells_v: Cells along the other side. Required.
    mass: Its whole mass. Unit: kg.
    mass_per_area: Mass over area. Unit: kg/m^2.
    radius: Radius of its particles. Unit: m. Default: 0.
    stiffness: Of the springs along the edges. Unit: N/m. Required.
    bending_stiffness: Of springs that join the corners across every edge between two triangles, and so resist
        bending. Unit: N/m. Default: 0.
    damping: Force against the rate at which a spring changes its length, over that rate. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a part of the rest length, beyond which a spring breaks for good.
    pinned: Numbers, from 0, of vertices that never move.
    pin_boxes: Boxes in which vertices never move.
    """

    _fixed = {"type": "sheet"}


class Stretch(Thing):
    """How drawn particles change their shape as they move; collisions know nothing of it.

    speed: Along their velocity they are longer by the factor 1 + `speed` times the speed. Unit: s/m. Default: 0.
    impact: At an impact they are flatter along its normal by the factor 1 + `impact` times the speed along it; this
        needs `output.contacts`. Unit: s/m. Default: 0.
    time: How long an impact shows, half of it before. Unit: s. Default: 0.1.
    most: Neither longer nor flatter than by this factor. Default: 2.
    """


class SurfaceMotion(Thing):
    """How the material of the surface moves while its geometry stands still: a belt, or the wall of a drum that turns about its own axis. Friction, resistance to rolling and spinning, and diffuse reflection are relative to it; only the part of the velocity along the surface counts.

    velocity: The same everywhere. Unit: m/s. Default: [0, 0, 0].
    angular_velocity: Turning by the right-hand rule about an axis through `center`, added to `velocity`. Unit:
        rad/s. Default: [0, 0, 0].
    center: A point of the axis, in world coordinates. Unit: m. Default: [0, 0, 0].
    """


class Tolerance(Thing):
    """What one sub-step of an adaptive integrator may be wrong by.

    position: Of the position, also between a sub-step's ends. Unit: m. Default: 1e-06.
    velocity: Of the velocity. Unit: m/s. Default: 1e-06.
    """


class VectorCurve(Thing):
    """A vector keyed in time: a curve whose values are [x, y, z].

    keys: The keys in the order of time, at least one, each `{"time": ..., "value": ...}`. Required.
    interpolation: What holds between two keys. Default: "linear".
    ends: What holds before the first and after the last key. Default: "hold".
    """


class VectorCurveKey(Thing):
    """A vector at a time.

    time: When; later than the key before. Unit: s. Required.
    value: The curve's value then. Required.
    """
