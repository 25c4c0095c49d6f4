"""The things of a scene, each with its keys as keyword arguments: made by python/generate_scene.py from the
tool's schema, not to be edited. Each is a dictionary with the keys of a scene file."""

import os
from typing import Any, Dict, Mapping, Optional, Sequence, Union

import numpy.typing as npt

Path = Union[str, "os.PathLike[str]"]
Vector = Union[Sequence[float], npt.NDArray[Any]]

class Thing(Dict[str, Any]):
    def __init__(self, **keys: Any) -> None: ...

class Scene(Thing):
    def __init__(
        self,
        *,
        simulation: Any = ...,
        forces: Optional[Sequence[Any]] = ...,
        particle_forces: Optional[Sequence[Any]] = ...,
        flows: Optional[Mapping[str, Any]] = ...,
        materials: Optional[Mapping[str, Any]] = ...,
        colliders: Optional[Sequence[Any]] = ...,
        frames: Optional[Mapping[str, Any]] = ...,
        emitters: Optional[Sequence[Any]] = ...,
        particles: Any = ...,
        springs: Optional[Sequence[Any]] = ...,
        particle_contacts: Any = ...,
        heat: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        reference_camera: Any = ...,
        bounds: Any = ...,
        counters: Optional[Sequence[Any]] = ...,
        output: Any = ...,
        camera: Any = ...,
        picture: Any = ...,
    ) -> None: ...

class Attractor(Thing):
    def __init__(
        self,
        *,
        position: Vector,
        strength: float,
        softening: Optional[float] = ...,
    ) -> None: ...

class Attribute(Thing):
    def __init__(
        self,
        *,
        components: Optional[int] = ...,
        default: Any = ...,
    ) -> None: ...

class Body(Thing):
    def __init__(
        self,
        *,
        mass: Optional[float] = ...,
        density: Optional[float] = ...,
        center: Optional[Vector] = ...,
        inertia: Optional[Vector] = ...,
        inertia_products: Optional[Vector] = ...,
        joint: Optional[str] = ...,
        axis: Optional[Vector] = ...,
        velocity: Optional[Vector] = ...,
        angular_velocity: Optional[Vector] = ...,
        rate: Optional[float] = ...,
        spring: Optional[float] = ...,
        spring_rest: Optional[float] = ...,
        damping: Optional[float] = ...,
        drive: Optional[float] = ...,
        friction: Optional[float] = ...,
        motor_rate: Optional[float] = ...,
        motor_most: Optional[float] = ...,
        feels_forces: Optional[bool] = ...,
    ) -> None: ...

class Bounds(Thing):
    def __init__(
        self,
        *,
        lower: Vector,
        upper: Vector,
    ) -> None: ...

class Camera(Thing):
    def __init__(
        self,
        *,
        position: Optional[Vector] = ...,
        target: Optional[Vector] = ...,
        path: Any = ...,
        target_path: Any = ...,
        frame: Optional[str] = ...,
        up: Optional[Vector] = ...,
        field_of_view: Optional[float] = ...,
        focal_length: Optional[float] = ...,
        aperture: Optional[float] = ...,
        focus_distance: Optional[float] = ...,
    ) -> None: ...

class PointCloud(Thing):
    def __init__(
        self,
        *,
        turning: Optional[Vector] = ...,
        pull: Optional[float] = ...,
        damping: Optional[float] = ...,
        parent_ends: Optional[str] = ...,
        center: Optional[Vector] = ...,
    ) -> None: ...

class DiskCloud(Thing):
    def __init__(
        self,
        *,
        turning: Optional[Vector] = ...,
        pull: Optional[float] = ...,
        damping: Optional[float] = ...,
        parent_ends: Optional[str] = ...,
        center: Optional[Vector] = ...,
        normal: Vector,
        radius: float,
    ) -> None: ...

class BoxCloud(Thing):
    def __init__(
        self,
        *,
        turning: Optional[Vector] = ...,
        pull: Optional[float] = ...,
        damping: Optional[float] = ...,
        parent_ends: Optional[str] = ...,
        center: Optional[Vector] = ...,
        size: Vector,
    ) -> None: ...

class SphereCloud(Thing):
    def __init__(
        self,
        *,
        turning: Optional[Vector] = ...,
        pull: Optional[float] = ...,
        damping: Optional[float] = ...,
        parent_ends: Optional[str] = ...,
        center: Optional[Vector] = ...,
        radius: float,
        surface: Optional[bool] = ...,
    ) -> None: ...

