#include "view/render/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ricochet/core/box3.h"

namespace ricochet {
namespace {

constexpr std::size_t kSampledPoints = 50000;
constexpr double kMargin = 1.06;  // margin of 6 % around the subject

void append_sample(std::vector<Vec3>& sample, const std::vector<Vec3>& points) {
    const std::size_t stride = points.size() / kSampledPoints + 1;
    for (std::size_t i = 0; i < points.size(); i += stride) {
        if (is_finite(points[i])) sample.push_back(points[i]);
    }
}

// Returns the box from the 2nd to the 98th percentile of each coordinate, widened by a tenth on each side.
Box3 bulk_box(const std::vector<Vec3>& points) {
    Box3 box;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        values.reserve(points.size());
        for (const Vec3& p : points) values.push_back(p[axis]);
        std::sort(values.begin(), values.end());
        const double low = values[(values.size() - 1) * 2 / 100];
        const double high = values[(values.size() - 1) * 98 / 100];
        box.lower[axis] = low - 0.1 * (high - low);
        box.upper[axis] = high + 0.1 * (high - low);
    }
    return box;
}

std::vector<Vec3> points_to_show(const ViewSubject& subject) {
    std::vector<Vec3> shown;
    append_sample(shown, subject.particles);
    if (!shown.empty()) {
        const Box3 bulk = bulk_box(shown);
        std::erase_if(shown, [&](const Vec3& p) { return !bulk.contains(p); });
    }
    append_sample(shown, subject.colliders);
    if (shown.empty()) shown = {{-1, -1, -1}, {1, 1, 1}};
    return shown;
}

// Returns the smallest distance of the camera at which all points are within its field of view in one direction
// (`across`). `tangent` is the tangent of half the field of view. The camera can also be shifted along `across`, so the
// condition is |x - shift| <= tangent * (z + distance) for some shift. Here x and z are the coordinates of a point
// along `across` and `forward`.
double fitting_distance(const std::vector<Vec3>& points, const Vec3& across, const Vec3& forward, double tangent) {
    double low = -std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    for (const Vec3& p : points) {
        const double x = dot(p, across);
        const double z = tangent * dot(p, forward);
        high = std::max(high, x - z);
        low = std::max(low, -x - z);
    }
    return 0.5 * (high + low) / tangent;
}

// Returns the shift of the camera along `across` at which the margins on both sides are equal.
double centering_shift(const std::vector<Vec3>& points, const Vec3& across, const Vec3& forward, double distance) {
    double low = -distance;
    double high = distance;
    for (int i = 0; i < 40; ++i) {
        const double shift = 0.5 * (low + high);
        double left = 0.0;
        double right = 0.0;
        for (const Vec3& p : points) {
            const double slope = (dot(p, across) - shift) / (dot(p, forward) + distance);
            left = std::max(left, -slope);
            right = std::max(right, slope);
        }
        (right > left ? low : high) = shift;
    }
    return 0.5 * (low + high);
}

}  // namespace

double half_height(const Camera& camera) { return std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180.0); }

CameraFrame camera_frame(const Camera& camera) {
    const Vec3 forward = normalized(camera.target - camera.position);
    Vec3 right = cross(forward, camera.up);
    // If the camera looks along its up vector, any perpendicular direction is valid.
    if (length(right) < 1e-9) right = tangent_frame(camera.up)[0];
    right = normalized(right);
    return {right, cross(right, forward), forward};
}

Camera automatic_camera(const ViewSubject& subject, const Vec3& up, double aspect) {
    const std::vector<Vec3> points = points_to_show(subject);
    Box3 box;
    for (const Vec3& p : points) box.include(p);
    const auto [east, north] = tangent_frame(up);
    Camera camera;
    camera.up = up;
    // The camera is to the right of the subject, in front of it and above it. Its azimuth from `east` is about -54
    // degrees, and its elevation about 31 degrees.
    camera.position = 0.55 * east - 0.75 * north + 0.56 * up;
    camera.target = {0, 0, 0};
    const CameraFrame frame = camera_frame(camera);
    const double tangent = half_height(camera);
    std::vector<Vec3> centered = points;
    for (Vec3& p : centered) p -= box.center();
    const double distance =
        kMargin *
        std::max({fitting_distance(centered, frame.right, frame.forward, aspect * tangent),
                  fitting_distance(centered, frame.up, frame.forward, tangent), 1e-9 * max_abs(box.center()), 1e-12});
    camera.target = box.center() + centering_shift(centered, frame.right, frame.forward, distance) * frame.right +
                    centering_shift(centered, frame.up, frame.forward, distance) * frame.up;
    camera.position = camera.target - distance * frame.forward;
    return camera;
}

}  // namespace ricochet
