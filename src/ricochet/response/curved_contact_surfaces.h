/// \file
/// The surfaces that hold a particle on an arc, as they are seen from where it starts.
#pragma once

#include <array>
#include <cstddef>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/response/contact_manifold.h"

namespace ricochet {

class CurvedContactSurfaces {
public:
    /// particle: at the start, touching what the manifold lists.
    CurvedContactSurfaces(const SurfaceGeometry& geometry, const ForceInput& particle, const ContactManifold& manifold);

    [[nodiscard]] SurfaceId id(std::size_t k) const { return of_[k].surface; }
    /// Surface k from the side of the start, all along: within an arc a point may come behind it by the arc's own
    /// error. Whatever it is on the face or the side of, goes on beyond its rim.
    [[nodiscard]] CollisionWorld::Nearest nearest(std::size_t k, const Vec3& position) const;
    /// The largest change of a shape's normal that a sphere sees from the start to a position. Of its outward normal:
    /// the way straight on comes out of a large shape behind a small sphere, where the direction to it turns round.
    [[nodiscard]] double turned_at(const Vec3& position) const;
    /// m, of a sphere with curved surface k at the start, where it was born so deep in it that being put on it were a
    /// jump: it goes along as deep. Less is taken back.
    [[nodiscard]] double overlap(std::size_t k) const { return of_[k].overlap; }

private:
    struct Surface {
        SurfaceId surface{};
        bool is_flat = false;
        bool is_on_rim = false;
        bool is_narrow = false;
        double side = 1.0;     // -1: the particle is behind it
        Vec3 normal_at_start;  // outward, or, on a rim, towards the particle
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