class ConeCloud(Thing):
    def __init__(
        self,
        *,
        turning: Optional[Vector] = ...,
        pull: Optional[float] = ...,
        damping: Optional[float] = ...,
        parent_ends: Optional[str] = ...,
        apex: Optional[Vector] = ...,
        axis: Vector,
        angle: float,
        height: float,
    ) -> None: ...

class PlaneCollider(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        material: Optional[str] = ...,
        looks: Any = ...,
        frame: Optional[str] = ...,
        motion: Optional[Sequence[Any]] = ...,
        point: Optional[Vector] = ...,
        normal: Vector,
    ) -> None: ...

class MeshCollider(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        material: Optional[str] = ...,
        looks: Any = ...,
        frame: Optional[str] = ...,
        motion: Optional[Sequence[Any]] = ...,
        file: Any,
        up: Optional[str] = ...,
        position: Optional[Vector] = ...,
        rotation: Any = ...,
        scale: Any = ...,
        group_materials: Optional[Mapping[str, Any]] = ...,
        deformation: Any = ...,
    ) -> None: ...

class SphereCollider(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        material: Optional[str] = ...,
        looks: Any = ...,
        frame: Optional[str] = ...,
        motion: Optional[Sequence[Any]] = ...,
        radius: float,
        position: Optional[Vector] = ...,
        rotation: Any = ...,
        scale: Any = ...,
    ) -> None: ...

class CylinderCollider(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        material: Optional[str] = ...,
        looks: Any = ...,
        frame: Optional[str] = ...,
        motion: Optional[Sequence[Any]] = ...,
        radius: float,
        height: float,
        position: Optional[Vector] = ...,
        rotation: Any = ...,
        scale: Any = ...,
    ) -> None: ...

class BoxCollider(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        material: Optional[str] = ...,
        looks: Any = ...,
        frame: Optional[str] = ...,
        motion: Optional[Sequence[Any]] = ...,
        size: Vector,
        position: Optional[Vector] = ...,
        rotation: Any = ...,
        scale: Any = ...,
    ) -> None: ...

class ColliderLooks(Thing):
    def __init__(
        self,
        *,
        color: Optional[Vector] = ...,
        roughness: Optional[float] = ...,
        glass: Optional[bool] = ...,
        hidden: Optional[bool] = ...,
        pattern: Optional[bool] = ...,
    ) -> None: ...

class Convection(Thing):
    def __init__(
        self,
        *,
        coefficient: Optional[float] = ...,
        conductivity: Optional[float] = ...,
        fluid_density: Optional[float] = ...,
        viscosity: Optional[float] = ...,
        prandtl: Optional[float] = ...,
        flow: Any = ...,
    ) -> None: ...

class Counter(Thing):
    def __init__(
        self,
        *,
        name: str,
        center: Vector,
        normal: Vector,
        radius: float,
    ) -> None: ...

class Curve(Thing):
    def __init__(
        self,
        *,
        keys: Sequence[Any],
        interpolation: Optional[str] = ...,
        ends: Optional[str] = ...,
    ) -> None: ...

class CurveKey(Thing):
    def __init__(
        self,
        *,
        time: float,
        value: float,
    ) -> None: ...

class CurvesOverLife(Thing):
    def __init__(
        self,
        *,
        color: Any = ...,
        opacity: Any = ...,
        size: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        vector_attributes: Optional[Mapping[str, Any]] = ...,
    ) -> None: ...

class SeriesDeformation(Thing):
    def __init__(
        self,
        *,
        ends: Optional[str] = ...,
        files: str,
        frame_rate: Optional[float] = ...,
        start: Optional[float] = ...,
    ) -> None: ...

class KeysDeformation(Thing):
    def __init__(
        self,
        *,
        ends: Optional[str] = ...,
        keys: Sequence[Any],
    ) -> None: ...

class CacheDeformation(Thing):
    def __init__(
        self,
        *,
        ends: Optional[str] = ...,
        file: Any,
        frame_rate: Optional[float] = ...,
        start: Optional[float] = ...,
    ) -> None: ...

class Drawing(Thing):
    def __init__(
        self,
        *,
        particles: str,
        sprite: Optional[str] = ...,
        mesh: Optional[str] = ...,
        turn: Optional[str] = ...,
        turning: Any = ...,
    ) -> None: ...

