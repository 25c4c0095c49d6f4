/// \file
/// What a contact query finds: the first contact of a path, and the triangles that come near it next.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ricochet/collision/collision_world.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/acceleration/triangle_clusters.h"

namespace ricochet {

/// A surface that takes part in an impact.
struct ContactSurface {
    SurfaceId surface = 0;
    Vec3 normal;       ///< unit, facing the side that the path comes from; for spheres from the surface to the centre
    bool flat = true;  ///< a plane or the inside of a triangle; false: an edge, a vertex or a curved surface
    /// The particle slides, rolls or rests on it when it comes to the impact. Its normal speed there is rounding, so
    /// the impact never counts it as approached.
    bool holds = false;
};

/// The first contact of a path: all surfaces that it reaches at the same time (kSimultaneousUlps), the smallest number
/// first.
struct Contact {
    static constexpr int kMostSurfaces = 8;

    double time = 0.0;  ///< time of impact, s along the path
    std::array<ContactSurface, kMostSurfaces> surfaces;
    int count = 0;  ///< at least 1; of more than kMostSurfaces the smallest numbers are kept

    [[nodiscard]] std::span<const ContactSurface> all() const {
        return {surfaces.data(), static_cast<std::size_t>(count)};
    }
    [[nodiscard]] const ContactSurface& first() const { return surfaces[0]; }
};

/// Unit normal of a surface that a point at p reaches from `side` (+1, -1) with velocity v. A point that moves exactly
/// in the surface's plane (side 0) has hit its boundary head-on: the normal is then against the motion.
[[nodiscard]] Vec3 facing_normal(const CollisionWorld& world, SurfaceId surface, int side, const Vec3& p,
                                 const Vec3& v);
/// The same for a surface whose unit normal is known.
[[nodiscard]] Vec3 facing_normal(const Vec3& normal, int side, const Vec3& v);

/// All triangles that come near a particle's path in one step to come, where they are known and few. They serve speed
/// only: the query that they are cached for needs no broad phase.
class ContactCandidates {
public:
    static constexpr std::size_t kMost = 4;

    /// Nothing is known.
    constexpr ContactCandidates() { triangles_.fill(kUnknown); }
    /// No triangle comes near.
    [[nodiscard]] static constexpr ContactCandidates none() {
        ContactCandidates candidates;
        candidates.triangles_.fill(kNoTriangle);
        return candidates;
    }

    [[nodiscard]] bool is_known() const { return triangles_[0] != kUnknown; }
    /// Only when is_known().
    [[nodiscard]] std::span<const std::uint32_t> triangles() const {
        std::size_t count = 0;
        while (count < kMost && triangles_[count] != kNoTriangle) ++count;
        return {triangles_.data(), count};
    }
    /// One more; with more than kMost nothing is known any longer. Only when is_known().
    void add(std::uint32_t triangle) {
        const std::size_t count = triangles().size();
        if (count == kMost) {
            *this = ContactCandidates{};
        } else {
            triangles_[count] = triangle;
        }
    }

private:
    static constexpr std::uint32_t kUnknown = kNoTriangle - 1;

    std::array<std::uint32_t, kMost> triangles_;
};

}  // namespace ricochet
