#include "ricochet/simulation/counters/path_legs.h"

#include <cmath>
#include <utility>

namespace ricochet {

Extremes extremes_of(const Path& path, const Vec3& normal, double duration) {
    const double a = 3.0 * dot(normal, path.c[3]);
    const double b = 2.0 * dot(normal, path.c[2]);
    const double c = dot(normal, path.c[1]);
    Extremes extremes;
    const double discriminant = b * b - 4.0 * a * c;
    if (!(discriminant > 0.0)) return extremes;
    // The root of larger magnitude has no cancellation. The other root follows from the product of both.
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    double first = a != 0.0 ? q / a : -1.0;
    double second = q != 0.0 ? c / q : -1.0;
    if (first > second) std::swap(first, second);
    for (const double s : {first, second}) {
        if (s > 0.0 && s < duration) extremes.time[static_cast<std::size_t>(extremes.count++)] = s;
    }
    return extremes;
}

}  // namespace ricochet
