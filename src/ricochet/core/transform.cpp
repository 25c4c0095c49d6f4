#include "ricochet/core/transform.h"

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

struct SineCosine {
    double sine;
    double cosine;
};

SineCosine sine_cosine_degrees(double degrees) {
    const double turn = std::remainder(degrees, 360.0);
    if (turn == 0.0) return {0.0, 1.0};
    if (turn == 90.0) return {1.0, 0.0};
    if (turn == -90.0) return {-1.0, 0.0};
    if (std::fabs(turn) == 180.0) return {0.0, -1.0};
    const double radians = turn * (3.14159265358979323846 / 180.0);
    return {std::sin(radians), std::cos(radians)};
}

}  // namespace

// Uses Rodrigues' rotation formula. The columns of the matrix are multiplied by the placement's scale.
AffineMap world_from_local(const Placement& placement) {
    if (!is_finite(placement.position) || !is_finite(placement.scale) || !std::isfinite(placement.rotation_degrees)) {
        throw InputError("placement: found a number that is not finite, expected finite numbers");
    }
    if (!is_finite(placement.rotation_axis) || max_abs(placement.rotation_axis) == 0.0) {
        throw InputError("placement: rotation axis: found one that is zero or not finite, expected a direction");
    }
    const Vec3 k = normalized(placement.rotation_axis);
    const auto [s, c] = sine_cosine_degrees(placement.rotation_degrees);
    const double d = 1.0 - c;
    AffineMap map;
    map.row_x = Vec3{c + d * k.x * k.x, d * k.x * k.y - s * k.z, d * k.x * k.z + s * k.y};
    map.row_y = Vec3{d * k.x * k.y + s * k.z, c + d * k.y * k.y, d * k.y * k.z - s * k.x};
    map.row_z = Vec3{d * k.x * k.z - s * k.y, d * k.y * k.z + s * k.x, c + d * k.z * k.z};
    for (Vec3* row : {&map.row_x, &map.row_y, &map.row_z}) {
        *row = {row->x * placement.scale.x, row->y * placement.scale.y, row->z * placement.scale.z};
    }
    map.translation = placement.position;
    return map;
}

}  // namespace ricochet
