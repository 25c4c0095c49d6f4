#include "ricochet/response/deformed_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "ricochet/core/bisection.h"
#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/response/contact_manifold.h"

namespace ricochet {
namespace {

/// Number of halvings in the bisection for the time at the rim. Local: it ends below rounding.
constexpr int kRimHalvings = 48;

/// A triangle within touching distance.
struct Candidate {
    DeformedContact contact;
    bool is_over = true;  ///< always true for a sphere
    bool is_left = false;
};

/// Returns the distance, in m, of a triangle from the projection of a position onto the triangle's plane. The
/// difference of the distances to rim and plane would have rounding errors of a few contact offsets.
double beyond_rim(const DeformedTriangle& triangle, const Vec3& p) {
    if (!triangle.nearest(p).rim) return 0.0;
    const Vec3 offset = closest_point_on_triangle(p, triangle.a, triangle.b, triangle.c).offset;
    const Vec3 normal = triangle.unit_normal();
    return length(offset - dot(offset, normal) * normal);
}

/// Returns true if a point is over a triangle, or is beside its rim and does not move farther away from it. The second
/// case is needed because a point slightly above a convex edge is over neither face.
bool is_point_over(const DeformedTriangle& triangle, double offset, const Vec3& p, const Vec3& velocity,
                   const Vec3& normal, double separation_speed) {
    const double beyond = beyond_rim(triangle, p);
    if (beyond == 0.0) return true;
    const Vec3 slip = velocity - dot(velocity, normal) * normal;
    const double speed = length(slip);
    if (speed <= kStandingSlip * separation_speed) return true;
    const Vec3 next = p + (kRimPathOffsets * offset / speed) * slip;
    return beyond_rim(triangle, next) <= beyond + kOverRim * offset;
}

/// Returns the contact of the particle with a surface at its present time, if there is one.
std::optional<Candidate> touched(const DeformingColliders& deforming, const ForceInput& particle, SurfaceId surface,
                                 double separation_speed) {
    const DeformingMesh& mesh = deforming.mesh_with(surface);
    const DeformedTriangle triangle = mesh.triangle_at(surface, particle.time);
    const Vec3& p = particle.position;
    const CollisionWorld::Nearest nearest = triangle.nearest(p);
    if (std::fabs(nearest.distance - particle.radius) > kTouchingOffsets * mesh.offset()) return std::nullopt;
    Candidate found{{{surface, nearest.normal, nearest.flat}, {surface}}};
    const Vec3 velocity = particle.velocity - mesh.motion_at(surface, p, particle.time).velocity;
    if (particle.radius == 0.0) {
        if (nearest.rim) {
            // The direction from the rim consists of rounding errors, so the plane's normal is used.
            const Vec3 normal = triangle.unit_normal();
            found.contact.surface = {surface, triangle.signed_distance_from(p) < 0.0 ? -normal : normal, true};
        }
        found.is_over =
            is_point_over(triangle, mesh.offset(), p, velocity, found.contact.surface.normal, separation_speed);
    }
    found.is_left = dot(velocity, found.contact.surface.normal) > separation_speed;
    return found;
}

/// Returns true if a triangle lies behind the plane of another triangle, `over`, which the particle reaches first.
bool is_behind(const DeformingColliders& deforming, double time, SurfaceId surface, const ContactSurface& over) {
    const auto [a, b, c] = deforming.triangle_at(surface, time);
    const double tolerance = 2.0 * deforming.mesh_with(surface).offset();
    const DeformedTriangle below = deforming.triangle_at(over.surface, time);
    const double side = dot(below.unit_normal(), over.normal) < 0.0 ? -1.0 : 1.0;
    const auto is_low = [&](const Vec3& corner) { return side * below.signed_distance_from(corner) <= tolerance; };
    return is_low(a) && is_low(b) && is_low(c);
}

/// Returns true if two triangles lie in one plane, so that their common edge has no effect.
bool are_coplanar(const Candidate& one, const Candidate& other) {
    return 1.0 - dot(one.contact.surface.normal, other.contact.surface.normal) <= kSameNormal;
}

/// Removes triangles beyond convex edges from the contacts of a point. A triangle beside the point is kept if it is in
/// front of all triangles below the point, as in a wide valley, or coplanar with them: rounding decides on which side
/// of the common edge the point is.
void drop_beyond_convex_edges(const DeformingColliders& deforming, const ForceInput& particle,
                              std::vector<Candidate>& found) {
    const auto is_inside = [&](const Candidate& one) {
        const DeformedTriangle triangle = deforming.triangle_at(one.contact.surface.surface, particle.time);
        return beyond_rim(triangle, particle.position) == 0.0;
    };
    std::stable_partition(found.begin(), found.end(), is_inside);
    std::stable_partition(found.begin(), found.end(), [](const Candidate& one) { return one.is_over; });
    std::vector<Candidate> kept;
    for (Candidate& one : found) {
        const auto hides = [&](const Candidate& over) {
            return over.is_over && !are_coplanar(over, one) &&
                   is_behind(deforming, particle.time, one.contact.surface.surface, over.contact.surface);
        };
        const bool is_seen = (one.is_over || !kept.empty()) && std::ranges::none_of(kept, hides);
        if (is_inside(one) || is_seen) kept.push_back(std::move(one));
    }
    found = std::move(kept);
}

/// Returns true if a triangle beside a sphere stays in the plane of a supporting face until the next key time.
bool goes_on_as_one_plane(const DeformingColliders& deforming, const ForceInput& particle, SurfaceId surface,
                          const ContactSurface& face) {
    const Vec3& p = particle.position;
    const DeformingMesh& mesh = deforming.mesh_with(surface);
    const DeformedTriangle triangle = mesh.triangle_at(surface, particle.time);
    const Vec3 own = triangle.unit_normal();
    const Vec3 normal = dot(own, face.normal) < 0.0 ? -own : own;
    if (1.0 - dot(normal, face.normal) > kSameNormal) return false;
    const double height = std::fabs(triangle.signed_distance_from(p));
    if (std::fabs(height - particle.radius) > kTouchingOffsets * mesh.offset()) return false;
    const DeformingMesh::Motion here = deforming.mesh_with(face.surface).motion_at(face.surface, p, particle.time);
    const DeformingMesh::Motion there = mesh.motion_at(surface, p, particle.time);
    // The rates of the normals times the radius, in m/s.
    const Vec3 turn_here = particle.radius * cross(here.turning, normal);
    const Vec3 turn_there = particle.radius * cross(there.turning, normal);
    const double scale = length(turn_here) + length(turn_there) + length(here.velocity) + length(there.velocity);
    return length(turn_there - turn_here) <= kSameVelocity * scale;
}

/// Adds triangles that continue the plane of a contact, because a sphere that rolls over the edge reaches them.
void add_rest_of_planes(const DeformingColliders& deforming, const ForceInput& particle,
                        const std::vector<SurfaceId>& near, std::vector<DeformedContact>& all) {
    for (DeformedContact& contact : all) {
        if (!contact.surface.flat) continue;
        for (const SurfaceId surface : near) {
            if (std::ranges::find(contact.all, surface) != contact.all.end()) continue;
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
    for (const DeformingMesh& mesh : deforming.all()) margin = std::max(margin, kTouchingOffsets * mesh.offset());
    std::vector<SurfaceId> near;
    deforming.near(ball_box(particle.position, particle.radius + 2.0 * margin), near);
    std::vector<Candidate> found;
    for (const SurfaceId surface : near) {
        if (auto one = touched(deforming, particle, surface, separation_speed)) found.push_back(std::move(*one));
    }
    if (particle.radius == 0.0) drop_beyond_convex_edges(deforming, particle, found);
    std::erase_if(found, [](const Candidate& one) { return one.is_left; });
    std::stable_partition(found.begin(), found.end(), [](const Candidate& one) { return one.contact.surface.flat; });
    for (const Candidate& candidate : found) {
        const ContactSurface& one = candidate.contact.surface;
        const double turn = seam_turn(particle.radius, deforming.mesh_with(one.surface).offset());
        const auto known = std::ranges::find_if(all, [&](const DeformedContact& other) {
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
    const DeformingMesh& mesh = deforming.mesh_with(surface.surface);
    const DeformingMesh::Motion motion = mesh.motion_at(surface.surface, particle.position, particle.time);
    const Vec3& n = surface.normal;
    const Vec3 slip = particle.velocity - motion.velocity;
    if (surface.flat) {
        const Vec3 turn = cross(motion.turning, n);
        const Vec3 change = cross(motion.turning, slip - particle.radius * turn);
        return {2.0 * dot(turn, slip) - particle.radius * dot(turn, turn), dot(change, n) * n - change};
    }
    const Vec3 along = slip - dot(slip, n) * n;
    const auto [a, b, c] = mesh.triangle_at(surface.surface, particle.time);
    const std::array<Vec3, 3> edges{b - a, c - b, a - c};
    const auto feature = static_cast<std::size_t>(closest_point_on_triangle(particle.position, a, b, c).feature);
    constexpr auto kFirstEdge = static_cast<std::size_t>(TriangleFeature::kEdgeAB);
    if (!(particle.radius > 0.0)) return {};
    double past = dot(along, along);
    if (feature >= kFirstEdge && feature < kFirstEdge + edges.size()) {
        const std::size_t k = feature - kFirstEdge;
        const std::array<Vec3, 3> rates = mesh.corner_velocities(surface.surface, particle.time);
        const double size = length(edges[k]);
        const double tilting = dot(rates[(k + 1) % 3] - rates[k], n) / size;
        const double passing = dot(along, edges[k]) / size + particle.radius * tilting;
        past -= passing * passing;
    }
    return {past / particle.radius, {}};
}

double time_over(const DeformingColliders& deforming, const DeformedContact& contact,
                 const std::function<Vec3(double)>& position_at, double duration, double begin) {
    const auto beyond_all = [&](double at) {
        const Vec3 p = position_at(at);
        double least = std::numeric_limits<double>::infinity();
        for (const SurfaceId surface : contact.all) {
            least = std::min(least, beyond_rim(deforming.triangle_at(surface, begin + at), p));
        }
        return least;
    };
    const double most = beyond_all(0.0) + kOverRim * deforming.mesh_with(contact.surface.surface).offset();
    const auto is_over = [&](double at) { return beyond_all(at) <= most; };
    if (is_over(duration)) return duration;
    const double off = bisect(0.0, duration, kRimHalvings, is_over).high;
    // An added time below the resolution of the clock would not move the particle off the triangle.
    return std::min(off + std::max(kPastRim * duration, kSimultaneousUlps * ulp(begin)), duration);
}

}  // namespace ricochet
