#include "ricochet/collision/deforming_sweep.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {
namespace {

DeformedTriangle deformed_at(const MovingTriangle& triangle, double part) {
    const auto& [a, b, c] = triangle.corners;
    return {a.at(part), b.at(part), c.at(part)};
}

double distance_at_start(const Path& path, const MovingTriangle& triangle) {
    const auto [a, b, c] = deformed_at(triangle, 0.0);
    return std::sqrt(closest_point_on_triangle(path.c[0], a, b, c).distance_squared);
}

}  // namespace

DeformingSweep::DeformingSweep(const DeformingColliders& deforming, const Path& path, const PathClock& clock,
                               double radius, std::span<const SurfaceId> supports, double beside)
    : deforming_(deforming), path_(path), clock_(clock), radius_(radius), tolerance_(0.0), supports_(supports) {
    for (const Vec3& point : path.control_points()) box_.include(point);
    box_.include(path.end);
    const double largest = std::max(max_abs(box_.lower), max_abs(box_.upper));
    if (radius > 0.0) tolerance_ = sphere_tolerance(radius, largest);
    box_ = grown(box_, radius + 2.0 * beside + kCandidateSlack * (largest + radius));
}

bool DeformingSweep::is_supported(SurfaceId surface) const {
    return std::ranges::find(supports_, surface) != supports_.end();
}

/// Returns the radius with which segments are certified. Supports and overlapped surfaces block only intersections.
double DeformingSweep::certified_radius(SurfaceId surface, const MovingTriangle& triangle) const {
    if (radius_ == 0.0 || is_supported(surface)) return 0.0;
    const double distance = distance_at_start(path_, triangle);
    return distance < radius_ - tolerance_ ? 0.0 : std::min(radius_, distance);
}

/// Returns the contact at a possible contact, or nothing if the particle does not approach the triangle at that time.
std::optional<DeformingSweep::Hit> DeformingSweep::hit_at(SurfaceId surface, const MovingTriangle& triangle,
                                                          const PossibleContact& possible_contact) const {
    const double time = possible_contact.part * path_.duration;
    const DeformedTriangle then = deformed_at(triangle, possible_contact.part);
    const auto& [a, b, c] = then;
    const Vec3 p = path_.position(time);
    const ClosestPointOnTriangle closest = closest_point_on_triangle(p, a, b, c);
    const Vec3 weights = barycentric_coordinates(closest, a, b, c);
    // Takes the corner velocities from the keys, because differences over a short piece are mostly rounding errors.
    const double middle = 0.5 * clock_.begin + 0.5 * clock_.end;
    const auto [u, v, w] = deforming_.mesh_with(surface).corner_velocities(surface, middle);
    const Vec3 relative = path_.velocity(time) - (weights.x * u + weights.y * v + weights.z * w);
    // A triangle without area has no normal for a point, nor for a sphere whose centre is on it.
    if (are_collinear(a, b, c) && (radius_ == 0.0 || closest.offset == Vec3{})) return std::nullopt;
    if (radius_ > 0.0) {
        const CollisionWorld::Nearest nearest = then.nearest(p);
        if (!(dot(nearest.normal, relative) < 0.0)) return std::nullopt;
        return Hit{time, {surface, nearest.normal, nearest.flat}};
    }
    const Vec3 normal = static_cast<double>(possible_contact.side) * then.unit_normal();
    if (!(dot(normal, relative) < -kDeformingGraze * length(relative))) return std::nullopt;
    return Hit{time, {surface, normal, true}};
}

std::optional<DeformingSweep::Hit> DeformingSweep::meet(SurfaceId surface, const MovingTriangle& triangle) const {
    if (!(path_.duration > 0.0) || pass_along_direction(path_, radius_, triangle)) return std::nullopt;
    double radius = radius_;
    double from = 0.0;
    const double distance = distance_at_start(path_, triangle);
    if (radius == 0.0) {
        // A point that leaves the triangle must not be hit again at once, except by the certificate.
        const bool touches = distance <= kTouchingOffsets * deforming_.mesh_with(surface).offset();
        if (touches && !hit_at(surface, triangle, {0.0, deformed_at(triangle, 0.0).side_of(path_.c[0])}))
            from = kShortLeave;
    } else if (distance <= radius) {
        if (const auto hit = hit_at(surface, triangle, {})) return hit;
        radius = kNearerFraction * distance;
    }
    std::optional<Hit> hit;
    static_cast<void>(
        first_possible_contact(path_, radius, triangle, from, [&](const PossibleContact& possible_contact) {
            hit = hit_at(surface, triangle, possible_contact);
            return hit.has_value();
        }));
    return hit;
}

/// Returns all hits at the earliest time. Hits with equal normals count once, as do a face and its own edge.
std::optional<Contact> DeformingSweep::first_of(std::vector<Hit> hits) const {
    if (hits.empty()) return std::nullopt;
    const auto earlier = [](const Hit& a, const Hit& b) {
        if (a.time != b.time) return a.time < b.time;
        return a.surface.surface < b.surface.surface;
    };
    std::ranges::sort(hits, earlier);
    Contact contact;
    contact.time = hits.front().time;
    // Faces come before edges, so that a seam beside its own face is ignored.
    for (const bool flat : {true, false}) {
        for (const Hit& hit : hits) {
            if (hit.time > contact.time + kSimultaneousUlps * ulp(contact.time)) break;
            const auto is_same = [&](const ContactSurface& known) {
                return dot(known.normal, hit.surface.normal) > 1.0 - kSameNormal;
            };
            const auto known = contact.all();
            if (hit.surface.flat != flat || std::ranges::any_of(known, is_same)) continue;
            if (contact.count < Contact::kMostSurfaces) {
                contact.surfaces[static_cast<std::size_t>(contact.count++)] = hit.surface;
            }
        }
    }
    std::sort(contact.surfaces.begin(), contact.surfaces.begin() + contact.count,
              [](const ContactSurface& a, const ContactSurface& b) { return a.surface < b.surface; });
    return contact;
}

}  // namespace ricochet
