#include "ricochet/collision/deforming_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/moving_separation.h"

namespace ricochet {
namespace {

constexpr std::size_t kVerticesInBlock = 1 << 14;

/// Margin of boxes, relative to the coordinates, above the rounding of a vertex. Local: it only has to be large enough.
constexpr double kBoxRounding = 0x1p-48;

}  // namespace

Box3 box_of(const MovingTriangle& triangle) {
    Box3 box;
    for (const MovingPoint& corner : triangle.corners) {
        box.include(corner.from);
        box.include(corner.to);
    }
    return box;
}

Box3 box_of(const StoredPosition& from, const StoredPosition& to, double radius) {
    Box3 box;
    box.include(from.position);
    box.include(to.position);
    return grown(box, radius * (1.0 + kBoxRounding) + kBoxRounding * (max_abs(box.lower) + max_abs(box.upper)));
}

CollisionWorld::Nearest DeformedTriangle::nearest(const Vec3& p) const {
    if (!are_collinear(a, b, c)) return CollisionWorld::nearest(TrianglePlane(a, b, c), p);
    const ClosestPointOnTriangle closest = closest_point_on_triangle(p, a, b, c);
    const double distance = length(closest.offset);
    return {distance > 0.0 ? closest.offset / distance : Vec3{0, 0, 1}, distance, false, true};
}

double DeformedTriangle::signed_distance_from(const Vec3& p) const {
    return are_collinear(a, b, c) ? nearest(p).distance : signed_distance(p, a, b, c);
}

Vec3 DeformedTriangle::unit_normal() const {
    return are_collinear(a, b, c) ? Vec3{0, 0, 1} : ricochet::unit_normal(a, b, c);
}

int DeformedTriangle::side_of(const Vec3& p) const { return orient3d(a, b, c, p); }

Vec3 DeformedTriangle::displacement_of(const Vec3& p, const DeformedTriangle& later) const {
    const Vec3 weights = barycentric_coordinates(closest_point_on_triangle(p, a, b, c), a, b, c);
    return weights.x * (later.a - a) + weights.y * (later.b - b) + weights.z * (later.c - c);
}

DeformingMesh::DeformingMesh(const ColliderDescription& description, std::size_t collider, SurfaceId first_surface)
    : collider_(collider), first_surface_(first_surface) {
    const auto& shape = std::get<MeshShape>(description.shape);
    const auto refuse = [&](const std::string& what) {
        throw InputError("collider \"" + description.name + "\": " + what);
    };
    if (shape.motion->vertex_count() != shape.mesh->vertices.size()) {
        refuse("its motion has " + std::to_string(shape.motion->vertex_count()) + " vertices, expected the " +
               std::to_string(shape.mesh->vertices.size()) + " of its mesh");
    }
    const AffineMap map = world_from_local(shape.placement);
    if (!(map.determinant() != 0.0)) refuse("its placement is singular, expected a scale without zeros");
    triangles_ = shape.mesh->triangles;
    if (map.determinant() < 0.0) {
        for (Triangle& triangle : triangles_) std::swap(triangle[1], triangle[2]);
    }
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const auto [a, b, c] = triangles_[t];
        if (a != b && b != c && c != a) solid_.push_back(t);
    }
    try {
        motion_ = std::make_shared<const MeshMotion>(shape.motion->mapped(map));
    } catch (const InputError& problem) {
        refuse(problem.what());
    }
    for (std::size_t key = 0; key < motion_->key_count(); ++key) {
        Box3 box;
        for (const Vec3& vertex : motion_->positions(key)) box.include(vertex);
        const double size = motion_->vertex_count() > 0 ? max_abs(box.size()) : 0.0;
        if (size > 0.0 && size < kSmallestSize) {
            refuse(fmt::format("at its key {} it measures {:g} m from end to end, expected at least {:g} m", key, size,
                               kSmallestSize));
        }
    }
}

TriangleMesh DeformingMesh::mesh_at(double time) const {
    const MeshMoment moment = motion_->at(time);
    TriangleMesh result;
    result.triangles = triangles_;
    for (std::size_t v = 0; v < motion_->vertex_count(); ++v) result.vertices.push_back(moment.position(v));
    return result;
}

