#include "ricochet/geometry/sweep/path.h"

#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

Vec3 Path::position(double s) const {
    if (s <= 0.0) return c[0];
    if (s >= duration) return end;
    Vec3 p = c[static_cast<std::size_t>(degree)];
    for (int k = degree - 1; k >= 0; --k) p = c[static_cast<std::size_t>(k)] + s * p;
    return flush_tiny(p);
}

Vec3 Path::velocity(double s) const { return c[1] + s * (2.0 * c[2] + (3.0 * s) * c[3]); }

// |p - chord| <= (to - from)^2 / 8 * max |p''|. p'' is linear in time, so max |p''| is at an end.
double Path::sagitta(double from, double to) const {
    if (degree < 2) return 0.0;
    const Vec3 at_from = 2.0 * c[2] + (6.0 * from) * c[3];
    const Vec3 at_to = 2.0 * c[2] + (6.0 * to) * c[3];
    const double span = to - from;
    return span * span / 8.0 * std::sqrt(std::max(length_squared(at_from), length_squared(at_to)));
}

ControlPoints Path::control_points() const {
    if (degree < 2) return {{c[0], end, {}, {}}, 2};
    const Vec3 second = c[0] + (duration / degree) * c[1];
    if (degree == 2) return {{c[0], second, end, {}}, 3};
    return {{c[0], second, c[0] + (duration / 3.0) * (2.0 * c[1] + duration * c[2]), end}, 4};
}

Vec3 line_end(const Vec3& x, const Vec3& v, double duration) { return flush_tiny(x + duration * v); }

Vec3 parabola_end(const Vec3& x, const Vec3& v, const Vec3& a, double duration) {
    if (a == Vec3{}) return line_end(x, v, duration);
    return flush_tiny(x + duration * (v + (0.5 * duration) * a));
}

Path line_path(const Vec3& x, const Vec3& v, double duration) {
    return {.c = {x, v, Vec3{}, Vec3{}}, .degree = 1, .duration = duration, .end = line_end(x, v, duration)};
}

Path parabola_path(const Vec3& x, const Vec3& v, const Vec3& a, double duration) {
    if (a == Vec3{}) return line_path(x, v, duration);
    return {.c = {x, v, 0.5 * a, Vec3{}}, .degree = 2, .duration = duration, .end = parabola_end(x, v, a, duration)};
}

Path hermite_path(const Vec3& x0, const Vec3& v0, const Vec3& x1, const Vec3& v1, double duration) {
    const Vec3 mean_velocity = (x1 - x0) / duration;
    const Vec3 square = (3.0 * mean_velocity - 2.0 * v0 - v1) / duration;
    const Vec3 cube = ((v0 + v1 - 2.0 * mean_velocity) / duration) / duration;
    const int degree = cube == Vec3{} ? (square == Vec3{} ? 1 : 2) : 3;
    return {.c = {x0, v0, square, cube}, .degree = degree, .duration = duration, .end = flush_tiny(x1)};
}

}  // namespace ricochet
