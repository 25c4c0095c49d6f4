#include "ricochet/dynamics/emitter.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/core/setting.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

namespace {

void require(bool condition, const char* what) {
    if (!condition) throw InputError(what);
}

bool is_position(const Vec3& p) { return is_finite(p) && max_abs(p) <= kLargestCoordinate; }

bool is_length(double x) { return x > 0.0 && x <= kLargestCoordinate; }

/// Returns true if the vector can be normalized.
bool is_direction(const Vec3& v) { return length(v) > 0.0 && std::isfinite(length(v)); }

void require_position(const Vec3& p, const std::string& name) {
    const std::string refused = refusal(p, kCoordinate, "m");
    if (!refused.empty()) throw InputError(name + refused);
}

void require_mesh(const TriangleMesh* mesh) {
    require(mesh != nullptr, "found a null pointer, expected a mesh");
    require_corners(*mesh);
}

struct CheckShape {
    static void check_center(const Vec3& center) { require_position(center, "center: "); }
    void operator()(const PointShape& point) const { check_center(point.center); }
    void operator()(const DiskShape& disk) const {
        check_center(disk.center);
        require(is_direction(disk.normal), "the disk's normal must be of finite length above 0");
        require(is_length(disk.radius), "the disk's radius must be > 0 and at most 1e75 m");
    }
    void operator()(const BoxShape& box) const {
        check_center(box.center);
        const bool good =
            max_abs(box.size) <= kLargestCoordinate && std::min({box.size.x, box.size.y, box.size.z}) >= 0.0;
        require(good, "the box's size must be >= 0 and at most 1e75 m");
    }
    void operator()(const SphereShape& sphere) const {
        check_center(sphere.center);
        require(is_length(sphere.radius), "the sphere's radius must be > 0 and at most 1e75 m");
    }
    void operator()(const MeshSurfaceShape& surface) const { require_mesh(surface.mesh.get()); }
    void operator()(const ConeShape& cone) const {
        require_position(cone.apex, "apex: ");
        require(is_direction(cone.axis), "the cone's axis must be of finite length above 0");
        require(cone.angle_degrees >= 0.0 && cone.angle_degrees < 90.0,
                "the cone's angle must be 0 to below 90 degrees");
        require(is_length(cone.height), "the cone's height must be > 0 and at most 1e75 m");
    }
    void operator()(const MeshVolumeShape& volume) const { require_mesh(volume.mesh.get()); }
};

// Returns running sums of twice the triangle areas. A uniform draw finds its triangle in them by binary search.
// Degenerate triangles have no normal, so they add nothing, even if their computed area is above 0 by rounding.
std::vector<double> cumulative_areas(const TriangleMesh& mesh) {
    std::vector<double> sums;
    sums.reserve(mesh.triangles.size());
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        const Vec3& b = mesh.vertices[t[1]];
        const Vec3& c = mesh.vertices[t[2]];
        if (!are_collinear(a, b, c)) sum += length(cross(b - a, c - a));
        sums.push_back(sum);
    }
    return sums;
}

void check_volume(const TriangleMesh& mesh) {
    require(is_closed(mesh), "the mesh is not closed, so it has no inside");
    const Vec3 size = bounds(mesh).size();
    const double box = size.x * size.y * size.z;
    require(std::isfinite(box) &&
                std::fabs(signed_volume(counted_surface(mesh))) >= ShapeSampler::kSmallestFill * box && box > 0.0,
            "the mesh's volume is less than a ten thousandth of its box");
}

Vec3 uniform_in(const Box3& box, RandomSequence& random) {
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
        point[axis] = box.lower[axis] + (box.upper[axis] - box.lower[axis]) * random.uniform();
    }
    return point;
}

double cosine_of_turns(double turns) { return sine_of_turns(turns + 0.25); }

double tangent_of_degrees(double degrees) { return sine_of_turns(degrees / 360.0) / cosine_of_turns(degrees / 360.0); }

void append_circle(const Vec3& center, const Vec3& normal, double radius, int segments, std::vector<Vec3>& points) {
    const auto [first, second] = tangent_frame(normal);
    for (int k = 0; k < segments; ++k) {
        const double turns = static_cast<double>(k) / segments;
        points.push_back(center + radius * (cosine_of_turns(turns) * first + sine_of_turns(turns) * second));
    }
}

Vec3 end_of(const ConeShape& cone) { return cone.apex + cone.height * normalized(cone.axis); }

double end_radius(const ConeShape& cone) { return cone.height * tangent_of_degrees(cone.angle_degrees); }

struct OutlinePoints {
    const Vec3& seen_from;
    int segments;

