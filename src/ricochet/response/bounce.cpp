#include "ricochet/response/bounce.h"

#include <algorithm>
#include <array>
#include <limits>

#include "ricochet/core/double_double.h"

namespace ricochet {
namespace {

/// Rounding that a projection onto a plane leaves in w . n, relative to |v|.
constexpr double kProjectionRounding = 0x1p-48;

DoubleDouble squared_length(const Vec3& v) {
    return two_product(v.x, v.x) + two_product(v.y, v.y) + two_product(v.z, v.z);
}

bool approaches_none(const Vec3& w, std::span<const Vec3> normals, double scale) {
    return std::all_of(normals.begin(), normals.end(),
                       [&](const Vec3& n) { return dot(w, n) >= -kProjectionRounding * scale; });
}

}  // namespace

Vec3 bounce(const Vec3& v, const Vec3& n, double restitution, double friction) {
    const double approach = -dot(v, n);
    if (!(approach > 0.0)) return v;
    Vec3 after = v + ((1.0 + restitution) * approach) * n;
    if (friction > 0.0) {
        const Vec3 tangential = v + approach * n;
        const double slip = length(tangential);
        const double loss = friction * (1.0 + restitution) * approach;
        after -= slip <= loss ? tangential : (loss / slip) * tangential;
    } else if (restitution == 1.0) {
        // The rounded normal is not exactly of unit length; without this its error would add up over many bounces. The
        // correction itself must not lean to one side, hence the exact products.
        after += (0.5 * (squared_length(v) - squared_length(after)).hi / length_squared(after)) * after;
    }
    return after;
}

// The closest point of a cone of up to three half spaces lies on one of its faces: in space, on a plane, on the line of
// two planes, or at the apex. Each is tried, the closest feasible one wins.
Vec3 project_off(const Vec3& v, std::span<const Vec3> normals) {
    normals = normals.first(std::min<std::size_t>(normals.size(), 3));
    const double scale = length(v);
    if (approaches_none(v, normals, scale)) return v;
    Vec3 best;
    double best_distance = length_squared(v);
    const auto consider = [&](const Vec3& w) {
        const double distance = length_squared(v - w);
        if (distance < best_distance && approaches_none(w, normals, scale)) {
            best = w;
            best_distance = distance;
        }
    };
    for (std::size_t i = 0; i < normals.size(); ++i) {
        consider(v - dot(v, normals[i]) * normals[i]);
        for (std::size_t j = i + 1; j < normals.size(); ++j) {
            const Vec3 line = cross(normals[i], normals[j]);
            const double size = length_squared(line);
            if (size > std::numeric_limits<double>::min()) consider((dot(v, line) / size) * line);
        }
    }
    return best;
}

}  // namespace ricochet
