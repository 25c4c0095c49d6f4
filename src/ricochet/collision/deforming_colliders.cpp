#include "ricochet/collision/deforming_colliders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/moving_separation.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 14;

/// Margin of boxes, relative to the coordinates: more than the rounding of a vertex between two keys. Local: it only
/// has to be large enough.
constexpr double kBoxRounding = 0x1p-48;

Box3 box_of(const MovingTriangle& triangle) {
    Box3 box;
    for (const MovingPoint& corner : triangle.corners) {
        box.include(corner.from);
        box.include(corner.to);
    }
    return box;
}

/// Returns the box of a segment, grown by the radius of the sphere that moves along it.
Box3 box_of(const StoredPosition& from, const StoredPosition& to, double radius) {
    Box3 box;
    box.include(from.position);
    box.include(to.position);
    return grown(box, radius * (1.0 + kBoxRounding) + kBoxRounding * (max_abs(box.lower) + max_abs(box.upper)));
}

}  // namespace

DeformingColliders::DeformingColliders(const std::shared_ptr<ColliderList>& colliders)
    : colliders_(colliders), mesh_of_(colliders->all().size(), kNone) {
    for (std::size_t number = 0; number < mesh_of_.size(); ++number) {
        if (is_deforming(colliders->all()[number])) add(number);
    }
}

void DeformingColliders::add(std::size_t number) {
    const ColliderDescription& collider = colliders_->all()[number];
    const auto& shape = std::get<MeshShape>(collider.shape);
    const auto refuse = [&](const std::string& what) {
        throw InputError("collider \"" + collider.name + "\": " + what);
    };
    if (shape.motion->vertex_count() != shape.mesh->vertices.size()) {
        refuse("its motion has " + std::to_string(shape.motion->vertex_count()) + " vertices, expected the " +
               std::to_string(shape.mesh->vertices.size()) + " of its mesh");
    }
    const AffineMap map = world_from_local(shape.placement);
    if (!(map.determinant() != 0.0)) refuse("its placement is singular, expected a scale without zeros");
    Mesh mesh;
    mesh.collider = number;
    mesh.first_surface = colliders_->first_surface_of(number);
    mesh.triangles = shape.mesh->triangles;
    if (map.determinant() < 0.0) {
        for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = mesh.triangles[t];
        if (a != b && b != c && c != a) mesh.solid.push_back(t);
    }
    try {
        mesh.motion = std::make_shared<const MeshMotion>(shape.motion->mapped(map));
    } catch (const InputError& problem) {
        refuse(problem.what());
    }
    for (std::size_t key = 0; key < mesh.motion->key_count(); ++key) {
        Box3 box;
        for (const Vec3& vertex : mesh.motion->positions(key)) box.include(vertex);
        const double size = mesh.motion->vertex_count() > 0 ? max_abs(box.size()) : 0.0;
        if (size > 0.0 && size < kSmallestSize) {
            refuse(fmt::format("at its key {} it measures {:g} m from end to end, expected at least {:g} m", key, size,
                               kSmallestSize));
        }
    }
    colliders_->replace_motion(number, mesh.motion);
    mesh_of_[number] = static_cast<std::uint32_t>(meshes_.size());
    meshes_.push_back(std::move(mesh));
}

TriangleMesh DeformingColliders::mesh_at(std::size_t collider, double time) const {
    const Mesh& of = mesh(collider);
    const MeshMoment moment = of.motion->at(time);
    TriangleMesh result;
    result.triangles = of.triangles;
    for (std::size_t v = 0; v < of.motion->vertex_count(); ++v) result.vertices.push_back(moment.position(v));
    return result;
}

void DeformingColliders::begin_step(double begin, double end) {
    begin_ = begin;
    end_ = end;
    for (Mesh& mesh : meshes_) sweep(mesh);
}