    std::vector<Vec3> operator()(const PointShape& point) const { return {point.center}; }
    std::vector<Vec3> operator()(const DiskShape& disk) const {
        std::vector<Vec3> points;
        append_circle(disk.center, normalized(disk.normal), disk.radius, segments, points);
        return points;
    }
    std::vector<Vec3> operator()(const BoxShape& box) const {
        std::vector<Vec3> points;
        for (int corner = 0; corner < 8; ++corner) {
            Vec3 point = box.center;
            for (int axis = 0; axis < 3; ++axis) point[axis] += box.size[axis] * ((corner >> axis & 1) - 0.5);
            points.push_back(point);
        }
        return points;
    }
    // Returns points on the circle at which lines of sight are tangent to the ball.
    std::vector<Vec3> operator()(const SphereShape& sphere) const {
        const Vec3 away = sphere.center - seen_from;
        const double distance = length(away);
        if (!(distance > sphere.radius)) return {};
        const double sine = sphere.radius / distance;
        std::vector<Vec3> points;
        append_circle(sphere.center - sphere.radius * sine * (away / distance), away / distance,
                      sphere.radius * std::sqrt(1.0 - sine * sine), segments, points);
        return points;
    }
    std::vector<Vec3> operator()(const MeshSurfaceShape& surface) const { return used_vertices(*surface.mesh); }
    std::vector<Vec3> operator()(const ConeShape& cone) const {
        std::vector<Vec3> points{cone.apex};
        append_circle(end_of(cone), normalized(cone.axis), end_radius(cone), segments, points);
        return points;
    }
    std::vector<Vec3> operator()(const MeshVolumeShape& volume) const { return used_vertices(*volume.mesh); }

    static std::vector<Vec3> used_vertices(const TriangleMesh& mesh) {
        std::vector<Vec3> points;
        for (const Triangle& t : mesh.triangles) {
            for (const std::uint32_t v : t) points.push_back(mesh.vertices[v]);
        }
        return points;
    }
};

/// Returns true if one of many random points of the mesh's box is inside the mesh. A sheet whose triangles are listed
/// on both sides has no interior, so draw() would never end. In a mesh that fills less than a millionth of its box,
/// draw() would take too long.
bool has_interior(const MeshInterior& inside) {
    constexpr int kMostTries = 1 << 20;
    RandomSequence random(0, 0, 0);
    for (int k = 0; k < kMostTries; ++k) {
        if (inside.contains(flush_tiny(uniform_in(inside.box(), random)))) return true;
    }
    return false;
}

constexpr int kSegments = 256;

bool is_left(const Point2& a, const Point2& b) { return a.u != b.u ? a.u < b.u : a.v < b.v; }

// Appends the upper or lower half of the hull. Method: A. M. Andrew, "Another efficient algorithm for convex hulls in
// two dimensions", Information Processing Letters 9(5), 1979.
template <class Iterator>
void append_half_hull(Iterator begin, Iterator end, std::vector<Point2>& hull) {
    const std::size_t first = hull.size();
    for (; begin != end; ++begin) {
        while (hull.size() >= first + 2 && orient2d(hull[hull.size() - 2], hull.back(), *begin) <= 0) hull.pop_back();
        hull.push_back(*begin);
    }
    if (!hull.empty()) hull.pop_back();
}

double hull_area(std::vector<Point2> points) {
    std::sort(points.begin(), points.end(), is_left);
    std::vector<Point2> hull;
    append_half_hull(points.begin(), points.end(), hull);
    append_half_hull(points.rbegin(), points.rend(), hull);
    double twice = 0.0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
        const Point2& a = hull[k];
        const Point2& b = hull[(k + 1) % hull.size()];
        twice += a.u * b.v - b.u * a.v;
    }
    return 0.5 * std::fabs(twice);
}

}  // namespace

ShapeSampler::ShapeSampler(const EmitterShape& shape) : shape_(shape) {
    std::visit(CheckShape{}, shape_);
    if (const auto* surface = std::get_if<MeshSurfaceShape>(&shape_)) {
        cumulative_area_ = cumulative_areas(*surface->mesh);
        require(!cumulative_area_.empty() && cumulative_area_.back() > 0.0, "the mesh has no area");
        require(std::isfinite(cumulative_area_.back()), "the mesh is too large");
    } else if (const auto* volume = std::get_if<MeshVolumeShape>(&shape_)) {
        check_volume(*volume->mesh);
        inside_ = std::make_shared<const MeshInterior>(volume->mesh);
        require(has_interior(*inside_),
                "the mesh is closed but encloses no volume: no random point of its box is inside");
    } else if (const auto* cone = std::get_if<ConeShape>(&shape_)) {
        cone_slope_ = tangent_of_degrees(cone->angle_degrees);
    }
}

LaunchPoint ShapeSampler::draw(double radius, RandomSequence& random) const {
    if (const auto* disk = std::get_if<DiskShape>(&shape_)) return on_disk(*disk, random);
    if (const auto* box = std::get_if<BoxShape>(&shape_)) {
        Vec3 position = box->center;
        for (int axis = 0; axis < 3; ++axis) position[axis] += box->size[axis] * (random.uniform() - 0.5);
        return {position, random.unit_vector()};
    }
    if (const auto* sphere = std::get_if<SphereShape>(&shape_)) {
        if (!sphere->surface) return {sphere->center + sphere->radius * random.in_unit_ball(), random.unit_vector()};
        const Vec3 normal = random.unit_vector();
        return {sphere->center + sphere->radius * normal, normal};
    }
    if (const auto* surface = std::get_if<MeshSurfaceShape>(&shape_)) return on_mesh(*surface->mesh, radius, random);
    if (const auto* cone = std::get_if<ConeShape>(&shape_)) return in_cone(*cone, random);
    if (inside_) return in_mesh(random);
    return {std::get<PointShape>(shape_).center, random.unit_vector()};
}

