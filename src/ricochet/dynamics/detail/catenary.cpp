#include "ricochet/dynamics/detail/catenary.h"

#include <cmath>

#include "ricochet/core/portable_math.h"
#include "ricochet/core/tolerances.h"

namespace ricochet::detail {
namespace {

double sinh_of(double x) { return 0.5 * (portable_exp(x) - portable_exp(-x)); }

double asinh_of(double t) {
    const double magnitude = std::fabs(t);
    return std::copysign(portable_log(magnitude + std::sqrt(magnitude * magnitude + 1.0)), t);
}

/// The x > 0 with sinh(x) / x = ratio > 1, by bisection: the function grows from 1.
double solve_sinh_ratio(double ratio) {
    double low = 0.0;
    double high = 1.0;
    while (sinh_of(high) < ratio * high) high *= 2.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (sinh_of(middle) < ratio * middle ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace

// With the parameter a, arc length s from the lowest point lies at a asinh(s / a) across and sqrt(a^2 + s^2) up. The
// ends are at asinh(s / a) = middle -+ x with sinh(x) / x = sqrt(L^2 - rise^2) / across, tanh(middle) = rise / L and
// a = across / (2 x).
std::vector<Vec3> catenary(const Vec3& from, const Vec3& to, double length_of_rope, const Vec3& up, std::size_t count) {
    const Vec3 way = to - from;
    const double rise = dot(way, up);
    const Vec3 level = way - up * rise;
    const double across = length(level);
    const bool is_taut = length_of_rope <= length(way) * (1.0 + kTautRope);
    const bool is_folded = across <= kFoldedRope * length_of_rope;
    const double depth = 0.5 * (length_of_rope - rise);  // of a folded rope
    double x = 0.0;
    double middle = 0.0;
    double a = 0.0;
    if (!is_taut && !is_folded) {
        x = solve_sinh_ratio(std::sqrt((length_of_rope - rise) * (length_of_rope + rise)) / across);
        middle = 0.5 * portable_log((length_of_rope + rise) / (length_of_rope - rise));
        a = across / (2.0 * x);
    }
    const double first = a * sinh_of(middle - x);
    const auto height_at = [&](double s) { return std::sqrt(a * a + s * s); };
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < count; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(count - 1);
        const double s = part * length_of_rope;
        if (is_taut) {
            places.push_back(from + way * part);
        } else if (is_folded) {
            places.push_back(from + level * part + up * (s < depth ? -s : s - 2.0 * depth));
        } else {
            const double aside = a * (asinh_of((first + s) / a) - (middle - x));
            const double height = height_at(first + s) - height_at(first);
            places.push_back(from + level * (aside / across) + up * height);
        }
    }
    places.front() = from;
    places.back() = to;
    return places;
}

}  // namespace ricochet::detail
