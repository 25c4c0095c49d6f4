// Sweeps of points and spheres against a mesh at rest or a moving mesh.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/error.h"
#include "ricochet/core/loop_stop.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/acceleration/box_tree.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/geometry/sweep/moving_triangle.h"
#include "ricochet/geometry/sweep/point_sweep.h"
#include "ricochet/geometry/sweep/sphere_sweep.h"
#include "ricochet/queries/mesh_index.h"

namespace ricochet {
namespace {

/// Straight paths of points and spheres.
struct Paths {
    std::span<const Vec3> from;
    std::span<const Vec3> to;
    std::span<const double> radii;

    [[nodiscard]] double radius(std::size_t i) const {
        if (radii.empty()) return 0.0;
        return radii.size() == 1 ? radii[0] : radii[i];
    }
    [[nodiscard]] double largest_radius() const { return radii.empty() ? 0.0 : *std::ranges::max_element(radii); }
    void require() const {
        require_same_length(to.size(), from.size(), "to");
        if (radii.size() > 1) require_same_length(radii.size(), from.size(), "radii");
        require_positions(from, "from");
        require_positions(to, "to");
        for (std::size_t i = 0; i < radii.size(); ++i) {
            if (radii[i] >= 0.0 && radii[i] <= kLargestCoordinate) continue;
            throw InputError(
                fmt::format("radii[{}]: found {}, expected a length of 0 to {:g} m", i, radii[i], kLargestCoordinate));
        }
    }
};

/// First contact of one path.
struct Contact {
    std::uint32_t triangle = 0;
    double fraction = 0.0;
    Vec3 point;
};

template <class First>
MeshHits first_contacts(const Paths& paths, const First& first) {
    MeshHits hits = no_hits(paths.from.size());
    parallel_for_blocks(paths.from.size(), kQueryBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            poll_loop_stop();
            const std::optional<Contact> contact = first(i);
            if (!contact) continue;
            hits.triangle[i] = contact->triangle;
            hits.distance[i] = contact->fraction;
            hits.point[i] = contact->point;
        }
    });
    return hits;
}

void keep_first(std::optional<Contact>& best, const Contact& found) {
    if (!best || found.fraction < best->fraction ||
        (found.fraction == best->fraction && found.triangle < best->triangle)) {
        best = found;
    }
}

Path straight(const Vec3& from, const Vec3& to) {
    Path path = line_path(from, to - from, 1.0);
    path.end = to;
    return path;
}

/// Returns the tube for the broad phase: all points within the radius, plus rounding, of the path.
Tube tube_of(const Vec3& from, const Vec3& to, double radius) {
    return {from, to, radius * (1.0 + kCandidateSlack) + 0x1p-48 * (max_abs(from) + max_abs(to))};
}

/// Returns the fraction of the path just beyond the first contact found so far, or 1 if there is none.
double limit_of(const std::optional<Contact>& best) {
    return best ? std::min(1.0, best->fraction * (1.0 + 0x1p-40) + 0x1p-60) : 1.0;
}

std::optional<Contact> point_contact(const MeshIndex& mesh, const Vec3& from, const Vec3& to) {
    const Path path = straight(from, to);
    std::optional<Contact> best;
    mesh.hierarchy().query_tube(tube_of(from, to, 0.0), [&](std::uint32_t triangle, double, double) {
        if (mesh.is_degenerate(triangle)) return limit_of(best);
        const auto [a, b, c] = mesh.corners(triangle);
        if (const auto crossing = first_crossing(path, a, b, c)) {
            keep_first(best, {triangle, crossing->time, path.position(crossing->time)});
        }
        return limit_of(best);
    });
    return best;
}

std::optional<Contact> sphere_contact(const MeshIndex& mesh, const TriangleBvh& hierarchy, const Vec3& from,
                                      const Vec3& to, double radius) {
    SphereSweep sweep(straight(from, to), radius);
    std::optional<Contact> best;
    hierarchy.query_tube(tube_of(from, to, radius), [&](std::uint32_t triangle, double, double) {
        if (mesh.is_degenerate(triangle)) return limit_of(best);
        const auto [a, b, c] = mesh.corners(triangle);
        if (const auto contact = sweep.first_contact(a, b, c)) {
            keep_first(best, {triangle, contact->time, contact->point});
            sweep.shorten_to(best->fraction);
        }
        return limit_of(best);
    });
    return best;
}

/// Number of equal parts of the path at whose ends an overlapping sphere is tested for separation from a moving
/// triangle.
constexpr int kSeparationSamples = 64;

/// Returns the rounded rest of a displacement, from the given fraction on.
MovingPoint rest_of(const MovingPoint& displacement, double from) { return {displacement.at(from), displacement.to}; }

/// Returns the first contact after the sphere has separated from the triangle.
std::optional<MovingContact> contact_after_leaving(const MovingPoint& point, double radius,
                                                   const MovingTriangle& triangle) {
    for (int k = 1; k < kSeparationSamples; ++k) {
        const double from = static_cast<double>(k) / kSeparationSamples;
        if (!is_apart(point, radius, triangle, from, from)) continue;
        const auto& [a, b, c] = triangle.corners;
        auto contact =
            first_contact(rest_of(point, from), radius, {{rest_of(a, from), rest_of(b, from), rest_of(c, from)}});
        if (!contact) return std::nullopt;
        if (contact->time == 0.0) continue;  // the separation is below the rounding of rest_of()
        contact->time = std::min(1.0, from + (1.0 - from) * contact->time);
        return contact;
    }
    return std::nullopt;
}

