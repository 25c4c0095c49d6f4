/// \file
/// Checks what particles did, independently of the code that moved them: every segment that was travelled against the
/// surfaces near it, after every step the side of every closed surface and the distance of spheres, and of every impact
/// and interval of contact that is recorded that no energy comes from surfaces at rest.
///
/// Independent: this folder includes none of the sweep's predicates, trees or distance code (a test checks that).
/// Its signs come from whole numbers of any length, its parity from counted crossings, its distances from a hundred
/// digits wherever doubles leave doubt. It is given the surfaces in world coordinates as they collide, so placements
/// are not checked again.
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

// What a verified run finds wrong.

/// Where a point is.
enum class Side : std::uint8_t { inside, outside, on_surface };

/// What is wrong.
enum class ViolationKind : std::uint8_t {
    crossing,    ///< a segment that was travelled intersects a surface
    gap,         ///< the segments do not join the position at which the particle was last seen to its position now
    wrong_side,  ///< the particle is on another side of a closed surface than at birth
    overlap,     ///< a sphere is nearer to a surface than its radius, by more than 1e-12 of its radius and coordinates
    energy,      ///< it has gained energy from surfaces, or the recorded parts of its motion do not join
    pair_overlap,  ///< a sphere stands in another, see verify/sphere_overlaps.h
    pair_impact,   ///< an impact of spheres on each other that does not add up, see verify/pair_books.h
    rebound,       ///< an impact whose rebound is not that of the surfaces that it has hit
};

/// One violation. Each is reported once: what follows from it later is measured from the new state.
struct Violation {
    ViolationKind kind = ViolationKind::crossing;
    std::uint64_t particle = 0;  ///< id
    Vec3 position;               ///< m: of the crossing (rounded), else of the particle's centre
    double time = 0.0;  ///< s: a crossing's flight, or what gained energy, began then; for the others the step's end
    std::optional<std::uint32_t> collider;  ///< index; nothing for a gap, energy, a rebound and spheres
    std::optional<std::uint32_t> triangle;  ///< of the collider's mesh; nothing for planes, shapes and sides
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

/// A mesh that deforms: vertices at keys, and between them each on a straight line at constant speed.
struct VerifiedDeformation {
    std::vector<Triangle> triangles;
    std::vector<double> times;                ///< s, of the keys, ascending
    std::vector<std::vector<Vec3>> vertices;  ///< m, at each key
    bool repeats = false;                     ///< the keys again and again; else they are held at both ends
};

/// A collider in world coordinates. Triangles of a mesh without area take no part, as in collisions.
using VerifiedSurface = std::variant<TriangleMesh, VerifiedPlane, VerifiedShape, VerifiedDeformation>;

/// Which surfaces move, and how.
struct VerifiedMotion {
    std::shared_ptr<const FrameTree> frames;           ///< null where none moves
    std::vector<std::optional<std::size_t>> frame_of;  ///< of each surface; its coordinates are the frame's
};

/// What the verifier remembers of a particle from one step to the next.
struct VerifiedParticle {
    Vec3 position;
    /// Per closed surface (closed meshes, shapes; planes count too: their two sides). on_surface: not decided yet, for
    /// a particle that was born exactly on the surface and takes the side that it moves to.
    std::vector<Side> sides;
    bool is_on_surface = false;  ///< of any surface, open ones included
    /// False while it overlaps something from its birth on: its distance is not judged until it has been free once.
    bool has_been_free = true;
    double time = 0.0;           ///< s, at which it stood there
    double checked_until = 0.0;  ///< s, when the last step ended; after `time` where its clock has stood still
};

/// How a particle's motion changed in a step, where that is recorded.
struct RecordedParts {
    RecordedMotion before;                ///< at its begin
    RecordedMotion after;                 ///< at its end
    std::span<const MotionPart> parts{};  ///< in the order of time; none where they are not recorded
};

/// What a particle did in a step.
struct VerifiedStep {
    std::uint64_t particle = 0;         ///< id
    Vec3 from;                          ///< where it stood before, m
    Vec3 to;                            ///< where it stands now, m
    double radius = 0.0;                ///< m
    double time = 0.0;                  ///< s, at the end of the step
    std::span<const Segment> segments;  ///< in the order of time
    RecordedParts motion{};
    double stored_time = 0.0;  ///< s, of its position now, where colliders move: before `time` for one that is squeezed
};

/// Immutable; safe from any number of threads. Copies share what they hold.
class Verifier {
public:
    /// Collider i is surfaces[i]. A mesh is closed when every edge belongs to an even number of triangle sides. Throws
    /// InputError for numbers that are not finite, corners that are not there, and normals and shapes without extent.
    explicit Verifier(const std::vector<VerifiedSurface>& surfaces, const VerifiedMotion& motion = {});
    ~Verifier();
    Verifier(const Verifier&);
    Verifier& operator=(const Verifier&);

    /// Begins to watch a particle at its birth, at a time, s. A position that is not finite has no side and is not
    /// judged.
    [[nodiscard]] VerifiedParticle watch(const Vec3& position, double radius, double time = 0.0) const;

    /// Checks a step and appends what is wrong to `violations`: gaps, then crossings in the order of the segments, then
    /// sides, then overlaps, each in the order of colliders and triangles, then energies in the order of the parts.
    /// Updates what is remembered. Throws InputError for a particle that another verifier has watched, with another
    /// number of sides.
    void check(const VerifiedStep& step, VerifiedParticle& particle, std::vector<Violation>& violations) const;

    /// Appends the closed surfaces on whose other side a particle ends whose clock stands still: they have passed it
    /// meanwhile. time: s, now.
    void check_end(std::uint64_t id, double time, const VerifiedParticle& particle,
                   std::vector<Violation>& violations) const;

private:
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

}  // namespace ricochet
