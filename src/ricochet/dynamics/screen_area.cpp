#include "ricochet/dynamics/screen_area.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/geometry/predicates/orient2d.h"

namespace ricochet {
namespace {

constexpr int kSegments = 256;

bool is_left(const Point2& a, const Point2& b) { return a.u != b.u ? a.u < b.u : a.v < b.v; }

// Upper or lower half of the hull. Method: A. M. Andrew, "Another efficient algorithm for convex hulls in two
// dimensions", Information Processing Letters 9(5), 1979.
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

double screen_area(const EmitterShape& shape, const ReferenceCamera& camera) {
    const Vec3 forward = normalized(camera.target - camera.position);
    const auto [right, up] = tangent_frame(forward);                // turning the picture does not change areas
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
