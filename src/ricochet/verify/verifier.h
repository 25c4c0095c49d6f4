/// \file
/// Verifier: checks the motion of particles, independently of the code that moved them. It checks every travelled
/// segment against the surfaces near the segment. After every step it checks the particle's side of every closed
/// surface, and the distance of spheres from surfaces. For every recorded impact and contact interval, it checks that
/// surfaces at rest add no energy.
///
/// This folder uses none of the sweep's predicates, trees or distance code; a test checks this rule. Signs are computed
/// with integers of any length, and parities by counted crossings. Distances are computed with a hundred digits if
/// doubles leave doubt. The surfaces are given in world coordinates, after the transforms of the scene. These
/// transforms are therefore not checked.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "ricochet/core/frame_tree.h"
#include "ricochet/core/motion_part.h"
#include "ricochet/core/segment.h"
#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

// Violations found in a verified run.

/// Side of a surface on which a point lies.
enum class Side : std::uint8_t { inside, outside, on_surface };

/// Kinds of violations.
enum class ViolationKind : std::uint8_t {
    crossing,    ///< a travelled segment intersects a surface
    gap,         ///< the segments do not connect the particle's last known position to its current position
    wrong_side,  ///< the particle is not on the same side of a closed surface as before
    /// The distance of a sphere from a surface is below its radius by more than 1e-12 of its radius and coordinates.
    overlap,
    /// The particle has gained energy from surfaces, or a recorded part of its motion does not start where the last one
    /// ended.
    energy,
    pair_overlap,  ///< a sphere overlaps another sphere, see verify/sphere_overlaps.h
    pair_impact,   ///< an impact between spheres fails the audit, see verify/impact_audit.h
    rebound,       ///< the rebound of an impact does not agree with the restitution of the surfaces
};

/// One violation. It is reported once, because later steps are checked against the new state.
struct Violation {
    ViolationKind kind = ViolationKind::crossing;
    std::uint64_t particle = 0;  ///< id
    Vec3 position;               ///< position of a crossing (rounded), otherwise of the particle's centre, in m
    /// Time, in s. A crossing has the start time of the flight or contact phase. A pair_impact or rebound has the time
    /// of the impact. An energy violation has the start time of the recorded part of the motion. Other violations have
    /// the end time of the step.
    double time = 0.0;
    /// Index of the collider. Nothing for the kinds gap, energy and rebound, and for violations between spheres.
    std::optional<std::uint32_t> collider;
    /// Index in the collider's mesh; nothing for planes, shapes and wrong sides.
    std::optional<std::uint32_t> triangle;
};

/// An infinite plane.
struct VerifiedPlane {
    Vec3 point;
    Vec3 normal;  ///< not zero
};

/// The image of the unit ball, or of the cylinder x^2 + y^2 <= 1, |z| <= 1 with its caps, under a map.
struct VerifiedShape {
    AffineMap world_from_unit;  ///< map made of a scale, a rotation and a translation
    bool is_cylinder = false;
};

/// A deforming mesh, given by its vertices at keys. Between keys each vertex moves in a straight line at constant
/// speed.
struct VerifiedDeformation {
    std::vector<Triangle> triangles;
    std::vector<double> times;                ///< times of the keys, in s, ascending
    std::vector<std::vector<Vec3>> vertices;  ///< positions of the vertices at each key, in m
    /// True if the keys repeat. Otherwise the vertices keep their positions before the first and after the last key.
    bool repeats = false;
};

/// A collider in world coordinates. Mesh triangles without area are ignored, as in collisions.
using VerifiedSurface = std::variant<TriangleMesh, VerifiedPlane, VerifiedShape, VerifiedDeformation>;

/// Frames in which surfaces move.
struct VerifiedMotion {
    std::shared_ptr<const FrameTree> frames;  ///< null if no surface moves
    /// Frame of each surface; the surface's coordinates are relative to this frame.
    std::vector<std::optional<std::size_t>> frame_of;
};

/// State of a particle that the verifier keeps from one step to the next.
struct VerifiedParticle {
    Vec3 position;
    /// One side for each closed surface: closed meshes, shapes and planes. `on_surface` means that the side is
    /// undecided. The particle was born exactly on the surface, and takes the side to which it moves.
    std::vector<Side> sides;
    bool is_on_surface = false;  ///< true if the particle is on any surface, open surfaces included
    /// False if the sphere was born in overlap with a surface and has not been free since. Until it is free, its
    /// distance from surfaces is not checked.
    bool has_been_free = true;
    double time = 0.0;           ///< time at which the particle had the position, in s
    double checked_until = 0.0;  ///< end of the last step, in s; later than `time` if the particle is stalled
};

/// Recorded changes of a particle's motion in a step.
struct RecordedParts {
    RecordedMotion before;                ///< at the start of the step
    RecordedMotion after;                 ///< at the end of the step
    std::span<const MotionPart> parts{};  ///< recorded parts in the order of time; empty if motion is not recorded
};

/// Motion of a particle in a step.
struct VerifiedStep {
    std::uint64_t particle = 0;         ///< id
    Vec3 from;                          ///< position at the start of the step, in m
    Vec3 to;                            ///< position at the end of the step, in m
    double radius = 0.0;                ///< in m
    double time = 0.0;                  ///< end of the step, in s
    std::span<const Segment> segments;  ///< in the order of time
    RecordedParts motion{};
    /// Time at which the particle has the position `to`, in s, if colliders move. It is before `time` if the particle
    /// is pinched.
    double stored_time = 0.0;
};

/// The verifier of a run. It is immutable and thread-safe. Copies share their data.
class Verifier {
public:
    /// Creates a verifier in which collider i has the surface surfaces[i]. A mesh is closed if every edge belongs to an
    /// even number of triangle sides. Throws InputError for numbers that are not finite, corner indices without a
    /// vertex, zero normals, and shapes without a volume.
    explicit Verifier(const std::vector<VerifiedSurface>& surfaces, const VerifiedMotion& motion = {});
    ~Verifier();
    Verifier(const Verifier&);
    Verifier& operator=(const Verifier&);

    /// Returns the state of a particle at its birth, for the first call of check(). time: time of the birth, in s. A
    /// position that is not finite has no side and is not checked.
    [[nodiscard]] VerifiedParticle watch(const Vec3& position, double radius, double time = 0.0) const;

    /// Checks a step, appends violations to `violations` and updates the state of the particle. Violations are appended
    /// in this order: gaps, crossings in the order of the segments, wrong sides, overlaps, and energies in the order of
    /// the parts. Crossings, wrong sides and overlaps are ordered by colliders and triangles. Throws InputError if the
    /// particle's number of sides does not match this verifier.
    void check(const VerifiedStep& step, VerifiedParticle& particle, std::vector<Violation>& violations) const;

    /// Checks a stalled particle at the end of a run. Appends a violation for each closed surface that has passed the
    /// particle meanwhile, so that the particle is now on its other side. time: current time, in s.
    void check_end(std::uint64_t id, double time, const VerifiedParticle& particle,
                   std::vector<Violation>& violations) const;

private:
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

}  // namespace ricochet
