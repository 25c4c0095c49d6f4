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

    simulation: Time steps and impacts.
    forces: Forces on the particles.
    particle_forces: Forces between the particles.
    flows: Flows by name, which several forces can share.
    materials: Materials by name.
    colliders: Surfaces that particles bounce off.
    frames: Moving frames of reference by name.
    emitters: Sources of particles.
    particles: Particles that exist from the start, one by one or from a table.
    springs: Springs between particles, and ropes, chains and cloth with particles of their own.
    particle_contacts: Contacts between spheres.
    heat: Processes that change the temperature of particles.
    attributes: User-defined values of particles, by name.
    reference_camera: Camera for emitter rates per screen area.
    bounds: Box outside which particles are retired.
    counters: Disks that count the particles that pass them.
    output: Files that a run writes.
    camera: Camera of pictures.
    picture: Light and surroundings of pictures.
    """

    _fixed = {"ricochet": 1}


class Attractor(Thing):
    """A point that attracts.

    position: Position of the point. Unit: m. Required.
    strength: Gravitational constant times mass. Negative values repel. Unit: m^3/s^2. Required.
    softening: Length over which its mass is spread. Unit: m. Default: 0.
    """


class Attribute(Thing):
    """A user-defined value of every particle. It is written to frames. Only forces that read an attribute depend on it, for example `charge`.

    components: Number of components: 1, or 3 for a vector. Default: 1.
    default: Value of particles without a value of their own.
    """


class Body(Thing):
    """A rigid body that impulses of particles and the scene's forces move. Its frame stands in the world and has no motions. The frame's translation and rotation give the start pose. Bodies collide neither with each other nor with colliders at rest.

    mass: Mass. Give either this or `density`. Unit: kg.
    density: Mass per volume. The volume is that of the closed colliders in the frame, which must not overlap. Unit:
        kg/m^3.
    center: Centre of mass, in the frame's coordinates. Unit: m.
    inertia: Moments of inertia about the axes of the frame through the centre of mass: [xx, yy, zz]. Unit: kg m^2.
    inertia_products: Elements xy, xz and yz of the inertia tensor: minus the sums of mass times x y, x z and y z.
        Unit: kg m^2. Default: [0, 0, 0].
    joint: Joint that constrains the body. Default: "free".
    axis: Direction of the axis of a hinge or slider, of any length, in the frame's axes at 0 s. Default: [0, 0, 1].
    velocity: Velocity of the centre of mass of a free body at 0 s. Unit: m/s. Default: [0, 0, 0].
    angular_velocity: Angular velocity of a free body at 0 s. Unit: rad/s. Default: [0, 0, 0].
    rate: Speed at 0 s: of the rotation on a hinge, by the right-hand rule, or of the motion along a slider. Unit:
        rad/s or m/s. Default: 0.
    spring: Spring constant of a hinge or slider: moment or force towards `spring_rest`, per angle or distance from
        it. Unit: N m/rad or N/m. Default: 0.
    spring_rest: Angle or offset at which the spring exerts no force. 0 is the pose at 0 s. Unit: rad or m. Default:
        0.
    damping: Damping of a hinge or slider: moment or force against the motion, per speed. Unit: N m s/rad or N s/m.
        Default: 0.
    drive: Constant moment about the axis of a hinge, or force along the axis of a slider. Unit: N m or N. Default:
        0.
    friction: Dry friction of a hinge or slider: largest moment or force against the motion. Unit: N m or N.
        Default: 0.
    motor_rate: Target speed of a motor on the hinge or slider. Unit: rad/s or m/s. Default: 0.
    motor_most: Largest moment or force of the motor. 0 means no motor. Unit: N m or N. Default: 0.
    feels_forces: true: the scene's forces act on it like on a point particle with its mass, at its centre of mass.
        Default: true.
    """


class Bounds(Thing):
    """A box in world coordinates. Particles that leave it are retired.

    lower: Corner with the smallest coordinates. Unit: m. Required.
    upper: Corner with the largest coordinates. Each is above that of `lower`. Unit: m. Required.
    """


class Camera(Thing):
    """Camera of `ricochet render`, unless its options say otherwise.

    position: Position of the camera. Unit: m.
    target: Point in the middle of the picture. Unit: m.
    path: Instead of `position`: path of the camera, a curve of [x, y, z]. Unit: m.
    target_path: Instead of `target`: path of the target, a curve of [x, y, z]. Unit: m.
    frame: Name of a frame in `frames`. Position, target and `up` are in its coordinates.
    up: Upward direction in the picture.
    field_of_view: Angle from the lower to the upper edge. Unit: degrees. Default: 35.
    focal_length: Instead of `field_of_view`: focal length of a lens in front of film 24 mm high. Unit: mm.
    aperture: Diameter of the lens. Objects nearer or farther than `focus_distance` blur. With 0 everything is
        sharp. Unit: m. Default: 0.
    focus_distance: Distance along the view at which objects are sharp. 0 means the distance of the target. Unit: m.
        Default: 0.
    """


class PointCloud(Thing):
    """All at one point.

    turning: Angular velocity of the target positions about the parent. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration of a child towards its target position, per metre of distance from it. Unit: 1/s^2. Default:
        0.
    damping: Acceleration against the velocity relative to the target position, per m/s. Unit: 1/s. Default: 0.
    parent_ends: Behaviour of the children after the end of their parent. Default: "free".
    center: Its centre. Unit: m. Default: [0, 0, 0].
    """

    _fixed = {"type": "point"}


class DiskCloud(Thing):
    """Uniform on a flat disk.

    turning: Angular velocity of the target positions about the parent. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration of a child towards its target position, per metre of distance from it. Unit: 1/s^2. Default:
        0.
    damping: Acceleration against the velocity relative to the target position, per m/s. Unit: 1/s. Default: 0.
    parent_ends: Behaviour of the children after the end of their parent. Default: "free".
    center: Its centre. Unit: m. Default: [0, 0, 0].
    normal: Normal of the disk, of any length. Required.
    radius: Its radius. Unit: m. Required.
    """

    _fixed = {"type": "disk"}


class BoxCloud(Thing):
    """Uniform in a box along the axes.

    turning: Angular velocity of the target positions about the parent. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration of a child towards its target position, per metre of distance from it. Unit: 1/s^2. Default:
        0.
    damping: Acceleration against the velocity relative to the target position, per m/s. Unit: 1/s. Default: 0.
    parent_ends: Behaviour of the children after the end of their parent. Default: "free".
    center: Its centre. Unit: m. Default: [0, 0, 0].
    size: Full edge lengths. Unit: m. Required.
    """

    _fixed = {"type": "box"}


class SphereCloud(Thing):
    """Uniform in a ball, or on its surface.

    turning: Angular velocity of the target positions about the parent. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration of a child towards its target position, per metre of distance from it. Unit: 1/s^2. Default:
        0.
    damping: Acceleration against the velocity relative to the target position, per m/s. Unit: 1/s. Default: 0.
    parent_ends: Behaviour of the children after the end of their parent. Default: "free".
    center: Its centre. Unit: m. Default: [0, 0, 0].
    radius: Its radius. Unit: m. Required.
    surface: true: only on the surface, launched outward. Default: false.
    """

    _fixed = {"type": "sphere"}


class ConeCloud(Thing):
    """Uniform in a cone, launched along the line from its tip.

    turning: Angular velocity of the target positions about the parent. Unit: rad/s. Default: [0, 0, 0].
    pull: Acceleration of a child towards its target position, per metre of distance from it. Unit: 1/s^2. Default:
        0.
    damping: Acceleration against the velocity relative to the target position, per m/s. Unit: 1/s. Default: 0.
    parent_ends: Behaviour of the children after the end of their parent. Default: "free".
    apex: Tip of the cone. Unit: m. Default: [0, 0, 0].
    axis: Direction from the tip into the cone, of any length. Required.
    angle: Angle between the axis and the side. Unit: degrees. Required.
    height: Its height. Unit: m. Required.
    """

    _fixed = {"type": "cone"}


class PlaneCollider(Thing):
    """An infinite plane.

    name: Unique name for messages, reports and emitters.
    material: Name of a material in `materials`.
    looks: Appearance in pictures.
    frame: Name of a frame in `frames`. The collider stands in it and moves with it. Requires the response "exact".
    motion: Poses of a frame of its own in order of time, at least one: `{"time": ..., "position": ..., "rotation":
        ..., "scale": ...}`. They are relative to `frame` if that is given, too. The collider's own position and
        rotation are relative to the poses.
    point: A point on the plane. Unit: m. Default: [0, 0, 0].
    normal: Normal of the plane, of any length. Required.
    """

    _fixed = {"type": "plane"}


class MeshCollider(Thing):
    """A triangle mesh from a file, open or closed.

    name: Unique name for messages, reports and emitters.
    material: Name of a material in `materials`.
    looks: Appearance in pictures.
    frame: Name of a frame in `frames`. The collider stands in it and moves with it. Requires the response "exact".
    motion: Poses of a frame of its own in order of time, at least one: `{"time": ..., "position": ..., "rotation":
        ..., "scale": ...}`. They are relative to `frame` if that is given, too. The collider's own position and
        rotation are relative to the poses.
    file: Mesh file: OBJ, PLY, STL, OFF or glTF (.gltf, .glb). Required.
    up: Axis of the file that points up. In scenes it is z. With y, (x, y, z) is read as (x, -z, y), before the
        scale.
    position: Position of its origin. Scale and rotation are applied first. Unit: m. Default: [0, 0, 0].
    rotation: Rotation about its origin.
    scale: Scale factor, or one factor for each of its own axes. A negative factor mirrors. Default: 1.
    group_materials: Materials for parts of an OBJ, glTF or ASCII STL mesh. Each key is a name that the file gives
        to faces, and each value is a name in `materials`. The material name (`usemtl`) of a face comes first. The
        next is its `g` name: the whole line, then word by word. In glTF this is the name of the mesh, in ASCII STL
        that of the solid. The last is its `o` name, in glTF that of the node. Faces without a listed name take the
        collider's material.
    deformation: Motion of the vertices. `file` then gives only the faces. Requires the response "exact", and no
        `frame` or `motion`.
    """

    _fixed = {"type": "mesh"}


class SphereCollider(Thing):
    """A ball about its own origin. It is an ellipsoid if the scale differs by axis.

    name: Unique name for messages, reports and emitters.
    material: Name of a material in `materials`.
    looks: Appearance in pictures.
    frame: Name of a frame in `frames`. The collider stands in it and moves with it. Requires the response "exact".
    motion: Poses of a frame of its own in order of time, at least one: `{"time": ..., "position": ..., "rotation":
        ..., "scale": ...}`. They are relative to `frame` if that is given, too. The collider's own position and
        rotation are relative to the poses.
    radius: Its radius. Unit: m. Required.
    position: Position of its origin. Scale and rotation are applied first. Unit: m. Default: [0, 0, 0].
    rotation: Rotation about its origin.
    scale: Scale factor, or one factor for each of its own axes. A negative factor mirrors. Default: 1.
    """

    _fixed = {"type": "sphere"}


class CylinderCollider(Thing):
    """A cylinder with flat caps about its own z axis, centred on its own origin.

    name: Unique name for messages, reports and emitters.
    material: Name of a material in `materials`.
    looks: Appearance in pictures.
    frame: Name of a frame in `frames`. The collider stands in it and moves with it. Requires the response "exact".
    motion: Poses of a frame of its own in order of time, at least one: `{"time": ..., "position": ..., "rotation":
        ..., "scale": ...}`. They are relative to `frame` if that is given, too. The collider's own position and
        rotation are relative to the poses.
    radius: Its radius. Unit: m. Required.
    height: Its height. Unit: m. Required.
    position: Position of its origin. Scale and rotation are applied first. Unit: m. Default: [0, 0, 0].
    rotation: Rotation about its origin.
    scale: Scale factor, or one factor for each of its own axes. A negative factor mirrors. Default: 1.
    """

    _fixed = {"type": "cylinder"}


class BoxCollider(Thing):
    """A box centred on its own origin.

    name: Unique name for messages, reports and emitters.
    material: Name of a material in `materials`.
    looks: Appearance in pictures.
    frame: Name of a frame in `frames`. The collider stands in it and moves with it. Requires the response "exact".
    motion: Poses of a frame of its own in order of time, at least one: `{"time": ..., "position": ..., "rotation":
        ..., "scale": ...}`. They are relative to `frame` if that is given, too. The collider's own position and
        rotation are relative to the poses.
    size: Full edge lengths. Unit: m. Required.
    position: Position of its origin. Scale and rotation are applied first. Unit: m. Default: [0, 0, 0].
    rotation: Rotation about its origin.
    scale: Scale factor, or one factor for each of its own axes. A negative factor mirrors. Default: 1.
    """

    _fixed = {"type": "box"}


class ColliderLooks(Thing):
    """Appearance of a collider in pictures. It does not affect the run.

    color: Red, green and blue, linear light.
    roughness: Roughness from 0 (mirror) to 1 (matt). Default: 1.
    glass: true: the collider is transparent. Default: false.
    hidden: true: the collider is not shown. Default: false.
    pattern: true: a plane has a faint chequer pattern (lines on pages) that shows the scale. Default: true.
    """


class Convection(Thing):
    """Heat exchange between spheres and the medium, by a coefficient or by the correlation of Ranz and Marshall: Nu = 2 + 0.6 Re^(1/2) Pr^(1/3). Re uses the speed relative to the flow. The defaults describe air at 20 degrees C.

    coefficient: Coefficient h in dT/dt = -h A (T - Ta) / (m c). It excludes all other keys. Unit: W/(m^2 K).
    conductivity: Thermal conductivity of the medium. Unit: W/(m K). Default: 0.0257.
    fluid_density: Density of the medium. Unit: kg/m^3. Default: 1.204.
    viscosity: Dynamic viscosity of the medium. Unit: Pa s. Default: 1.82e-05.
    prandtl: Prandtl number of the medium. Default: 0.713.
    flow: Motion of the medium: a flow, or the name of one in `flows`.
    """


class Counter(Thing):
    """A disk at rest that counts the particles whose centres pass it. Particles do not feel it.

    name: Name of the counter, different from the names of other counters. Required.
    center: Centre of the disk. Unit: m. Required.
    normal: Direction that counts as forward, of any length. The disk itself belongs to the side that it points to.
        Required.
    radius: Radius of the disk. The rim belongs to it. Unit: m. Required.
    """


class Curve(Thing):
    """A number over time, in the unit of the key that contains the curve.

    keys: Keys in order of time, at least one, each `{"time": ..., "value": ...}`. Required.
    interpolation: Interpolation between two keys. Default: "linear".
    ends: Value before the first and after the last key. Default: "hold".
    """


class CurveKey(Thing):
    """A number at a time.

    time: Time of the key, later than the previous key. Unit: s. Required.
    value: Value of the curve at that time. Required.
    """


class CurvesOverLife(Thing):
    """Factors that multiply the values of a particle at birth as it ages. They are evaluated when a state is written and never stored. In `over_life` the `time` of a key is the elapsed fraction of the lifetime, from 0 to 1. In `over_age` it is the age in s.

    color: Factors of the colour, for red, green and blue.
    opacity: Factor of the opacity.
    size: Factor of the drawn size.
    attributes: Factors of attributes with one component, by name.
    vector_attributes: Factors of attributes with three components, by name.
    """


class SeriesDeformation(Thing):
    """A numbered series of meshes.

    ends: Vertices before the first and after the last key. Default: "hold".
    files: OBJ, PLY or OFF files with the faces of the collider's `file` and consecutive numbers. Required.
    frame_rate: Frames per second. Unit: 1/s. Default: 25.
    start: Time of the first file, or of frame 0 of a cache. Unit: s. Default: 0.
    """

    _fixed = {"type": "series"}


class KeysDeformation(Thing):
    """Meshes with a time for each.

    ends: Vertices before the first and after the last key. Default: "hold".
    keys: Keys in order of time. Required.
    """

    _fixed = {"type": "keys"}


class CacheDeformation(Thing):
    """A point cache beside the mesh, in the PC2 format.

    ends: Vertices before the first and after the last key. Default: "hold".
    file: Cache file with one point per vertex of the collider's `file`, in the same order. Its header gives the
        start frame and the frames between samples. Required.
    frame_rate: Frames per second. Unit: 1/s. Default: 25.
    start: Time of the first file, or of frame 0 of a cache. Unit: s. Default: 0.
    """

    _fixed = {"type": "cache"}


class Drawing(Thing):
    """How the particles of an emitter are drawn, if they differ from other particles.

    particles: Shape of drawn particles. Required.
    sprite: PNG file, with or without alpha. Its longer edge has the length of the particle's diameter.
    mesh: Mesh file. The middle of its bounding box is at the particle's centre. Its farthest vertex is one radius
        away.
    turn: Orientation of sprites.
    turning: Rotation rate of sprites, and of meshes of particles without a spin, over their age. Unit: rad/s.
    """


class PointEmitter(Thing):
    """All at one point.

    name: Unique name for messages and reports.
    burst: Number of particles born at once at `start`. Default: 0.
    rate: Particles per second from `start` to `stop`, drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles per frame of `simulation.frame_rate`, evenly spread over the frame.
        Drawn anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles per frame and per pixel that the shape covers in the image of the
        `reference_camera`. Unit: 1/pixel. Default: 0.
    start: Time at which it begins. Unit: s. Default: 0.
    stop: Time at which the rate ends. Unit: s.
    limit: Largest number of births in total. For type `child`: per parent.
    seed: Seed of its own random numbers.
    direction: Launch direction.
    cone: Half angle of a cone about the direction. Directions are uniform in solid angle. Unit: degrees. Default:
        0.
    speed: Speed along the direction. Unit: m/s. Default: 0.
    velocity: Velocity added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: Name of a frame in `frames`. Shape, direction and velocity are in its coordinates. Particles also get the
        frame's velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light). Values that spread beyond are clamped.
    opacity: Opacity from 0 (invisible) to 1 (covers everything behind). Values that spread beyond are clamped.
    particle_size: Drawn radius. Collisions use `particle_radius`. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Material of the particles: a name in `particle_contacts.materials`.
    drawing: How its particles are drawn.
    over_life: Factors over the lifetime. Keys go from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    """

    _fixed = {"type": "point"}


class DiskEmitter(Thing):
    """Uniform on a flat disk.

    name: Unique name for messages and reports.
    burst: Number of particles born at once at `start`. Default: 0.
    rate: Particles per second from `start` to `stop`, drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles per frame of `simulation.frame_rate`, evenly spread over the frame.
        Drawn anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles per frame and per pixel that the shape covers in the image of the
        `reference_camera`. Unit: 1/pixel. Default: 0.
    start: Time at which it begins. Unit: s. Default: 0.
    stop: Time at which the rate ends. Unit: s.
    limit: Largest number of births in total. For type `child`: per parent.
    seed: Seed of its own random numbers.
    direction: Launch direction.
    cone: Half angle of a cone about the direction. Directions are uniform in solid angle. Unit: degrees. Default:
        0.
    speed: Speed along the direction. Unit: m/s. Default: 0.
    velocity: Velocity added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: Name of a frame in `frames`. Shape, direction and velocity are in its coordinates. Particles also get the
        frame's velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light). Values that spread beyond are clamped.
    opacity: Opacity from 0 (invisible) to 1 (covers everything behind). Values that spread beyond are clamped.
    particle_size: Drawn radius. Collisions use `particle_radius`. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Material of the particles: a name in `particle_contacts.materials`.
    drawing: How its particles are drawn.
    over_life: Factors over the lifetime. Keys go from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    normal: Normal of the disk, of any length. Required.
    radius: Its radius. Unit: m. Required.
    """

    _fixed = {"type": "disk"}


class BoxEmitter(Thing):
    """Uniform in a box along the axes.

    name: Unique name for messages and reports.
    burst: Number of particles born at once at `start`. Default: 0.
    rate: Particles per second from `start` to `stop`, drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles per frame of `simulation.frame_rate`, evenly spread over the frame.
        Drawn anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles per frame and per pixel that the shape covers in the image of the
        `reference_camera`. Unit: 1/pixel. Default: 0.
    start: Time at which it begins. Unit: s. Default: 0.
    stop: Time at which the rate ends. Unit: s.
    limit: Largest number of births in total. For type `child`: per parent.
    seed: Seed of its own random numbers.
    direction: Launch direction.
    cone: Half angle of a cone about the direction. Directions are uniform in solid angle. Unit: degrees. Default:
        0.
    speed: Speed along the direction. Unit: m/s. Default: 0.
    velocity: Velocity added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: Name of a frame in `frames`. Shape, direction and velocity are in its coordinates. Particles also get the
        frame's velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light). Values that spread beyond are clamped.
    opacity: Opacity from 0 (invisible) to 1 (covers everything behind). Values that spread beyond are clamped.
    particle_size: Drawn radius. Collisions use `particle_radius`. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Material of the particles: a name in `particle_contacts.materials`.
    drawing: How its particles are drawn.
    over_life: Factors over the lifetime. Keys go from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    size: Full edge lengths. Unit: m. Required.
    """

    _fixed = {"type": "box"}


class SphereEmitter(Thing):
    """Uniform in a ball, or on its surface.

    name: Unique name for messages and reports.
    burst: Number of particles born at once at `start`. Default: 0.
    rate: Particles per second from `start` to `stop`, drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles per frame of `simulation.frame_rate`, evenly spread over the frame.
        Drawn anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles per frame and per pixel that the shape covers in the image of the
        `reference_camera`. Unit: 1/pixel. Default: 0.
    start: Time at which it begins. Unit: s. Default: 0.
    stop: Time at which the rate ends. Unit: s.
    limit: Largest number of births in total. For type `child`: per parent.
    seed: Seed of its own random numbers.
    direction: Launch direction.
    cone: Half angle of a cone about the direction. Directions are uniform in solid angle. Unit: degrees. Default:
        0.
    speed: Speed along the direction. Unit: m/s. Default: 0.
    velocity: Velocity added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: Name of a frame in `frames`. Shape, direction and velocity are in its coordinates. Particles also get the
        frame's velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light). Values that spread beyond are clamped.
    opacity: Opacity from 0 (invisible) to 1 (covers everything behind). Values that spread beyond are clamped.
    particle_size: Drawn radius. Collisions use `particle_radius`. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Material of the particles: a name in `particle_contacts.materials`.
    drawing: How its particles are drawn.
    over_life: Factors over the lifetime. Keys go from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    radius: Its radius. Unit: m. Required.
    surface: true: only on the surface, launched outward. Default: false.
    """

    _fixed = {"type": "sphere"}


class MeshEmitter(Thing):
    """Uniform by area on a mesh, launched along the normals of its triangles. Positions are just off the surface, on the side of the normals.

    name: Unique name for messages and reports.
    burst: Number of particles born at once at `start`. Default: 0.
    rate: Particles per second from `start` to `stop`, drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles per frame of `simulation.frame_rate`, evenly spread over the frame.
        Drawn anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles per frame and per pixel that the shape covers in the image of the
        `reference_camera`. Unit: 1/pixel. Default: 0.
    start: Time at which it begins. Unit: s. Default: 0.
    stop: Time at which the rate ends. Unit: s.
    limit: Largest number of births in total. For type `child`: per parent.
    seed: Seed of its own random numbers.
    direction: Launch direction.
    cone: Half angle of a cone about the direction. Directions are uniform in solid angle. Unit: degrees. Default:
        0.
    speed: Speed along the direction. Unit: m/s. Default: 0.
    velocity: Velocity added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: Name of a frame in `frames`. Shape, direction and velocity are in its coordinates. Particles also get the
        frame's velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light). Values that spread beyond are clamped.
    opacity: Opacity from 0 (invisible) to 1 (covers everything behind). Values that spread beyond are clamped.
    particle_size: Drawn radius. Collisions use `particle_radius`. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Material of the particles: a name in `particle_contacts.materials`.
    drawing: How its particles are drawn.
    over_life: Factors over the lifetime. Keys go from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    file: Mesh file: OBJ, PLY, STL, OFF or glTF (.gltf, .glb).
    collider: Name of a mesh collider. Its surface and its frame are used.
    up: Axis of the file that points up. In scenes it is z. With y, (x, y, z) is read as (x, -z, y), before the
        scale.
    position: Position of its origin. Scale and rotation are applied first. Unit: m. Default: [0, 0, 0].
    rotation: Rotation about its origin.
    scale: Scale factor, or one factor for each of its own axes. A negative factor mirrors. Default: 1.
    volume: true: uniform in the inside, launched in any direction. The mesh must be closed. Default: false.
    """

    _fixed = {"type": "mesh"}


class ConeEmitter(Thing):
    """Uniform in a cone, launched along the line from its tip.

    name: Unique name for messages and reports.
    burst: Number of particles born at once at `start`. Default: 0.
    rate: Particles per second from `start` to `stop`, drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles per frame of `simulation.frame_rate`, evenly spread over the frame.
        Drawn anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles per frame and per pixel that the shape covers in the image of the
        `reference_camera`. Unit: 1/pixel. Default: 0.
    start: Time at which it begins. Unit: s. Default: 0.
    stop: Time at which the rate ends. Unit: s.
    limit: Largest number of births in total. For type `child`: per parent.
    seed: Seed of its own random numbers.
    direction: Launch direction.
    cone: Half angle of a cone about the direction. Directions are uniform in solid angle. Unit: degrees. Default:
        0.
    speed: Speed along the direction. Unit: m/s. Default: 0.
    velocity: Velocity added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: Name of a frame in `frames`. Shape, direction and velocity are in its coordinates. Particles also get the
        frame's velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light). Values that spread beyond are clamped.
    opacity: Opacity from 0 (invisible) to 1 (covers everything behind). Values that spread beyond are clamped.
    particle_size: Drawn radius. Collisions use `particle_radius`. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Material of the particles: a name in `particle_contacts.materials`.
    drawing: How its particles are drawn.
    over_life: Factors over the lifetime. Keys go from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    apex: Tip of the cone. Unit: m. Default: [0, 0, 0].
    axis: Direction from the tip into the cone, of any length. Required.
    angle: Angle between the axis and the side. Unit: degrees. Required.
    height: Its height. Unit: m. Required.
    """

    _fixed = {"type": "cone"}


class ChildEmitter(Thing):
    """Children of another emitter's particles, born at their position with their velocity. `burst`, `start`, `stop`, `rate_per_frame` and `rate_per_area` do not apply.

    name: Unique name for messages and reports.
    burst: Number of particles born at once at `start`. Default: 0.
    rate: Particles per second from `start` to `stop`, drawn anew for every second. Unit: 1/s. Default: 0.
    rate_per_frame: Instead of `rate`: particles per frame of `simulation.frame_rate`, evenly spread over the frame.
        Drawn anew for every frame. Default: 0.
    rate_per_area: Instead of `rate`: particles per frame and per pixel that the shape covers in the image of the
        `reference_camera`. Unit: 1/pixel. Default: 0.
    start: Time at which it begins. Unit: s. Default: 0.
    stop: Time at which the rate ends. Unit: s.
    limit: Largest number of births in total. For type `child`: per parent.
    seed: Seed of its own random numbers.
    direction: Launch direction.
    cone: Half angle of a cone about the direction. Directions are uniform in solid angle. Unit: degrees. Default:
        0.
    speed: Speed along the direction. Unit: m/s. Default: 0.
    velocity: Velocity added to direction times speed. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of a particle. Unit: kg. Default: 1.
    lifetime: Time after birth at which a particle is retired. Unit: s.
    particle_radius: Radius of a particle. Unit: m. Default: 0.
    frame: Name of a frame in `frames`. Shape, direction and velocity are in its coordinates. Particles also get the
        frame's velocity at the time and position of their birth.
    color: Red, green and blue, 0 to 1 (linear light). Values that spread beyond are clamped.
    opacity: Opacity from 0 (invisible) to 1 (covers everything behind). Values that spread beyond are clamped.
    particle_size: Drawn radius. Collisions use `particle_radius`. Unit: m.
    attributes: Values of the scene's `attributes`, by name.
    material: Material of the particles: a name in `particle_contacts.materials`.
    drawing: How its particles are drawn.
    over_life: Factors over the lifetime. Keys go from 0 (birth) to 1 (end of life).
    over_age: Factors over the age in s.
    parent: Name of the emitter whose particles are the parents. Required.
    on: Event at which parents give birth. Default: "life".
    count: Number of children per death, impact or birth, rounded to a whole number. Default: 1.
    threshold_impulse: Smallest impulse of an impact that gives birth. Unit: N s. Default: 0.
    share: true: the parent ends and its children share its mass and momentum. `mass` is the weight of a share.
        Radii follow from the same density. `speed` sets how fast the children fly apart.
    recursive: true: the children become parents, too, up to `simulation.max_depth`. Default: false.
    inherit_velocity: Fraction of the parent's velocity that a child starts with. It is 1 for shares. Default: 1.
    inherit_color: Fraction of the parent's colour in the child's own `color`. Without a `color`, the child has the
        parent's colour. Default: 0.
    cloud: The children follow their parent through flights and impacts. Each has its own target position near the
        parent.
    """

    _fixed = {"type": "child"}


class UniformFlow(Thing):
    """A wind with the same velocity everywhere.

    factor: Factor of the velocity. Default: 1.
    velocity: Velocity of the wind. Unit: m/s. Required.
    gust: Periodic variation: `amplitude` (fraction of the speed), `frequency` (Hz) and `phase` (turns, 0 by
        default).
    """

    _fixed = {"type": "uniform"}


class VortexFlow(Thing):
    """A straight vortex of infinite length.

    factor: Factor of the velocity. Default: 1.
    point: A point on the axis. Unit: m. Default: [0, 0, 0].
    axis: Direction of the axis, of any length. Rotation follows the right-hand rule. Required.
    circulation: Speed times circumference, outside the core. Negative values reverse the rotation. Unit: m^2/s.
        Required.
    core_radius: Radius of the core. Inside it the speed falls to 0 on the axis. Unit: m. Required.
    profile: Speed as a function of the distance. Default: "rankine".
    """

    _fixed = {"type": "vortex"}


class RadialFlow(Thing):
    """A source or a sink with a soft core.

    factor: Factor of the velocity. Default: 1.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    strength: Volume flow out of the source. Negative for a sink. Unit: m^3/s. Required.
    core_radius: Radius of the core. Inside it the speed falls to 0. Unit: m. Required.
    """

    _fixed = {"type": "radial"}


class RotationFlow(Thing):
    """Rotation like a rigid body.

    factor: Factor of the velocity. Default: 1.
    point: A point on the axis. Unit: m. Default: [0, 0, 0].
    angular_velocity: Angular velocity along the axis, by the right-hand rule. Unit: rad/s. Required.
    """

    _fixed = {"type": "rotation"}


class ShearFlow(Thing):
    """A velocity that grows linearly along a direction.

    factor: Factor of the velocity. Default: 1.
    point: A point where the fluid is at rest. Unit: m. Default: [0, 0, 0].
    rate: Velocity gain per metre. Unit: 1/s. Required.
    gradient: Direction along which the velocity grows, of any length. Required.
    """

    _fixed = {"type": "shear"}


class TurbulenceFlow(Thing):
    """Eddies of several sizes without divergence (curl noise).

    factor: Factor of the velocity. Default: 1.
    speed: Root mean square of the speed. Unit: m/s. Required.
    length: Size of the largest eddies. Unit: m. Required.
    octaves: Number of eddy sizes. Each size is half the previous one. Default: 3.
    gain: Speed of the eddies of one size divided by the speed at the previous size. Default: 0.5.
    rate: Rate at which new eddies replace the largest ones. 0 freezes the flow. Unit: 1/s. Default: 0.
    seed: Seed of the turbulence, independent of the simulation's seed. Default: 0.
    """

    _fixed = {"type": "turbulence"}


class SphereFlow(Thing):
    """Flow of an ideal fluid past a ball. The fluid inside the ball is at rest.

    factor: Factor of the velocity. Default: 1.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    radius: Radius of the ball. Unit: m. Required.
    velocity: Velocity far from the ball. Unit: m/s. Required.
    """

    _fixed = {"type": "sphere"}


class GridFlow(Thing):
    """Samples on a regular grid with linear interpolation along each axis.

    factor: Factor of the velocity. Default: 1.
    file: VTK image file (.vti) with uncompressed point data. Required.
    array: Name of the array, which must have three components.
    outside: Velocity outside the grid. Default: "clamp".
    """

    _fixed = {"type": "grid"}


class SumFlow(Thing):
    """Sum of several flows.

    factor: Factor of the velocity. Default: 1.
    parts: Flows whose velocities are added. Required.
    """

    _fixed = {"type": "sum"}


class GravityForce(Thing):
    """The same acceleration everywhere.

    particles: Ids of the particles that it acts on.
    acceleration: Acceleration. Unit: m/s^2. Required.
    """

    _fixed = {"type": "gravity"}


class DragForce(Thing):
    """Linear drag F = -c w, with the velocity w relative to the flow.

    particles: Ids of the particles that it acts on.
    coefficient: Coefficient c. Unit: kg/s. Required.
    flow: Motion of the fluid: a flow, or the name of one in `flows`.
    """

    _fixed = {"type": "drag"}


class QuadraticDragForce(Thing):
    """Drag of fast bodies: F = -c |w| w, or -1/2 rho C_d pi r^2 |w| w with the particle's radius r (none for points). w is the velocity relative to the flow.

    particles: Ids of the particles that it acts on.
    coefficient: Coefficient c. Unit: kg/m.
    drag_coefficient: Drag coefficient C_d, for particles with a radius.
    fluid_density: Density of the fluid. The default is air at 20 degrees C. Unit: kg/m^3. Default: 1.204.
    flow: Motion of the fluid: a flow, or the name of one in `flows`.
    """

    _fixed = {"type": "quadratic_drag"}


class StokesDragForce(Thing):
    """Drag of slow small spheres: F = -6 pi mu r w, with the particle's radius r (none for points).

    particles: Ids of the particles that it acts on.
    viscosity: Dynamic viscosity of the fluid. The default is air at 20 degrees C. Unit: Pa s. Default: 1.82e-05.
    flow: Motion of the fluid: a flow, or the name of one in `flows`.
    """

    _fixed = {"type": "stokes_drag"}


class SchillerNaumannDragForce(Thing):
    """Drag of spheres at any speed, with the particle's radius (none for points). C_d = 24 / Re (1 + 0.15 Re^0.687) below Re = 1000, and 0.44 above.

    particles: Ids of the particles that it acts on.
    fluid_density: Density of the fluid. The default is air at 20 degrees C. Unit: kg/m^3. Default: 1.204.
    viscosity: Dynamic viscosity of the fluid. The default is air at 20 degrees C. Unit: Pa s. Default: 1.82e-05.
    flow: Motion of the fluid: a flow, or the name of one in `flows`.
    """

    _fixed = {"type": "schiller_naumann_drag"}


class BuoyancyForce(Thing):
    """Buoyancy of a particle in the fluid: F = -rho 4/3 pi r^3 g (none for points).

    particles: Ids of the particles that it acts on.
    fluid_density: Density of the fluid. Unit: kg/m^3. Required.
    gravity: Gravitational acceleration g. Unit: m/s^2. Required.
    """

    _fixed = {"type": "buoyancy"}


class ThermalBuoyancyForce(Thing):
    """Buoyancy of gas parcels by their attribute `temperature`: a = -g T / Ta. Together with a separate gravity force the sum is g (1 - T / Ta). Particles at 0 K have none.

    particles: Ids of the particles that it acts on.
    ambient_temperature: Temperature Ta of the surrounding gas. Unit: K. Default: 293.15.
    gravity: Gravitational acceleration g. Unit: m/s^2. Required.
    """

    _fixed = {"type": "thermal_buoyancy"}


class PointGravityForce(Thing):
    """Gravity of point masses: a = -G M d / (|d|^2 + softening^2)^(3/2).

    particles: Ids of the particles that it acts on.
    attractors: Objects with `position` (m), `strength` (G M, m^3/s^2) and `softening` (m, 0 by default). Required.
    """

    _fixed = {"type": "point_gravity"}


class RadialForce(Thing):
    """Force towards a centre by a power of the distance d: |F| = strength (s / reference)^exponent d / s, with s^2 = d^2 + softening^2.

    particles: Ids of the particles that it acts on.
    center: Its centre. Unit: m. Default: [0, 0, 0].
    strength: Force at the reference distance. Negative values push away. Unit: N. Required.
    exponent: 1 for a spring, -2 for Coulomb's law. Default: -2.
    softening: Distance below which the force weakens. Unit: m. Default: 0.
    reference: Distance at which the force has this strength. Unit: m. Default: 1.
    """

    _fixed = {"type": "radial"}


class SwirlForce(Thing):
    """Force around an axis. It grows linearly within the core and falls as one over the distance outside.

    particles: Ids of the particles that it acts on.
    point: A point on the axis. Unit: m. Default: [0, 0, 0].
    axis: Direction of the axis, of any length. Rotation follows the right-hand rule. Required.
    acceleration: Acceleration at the rim of the core. Negative values reverse the direction. Unit: m/s^2. Required.
    core_radius: Radius of the core. Unit: m. Required.
    """

    _fixed = {"type": "swirl"}


class FieldForce(Thing):
    """Vectors of a flow, used as accelerations or forces.

    particles: Ids of the particles that it acts on.
    flow: Motion of the fluid: a flow, or the name of one in `flows`. Required.
    as: Meaning of the vectors. Default: "acceleration".
    """

    _fixed = {"type": "field"}


class LorentzForce(Thing):
    """Force on charged particles in uniform fields: F = q (E + v x B).

    particles: Ids of the particles that it acts on.
    charge: Charge of every particle. Unit: C. Required.
    electric: Electric field E. Unit: V/m. Default: [0, 0, 0].
    magnetic: Magnetic field B. Unit: T. Default: [0, 0, 0].
    """

    _fixed = {"type": "lorentz"}


class AnchorForce(Thing):
    """A spring and damper to a fixed point. The damper acts along the spring.

    particles: Ids of the particles that it acts on.
    position: Position of the fixed point. Unit: m. Required.
    stiffness: Spring constant. Unit: N/m. Required.
    rest_length: Length at which the spring exerts no force. Unit: m. Default: 0.
    damping: Force divided by the speed along the spring. Unit: kg/s. Default: 0.
    """

    _fixed = {"type": "anchor"}


class GravityForceBetweenParticles(Thing):
    """Newton's law between all pairs of particles, by their masses.

    particles: Ids of the particles that take part.
    emitter: Name of an emitter whose particles take part.
    constant: Gravitational constant. Negative values repel. Scenes with their own units often use 1. Unit: m^3/(kg
        s^2). Default: 6.6743e-11.
    softening: Length over which each particle is spread. The force is weaker within it. Without it, close
        encounters need steps as short as the encounter. Unit: m. Default: 0.
    method: Method that sums the forces. Default: "auto".
    opening: For the tree: a group is summed as one if its radius divided by its distance is below this value.
        Smaller values are more exact and slower. Default: 0.5.
    """

    _fixed = {"type": "gravity"}


class ChargeForceBetweenParticles(Thing):
    """Coulomb's law between all pairs of particles. Their charge is an attribute.

    particles: Ids of the particles that take part.
    emitter: Name of an emitter whose particles take part.
    attribute: Name of the attribute, with one component, that contains the charge in C. Default: "charge".
    constant: Coulomb constant. Negative values attract like charges. Unit: N m^2/C^2. Default: 8987551786.2.
    softening: Length over which each particle is spread. The force is weaker within it. Without it, close
        encounters need steps as short as the encounter. Unit: m. Default: 0.
    method: Method that sums the forces. Default: "auto".
    opening: For the tree: a group is summed as one if its radius divided by its distance is below this value.
        Smaller values are more exact and slower. Default: 0.5.
    """

    _fixed = {"type": "charge"}


class LennardJonesForceBetweenParticles(Thing):
    """Force of neutral atoms: repulsion by the 12th and attraction by the 6th power of the distance, with a smooth cutoff. The potential is lowest near a distance of 1.12 diameters.

    particles: Ids of the particles that take part.
    emitter: Name of an emitter whose particles take part.
    depth: Depth of the potential at its minimum, without the cutoff. Unit: J. Default: 1.
    diameter: Distance of the centres at which the potential is 0. Unit: m. Default: 1.
    cutoff: Distance, in diameters, beyond which there is no force. Default: 2.5.
    """

    _fixed = {"type": "lennard_jones"}


class CohesionForceBetweenParticles(Thing):
    """Cohesion of spheres: a spring between their surfaces, F = k g (1 - g / range)^2 at the gap g. It ends at the gap `range`, and it pushes overlapping spheres apart.

    particles: Ids of the particles that take part.
    emitter: Name of an emitter whose particles take part.
    stiffness: Stiffness k of the spring near contact. Unit: N/m. Required.
    range: Gap between the surfaces at which the force ends. Unit: m. Required.
    damping: Damping along the line of the centres, within the range. Unit: N s/m. Default: 0.
    """

    _fixed = {"type": "cohesion"}


class Frame(Thing):
    """A moving frame of reference for emitters and colliders. Its pose in the parent consists of the translation, the rotation, and then the motions in their order.

    parent: Name of the parent frame in `frames`.
    translation: Position of its origin in the parent's axes. Unit: m. Default: [0, 0, 0].
    rotation: Rotation about its origin.
    motions: Motions of the frame, in their order.
    body: Makes it a rigid body that particles and forces move.
    """


class RotationFrameMotion(Thing):
    """A rotation about an axis through the frame's origin, by the right-hand rule.

    axis: Direction of the axis, of any length. Required.
    angle: Rotation angle: a curve. Unit: degrees. Required.
    """

    _fixed = {"type": "rotation"}


class SpinFrameMotion(Thing):
    """A steady rotation about an axis through the frame's origin.

    axis: Direction of the axis, of any length. Required.
    rate: Angular rate, by the right-hand rule. The angle is 0 at 0 s. Unit: degrees/s. Required.
    """

    _fixed = {"type": "spin"}


class SwingFrameMotion(Thing):
    """An oscillating rotation about an axis through the frame's origin.

    axis: Direction of the axis, of any length. Required.
    amplitude: Largest angle. Unit: degrees. Required.
    frequency: Oscillations per second. Unit: Hz. Required.
    phase: Phase of the sine at 0 s. Unit: degrees. Default: 0.
    """

    _fixed = {"type": "swing"}


class OscillationFrameMotion(Thing):
    """An oscillating translation.

    amplitude: Largest offset of the origin. Unit: m. Required.
    frequency: Oscillations per second. Unit: Hz. Required.
    phase: Phase of the sine at 0 s. Unit: degrees. Default: 0.
    """

    _fixed = {"type": "oscillation"}


class TranslationFrameMotion(Thing):
    """A translation along a curve.

    way: Path of the origin: a curve of [x, y, z]. Unit: m. Required.
    """

    _fixed = {"type": "translation"}


class ScaleFrameMotion(Thing):
    """A scale along the frame's axes, about its origin. It applies to later motions and to everything that stands on the frame. Colliders in it must be meshes or boxes.

    factor: Scale factor: a curve of numbers, or of [x, y, z]. Required.
    """

    _fixed = {"type": "scale"}


class Gust(Thing):
    """The wind is multiplied by 1 + amplitude sin(2 pi (frequency t + phase)).

    amplitude: Fraction of the wind speed. Above 1 the wind reverses at times. Required.
    frequency: Frequency of the variation. Unit: Hz. Required.
    phase: Phase of the cycle at 0 s. Unit: turns. Default: 0.
    """


class Heat(Thing):
    """Processes that change the attribute `temperature` (K) of all particles. The attribute must be declared. The temperature is uniform inside a particle.

    specific_heat: Specific heat of the particles. Unit: J/(kg K). Required.
    ambient_temperature: Temperature of the medium, and of the surroundings that particles exchange radiation with.
        Unit: K. Default: 293.15.
    convection: Heat exchange with the medium.
    emissivity: Heat that spheres radiate and absorb, divided by that of black bodies. Default: 0.
    impact_fraction: Fraction of the energy lost along the normal at impacts, by restitution, that heats the
        particle. Default: 0.
    friction_fraction: Fraction of the energy lost by friction, in impacts and in contact, that heats the particle.
        Default: 0.
    """


class KeyPose(Thing):
    """Pose of a collider's frame at a time. Between two keys it moves, rotates and scales at constant rates.

    time: Time of the key, later than the previous key. Unit: s. Required.
    position: Position of the frame's origin. Unit: m. Default: [0, 0, 0].
    rotation: Rotation at that time.
    scale: Scale factor, or one for each of the frame's axes. Only for meshes and boxes, because it moves their
        vertices. Default: 1.
    """


class Material(Thing):
    """Response of a surface to impacts and contacts.

    restitution: Rebound speed divided by approach speed, along the normal. Default: 1.
    restitution_threshold: Approach speed below which the restitution falls linearly to 0. Unit: m/s. Default: 0.
    friction: Coulomb coefficient, for impacts and sliding. Default: 0.
    rolling_friction: Moment that resists rolling, divided by radius times normal force. For particles with a
        radius. Default: 0.
    spinning_friction: Moment that resists spinning about the normal, divided by normal force. For particles with a
        radius. Unit: m. Default: 0.
    diffuse: Accommodation: fraction of the impacts that reflect by the cosine law. Default: 0.
    wall_temperature: Temperature of the wall. Diffuse reflections leave with its thermal speeds. Unit: K.
    absorption: Fraction of the impacts that remove the particle. Default: 0.
    surface_motion: Motion of the surface material.
    """


class MeshKey(Thing):
    """Vertices of a mesh at a time.

    time: Time of the key, later than the previous key. Unit: s. Required.
    file: OBJ, PLY or OFF file with the faces of the collider's `file`. Required.
    """


class Output(Thing):
    """Files that a run writes.

    format: File format of the frames. Default: "vtp".
    every: Steps from one frame to the next. The last state is always written. Default: 1.
    checkpoint_every: Steps from one checkpoint to the next. Each is written together with the next frame. An
        interrupted run always leaves a checkpoint, from which `ricochet run --resume` continues. Default: 0.
    pieces: true: each process of a shared run writes its own part of the frames and checkpoints, with a .pvtp index
        for the frames. false: the first process gathers and writes them. Default: false.
    contacts: true: the run writes every impact as a point with its columns, once per frame. Default: false.
    """


class PairOfMaterials(Thing):
    """Contact between spheres of two materials.

    first: Name of a material. Required.
    second: Name of another material. Required.
    restitution: Separation speed divided by approach speed, along the normal.
    friction: Coulomb coefficient between spheres.
    rolling_friction: Moment that resists relative rotation, divided by reduced radius times normal impulse.
    """


class Particle(Thing):
    """A particle that exists from the start.

    position: Position at the start. Unit: m. Required.
    velocity: Velocity at the start. Unit: m/s. Default: [0, 0, 0].
    mass: Mass of the particle. Unit: kg. Default: 1.
    radius: Radius of the particle. Unit: m. Default: 0.
    spin: Angular velocity at the start, for particles with a radius. Unit: rad/s. Default: [0, 0, 0].
    lifetime: Time after which it is retired. Unit: s.
    pinned: true: it never moves. Springs can hang on it. Default: false.
    color: Red, green and blue, 0 to 1 (linear light).
    opacity: Opacity from 0 (invisible) to 1 (covers everything behind).
    size: Drawn radius. Unit: m.
    attributes: Values of the scene's `attributes`, by name, without a spread.
    material: Material of the particle: a name in `particle_contacts.materials`.
    """


class ParticleContacts(Thing):
    """Contacts between spheres.

    restitution: Separation speed divided by approach speed, along the normal. Default: 1.
    friction: Coulomb coefficient between spheres. Default: 0.
    rolling_friction: Moment that resists relative rotation, divided by reduced radius times normal impulse.
        Default: 0.
    method: Method that resolves contacts between spheres. Default: "auto".
    impact_budget: Largest number of impacts of one sphere on others in one step. A sphere that spends the budget
        stops for the rest of the step, and the omitted time is counted. Default: 1000.
    materials: Materials of spheres by name, with the contact between spheres of the same material. Emitters and
        particles select a material by the key `material`. The column `material` of particles is its number in this
        order.
    pairs: Contacts between spheres of two materials.
    """


class ParticleTable(Thing):
    """Particles from a file.

    file: A .csv file: a header line that names the columns, then one line per particle. The columns x, y, z are
        required. vx, vy, vz, mass, radius, spin_x, spin_y, spin_z and lifetime are optional. Required.
    """


class Penalty(Thing):
    """Settings of the penalty response.

    stiffness: Spring constant of contacts. Unit: N/m.
    contact_steps: Duration of an undamped contact, in sub-steps, if no stiffness is given. Default: 20.
    substeps: Number of equal sub-steps in every step. Default: 10.
    friction_speed: Slip speed up to which friction grows linearly. Unit: m/s. Default: 0.001.
    """


class Picture(Thing):
    """Light and surroundings of `ricochet render`, unless its options say otherwise.

    light: Light of the picture.
    background: Red, green and blue of the background, linear light.
    transparent: true: the background is transparent, as an alpha channel in PNG files. Default: false.
    particles: Shape of drawn particles.
    sprite: PNG file, with or without alpha. Its longer edge has the length of the particle's diameter.
    mesh: Mesh file. The middle of its bounding box is at the particle's centre. Its farthest vertex is one radius
        away.
    turn: Orientation of sprites.
    turning: Rotation rate of sprites, and of meshes of particles without a spin, over their age. Unit: rad/s.
    shutter: Time for which the shutter is open, up to the picture's time. Moving particles blur. 0 means no blur.
        Unit: s. Default: 0.
    black_body: Temperature at which a particle shines as brightly as a white surface in the sun. Particles shine as
        black bodies of their attribute `temperature` (K). Unit: K.
    stretch: Squash and stretch of spheres and meshes, at the same volume.
    ground: Height of a level ground along the upward axis. Unit: m.
    particle_radius: Drawn radius of all particles. Collisions ignore it. Unit: m.
    time: Time of a single picture, which shows the nearest frame. Films show all frames. Unit: s.
    """


class PinBox(Thing):
    """A box along the axes. Vertices in it or on its surface are pinned.

    lower: Corner with the smallest coordinates. Unit: m. Required.
    upper: Corner with the largest coordinates. Unit: m. Required.
    """


class Project(Thing):
    """Settings of the project response.

    offset: Thickness of the contact layer on surfaces. A particle in the layer is in contact and is moved to its
        top. Unit: m. Default: 1e-06.
    """


class ReferenceCamera(Thing):
    """Camera whose image defines emitter rates per pixel. It is part of the scene, not of any picture.

    position: Position of the camera. Unit: m. Required.
    target: Point in the middle of its image. Unit: m. Required.
    field_of_view: Angle from the lower to the upper edge. Unit: degrees. Default: 35.
    image_height: Height of the image, in pixels. Default: 720.
    """


class Rollback(Thing):
    """Settings of the rollback response.

    time_tolerance: Largest error of the time of contact, which bisection brackets. Unit: s. Default: 1e-09.
    global: true: the whole system goes back to the earliest contact, as in textbooks. Costs grow with particles
        times contacts. false: each particle goes back by itself. Default: false.
    """


class Rotation(Thing):
    """A rotation about an axis through the object's own origin, by the right-hand rule.

    axis: Direction of the axis, of any length. Required.
    degrees: Rotation angle. Unit: degrees. Required.
    """


class ScaleCurve(Thing):
    """Scale factors over time: a curve whose values are numbers or [x, y, z], all above 0.

    keys: Keys in order of time, at least one, each `{"time": ..., "value": ...}`. Required.
    interpolation: Interpolation between two keys. Default: "linear".
    ends: Value before the first and after the last key. Default: "hold".
    """


class ScaleCurveKey(Thing):
    """A factor at a time.

    time: Time of the key, later than the previous key. Unit: s. Required.
    value: Scale factor at that time, or one for each axis. Required.
    """


class SimulationOptions(Thing):
    """Time steps and the handling of impacts.

    time_step: Length of a step. Unit: s. Default: 0.016666666666666666.
    duration: Simulated time. The number of steps is ceil(duration / time_step - 1e-6), and at least 1 if the
        duration is above 0. The last step ends at the duration. Unit: s. Default: 1.
    integrator: Method that moves particles inside a step. If a flow carries the particles, only `forward_euler`,
        `midpoint`, `rk4` and `dormand_prince` are allowed.
    tolerance: Largest error of one sub-step of `dormand_prince`.
    response: Method that handles impacts. Default: "exact".
    motion: Cause of the particles' motion. Default: "forces".
    flow: Flow that carries the particles if `motion` is `flow`: a flow, or the name of one in `flows`.
    walls: Behaviour of particles that the flow carries into a wall. Default: "slide".
    seed: Seed of all random numbers. The same seed gives the same run, bit for bit. Default: 0.
    resting_speed: Rebound speed below which resting or sliding contact begins, if bounces lose energy and a force
        presses the particle on. Unit: m/s. Default: 0.001.
    frame_rate: Frames per second for emitter rates per frame. It affects neither the output nor the time step.
        Unit: 1/s. Default: 24.
    max_depth: Highest generation of particles that are born of particles. Births beyond it are refused and counted.
        Default: 16.
    most_particles: Largest number of particles alive at a time. Births beyond it are refused and counted. It is a
        fixed number, so that a run is the same on every machine. It must still fit the memory. Default: 100000000.
    bounce_budget: Largest number of impacts of one particle in one step. Beyond 64 contact intervals, every four
        intervals count as one impact. A particle that spends the budget stops for the rest of the step, and the
        omitted time is counted. Default: 1000.
    rollback: Settings of the rollback response.
    project: Settings of the project response.
    penalty: Settings of the penalty response.
    """


class SphereMaterial(Thing):
    """Contact between spheres of this material.

    restitution: Separation speed divided by approach speed, along the normal.
    friction: Coulomb coefficient between spheres.
    rolling_friction: Moment that resists relative rotation, divided by reduced radius times normal impulse.
    """


class Spring(Thing):
    """A spring between two particles.

    first: Number of the particle at one end. Required.
    second: Number of the particle at the other end. Required.
    rest_length: Length at which it neither pulls nor pushes. Unit: m.
    stiffness: Force divided by stretch. Unit: N/m. Required.
    damping: Damping force of a spring divided by the rate of change of its length. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a fraction of the rest length, beyond which a spring breaks permanently.
    """


class ListSprings(Thing):
    """Single springs between particles. The numbers of particles start at 0: first the list `particles`, then the particles of ropes, chains, cloths and sheets, each in its order.

    springs: The springs. Required.
    """

    _fixed = {"type": "list"}


class RopeSprings(Thing):
    """Particles at equal distances along a line, with springs between neighbours.

    from: Position of its first particle. Unit: m. Required.
    to: Position of its last particle. Unit: m. Required.
    nodes: Number of its particles. Required.
    length: Rest length. A rope longer than the distance of its ends starts as a catenary. A shorter rope starts
        straight and under tension. Unit: m.
    mass: Total mass. Unit: kg. Required.
    radius: Radius of its particles. Unit: m. Default: 0.
    stiffness: Stiffness of every segment. Unit: N/m.
    axial_stiffness: Stiffness E A of the material. The stiffness of a segment is this value divided by its rest
        length. Unit: N.
    damping: Damping force of a spring divided by the rate of change of its length. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a fraction of the rest length, beyond which a spring breaks permanently.
    sag: Direction in which it hangs at first, if it is longer than the distance of its ends.
    pinned: Ends that never move. Default: "none".
    """

    _fixed = {"type": "rope"}


class ChainSprings(Thing):
    """A rope described by its links. It starts as a catenary if it is longer than the distance of its ends.

    from: Position of its first particle. Unit: m. Required.
    to: Position of its last particle. Unit: m. Required.
    links: Number of springs in a row. The chain has one particle more. Required.
    link_length: Rest length of a link. Unit: m. Required.
    mass: Total mass. Unit: kg. Required.
    radius: Radius of its particles. Unit: m. Default: 0.
    stiffness: Stiffness of every segment. Unit: N/m.
    axial_stiffness: Stiffness E A of the material. The stiffness of a segment is this value divided by its rest
        length. Unit: N.
    damping: Damping force of a spring divided by the rate of change of its length. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a fraction of the rest length, beyond which a spring breaks permanently.
    sag: Direction in which it hangs at first, if it is longer than the distance of its ends.
    pinned: Ends that never move. Default: "none".
    """

    _fixed = {"type": "chain"}


class ClothSprings(Thing):
    """A particle at every vertex of a mesh, and a spring along every edge. The mesh is the rest shape. A particle has a third of the mass of every triangle around it.

    file: Mesh file: OBJ, PLY, STL, OFF or glTF (.gltf, .glb). Required.
    up: Axis of the file that points up. In scenes it is z. With y, (x, y, z) is read as (x, -z, y), before the
        scale.
    position: Position of its origin. Scale and rotation are applied first. Unit: m. Default: [0, 0, 0].
    rotation: Rotation about its origin.
    scale: Scale factor, or one factor for each of its own axes. A negative factor mirrors. Default: 1.
    mass: Total mass. Unit: kg.
    mass_per_area: Mass per area. Unit: kg/m^2.
    radius: Radius of its particles. Unit: m. Default: 0.
    stiffness: Stiffness of the springs along the edges. Unit: N/m. Required.
    bending_stiffness: Stiffness of the springs that resist bending. They join the corners across every edge between
        two triangles. Unit: N/m. Default: 0.
    damping: Damping force of a spring divided by the rate of change of its length. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a fraction of the rest length, beyond which a spring breaks permanently.
    pinned: Numbers, from 0, of vertices that never move.
    pin_boxes: Boxes in which vertices never move.
    """

    _fixed = {"type": "cloth"}


class SheetSprings(Thing):
    """A flat cloth without a file, made of cells with two triangles each. Vertex (i, j) has the number j (cells_u + 1) + i.

    corner: A corner of the sheet. Unit: m. Required.
    side_u: Vector from the corner along one side to its end. Unit: m. Required.
    side_v: Vector from the corner along the other side to its end. Unit: m. Required.
    cells_u: Number of cells along `side_u`. Required.
    cells_v: Number of cells along `side_v`. Required.
    mass: Total mass. Unit: kg.
    mass_per_area: Mass per area. Unit: kg/m^2.
    radius: Radius of its particles. Unit: m. Default: 0.
    stiffness: Stiffness of the springs along the edges. Unit: N/m. Required.
    bending_stiffness: Stiffness of the springs that resist bending. They join the corners across every edge between
        two triangles. Unit: N/m. Default: 0.
    damping: Damping force of a spring divided by the rate of change of its length. Unit: N s/m. Default: 0.
    breaking_stretch: Stretch, as a fraction of the rest length, beyond which a spring breaks permanently.
    pinned: Numbers, from 0, of vertices that never move.
    pin_boxes: Boxes in which vertices never move.
    """

    _fixed = {"type": "sheet"}


class Stretch(Thing):
    """Change of the drawn shape of moving particles. Collisions ignore it.

    speed: Stretch along the velocity: particles are longer by the factor 1 + `speed` times their speed. Unit: s/m.
        Default: 0.
    impact: Squash along the normal of an impact: particles are flatter by the factor 1 + `impact` times the normal
        speed. This needs `output.contacts`. Unit: s/m. Default: 0.
    time: Duration of the squash. Half of it is before the impact. Unit: s. Default: 0.1.
    most: Largest factor of stretch and squash. Default: 2.
    """


class SurfaceMotion(Thing):
    """Motion of the surface material while the geometry stands still: a conveyor belt, or the wall of a drum that turns about its own axis. Friction, rolling and spinning resistance, and diffuse reflection act relative to it. Only the velocity component along the surface counts.

    velocity: Uniform velocity. Unit: m/s. Default: [0, 0, 0].
    angular_velocity: Rotation by the right-hand rule about an axis through `center`, added to `velocity`. Unit:
        rad/s. Default: [0, 0, 0].
    center: A point on the axis, in world coordinates. Unit: m. Default: [0, 0, 0].
    """


class Tolerance(Thing):
    """Largest error of one sub-step of an adaptive integrator.

    position: Error of the position, also between the ends of a sub-step. Unit: m. Default: 1e-06.
    velocity: Error of the velocity. Unit: m/s. Default: 1e-06.
    """


class VectorCurve(Thing):
    """A vector over time: a curve whose values are [x, y, z].

    keys: Keys in order of time, at least one, each `{"time": ..., "value": ...}`. Required.
    interpolation: Interpolation between two keys. Default: "linear".
    ends: Value before the first and after the last key. Default: "hold".
    """


class VectorCurveKey(Thing):
    """A vector at a time.

    time: Time of the key, later than the previous key. Unit: s. Required.
    value: Value of the curve at that time. Required.
    """