/// Computes the boxes of the triangles for the step, from the vertices' positions at both ends and at keys.
void DeformingMesh::begin_step(double begin, double end, std::vector<Box3>& boxes) {
    begin_ = begin;
    end_ = end;
    std::vector<MeshMoment> moments{motion_->at(begin)};
    for (double key = motion_->next_key(begin); key < end; key = motion_->next_key(key)) {
        moments.push_back(motion_->at(key));
    }
    moments.push_back(motion_->at(end));
    at_begin_ = moments.front();
    at_end_ = moments.back();
    const bool is_at_rest = std::ranges::all_of(moments, [&](const MeshMoment& moment) {
        return moment.duration == 0.0 && moment.from.data() == moments[0].from.data();
    });
    const Vec3* const resting_vertices = is_at_rest ? moments[0].from.data() : nullptr;
    if (std::exchange(resting_vertices_, resting_vertices) == resting_vertices && is_at_rest) return;
    const std::size_t count = motion_->vertex_count();
    boxes.resize(count);
    std::vector<double> largest((count + kVerticesInBlock - 1) / kVerticesInBlock, 0.0);
    parallel_for_blocks(count, kVerticesInBlock, [&](std::size_t block, std::size_t first, std::size_t last) {
        Box3 all;
        for (std::size_t v = first; v < last; ++v) {
            const Vec3 start = moments.front().position(v);
            Box3 box{start, start};
            for (std::size_t k = 1; k < moments.size(); ++k) box.include(moments[k].position(v));
            boxes[v] = box;
            all.include(box);
        }
        largest[block] = std::max(max_abs(all.lower), max_abs(all.upper));
    });
    const double most = largest.empty() ? 0.0 : *std::ranges::max_element(largest);
    offset_ = contact_offset({most, 0.0, 0.0});
    tree_.fit(solid_.size(), [&](std::uint32_t k) {
        const auto [a, b, c] = triangles_[solid_[k]];
        Box3 box = boxes[a];
        box.include(boxes[b]);
        box.include(boxes[c]);
        return grown(box, kBoxRounding * most);
    });
}

MeshMoment DeformingMesh::moment_at(double time) const {
    if (begin_ < end_ && time == begin_) return at_begin_;
    if (begin_ < end_ && time == end_) return at_end_;
    return motion_->at(time);
}

DeformedTriangle DeformingMesh::triangle_at(SurfaceId surface, double time) const {
    const auto [a, b, c] = triangle(surface);
    const MeshMoment moment = moment_at(time);
    return {moment.position(a), moment.position(b), moment.position(c)};
}

std::array<Vec3, 3> DeformingMesh::corner_velocities(SurfaceId surface, double time) const {
    const auto [a, b, c] = triangle(surface);
    const MeshMoment moment = moment_at(time);
    return {moment.velocity(a), moment.velocity(b), moment.velocity(c)};
}

MovingTriangle DeformingMesh::between(SurfaceId surface, double begin, double end) const {
    const DeformedTriangle from = triangle_at(surface, begin);
    const DeformedTriangle to = triangle_at(surface, end);
    return {{{{from.a, to.a}, {from.b, to.b}, {from.c, to.c}}}};
}

DeformingMesh::Motion DeformingMesh::motion_at(SurfaceId surface, const Vec3& p, double time) const {
    const auto [i, j, k] = triangle(surface);
    const MeshMoment moment = motion_->at(time + kKeyUlps * ulp(time));
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

bool DeformingMesh::is_free(SurfaceId surface, const StoredPosition& from, const StoredPosition& to,
                            double radius) const {
    const MovingTriangle triangle = between(surface, from.time, to.time);
    const double key = motion_->next_key(from.time);
    if (!(key < to.time)) {
        if (!overlap(box_of(triangle), box_of(from, to, radius))) return true;
        return stay_apart({from.position, to.position}, radius, triangle);
    }
    Box3 box = box_of(triangle);
    for (double at = key; at < to.time; at = motion_->next_key(at)) {
        const auto [a, b, c] = triangle_at(surface, at);
        for (const Vec3* const corner : {&a, &b, &c}) box.include(*corner);
    }
    return !overlap(box, box_of(from, to, radius));
}

bool DeformingMesh::is_late_segment_free(const StoredPosition& from, const StoredPosition& to, double radius) const {
    const Box3 swept = box_of(from, to, radius);
    const double tolerance = sphere_tolerance(radius, std::max(max_abs(from.position), max_abs(to.position)));
    return std::ranges::all_of(solid_, [&](std::uint32_t t) {
        const SurfaceId surface = first_surface_ + t;
        const MovingTriangle triangle = between(surface, from.time, to.time);
        if (!overlap(box_of(triangle), swept)) return true;
        if (!stay_apart({from.position, to.position}, 0.0, triangle)) return false;
        if (radius == 0.0) return true;
        const double distance = triangle_at(surface, to.time).nearest(to.position).distance;
        return distance >= radius - kUsedSphereTolerance * tolerance ||
               distance >= triangle_at(surface, from.time).nearest(from.position).distance;
    });
}

}  // namespace ricochet
