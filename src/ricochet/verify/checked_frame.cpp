#include "ricochet/verify/checked_frame.h"

#include <utility>

#include "ricochet/core/error.h"

namespace ricochet::verify {
namespace {

void add_triangles(const TriangleMesh& mesh, std::uint32_t collider, std::vector<NamedTriangle>& triangles) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = mesh.triangles[t];
        const Corners corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
        if (on_one_line(corners.a, corners.b, corners.c)) continue;
        triangles.push_back({corners, collider, static_cast<std::uint32_t>(t)});
    }
}

void require_surface(bool condition, const char* what) {
    if (!condition) throw InputError(what);
}

void require_good(const TriangleMesh& mesh) {
    require_corners(mesh);
    require_surface(std::ranges::all_of(mesh.vertices, is_finite), "verified mesh: found a vertex that is not finite");
}

Side side_of(int sign) { return sign > 0 ? Side::outside : (sign < 0 ? Side::inside : Side::on_surface); }

/// Returns the local position R^T (x - t) of a stored position x in a moving frame, as defined by
/// MovingPose::local_position().
Vec3 local_position_by(const AffineMap& map, const Vec3& world) {
    const Vec3 d = world - map.translation;
    const auto sum = [&](double x, double y, double z) { return d.x * x + d.y * y + d.z * z; };
    return {sum(map.row_x.x, map.row_y.x, map.row_z.x), sum(map.row_x.y, map.row_y.y, map.row_z.y),
            sum(map.row_x.z, map.row_y.z, map.row_z.z)};
}

}  // namespace

void CheckedFrame::add(std::uint32_t collider, const VerifiedSurface& surface) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&surface)) {
        require_good(*mesh);
        add_triangles(*mesh, collider, to_build_);
        if (count_open_edges(*mesh) == 0) bodies_.push_back({collider, ParityOracle(*mesh)});
        for (const Vec3& vertex : mesh->vertices) box_.include(vertex);
    } else if (const auto* plane = std::get_if<VerifiedPlane>(&surface)) {
        require_surface(is_finite(plane->point) && is_finite(plane->normal) && max_abs(plane->normal) > 0.0,
                        "verified plane: expected finite numbers and a normal above 0");
        planes_.push_back({collider, *plane});
    } else {
        const auto& shape = std::get<VerifiedShape>(surface);
        const AffineMap& map = shape.world_from_unit;
        require_surface(is_finite(map.row_x) && is_finite(map.row_y) && is_finite(map.row_z) &&
                            is_finite(map.translation) && map.determinant() != 0.0,
                        "verified shape: expected finite numbers and a volume");
        shapes_.push_back({collider, CheckedShape(shape.world_from_unit, shape.is_cylinder)});
        const Vec3 reach = abs(Vec3{length(map.row_x), length(map.row_y), length(map.row_z)}) * 1.5;
        box_.include(map.translation - reach);
        box_.include(map.translation + reach);
    }
}

void CheckedFrame::build() { triangles_ = TriangleTree(std::exchange(to_build_, {})); }

Vec3 CheckedFrame::local_position(const Vec3& world, double time) const {
    return frame_ ? local_position_by(frames_->at(*frame_, time).world_from_frame, world) : world;
}

void CheckedFrame::append_sides(const Vec3& p, double time, std::vector<Side>& sides) const {
    const Vec3 seen = local_position(p, time);
    for (const auto& [collider, plane] : planes_)
        sides.push_back(side_of(height_sign(plane.normal, plane.point, seen)));
    for (const auto& [collider, shape] : shapes_) sides.push_back(side_of(shape.side(seen)));
    for (const auto& [collider, body] : bodies_) sides.push_back(body.side(seen));
}

bool CheckedFrame::is_on_surface(const Vec3& p, double time) const {
    const Vec3 seen = local_position(p, time);
    bool is_on = false;
    triangles_.near_segment(seen, seen,
                            [&](const NamedTriangle& t) { is_on = is_on || intersects(seen, seen, t.corners); });
    return is_on;
}

void CheckedFrame::find_crossings(const Segment& segment, bool starts_on_surface,
                                  std::vector<Crossing>& crossings) const {
    const Vec3 p = local_position(segment.from, segment.begin);
    const Vec3 q = local_position(segment.to, segment.end);
    const std::size_t first = crossings.size();
    for (const auto& [collider, plane] : planes_) {
        const int of_p = height_sign(plane.normal, plane.point, p);
        const int of_q = height_sign(plane.normal, plane.point, q);
        const bool leaves = starts_on_surface && of_p == 0 && of_q != 0;
        if (of_p * of_q <= 0 && !leaves) crossings.push_back({segment.to, collider, std::nullopt});
    }
    for (const auto& [collider, shape] : shapes_) {
        if (!shape.intersects(p, q)) continue;
        const bool leaves = starts_on_surface && shape.side(p) == 0 && !shape.intersects_after_start(p, q);
        if (!leaves) crossings.push_back({segment.to, collider, std::nullopt});
    }
    triangles_.near_segment(p, q, [&](const NamedTriangle& t) {
        if (!intersects(p, q, t.corners)) return;
        if (starts_on_surface && !intersects_after_start(p, q, t.corners)) return;
        crossings.push_back({frame_ ? segment.to : crossing_point(p, q, t.corners), t.collider, t.triangle});
    });
    if (frame_ && crossings.size() > first && stays_away(segment)) crossings.resize(first);
}

/// Returns true if a segment does not come near a turning body. In this case, a chord that intersects the body in the
/// body's frame is no evidence of a crossing. The test splits the time of the segment into parts. In each part, a box
/// that encloses the moving body must not touch the box of the segment.
bool CheckedFrame::stays_away(const Segment& segment) const {
    constexpr int kMostParts = 256;
    if (!planes_.empty() || box_.empty()) return false;
    const Box3 way = enclosing(segment.from, segment.to);
    const double reach = length(max(abs(box_.lower), abs(box_.upper)));
    const auto meets = [&](double from, double to) {
        const double middle = 0.5 * from + 0.5 * to;
        const MotionBounds bounds = frames_->bounds(*frame_, from, to);
        const AffineMap map = frames_->at(*frame_, middle).world_from_frame;
        const Vec3 half = 0.5 * box_.size();
        const Vec3 size{dot(abs(map.row_x), half), dot(abs(map.row_y), half), dot(abs(map.row_z), half)};
        const Vec3 center = map.point(box_.center());
        const double rounding = 0x1p-40 * (max_abs(center) + max_abs(size));
        const double by = (bounds.origin[1] + reach * bounds.rotation[1]) * 0.5 * (to - from) + rounding;
        const Vec3 all = size + Vec3{by, by, by};
        const Vec3 gap = max(way.lower - (center + all), (center - all) - way.upper);
        return !(std::max({gap.x, gap.y, gap.z}) > 0.0);
    };
    for (int parts = 1; parts <= kMostParts; parts *= 4) {
        bool meets_any = false;
        for (int k = 0; k < parts && !meets_any; ++k) {
            const double h = (segment.end - segment.begin) / parts;
            meets_any = meets(segment.begin + k * h, segment.begin + (k + 1) * h);
        }
        if (!meets_any) return true;
    }
    return false;
}

}  // namespace ricochet::verify