class PointEmitter(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        burst: Optional[int] = ...,
        rate: Any = ...,
        rate_per_frame: Any = ...,
        rate_per_area: Any = ...,
        start: Optional[float] = ...,
        stop: Optional[float] = ...,
        limit: Optional[int] = ...,
        seed: Optional[int] = ...,
        direction: Optional[Vector] = ...,
        cone: Optional[float] = ...,
        speed: Any = ...,
        velocity: Optional[Vector] = ...,
        mass: Any = ...,
        lifetime: Any = ...,
        particle_radius: Any = ...,
        frame: Optional[str] = ...,
        color: Any = ...,
        opacity: Any = ...,
        particle_size: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        material: Optional[str] = ...,
        drawing: Any = ...,
        over_life: Any = ...,
        over_age: Any = ...,
        center: Optional[Vector] = ...,
    ) -> None: ...

class DiskEmitter(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        burst: Optional[int] = ...,
        rate: Any = ...,
        rate_per_frame: Any = ...,
        rate_per_area: Any = ...,
        start: Optional[float] = ...,
        stop: Optional[float] = ...,
        limit: Optional[int] = ...,
        seed: Optional[int] = ...,
        direction: Optional[Vector] = ...,
        cone: Optional[float] = ...,
        speed: Any = ...,
        velocity: Optional[Vector] = ...,
        mass: Any = ...,
        lifetime: Any = ...,
        particle_radius: Any = ...,
        frame: Optional[str] = ...,
        color: Any = ...,
        opacity: Any = ...,
        particle_size: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        material: Optional[str] = ...,
        drawing: Any = ...,
        over_life: Any = ...,
        over_age: Any = ...,
        center: Optional[Vector] = ...,
        normal: Vector,
        radius: float,
    ) -> None: ...

class BoxEmitter(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        burst: Optional[int] = ...,
        rate: Any = ...,
        rate_per_frame: Any = ...,
        rate_per_area: Any = ...,
        start: Optional[float] = ...,
        stop: Optional[float] = ...,
        limit: Optional[int] = ...,
        seed: Optional[int] = ...,
        direction: Optional[Vector] = ...,
        cone: Optional[float] = ...,
        speed: Any = ...,
        velocity: Optional[Vector] = ...,
        mass: Any = ...,
        lifetime: Any = ...,
        particle_radius: Any = ...,
        frame: Optional[str] = ...,
        color: Any = ...,
        opacity: Any = ...,
        particle_size: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        material: Optional[str] = ...,
        drawing: Any = ...,
        over_life: Any = ...,
        over_age: Any = ...,
        center: Optional[Vector] = ...,
        size: Vector,
    ) -> None: ...

class SphereEmitter(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        burst: Optional[int] = ...,
        rate: Any = ...,
        rate_per_frame: Any = ...,
        rate_per_area: Any = ...,
        start: Optional[float] = ...,
        stop: Optional[float] = ...,
        limit: Optional[int] = ...,
        seed: Optional[int] = ...,
        direction: Optional[Vector] = ...,
        cone: Optional[float] = ...,
        speed: Any = ...,
        velocity: Optional[Vector] = ...,
        mass: Any = ...,
        lifetime: Any = ...,
        particle_radius: Any = ...,
        frame: Optional[str] = ...,
        color: Any = ...,
        opacity: Any = ...,
        particle_size: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        material: Optional[str] = ...,
        drawing: Any = ...,
        over_life: Any = ...,
        over_age: Any = ...,
        center: Optional[Vector] = ...,
        radius: float,
        surface: Optional[bool] = ...,
    ) -> None: ...

class MeshEmitter(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        burst: Optional[int] = ...,
        rate: Any = ...,
        rate_per_frame: Any = ...,
        rate_per_area: Any = ...,
        start: Optional[float] = ...,
        stop: Optional[float] = ...,
        limit: Optional[int] = ...,
        seed: Optional[int] = ...,
        direction: Optional[Vector] = ...,
        cone: Optional[float] = ...,
        speed: Any = ...,
        velocity: Optional[Vector] = ...,
        mass: Any = ...,
        lifetime: Any = ...,
        particle_radius: Any = ...,
        frame: Optional[str] = ...,
        color: Any = ...,
        opacity: Any = ...,
        particle_size: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        material: Optional[str] = ...,
        drawing: Any = ...,
        over_life: Any = ...,
        over_age: Any = ...,
        file: Any = ...,
        collider: Optional[str] = ...,
        up: Optional[str] = ...,
        position: Optional[Vector] = ...,
        rotation: Any = ...,
        scale: Any = ...,
        volume: Optional[bool] = ...,
    ) -> None: ...

