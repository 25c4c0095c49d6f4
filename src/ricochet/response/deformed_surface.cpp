#include "ricochet/response/deformed_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "ricochet/core/bisection.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {
namespace {

/// Halvings in the search for the time at the rim. Local: it ends below the rounding of the result.
constexpr int kRimHalvings = 48;

/// A triangle within touching distance.
struct Candidate {
    DeformedContact contact;
    bool is_over = true;  ///< always true for a sphere
    bool is_left = false;
};

/// Returns the distance, in m, by which the foot of a position lies beside a triangle. It is measured along the
/// triangle's plane: the difference of the distances to the rim and to the plane would be rounding of a few offsets.
double beyond_rim(const DeformingColliders& deforming, SurfaceId surface, const Vec3& p, double time) {
    if (!deforming.nearest(surface, p, time).rim) return 0.0;
    const auto [a, b, c] = deforming.corners_at(surface, time);
    const Vec3 offset = closest_point_on_triangle(p, a, b, c).offset;
    const Vec3 normal = deforming.unit_normal_of(surface, time);
    return length(offset - dot(offset, normal) * normal);
}

/// Returns true if a point touches a triangle from above, or stands on its rim and moves no further beyond it. A point
/// above a convex edge is over neither face, because of its height.
bool is_point_over(const DeformingColliders& deforming, const ForceInput& particle, SurfaceId surface,
                   const Vec3& velocity, const Vec3& normal, double separation_speed) {
    const double offset = deforming.offset_of(surface);
    const Vec3& p = particle.position;
    const double beyond = beyond_rim(deforming, surface, p, particle.time);
    if (beyond == 0.0) return true;
    const Vec3 slip = velocity - dot(velocity, normal) * normal;
    const double speed = length(slip);
    if (speed <= kStandingSlip * separation_speed) return true;
    const Vec3 next = p + (kRimLookOffsets * offset / speed) * slip;
    return beyond_rim(deforming, surface, next, particle.time) <= beyond + kOverRim * offset;
}

/// Returns the contact of the particle with a surface at its present time, if there is one.
std::optional<Candidate> touched(const DeformingColliders& deforming, const ForceInput& particle, SurfaceId surface,
                                 double separation_speed) {
    const double reach = kTouchingOffsets * deforming.offset_of(surface);
    const Vec3& p = particle.position;
    const CollisionWorld::Nearest nearest = deforming.nearest(surface, p, particle.time);
    if (std::fabs(nearest.distance - particle.radius) > reach) return std::nullopt;
    Candidate found{{{surface, nearest.normal, nearest.flat}, {surface}}};
    const Vec3 velocity = particle.velocity - deforming.motion_at(surface, p, particle.time).velocity;
    if (particle.radius == 0.0) {
        if (nearest.rim) {
            // The direction from the rim is mere rounding, so the plane's normal is used.
            const double height = deforming.signed_distance_from(surface, p, particle.time);
            const Vec3 normal = deforming.unit_normal_of(surface, particle.time);
            found.contact.surface = {surface, height < 0.0 ? -normal : normal, true};
        }
        found.is_over =
            is_point_over(deforming, particle, surface, velocity, found.contact.surface.normal, separation_speed);
    }
    found.is_left = dot(velocity, found.contact.surface.normal) > separation_speed;
    return found;
}

/// Returns true if a triangle lies behind the plane of another triangle below the particle. The particle would meet
/// that one first.
bool is_behind(const DeformingColliders& deforming, const ForceInput& particle, SurfaceId surface,
               const ContactSurface& over) {
    const std::array<Vec3, 3> corners = deforming.corners_at(surface, particle.time);
    const double tolerance = 2.0 * deforming.offset_of(surface);
    const Vec3 normal = deforming.unit_normal_of(over.surface, particle.time);
    const double side = dot(normal, over.normal) < 0.0 ? -1.0 : 1.0;
    return std::all_of(corners.begin(), corners.end(), [&](const Vec3& corner) {
        return side * deforming.signed_distance_from(over.surface, corner, particle.time) <= tolerance;
    });
}

/// Returns true if two triangles lie in one plane. Their common edge is not felt.
bool are_coplanar(const Candidate& one, const Candidate& other) {
    return 1.0 - dot(one.contact.surface.normal, other.contact.surface.normal) <= kSameNormal;
}

/// Removes triangles beyond convex edges from the contacts of a point. A triangle beside the point stays if it is in
/// front of all triangles below the point, like the other side of a blunt valley. It also stays if it is in one plane
/// with them: rounding decides on which side of their edge the point is.
void drop_beyond_convex_edges(const DeformingColliders& deforming, const ForceInput& particle,
                              std::vector<Candidate>& found) {
    std::stable_partition(found.begin(), found.end(), [&](const Candidate& one) {
        return beyond_rim(deforming, one.contact.surface.surface, particle.position, particle.time) == 0.0;
    });
    std::stable_partition(found.begin(), found.end(), [](const Candidate& one) { return one.is_over; });
    std::vector<Candidate> kept;
    for (Candidate& one : found) {
        const SurfaceId surface = one.contact.surface.surface;
        const bool is_inside = beyond_rim(deforming, surface, particle.position, particle.time) == 0.0;
        const auto hides = [&](const Candidate& over) {
            return over.is_over && !are_coplanar(over, one) &&
                   is_behind(deforming, particle, surface, over.contact.surface);
        };
        const bool is_seen = is_inside || std::none_of(kept.begin(), kept.end(), hides);
        if (is_inside || (is_seen && (one.is_over || !kept.empty()))) kept.push_back(std::move(one));
    }
    found = std::move(kept);
}

/// Returns one minus the cosine of the largest angle between the normals of an edge and of a face that a particle
/// touches at once.
double seam_turn(const DeformingColliders& deforming, const ForceInput& particle, SurfaceId surface) {
    if (particle.radius == 0.0) return kSameNormal;
    return kSeamTurn + 2.0 * kTouchingOffsets * deforming.offset_of(surface) / particle.radius;
}

/// Returns the rate of a triangle's normal times the radius, in m/s.
Vec3 turning_of_normal(const DeformingColliders::Motion& motion, const Vec3& normal, double radius) {
    return radius * cross(motion.turning, normal);
}

/// Returns true if a triangle beside a sphere lies in the plane of a face that holds the sphere, until the next key.
bool goes_on_as_one_plane(const DeformingColliders& deforming, const ForceInput& particle, SurfaceId surface,
                          const ContactSurface& face) {
    const Vec3& p = particle.position;
    const Vec3 own = deforming.unit_normal_of(surface, particle.time);
    const Vec3 normal = dot(own, face.normal) < 0.0 ? -own : own;
    if (1.0 - dot(normal, face.normal) > kSameNormal) return false;
    const double height = std::fabs(deforming.signed_distance_from(surface, p, particle.time));
    if (std::fabs(height - particle.radius) > kTouchingOffsets * deforming.offset_of(surface)) return false;
    const DeformingColliders::Motion here = deforming.motion_at(face.surface, p, particle.time);
    const DeformingColliders::Motion there = deforming.motion_at(surface, p, particle.time);
    const Vec3 turn_here = turning_of_normal(here, normal, particle.radius);
    const Vec3 turn_there = turning_of_normal(there, normal, particle.radius);
    const double scale = length(turn_here) + length(turn_there) + length(here.velocity) + length(there.velocity);
    return length(turn_there - turn_here) <= kSameVelocity * scale;
}

/// Adds triangles that continue the plane of a contact. A sphere that rolls over the edge of a face reaches them, and
/// they are no obstacle.
void add_rest_of_planes(const DeformingColliders& deforming, const ForceInput& particle,
                        const std::vector<SurfaceId>& near, std::vector<DeformedContact>& all) {
    for (DeformedContact& contact : all) {
        if (!contact.surface.flat) continue;
        for (const SurfaceId surface : near) {
            if (std::find(contact.all.begin(), contact.all.end(), surface) != contact.all.end()) continue;
            if (goes_on_as_one_plane(deforming, particle, surface, contact.surface)) contact.all.push_back(surface);
        }
    }
}

}  // namespace

