#include "ricochet/response/deformed_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {
namespace {

/// The surface as the particle touches it now; nothing when it does not.
std::optional<ContactSurface> touched(const DeformingColliders& deforming, const ForceInput& particle,
                                      SurfaceId surface, double departure) {
    const double reach = kTouchingOffsets * deforming.offset_of(surface);
    const Vec3& p = particle.position;
    const CollisionWorld::Nearest nearest = deforming.nearest(surface, p, particle.time);
    if (std::fabs(nearest.distance - particle.radius) > reach) return std::nullopt;
    ContactSurface found{surface, nearest.normal, nearest.flat};
    if (particle.radius == 0.0 && nearest.rim) {
        // The direction from the rim is rounding, the plane's normal counts.
        const double height = deforming.signed_distance_from(surface, p, particle.time);
        if (std::fabs(height) > reach) return std::nullopt;
        const Vec3 normal = deforming.unit_normal_of(surface, particle.time);
        found = {surface, height < 0.0 ? -normal : normal, true};
    }
    const Vec3 velocity = deforming.motion_at(surface, p, particle.time).velocity;
    return dot(particle.velocity - velocity, found.normal) > departure ? std::nullopt : std::optional(found);
}

/// One minus the cosine by which an edge's normal can differ from the face's while both are within reach.
double seam_turn(const DeformingColliders& deforming, const ForceInput& particle, SurfaceId surface) {
    if (particle.radius == 0.0) return kSameNormal;
    return kSeamTurn + 2.0 * kTouchingOffsets * deforming.offset_of(surface) / particle.radius;
}

}  // namespace

std::vector<ContactSurface> touched_surfaces(const DeformingColliders& deforming, const ForceInput& particle,
                                             double departure) {
    std::vector<ContactSurface> all;
    if (deforming.empty()) return all;
    double margin = 0.0;
    for (std::size_t mesh = 0; mesh < deforming.size(); ++mesh) {
        margin = std::max(margin, kTouchingOffsets * deforming.offset_of_mesh(mesh));
    }
    margin = particle.radius + 2.0 * margin;
    const Vec3 by{margin, margin, margin};
    std::vector<SurfaceId> near;
    deforming.near({particle.position - by, particle.position + by}, near);
    std::vector<ContactSurface> found;
    for (const SurfaceId surface : near) {
        if (const auto one = touched(deforming, particle, surface, departure)) found.push_back(*one);
    }
    std::stable_partition(found.begin(), found.end(), [](const ContactSurface& one) { return one.flat; });
    for (const ContactSurface& one : found) {
        const double turn = seam_turn(deforming, particle, one.surface);
        const bool is_known = std::any_of(all.begin(), all.end(), [&](const ContactSurface& known) {
            return 1.0 - dot(known.normal, one.normal) <= (known.flat != one.flat ? turn : kSameNormal);
        });
        if (!is_known) all.push_back(one);
    }
    return all;
}

SurfaceBend bend_of(const DeformingColliders& deforming, const ForceInput& particle, const ContactSurface& surface) {
    const DeformingColliders::Motion motion = deforming.motion_at(surface.surface, particle.position, particle.time);
    const Vec3& n = surface.normal;
    const Vec3 slip = particle.velocity - motion.velocity;
    if (surface.flat) {
        const Vec3 turn = cross(motion.turning, n);
        const Vec3 change = cross(motion.turning, slip - particle.radius * turn);
        return {2.0 * dot(turn, slip) - particle.radius * dot(turn, turn), dot(change, n) * n - change};
    }
    Vec3 along = slip - dot(slip, n) * n;
    const auto [a, b, c] = deforming.corners_at(surface.surface, particle.time);
    const std::array<Vec3, 3> edges{b - a, c - b, a - c};
    const auto feature = static_cast<std::size_t>(closest_point_on_triangle(particle.position, a, b, c).feature);
    constexpr auto kFirstEdge = static_cast<std::size_t>(TriangleFeature::kEdgeAB);
    if (feature >= kFirstEdge && feature < kFirstEdge + edges.size()) {
        const Vec3 edge = normalized(edges[feature - kFirstEdge]);
        along -= dot(along, edge) * edge;
    }
    return {particle.radius > 0.0 ? dot(along, along) / particle.radius : 0.0, {}};
}

SurfaceHeight height_above(const DeformingColliders& deforming, const ContactSurface& surface, const Vec3& position,
                           double time) {
    SurfaceHeight height{deforming.unit_normal_of(surface.surface, time),
                         deforming.signed_distance_from(surface.surface, position, time)};
    if (!surface.flat) {
        const CollisionWorld::Nearest nearest = deforming.nearest(surface.surface, position, time);
        height = {nearest.normal, nearest.distance};
    }
    const double side = dot(height.normal, surface.normal) < 0.0 ? -1.0 : 1.0;
    return {side * height.normal, side * height.above};
}

}  // namespace ricochet