class ConeEmitter(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        burst: Optional[int] = ...,
        rate: Any = ...,
        rate_per_frame: Any = ...,
        rate_per_area: Any = ...,
        start: Optional[float] = ...,
        stop: Optional[float] = ...,
        limit: Optional[int] = ...,
        seed: Optional[int] = ...,
        direction: Optional[Vector] = ...,
        cone: Optional[float] = ...,
        speed: Any = ...,
        velocity: Optional[Vector] = ...,
        mass: Any = ...,
        lifetime: Any = ...,
        particle_radius: Any = ...,
        frame: Optional[str] = ...,
        color: Any = ...,
        opacity: Any = ...,
        particle_size: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        material: Optional[str] = ...,
        drawing: Any = ...,
        over_life: Any = ...,
        over_age: Any = ...,
        apex: Optional[Vector] = ...,
        axis: Vector,
        angle: float,
        height: float,
    ) -> None: ...

class ChildEmitter(Thing):
    def __init__(
        self,
        *,
        name: Optional[str] = ...,
        burst: Optional[int] = ...,
        rate: Any = ...,
        rate_per_frame: Any = ...,
        rate_per_area: Any = ...,
        start: Optional[float] = ...,
        stop: Optional[float] = ...,
        limit: Optional[int] = ...,
        seed: Optional[int] = ...,
        direction: Optional[Vector] = ...,
        cone: Optional[float] = ...,
        speed: Any = ...,
        velocity: Optional[Vector] = ...,
        mass: Any = ...,
        lifetime: Any = ...,
        particle_radius: Any = ...,
        frame: Optional[str] = ...,
        color: Any = ...,
        opacity: Any = ...,
        particle_size: Any = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        material: Optional[str] = ...,
        drawing: Any = ...,
        over_life: Any = ...,
        over_age: Any = ...,
        parent: str,
        on: Optional[str] = ...,
        count: Any = ...,
        threshold_impulse: Optional[float] = ...,
        share: Optional[bool] = ...,
        recursive: Optional[bool] = ...,
        inherit_velocity: Optional[float] = ...,
        inherit_color: Optional[float] = ...,
        cloud: Any = ...,
    ) -> None: ...

class UniformFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        velocity: Vector,
        gust: Any = ...,
    ) -> None: ...

class VortexFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        point: Optional[Vector] = ...,
        axis: Vector,
        circulation: float,
        core_radius: float,
        profile: Optional[str] = ...,
    ) -> None: ...

class RadialFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        center: Optional[Vector] = ...,
        strength: float,
        core_radius: float,
    ) -> None: ...

class RotationFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        point: Optional[Vector] = ...,
        angular_velocity: Vector,
    ) -> None: ...

class ShearFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        point: Optional[Vector] = ...,
        rate: Vector,
        gradient: Vector,
    ) -> None: ...

class TurbulenceFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        speed: float,
        length: float,
        octaves: Optional[int] = ...,
        gain: Optional[float] = ...,
        rate: Optional[float] = ...,
        seed: Optional[int] = ...,
    ) -> None: ...

class SphereFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        center: Optional[Vector] = ...,
        radius: float,
        velocity: Vector,
    ) -> None: ...

class GridFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        file: Any,
        array: Optional[str] = ...,
        outside: Optional[str] = ...,
    ) -> None: ...

class SumFlow(Thing):
    def __init__(
        self,
        *,
        factor: Optional[float] = ...,
        parts: Sequence[Any],
    ) -> None: ...

class GravityForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        acceleration: Vector,
    ) -> None: ...

class DragForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        coefficient: float,
        flow: Any = ...,
    ) -> None: ...

class QuadraticDragForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        coefficient: Optional[float] = ...,
        drag_coefficient: Optional[float] = ...,
        fluid_density: Optional[float] = ...,
        flow: Any = ...,
    ) -> None: ...

class StokesDragForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        viscosity: Optional[float] = ...,
        flow: Any = ...,
    ) -> None: ...

class SchillerNaumannDragForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        fluid_density: Optional[float] = ...,
        viscosity: Optional[float] = ...,
        flow: Any = ...,
    ) -> None: ...

class BuoyancyForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        fluid_density: float,
        gravity: Vector,
    ) -> None: ...

class ThermalBuoyancyForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        ambient_temperature: Optional[float] = ...,
        gravity: Vector,
    ) -> None: ...

class PointGravityForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        attractors: Sequence[Any],
    ) -> None: ...

class RadialForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        center: Optional[Vector] = ...,
        strength: float,
        exponent: Optional[float] = ...,
        softening: Optional[float] = ...,
        reference: Optional[float] = ...,
    ) -> None: ...

class SwirlForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        point: Optional[Vector] = ...,
        axis: Vector,
        acceleration: float,
        core_radius: float,
    ) -> None: ...

class FieldForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        flow: Any,
        **keys: Any,
    ) -> None: ...

class LorentzForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        charge: float,
        electric: Optional[Vector] = ...,
        magnetic: Optional[Vector] = ...,
    ) -> None: ...

class AnchorForce(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        position: Vector,
        stiffness: float,
        rest_length: Optional[float] = ...,
        damping: Optional[float] = ...,
    ) -> None: ...

class GravityForceBetweenParticles(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        emitter: Optional[str] = ...,
        constant: Optional[float] = ...,
        softening: Optional[float] = ...,
        method: Optional[str] = ...,
        opening: Optional[float] = ...,
    ) -> None: ...

class ChargeForceBetweenParticles(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        emitter: Optional[str] = ...,
        attribute: Optional[str] = ...,
        constant: Optional[float] = ...,
        softening: Optional[float] = ...,
        method: Optional[str] = ...,
        opening: Optional[float] = ...,
    ) -> None: ...

class LennardJonesForceBetweenParticles(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        emitter: Optional[str] = ...,
        depth: Optional[float] = ...,
        diameter: Optional[float] = ...,
        cutoff: Optional[float] = ...,
    ) -> None: ...

class CohesionForceBetweenParticles(Thing):
    def __init__(
        self,
        *,
        particles: Optional[Vector] = ...,
        emitter: Optional[str] = ...,
        stiffness: float,
        range: float,
        damping: Optional[float] = ...,
    ) -> None: ...

class Frame(Thing):
    def __init__(
        self,
        *,
        parent: Optional[str] = ...,
        translation: Optional[Vector] = ...,
        rotation: Any = ...,
        motions: Optional[Sequence[Any]] = ...,
        body: Any = ...,
    ) -> None: ...

class RotationFrameMotion(Thing):
    def __init__(
        self,
        *,
        axis: Vector,
        angle: Any,
    ) -> None: ...

class SpinFrameMotion(Thing):
    def __init__(
        self,
        *,
        axis: Vector,
        rate: float,
    ) -> None: ...

class SwingFrameMotion(Thing):
    def __init__(
        self,
        *,
        axis: Vector,
        amplitude: float,
        frequency: float,
        phase: Optional[float] = ...,
    ) -> None: ...

class OscillationFrameMotion(Thing):
    def __init__(
        self,
        *,
        amplitude: Vector,
        frequency: float,
        phase: Optional[float] = ...,
    ) -> None: ...

class TranslationFrameMotion(Thing):
    def __init__(
        self,
        *,
        way: Any,
    ) -> None: ...

class ScaleFrameMotion(Thing):
    def __init__(
        self,
        *,
        factor: Any,
    ) -> None: ...

class Gust(Thing):
    def __init__(
        self,
        *,
        amplitude: float,
        frequency: float,
        phase: Optional[float] = ...,
    ) -> None: ...

class Heat(Thing):
    def __init__(
        self,
        *,
        specific_heat: float,
        ambient_temperature: Optional[float] = ...,
        convection: Any = ...,
        emissivity: Optional[float] = ...,
        impact_fraction: Optional[float] = ...,
        friction_fraction: Optional[float] = ...,
    ) -> None: ...

class KeyPose(Thing):
    def __init__(
        self,
        *,
        time: float,
        position: Optional[Vector] = ...,
        rotation: Any = ...,
        scale: Any = ...,
    ) -> None: ...

