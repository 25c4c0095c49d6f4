/// \file
/// Surfaces that support a particle along an arc. The side of the particle is determined at the start of the arc.
#pragma once

#include <array>
#include <cstddef>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/response/contact_manifold.h"

namespace ricochet {

class CurvedContactSurfaces {
public:
    /// particle: state at the start of the arc, in contact with the surfaces of the manifold.
    CurvedContactSurfaces(const SurfaceGeometry& geometry, const ForceInput& particle, const ContactManifold& manifold);

    [[nodiscard]] SurfaceId id(std::size_t k) const { return of_[k].surface; }
    /// Returns the nearest point of surface k. Its normal points to the particle's side at the start, because
    /// integration errors can put a position on the arc behind the surface. A face or side is extended beyond its rim.
    [[nodiscard]] CollisionWorld::Nearest nearest(std::size_t k, const Vec3& position) const;
    /// Returns the largest change of the normal of a touched shape between the start and a position; 0 for a point.
    /// Uses outward normals, because a position straight ahead may lie behind the surface of a large shape.
    [[nodiscard]] double turned_at(const Vec3& position) const;
    /// Returns the overlap, in m, that a sphere keeps with curved surface k. A sphere that was spawned deep in the
    /// surface keeps its overlap, because moving it out would be a jump. Smaller overlaps are removed, so that the
    /// result is 0.
    [[nodiscard]] double overlap(std::size_t k) const { return of_[k].overlap; }

private:
    struct Surface {
        SurfaceId surface{};
        bool is_flat = false;
        bool is_on_rim = false;
        bool is_narrow = false;
        double side = 1.0;     // -1: the particle is behind the surface
        Vec3 normal_at_start;  // outward, or on a rim towards the particle
        double overlap = 0.0;
    };
    [[nodiscard]] double side_of(const Surface& surface, const Vec3& normal, const Vec3& position) const;
    [[nodiscard]] Vec3 outward_normal(const Surface& surface, const Vec3& position) const;

    const SurfaceGeometry& geometry_;
    double radius_;
    std::array<Surface, kMostSupports> of_{};
    std::size_t count_ = 0;
};

}  // namespace ricochet