std::vector<DeformedContact> touched_surfaces(const DeformingColliders& deforming, const ForceInput& particle,
                                              double separation_speed) {
    std::vector<DeformedContact> all;
    if (deforming.empty()) return all;
    double margin = 0.0;
    for (std::size_t mesh = 0; mesh < deforming.size(); ++mesh) {
        margin = std::max(margin, kTouchingOffsets * deforming.offset_of_mesh(mesh));
    }
    margin = particle.radius + 2.0 * margin;
    const Vec3 by{margin, margin, margin};
    std::vector<SurfaceId> near;
    deforming.near({particle.position - by, particle.position + by}, near);
    std::vector<Candidate> found;
    for (const SurfaceId surface : near) {
        if (auto one = touched(deforming, particle, surface, separation_speed)) found.push_back(std::move(*one));
    }
    if (particle.radius == 0.0) drop_beyond_convex_edges(deforming, particle, found);
    std::erase_if(found, [](const Candidate& one) { return one.is_left; });
    std::stable_partition(found.begin(), found.end(), [](const Candidate& one) { return one.contact.surface.flat; });
    for (const Candidate& candidate : found) {
        const ContactSurface& one = candidate.contact.surface;
        const double turn = seam_turn(deforming, particle, one.surface);
        const auto known = std::find_if(all.begin(), all.end(), [&](const DeformedContact& other) {
            return 1.0 - dot(other.surface.normal, one.normal) <= (other.surface.flat != one.flat ? turn : kSameNormal);
        });
        if (known == all.end()) {
            all.push_back(candidate.contact);
        } else {
            known->all.push_back(one.surface);
        }
    }
    if (particle.radius > 0.0) add_rest_of_planes(deforming, particle, near, all);
    return all;
}