class Material(Thing):
    def __init__(
        self,
        *,
        restitution: Optional[float] = ...,
        restitution_threshold: Optional[float] = ...,
        friction: Optional[float] = ...,
        rolling_friction: Optional[float] = ...,
        spinning_friction: Optional[float] = ...,
        diffuse: Optional[float] = ...,
        wall_temperature: Optional[float] = ...,
        absorption: Optional[float] = ...,
        surface_motion: Any = ...,
    ) -> None: ...

class MeshKey(Thing):
    def __init__(
        self,
        *,
        time: float,
        file: Any,
    ) -> None: ...

class Output(Thing):
    def __init__(
        self,
        *,
        format: Optional[str] = ...,
        every: Optional[int] = ...,
        checkpoint_every: Optional[int] = ...,
        pieces: Optional[bool] = ...,
        contacts: Optional[bool] = ...,
    ) -> None: ...

class PairOfMaterials(Thing):
    def __init__(
        self,
        *,
        first: str,
        second: str,
        restitution: Optional[float] = ...,
        friction: Optional[float] = ...,
        rolling_friction: Optional[float] = ...,
    ) -> None: ...

class Particle(Thing):
    def __init__(
        self,
        *,
        position: Vector,
        velocity: Optional[Vector] = ...,
        mass: Optional[float] = ...,
        radius: Optional[float] = ...,
        spin: Optional[Vector] = ...,
        lifetime: Optional[float] = ...,
        pinned: Optional[bool] = ...,
        color: Optional[Vector] = ...,
        opacity: Optional[float] = ...,
        size: Optional[float] = ...,
        attributes: Optional[Mapping[str, Any]] = ...,
        material: Optional[str] = ...,
    ) -> None: ...

class ParticleContacts(Thing):
    def __init__(
        self,
        *,
        restitution: Optional[float] = ...,
        friction: Optional[float] = ...,
        rolling_friction: Optional[float] = ...,
        method: Optional[str] = ...,
        impact_budget: Optional[int] = ...,
        materials: Optional[Mapping[str, Any]] = ...,
        pairs: Optional[Sequence[Any]] = ...,
    ) -> None: ...

class ParticleTable(Thing):
    def __init__(
        self,
        *,
        file: Any,
    ) -> None: ...

class Penalty(Thing):
    def __init__(
        self,
        *,
        stiffness: Optional[float] = ...,
        contact_steps: Optional[float] = ...,
        substeps: Optional[int] = ...,
        friction_speed: Optional[float] = ...,
    ) -> None: ...

class Picture(Thing):
    def __init__(
        self,
        *,
        light: Optional[str] = ...,
        background: Optional[Vector] = ...,
        transparent: Optional[bool] = ...,
        particles: Optional[str] = ...,
        sprite: Optional[str] = ...,
        mesh: Optional[str] = ...,
        turn: Optional[str] = ...,
        turning: Any = ...,
        shutter: Optional[float] = ...,
        black_body: Optional[float] = ...,
        stretch: Any = ...,
        ground: Optional[float] = ...,
        particle_radius: Optional[float] = ...,
        time: Optional[float] = ...,
    ) -> None: ...

class PinBox(Thing):
    def __init__(
        self,
        *,
        lower: Vector,
        upper: Vector,
    ) -> None: ...

class Project(Thing):
    def __init__(
        self,
        *,
        offset: Optional[float] = ...,
    ) -> None: ...

class ReferenceCamera(Thing):
    def __init__(
        self,
        *,
        position: Vector,
        target: Vector,
        field_of_view: Optional[float] = ...,
        image_height: Optional[float] = ...,
    ) -> None: ...

class Rollback(Thing):
    def __init__(
        self,
        *,
        time_tolerance: Optional[float] = ...,
        **keys: Any,
    ) -> None: ...

class Rotation(Thing):
    def __init__(
        self,
        *,
        axis: Vector,
        degrees: float,
    ) -> None: ...

class ScaleCurve(Thing):
    def __init__(
        self,
        *,
        keys: Sequence[Any],
        interpolation: Optional[str] = ...,
        ends: Optional[str] = ...,
    ) -> None: ...

class ScaleCurveKey(Thing):
    def __init__(
        self,
        *,
        time: float,
        value: Any,
    ) -> None: ...

