#include "ricochet/response/curved_contact_surfaces.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {

CurvedContactSurfaces::CurvedContactSurfaces(const SurfaceGeometry& geometry, const ForceInput& particle,
                                             const ContactManifold& manifold)
    : geometry_(geometry), radius_(particle.radius), count_(manifold.size()) {
    for (std::size_t k = 0; k < count_; ++k) {
        Surface& surface = of_[k];
        surface.surface = manifold[k].surface;
        surface.is_flat = manifold[k].flat;
        surface.is_on_rim = !manifold[k].flat && geometry.nearest(surface.surface, particle.position).rim;
        surface.normal_at_start = outward_normal(surface, particle.position);
        surface.side = side_of(surface, manifold[k].normal, particle.position);
        // A sphere in an equally narrow shape touches both walls. The nearest is then opposite to the contact.
        surface.is_narrow = radius_ > 0.0 && dot(surface.side * surface.normal_at_start, manifold[k].normal) < 0.0;
        if (radius_ == 0.0 || surface.is_flat) continue;
        const double overlap = radius_ - nearest(k, particle.position).distance;
        if (overlap > kJump * radius_) surface.overlap = overlap;
    }
}

double CurvedContactSurfaces::side_of(const Surface& surface, const Vec3& normal, const Vec3& position) const {
    if (radius_ == 0.0 || surface.is_on_rim) return dot(surface.normal_at_start, normal) < 0.0 ? -1.0 : 1.0;
    return geometry_.signed_distance_from(surface.surface, position) < 0.0 ? -1.0 : 1.0;
}

Vec3 CurvedContactSurfaces::outward_normal(const Surface& surface, const Vec3& position) const {
    return surface.is_on_rim ? geometry_.nearest(surface.surface, position).normal
                             : geometry_.unit_normal_of(surface.surface, position);
}

CollisionWorld::Nearest CurvedContactSurfaces::nearest(std::size_t k, const Vec3& position) const {
    const Surface& surface = of_[k];
    CollisionWorld::Nearest nearest;
    if (surface.is_on_rim) {
        nearest = geometry_.nearest(surface.surface, position);
    } else {
        nearest = {geometry_.unit_normal_of(surface.surface, position),
                   geometry_.signed_distance_from(surface.surface, position), surface.is_flat, false};
    }
    nearest.normal = surface.side * nearest.normal;
    nearest.distance *= surface.side;
    return nearest;
}

double CurvedContactSurfaces::turned_at(const Vec3& position) const {
    double turned = 0.0;
    for (std::size_t k = 0; k < count_; ++k) {
        const Surface& surface = of_[k];
        const bool can_be_narrow = radius_ > 0.0 && !surface.is_flat && geometry_.world().is_shape(surface.surface);
        if (!can_be_narrow) continue;
        if (surface.is_narrow) return 2.0;
        turned = std::max(turned, length(outward_normal(surface, position) - surface.normal_at_start));
    }
    return turned;
}

}  // namespace ricochet