CurvatureTerms curvature_of(const DeformingColliders& deforming, const ForceInput& particle,
                            const ContactSurface& surface) {
    const DeformingColliders::Motion motion = deforming.motion_at(surface.surface, particle.position, particle.time);
    const Vec3& n = surface.normal;
    const Vec3 slip = particle.velocity - motion.velocity;
    if (surface.flat) {
        const Vec3 turn = cross(motion.turning, n);
        const Vec3 change = cross(motion.turning, slip - particle.radius * turn);
        return {2.0 * dot(turn, slip) - particle.radius * dot(turn, turn), dot(change, n) * n - change};
    }
    const Vec3 along = slip - dot(slip, n) * n;
    const auto [a, b, c] = deforming.corners_at(surface.surface, particle.time);
    const std::array<Vec3, 3> edges{b - a, c - b, a - c};
    const auto feature = static_cast<std::size_t>(closest_point_on_triangle(particle.position, a, b, c).feature);
    constexpr auto kFirstEdge = static_cast<std::size_t>(TriangleFeature::kEdgeAB);
    if (!(particle.radius > 0.0)) return {};
    double past = dot(along, along);
    if (feature >= kFirstEdge && feature < kFirstEdge + edges.size()) {
        const std::size_t k = feature - kFirstEdge;
        const std::array<Vec3, 3> rates = deforming.corner_velocities(surface.surface, particle.time);
        const double size = length(edges[k]);
        const double tilting = dot(rates[(k + 1) % 3] - rates[k], n) / size;
        const double passing = dot(along, edges[k]) / size + particle.radius * tilting;
        past -= passing * passing;
    }
    return {past / particle.radius, {}};
}

SurfaceHeight height_above(const DeformingColliders& deforming, const DeformedContact& contact, const Vec3& position,
                           double time) {
    SurfaceId surface = contact.all.front();
    CollisionWorld::Nearest nearest = deforming.nearest(surface, position, time);
    for (const SurfaceId other : contact.all) {
        const CollisionWorld::Nearest there = deforming.nearest(other, position, time);
        if (!(there.distance < nearest.distance)) continue;
        nearest = there;
        surface = other;
    }
    SurfaceHeight height{nearest.normal, nearest.distance};
    if (contact.surface.flat) {
        height = {deforming.unit_normal_of(surface, time), deforming.signed_distance_from(surface, position, time)};
    }
    const double side = dot(height.normal, contact.surface.normal) < 0.0 ? -1.0 : 1.0;
    return {side * height.normal, side * height.above};
}

double time_over(const DeformingColliders& deforming, const DeformedContact& contact,
                 const std::function<Vec3(double)>& position_at, double duration, double begin) {
    const auto beyond_all = [&](double at) {
        const Vec3 p = position_at(at);
        double least = std::numeric_limits<double>::infinity();
        for (const SurfaceId surface : contact.all) {
            least = std::min(least, beyond_rim(deforming, surface, p, begin + at));
        }
        return least;
    };
    const double most = beyond_all(0.0) + kOverRim * deforming.offset_of(contact.surface.surface);
    const auto is_over = [&](double at) { return beyond_all(at) <= most; };
    if (is_over(duration)) return duration;
    const double off = bisect(0.0, duration, kRimHalvings, is_over).high;
    // A time below the resolution of the clock would not lead off the triangle.
    return std::min(off + std::max(kPastRim * duration, kSimultaneousUlps * ulp(begin)), duration);
}

}  // namespace ricochet