class SimulationOptions(Thing):
    def __init__(
        self,
        *,
        time_step: Optional[float] = ...,
        duration: Optional[float] = ...,
        integrator: Optional[str] = ...,
        tolerance: Any = ...,
        response: Optional[str] = ...,
        motion: Optional[str] = ...,
        flow: Any = ...,
        walls: Optional[str] = ...,
        seed: Optional[int] = ...,
        resting_speed: Optional[float] = ...,
        frame_rate: Optional[float] = ...,
        max_depth: Optional[int] = ...,
        most_particles: Optional[int] = ...,
        bounce_budget: Optional[int] = ...,
        rollback: Any = ...,
        project: Any = ...,
        penalty: Any = ...,
    ) -> None: ...

class SphereMaterial(Thing):
    def __init__(
        self,
        *,
        restitution: Optional[float] = ...,
        friction: Optional[float] = ...,
        rolling_friction: Optional[float] = ...,
    ) -> None: ...

class Spring(Thing):
    def __init__(
        self,
        *,
        first: int,
        second: int,
        rest_length: Optional[float] = ...,
        stiffness: float,
        damping: Optional[float] = ...,
        breaking_stretch: Optional[float] = ...,
    ) -> None: ...

class ListSprings(Thing):
    def __init__(
        self,
        *,
        springs: Sequence[Any],
    ) -> None: ...

class RopeSprings(Thing):
    def __init__(
        self,
        *,
        to: Vector,
        nodes: int,
        length: Optional[float] = ...,
        mass: float,
        radius: Optional[float] = ...,
        stiffness: Optional[float] = ...,
        axial_stiffness: Optional[float] = ...,
        damping: Optional[float] = ...,
        breaking_stretch: Optional[float] = ...,
        sag: Optional[Vector] = ...,
        pinned: Optional[str] = ...,
        **keys: Any,
    ) -> None: ...

class ChainSprings(Thing):
    def __init__(
        self,
        *,
        to: Vector,
        links: int,
        link_length: float,
        mass: float,
        radius: Optional[float] = ...,
        stiffness: Optional[float] = ...,
        axial_stiffness: Optional[float] = ...,
        damping: Optional[float] = ...,
        breaking_stretch: Optional[float] = ...,
        sag: Optional[Vector] = ...,
        pinned: Optional[str] = ...,
        **keys: Any,
    ) -> None: ...

class ClothSprings(Thing):
    def __init__(
        self,
        *,
        file: Any,
        up: Optional[str] = ...,
        position: Optional[Vector] = ...,
        rotation: Any = ...,
        scale: Any = ...,
        mass: Optional[float] = ...,
        mass_per_area: Optional[float] = ...,
        radius: Optional[float] = ...,
        stiffness: float,
        bending_stiffness: Optional[float] = ...,
        damping: Optional[float] = ...,
        breaking_stretch: Optional[float] = ...,
        pinned: Optional[Vector] = ...,
        pin_boxes: Optional[Sequence[Any]] = ...,
    ) -> None: ...

class SheetSprings(Thing):
    def __init__(
        self,
        *,
        corner: Vector,
        side_u: Vector,
        side_v: Vector,
        cells_u: int,
        cells_v: int,
        mass: Optional[float] = ...,
        mass_per_area: Optional[float] = ...,
        radius: Optional[float] = ...,
        stiffness: float,
        bending_stiffness: Optional[float] = ...,
        damping: Optional[float] = ...,
        breaking_stretch: Optional[float] = ...,
        pinned: Optional[Vector] = ...,
        pin_boxes: Optional[Sequence[Any]] = ...,
    ) -> None: ...

class Stretch(Thing):
    def __init__(
        self,
        *,
        speed: Optional[float] = ...,
        impact: Optional[float] = ...,
        time: Optional[float] = ...,
        most: Optional[float] = ...,
    ) -> None: ...

class SurfaceMotion(Thing):
    def __init__(
        self,
        *,
        velocity: Optional[Vector] = ...,
        angular_velocity: Optional[Vector] = ...,
        center: Optional[Vector] = ...,
    ) -> None: ...

class Tolerance(Thing):
    def __init__(
        self,
        *,
        position: Optional[float] = ...,
        velocity: Optional[float] = ...,
    ) -> None: ...

class VectorCurve(Thing):
    def __init__(
        self,
        *,
        keys: Sequence[Any],
        interpolation: Optional[str] = ...,
        ends: Optional[str] = ...,
    ) -> None: ...

class VectorCurveKey(Thing):
    def __init__(
        self,
        *,
        time: float,
        value: Vector,
    ) -> None: ...
