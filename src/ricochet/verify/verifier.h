/// \file
/// Checks the motion of particles, independently of the code that moved them. It checks every travelled segment against
/// the surfaces near it. After every step it checks the side of every closed surface and the distance of spheres. For
/// every recorded impact and interval of contact it checks that no energy comes from surfaces at rest.
///
/// This folder includes none of the sweep's predicates, trees or distance code (a test checks that). Its signs come
/// from integers of any length and its parity from counted crossings. Its distances come from a hundred digits if
/// doubles leave doubt. The surfaces are given in world coordinates, after their placement, so placements are not
/// checked.
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

/// Side of a surface on which a point is.
enum class Side : std::uint8_t { inside, outside, on_surface };

/// Kinds of violations.
enum class ViolationKind : std::uint8_t {
    crossing,    ///< a travelled segment intersects a surface
    gap,         ///< segments do not join the particle's last known position to its position now
    wrong_side,  ///< the particle is on another side of a closed surface than at birth
    overlap,     ///< a sphere is nearer to a surface than its radius, by more than 1e-12 of its radius and coordinates
    energy,      ///< the particle has gained energy from surfaces, or the recorded parts of its motion do not join
    pair_overlap,  ///< a sphere overlaps another, see verify/sphere_overlaps.h
    pair_impact,   ///< an impact between spheres fails the audit, see verify/impact_audit.h
    rebound,       ///< the rebound of an impact does not agree with its surfaces
};

/// One violation. Each is reported once: later steps are checked against the new state.
struct Violation {
    ViolationKind kind = ViolationKind::crossing;
    std::uint64_t particle = 0;  ///< id
    Vec3 position;               ///< in m; of the crossing (rounded), otherwise of the particle's centre
    /// Time, in s. It is the start of the flight for a crossing and the start of the part for energy. For other kinds
    /// it is the end of the step.
    double time = 0.0;
    std::optional<std::uint32_t> collider;  ///< index; nothing for a gap, energy, a rebound and spheres
    std::optional<std::uint32_t> triangle;  ///< in the collider's mesh; nothing for planes, shapes and sides
};

/// An infinite plane.
struct VerifiedPlane {
    Vec3 point;
    Vec3 normal;  ///< not zero
};

/// The image of the unit ball, or of the cylinder x^2 + y^2 <= 1, |z| <= 1 with its caps.
struct VerifiedShape {
    AffineMap world_from_unit;  ///< rotation times scale, and a translation
    bool is_cylinder = false;
};

/// A deforming mesh: vertices at keys. Between keys each vertex moves in a straight line at constant speed.
struct VerifiedDeformation {
    std::vector<Triangle> triangles;
    std::vector<double> times;                ///< of the keys, in s, ascending
    std::vector<std::vector<Vec3>> vertices;  ///< at each key, in m
    /// True if the keys repeat. Otherwise the vertices keep their positions before the first and after the last key.
    bool repeats = false;
};

/// A collider in world coordinates. Mesh triangles without area are ignored, as in collisions.
using VerifiedSurface = std::variant<TriangleMesh, VerifiedPlane, VerifiedShape, VerifiedDeformation>;

/// Motion of the surfaces.
struct VerifiedMotion {
    std::shared_ptr<const FrameTree> frames;           ///< null if none moves
    std::vector<std::optional<std::size_t>> frame_of;  ///< one per surface; its coordinates are relative to that frame
};

/// State of a particle that the verifier keeps from one step to the next.
struct VerifiedParticle {
    Vec3 position;
    /// One side per closed surface: closed meshes, shapes and planes, which have two sides. `on_surface` means
    /// undecided: a particle was born exactly on the surface and takes the side that it moves to.
    std::vector<Side> sides;
    bool is_on_surface = false;  ///< true on any surface, open ones included
    /// False from birth until the sphere is first free, if it is born in overlap. Its distance is not checked until
    /// then.
    bool has_been_free = true;
    double time = 0.0;           ///< time of the position, in s
    double checked_until = 0.0;  ///< end of the last step, in s; later than `time` if the particle is stalled
};

/// Recorded changes of a particle's motion in a step.
struct RecordedParts {
    RecordedMotion before;                ///< at the start of the step
    RecordedMotion after;                 ///< at the end of the step
    std::span<const MotionPart> parts{};  ///< in the order of time; empty if they are not recorded
};

/// Motion of a particle in a step.
struct VerifiedStep {
    std::uint64_t particle = 0;         ///< id
    Vec3 from;                          ///< position before, in m
    Vec3 to;                            ///< position now, in m
    double radius = 0.0;                ///< in m
    double time = 0.0;                  ///< end of the step, in s
    std::span<const Segment> segments;  ///< in the order of time
    RecordedParts motion{};
    /// Time of its position now, in s, if colliders move. It is before `time` for a pinched particle.
    double stored_time = 0.0;
};

/// The verifier of a run. Immutable; safe from any number of threads. Copies share their data.
class Verifier {
public:
    /// Collider i is surfaces[i]. A mesh is closed if every edge belongs to an even number of triangle sides. Throws
    /// InputError for numbers that are not finite, indices of missing corners, and normals and shapes without extent.
    explicit Verifier(const std::vector<VerifiedSurface>& surfaces, const VerifiedMotion& motion = {});
    ~Verifier();
    Verifier(const Verifier&);
    Verifier& operator=(const Verifier&);

    /// Starts to observe a particle at its birth, at a time, in s. A position that is not finite has no side and is not
    /// checked.
    [[nodiscard]] VerifiedParticle watch(const Vec3& position, double radius, double time = 0.0) const;

    /// Checks a step, appends violations to `violations` and updates the state of the particle. The order is: gaps,
    /// crossings in the order of the segments, sides, overlaps, energies in the order of the parts. Crossings, sides
    /// and overlaps are each in the order of colliders and triangles. Throws InputError for a particle of another
    /// verifier with another number of sides.
    void check(const VerifiedStep& step, VerifiedParticle& particle, std::vector<Violation>& violations) const;

    /// Checks a stalled particle at the end of a run. Appends the closed surfaces that have passed it meanwhile, so
    /// that it is on their other side. `time` is the current time, in s.
    void check_end(std::uint64_t id, double time, const VerifiedParticle& particle,
                   std::vector<Violation>& violations) const;

private:
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

}  // namespace ricochet