/// Computes the boxes of a mesh for the step. Between keys vertices move on straight lines, so their positions at both
/// ends and at keys bound the motion.
void DeformingColliders::sweep(Mesh& mesh) {
    std::vector<MeshMoment> moments{mesh.motion->at(begin_)};
    for (double key = mesh.motion->next_key(begin_); key < end_; key = mesh.motion->next_key(key)) {
        moments.push_back(mesh.motion->at(key));
    }
    moments.push_back(mesh.motion->at(end_));
    mesh.at_begin = moments.front();
    mesh.at_end = moments.back();
    const bool stands = std::all_of(moments.begin(), moments.end(), [&](const MeshMoment& moment) {
        return moment.duration == 0.0 && moment.from.data() == moments[0].from.data();
    });
    const Vec3* const stands_at = stands ? moments[0].from.data() : nullptr;
    if (std::exchange(mesh.stands_at, stands_at) == stands_at && stands) return;
    const std::size_t count = mesh.motion->vertex_count();
    swept_.resize(count);
    std::vector<double> largest((count + kBlock - 1) / kBlock, 0.0);
    parallel_for_blocks(count, kBlock, [&](std::size_t block, std::size_t first, std::size_t last) {
        Box3 all;
        for (std::size_t v = first; v < last; ++v) {
            const Vec3 begin = moments.front().position(v);
            const Vec3 end = moments.back().position(v);
            Box3 box{min(begin, end), max(begin, end)};
            for (std::size_t k = 1; k + 1 < moments.size(); ++k) box.include(moments[k].position(v));
            swept_[v] = box;
            all.lower = min(all.lower, box.lower);
            all.upper = max(all.upper, box.upper);
        }
        largest[block] = std::max(max_abs(all.lower), max_abs(all.upper));
    });
    const double most = largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
    mesh.offset = contact_offset({most, 0.0, 0.0});
    mesh.tree.fit(mesh.solid.size(), [&](std::uint32_t k) {
        const auto [a, b, c] = mesh.triangles[mesh.solid[k]];
        const Box3& at_a = swept_[a];
        const Box3& at_b = swept_[b];
        const Box3& at_c = swept_[c];
        return grown({min(at_a.lower, min(at_b.lower, at_c.lower)), max(at_a.upper, max(at_b.upper, at_c.upper))},
                     kBoxRounding * most);
    });
}

void DeformingColliders::near(const Box3& box, std::vector<SurfaceId>& out) const {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    for (const Mesh& mesh : meshes_) {
        mesh.tree.near(box, [&](std::uint32_t k) { out.push_back(mesh.first_surface + mesh.solid[k]); });
    }
    std::sort(out.begin() + first, out.end());
}

bool DeformingColliders::stay_out(const Box3& box) const {
    return std::none_of(meshes_.begin(), meshes_.end(), [&](const Mesh& mesh) { return mesh.tree.has_near(box); });
}

double DeformingColliders::offset_in(const Box3& box) const {
    double offset = 0.0;
    for (const Mesh& mesh : meshes_) {
        if (BoxTree::meet(mesh.tree.bounds(), box)) offset = std::max(offset, mesh.offset);
    }
    return offset;
}

double DeformingColliders::next_key(double time) const {
    double first = std::numeric_limits<double>::infinity();
    for (const Mesh& mesh : meshes_) first = std::min(first, mesh.motion->next_key(time));
    return first;
}

MeshMoment DeformingColliders::moment_of(const Mesh& mesh, double time) const {
    if (begin_ < end_ && time == begin_) return mesh.at_begin;
    if (begin_ < end_ && time == end_) return mesh.at_end;
    return mesh.motion->at(time);
}

std::array<Vec3, 3> DeformingColliders::corners_at(SurfaceId surface, double time) const {
    const Mesh& mesh = mesh_with(surface);
    const Triangle& triangle = mesh.triangles[surface - mesh.first_surface];
    const MeshMoment moment = moment_of(mesh, time);
    return {moment.position(triangle[0]), moment.position(triangle[1]), moment.position(triangle[2])};
}