/// Returns the contact of a sphere that touches or overlaps the triangle at the start. `at_start` is the contact that
/// first_contact() reports at time 0. If the distance decreases at the start, the result is `at_start`, as for a
/// triangle at rest (SphereSweep). Otherwise the sphere has a contact when it comes nearer to the triangle than at the
/// start, or touches it again after a separation. If all corners of the triangle move equally, the sphere never comes
/// nearer.
std::optional<MovingContact> contact_from_overlap(const MovingPoint& point, double radius,
                                                  const MovingTriangle& triangle, const MovingContact& at_start) {
    const auto& [a, b, c] = triangle.corners;
    const ClosestPointOnTriangle nearest = closest_point_on_triangle(point.from, a.from, b.from, c.from);
    const double distance = std::sqrt(nearest.distance_squared);
    Vec3 relative = point.to - point.from;
    for (int k = 0; k < 3; ++k) {
        const MovingPoint& corner = triangle.corners[static_cast<std::size_t>(k)];
        relative -= at_start.barycentric[k] * (corner.to - corner.from);
    }
    const double speed = length(relative);
    if (dot(nearest.offset, relative) < -kMinApproach * distance * speed) return at_start;
    const double nearer_still = kNearerFraction * distance - kMinApproach * speed;
    std::optional<MovingContact> sunk;
    if (nearer_still > 0.0) sunk = first_contact(point, nearer_still, triangle);
    const auto back = contact_after_leaving(point, radius, triangle);
    if (!sunk || (back && back->time < sunk->time)) return back;
    return sunk;
}

/// Returns the first contact of a moving point or sphere with a moving triangle.
std::optional<MovingContact> meeting_of(const MovingPoint& point, double radius, const MovingTriangle& triangle) {
    const auto contact = first_contact(point, radius, triangle);
    if (!contact || contact->time > 0.0 || radius == 0.0) return contact;
    return contact_from_overlap(point, radius, triangle, *contact);
}

/// Mesh whose vertices move from their present to their later positions.
class MovingMesh {
public:
    MovingMesh(const MeshIndex& mesh, std::span<const Vec3> after) : mesh_(mesh), after_(after) {
        std::vector<Box3> boxes(mesh.mesh().triangles.size());
        for (std::size_t t = 0; t < boxes.size(); ++t) {
            for (const std::uint32_t v : mesh.mesh().triangles[t]) {
                boxes[t].include(box_around(mesh.mesh().vertices[v], after[v]));
            }
        }
        tree_.fit(boxes);
    }

    [[nodiscard]] std::optional<Contact> first(const MovingPoint& point, double radius) const {
        const Box3 box = box_around(point.from, point.to);
        const double beside = radius * (1.0 + 0x1p-50) + 0x1p-50 * max_abs(max(abs(box.lower), abs(box.upper)));
        std::vector<std::uint32_t> near;
        tree_.near(grown(box, beside), [&](std::uint32_t t) { near.push_back(t); });
        std::optional<Contact> best;
        for (const std::uint32_t triangle : near) {
            const MovingTriangle moving = moving_triangle(triangle);
            if (best && best->fraction < 1.0 && is_apart(point, radius, moving, 0.0, best->fraction)) continue;
            const auto contact = meeting_of(point, radius, moving);
            if (contact) keep_first(best, {triangle, contact->time, place(moving, *contact)});
        }
        return best;
    }

private:
    [[nodiscard]] MovingTriangle moving_triangle(std::uint32_t triangle) const {
        MovingTriangle moving;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh_.mesh().triangles[triangle][k];
            moving.corners[k] = {mesh_.mesh().vertices[v], after_[v]};
        }
        return moving;
    }
    [[nodiscard]] static Vec3 place(const MovingTriangle& triangle, const MovingContact& contact) {
        Vec3 point;
        for (std::size_t k = 0; k < 3; ++k) {
            point += contact.barycentric[static_cast<int>(k)] * triangle.corners[k].at(contact.time);
        }
        return point;
    }

    const MeshIndex& mesh_;
    std::span<const Vec3> after_;
    BoxTree tree_;
};

}  // namespace

MeshHits MeshQueries::sweep(std::span<const Vec3> from, std::span<const Vec3> to, std::span<const double> radii) const {
    const Paths paths{from, to, radii};
    paths.require();
    const TriangleBvh& for_spheres = index_->hierarchy(paths.largest_radius());
    return first_contacts(paths, [&](std::size_t i) {
        const Vec3 start = flush_tiny(from[i]);
        const Vec3 end = flush_tiny(to[i]);
        const double radius = paths.radius(i);
        return radius > 0.0 ? sphere_contact(*index_, for_spheres, start, end, radius)
                            : point_contact(*index_, start, end);
    });
}

MeshHits MeshQueries::sweep_moving(std::span<const Vec3> from, std::span<const Vec3> to, std::span<const double> radii,
                                   std::span<const Vec3> vertices_after) const {
    const Paths paths{from, to, radii};
    paths.require();
    require_same_length(vertices_after.size(), mesh().vertices.size(), "vertices_after");
    require_positions(vertices_after, "vertices_after");
    const MovingMesh moving(*index_, vertices_after);
    return first_contacts(paths, [&](std::size_t i) { return moving.first({from[i], to[i]}, paths.radius(i)); });
}

}  // namespace ricochet