LaunchPoint ShapeSampler::on_disk(const DiskShape& disk, RandomSequence& random) const {
    const Vec3 normal = normalized(disk.normal);
    const auto [first, second] = tangent_frame(normal);
    const Vec3 p = random.in_unit_disk();
    return {disk.center + disk.radius * (first * p.x + second * p.y), normal};
}

// The largest of three uniform numbers has the cumulative distribution x^3. The relative height of a uniform point in a
// cone has the same distribution.
LaunchPoint ShapeSampler::in_cone(const ConeShape& cone, RandomSequence& random) const {
    const double first_draw = random.uniform();
    const double second_draw = random.uniform();
    const double height = cone.height * std::max({first_draw, second_draw, random.uniform()});
    const Vec3 axis = normalized(cone.axis);
    const auto [first, second] = tangent_frame(axis);
    const Vec3 p = cone_slope_ * random.in_unit_disk();
    const Vec3 line = axis + first * p.x + second * p.y;  // vector from the apex to the height 1
    return {cone.apex + height * line, normalized(line)};
}

// Rounding moves the point by a few ulp of the corners' coordinates, which can exceed the ulp of the point. The contact
// offset is therefore computed from the corners.
LaunchPoint ShapeSampler::on_mesh(const TriangleMesh& mesh, double radius, RandomSequence& random) const {
    const double area = random.uniform() * cumulative_area_.back();
    const auto found = std::upper_bound(cumulative_area_.begin(), cumulative_area_.end() - 1, area);
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(found - cumulative_area_.begin())];
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    double u = random.uniform();
    double v = random.uniform();
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    const Vec3 normal = unit_normal(a, b, c);
    const double gap = contact_offset(max(max(abs(a), abs(b)), abs(c)));
    return {a + u * (b - a) + v * (c - a) + (radius + gap) * normal, normal};
}

LaunchPoint ShapeSampler::in_mesh(RandomSequence& random) const {
    Vec3 position = flush_tiny(uniform_in(inside_->box(), random));
    while (!inside_->contains(position)) position = flush_tiny(uniform_in(inside_->box(), random));
    return {position, random.unit_vector()};
}

std::vector<Vec3> outline_points(const EmitterShape& shape, const Vec3& seen_from, int segments) {
    std::visit(CheckShape{}, shape);
    require(segments >= 3, "its outline needs at least 3 points a circle");
    require(is_finite(seen_from), "it must be seen from a finite position");
    return std::visit(OutlinePoints{seen_from, segments}, shape);
}

Box3 bounds(const EmitterShape& shape) {
    std::visit(CheckShape{}, shape);
    Box3 box;
    const auto around = [&](const Vec3& center, double radius) {
        box.include(center - Vec3{radius, radius, radius});
        box.include(center + Vec3{radius, radius, radius});
    };
    if (const auto* disk = std::get_if<DiskShape>(&shape)) {
        around(disk->center, disk->radius);
    } else if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
        around(sphere->center, sphere->radius);
    } else if (const auto* cone = std::get_if<ConeShape>(&shape)) {
        box.include(cone->apex);
        around(end_of(*cone), end_radius(*cone));
    } else {
        for (const Vec3& point : outline_points(shape, {}, 3)) box.include(point);
    }
    return box;
}

double screen_area(const EmitterShape& shape, const ReferenceCamera& camera) {
    require(is_position(camera.position) && is_position(camera.target) && is_direction(camera.target - camera.position),
            "the reference camera must look from one finite position to another");
    require(camera.field_of_view_degrees >= 1.0 && camera.field_of_view_degrees <= 170.0,
            "the reference camera's field of view must be 1 to 170 degrees");
    require(camera.image_height > 0.0 && std::isfinite(camera.image_height),
            "the reference camera's image height must be > 0 pixels");
    const Vec3 forward = normalized(camera.target - camera.position);
    const auto [right, up] = tangent_frame(forward);                // a rotation of the image does not change areas
    const double half_view = camera.field_of_view_degrees / 720.0;  // in turns
    const double scale = 0.5 * camera.image_height * sine_of_turns(half_view + 0.25) / sine_of_turns(half_view);
    std::vector<Point2> seen;
    for (const Vec3& point : outline_points(shape, camera.position, kSegments)) {
        const Vec3 away = point - camera.position;
        const double depth = dot(away, forward);
        if (!(depth > 0.0)) throw InputError("a part of it is not in front of the reference camera");
        seen.push_back({scale * dot(away, right) / depth, scale * dot(away, up) / depth});
    }
    if (seen.empty()) throw InputError("the reference camera stands inside it");
    return hull_area(std::move(seen));
}

}  // namespace ricochet