std::array<Vec3, 3> DeformingColliders::corner_velocities(SurfaceId surface, double time) const {
    const Mesh& mesh = mesh_with(surface);
    const Triangle& triangle = mesh.triangles[surface - mesh.first_surface];
    const MeshMoment moment = moment_of(mesh, time);
    return {moment.velocity(triangle[0]), moment.velocity(triangle[1]), moment.velocity(triangle[2])};
}

MovingTriangle DeformingColliders::between(SurfaceId surface, double begin, double end) const {
    const std::array<Vec3, 3> from = corners_at(surface, begin);
    const std::array<Vec3, 3> to = corners_at(surface, end);
    return {{{{from[0], to[0]}, {from[1], to[1]}, {from[2], to[2]}}}};
}

CollisionWorld::Nearest DeformingColliders::nearest(SurfaceId surface, const Vec3& p, double time) const {
    const auto [a, b, c] = corners_at(surface, time);
    if (!are_collinear(a, b, c)) return CollisionWorld::nearest(TrianglePlane(a, b, c), p);
    const ClosestPointOnTriangle closest = closest_point_on_triangle(p, a, b, c);
    const double distance = length(closest.offset);
    return {distance > 0.0 ? closest.offset / distance : Vec3{0, 0, 1}, distance, false, true};
}

double DeformingColliders::signed_distance_from(SurfaceId surface, const Vec3& p, double time) const {
    const auto [a, b, c] = corners_at(surface, time);
    return are_collinear(a, b, c) ? nearest(surface, p, time).distance : signed_distance(p, a, b, c);
}

Vec3 DeformingColliders::unit_normal_of(SurfaceId surface, double time) const {
    const auto [a, b, c] = corners_at(surface, time);
    return are_collinear(a, b, c) ? Vec3{0, 0, 1} : unit_normal(a, b, c);
}

int DeformingColliders::side_of_surface(SurfaceId surface, const Vec3& p, double time) const {
    const auto [a, b, c] = corners_at(surface, time);
    return orient3d(a, b, c, p);
}

DeformingColliders::Motion DeformingColliders::motion_at(SurfaceId surface, const Vec3& p, double time) const {
    const Mesh& mesh = mesh_with(surface);
    const auto [i, j, k] = mesh.triangles[surface - mesh.first_surface];
    const MeshMoment moment = mesh.motion->at(time + kKeyUlps * ulp(time));
    const Vec3 a = moment.position(i);
    const Vec3 e = moment.position(j) - a;
    const Vec3 f = moment.position(k) - a;
    const Vec3 weights = barycentric_coordinates(closest_point_on_triangle(p, a, a + e, a + f), a, a + e, a + f);
    const Vec3 v = moment.velocity(i);
    const Vec3 e_rate = moment.velocity(j) - v;
    const Vec3 f_rate = moment.velocity(k) - v;
    Motion motion{v + weights.y * e_rate + weights.z * f_rate, {}};
    const Vec3 across = cross(e, f);
    const double area = length(across);
    if (!(area > 0.0)) return motion;
    const Vec3 normal = across / area;
    const Vec3 rate = (cross(e_rate, f) + cross(e, f_rate)) / area;
    const double about_normal = (dot(e_rate, f) - dot(f_rate, e)) / (2.0 * area);
    motion.turning = cross(normal, rate) + about_normal * normal;
    return motion;
}

bool DeformingColliders::is_free(SurfaceId surface, const StoredPosition& from, const StoredPosition& to,
                                 double radius) const {
    const MovingTriangle triangle = between(surface, from.time, to.time);
    const double key = mesh_with(surface).motion->next_key(from.time);
    if (!(key < to.time)) {
        if (!BoxTree::meet(box_of(triangle), box_of(from, to, radius))) return true;
        return stay_apart({from.position, to.position}, radius, triangle);
    }
    Box3 box = box_of(triangle);
    for (double at = key; at < to.time; at = mesh_with(surface).motion->next_key(at)) {
        for (const Vec3& corner : corners_at(surface, at)) box.include(corner);
    }
    return !BoxTree::meet(box, box_of(from, to, radius));
}

bool DeformingColliders::is_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const {
    const Box3 box = box_of(from, to, radius);
    std::vector<SurfaceId> all;
    if (begin_ <= from.time && to.time <= end_) {
        near(box, all);
    } else {  // a stalled particle continues, and its start is outside the step
        for (const Mesh& mesh : meshes_) {
            for (const std::uint32_t t : mesh.solid) all.push_back(mesh.first_surface + t);
        }
    }
    const double tolerance = sphere_tolerance(radius, std::max(max_abs(from.position), max_abs(to.position)));
    return std::all_of(all.begin(), all.end(), [&](SurfaceId surface) {
        if (radius == 0.0) return is_free(surface, from, to, 0.0);
        // The ends keep a larger distance than the certificate requires, because losses of successive segments add up.
        const double distance = nearest(surface, from.position, from.time).distance;
        const double least = distance >= radius - tolerance
                                 ? std::min(radius - kUsedSphereTolerance * tolerance, kNearerStill * distance)
                                 : distance - kOverlapRounding * tolerance;
        if (nearest(surface, to.position, to.time).distance < least) return false;
        return is_free(surface, from, to, std::max(0.0, std::min(radius - tolerance, distance - 0.25 * tolerance)));
    });
}

bool DeformingColliders::is_late_segment_free(const Mesh& mesh, const StoredPosition& from, const StoredPosition& to,
                                              double radius) const {
    const MeshMoment first = moment_of(mesh, from.time);
    const MeshMoment last = moment_of(mesh, to.time);
    const Box3 swept = box_of(from, to, radius);
    const double tolerance = sphere_tolerance(radius, std::max(max_abs(from.position), max_abs(to.position)));
    return std::all_of(mesh.solid.begin(), mesh.solid.end(), [&](std::uint32_t t) {
        MovingTriangle triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[t][k];
            triangle.corners[k] = {first.position(vertex), last.position(vertex)};
        }
        if (!BoxTree::meet(box_of(triangle), swept)) return true;
        if (!stay_apart({from.position, to.position}, 0.0, triangle)) return false;
        if (radius == 0.0) return true;
        const SurfaceId surface = mesh.first_surface + t;
        const double distance = nearest(surface, to.position, to.time).distance;
        return distance >= radius - kUsedSphereTolerance * tolerance ||
               distance >= nearest(surface, from.position, from.time).distance;
    });
}

bool DeformingColliders::is_late_segment_free(const StoredPosition& from, const StoredPosition& to,
                                              double radius) const {
    return std::all_of(meshes_.begin(), meshes_.end(),
                       [&](const Mesh& mesh) { return is_late_segment_free(mesh, from, to, radius); });
}

void DeformingColliders::nearest_to(const Vec3& p, double time, std::size_t most, std::vector<SurfaceId>& out) const {
    std::vector<std::pair<double, SurfaceId>> all;
    for (const Mesh& mesh : meshes_) {
        const MeshMoment moment = moment_of(mesh, time);
        for (const std::uint32_t t : mesh.solid) {
            const auto [a, b, c] = mesh.triangles[t];
            const ClosestPointOnTriangle closest =
                closest_point_on_triangle(p, moment.position(a), moment.position(b), moment.position(c));
            all.emplace_back(closest.distance_squared, mesh.first_surface + t);
        }
    }
    const std::size_t count = std::min(most, all.size());
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
    for (std::size_t k = 0; k < count; ++k) out.push_back(all[k].second);
}

std::size_t DeformingColliders::memory_bytes() const {
    std::size_t bytes = swept_.capacity() * sizeof(Box3);
    for (const Mesh& mesh : meshes_) {
        bytes += mesh.triangles.capacity() * (sizeof(Triangle) + 2 * sizeof(Box3)) + mesh.motion->memory_bytes();
    }
    return bytes;
}

}  // namespace ricochet
