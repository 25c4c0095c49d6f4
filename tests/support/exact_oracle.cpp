#include "support/exact_oracle.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace ricochet::testing {
namespace {

using Integer = boost::multiprecision::cpp_int;
using IntegerPoint = std::array<Integer, 3>;

/// The number mantissa * 2^exponent with an integer mantissa.
struct Dyadic {
    Integer mantissa;
    int exponent = 0;

    explicit Dyadic(double x) {
        const double fraction = std::frexp(x, &exponent);
        mantissa = static_cast<long long>(std::ldexp(fraction, 53));
        exponent -= 53;
    }
};

/// Multiplies all points by one power of two, chosen so that all coordinates become integers.
template <std::size_t N>
std::array<IntegerPoint, N> whole_points(const std::array<Vec3, N>& points) {
    int least = std::numeric_limits<int>::max();
    for (const Vec3& point : points) {
        for (int axis = 0; axis < 3; ++axis) {
            if (point[axis] != 0.0) least = std::min(least, Dyadic(point[axis]).exponent);
        }
    }
    std::array<IntegerPoint, N> whole;
    for (std::size_t i = 0; i < N; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const Dyadic x(points[i][axis]);
            if (x.mantissa != 0) whole[i][static_cast<std::size_t>(axis)] = x.mantissa << (x.exponent - least);
        }
    }
    return whole;
}

/// The linear form coefficients . variables + constant. An equation requires it to be 0, an inequality requires it to
/// be >= 0.
struct LinearForm {
    std::array<Integer, 3> coefficients;
    Integer constant;
};

/// Returns of_form * form + of_other * other. The callers choose factors with which a variable cancels. `of_form` is
/// positive, so an inequality keeps its direction.
LinearForm combined(const LinearForm& form, const Integer& of_form, const LinearForm& other, const Integer& of_other) {
    LinearForm sum;
    for (std::size_t v = 0; v < 3; ++v) {
        sum.coefficients[v] = of_form * form.coefficients[v] + of_other * other.coefficients[v];
    }
    sum.constant = of_form * form.constant + of_other * other.constant;
    return sum;
}

/// Eliminates variable v from the form. The equation must contain this variable.
LinearForm substituted(const LinearForm& form, const LinearForm& equation, std::size_t v) {
    const Integer& pivot = equation.coefficients[v];
    const Integer factor = pivot > 0 ? -form.coefficients[v] : form.coefficients[v];
    return combined(form, boost::multiprecision::abs(pivot), equation, factor);
}

/// Eliminates variable v from a system of inequalities (Fourier-Motzkin).
std::vector<LinearForm> without_variable(const std::vector<LinearForm>& inequalities, std::size_t v) {
    std::vector<LinearForm> reduced;
    for (const LinearForm& form : inequalities) {
        if (form.coefficients[v] == 0) reduced.push_back(form);
    }
    for (const LinearForm& lower : inequalities) {
        if (lower.coefficients[v] <= 0) continue;
        for (const LinearForm& upper : inequalities) {
            if (upper.coefficients[v] >= 0) continue;
            reduced.push_back(combined(lower, -upper.coefficients[v], upper, lower.coefficients[v]));
        }
    }
    return reduced;
}

bool has_solution(std::vector<LinearForm> equations, std::vector<LinearForm> inequalities) {
    while (!equations.empty()) {
        const LinearForm equation = equations.back();
        equations.pop_back();
        const auto& factors = equation.coefficients;
        const auto found = std::find_if(factors.begin(), factors.end(), [](const Integer& x) { return x != 0; });
        if (found == factors.end()) {
            if (equation.constant != 0) return false;
            continue;
        }
        const auto v = static_cast<std::size_t>(found - factors.begin());
        for (LinearForm& form : equations) form = substituted(form, equation, v);
        for (LinearForm& form : inequalities) form = substituted(form, equation, v);
    }
    for (std::size_t v = 0; v < 3; ++v) inequalities = without_variable(inequalities, v);
    return std::all_of(inequalities.begin(), inequalities.end(), [](const LinearForm& f) { return f.constant >= 0; });
}

Integer determinant3(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Returns the determinant of exact_orient3d for points scaled by whole_points.
Integer whole_orient3d(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c, const IntegerPoint& d) {
    return determinant3(b, c, d) - determinant3(a, c, d) + determinant3(a, b, d) - determinant3(a, b, c);
}

}  // namespace

Rational exact(double x) {
    const Dyadic dyadic(x);
    const Integer power = Integer(1) << std::abs(dyadic.exponent);
    return dyadic.exponent < 0 ? Rational(dyadic.mantissa, power) : Rational(dyadic.mantissa * power);
}

Rational exact(const DoubleDouble& x) { return exact(x.hi) + exact(x.lo); }

Rational exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    // The additional point (1, 0, 0) is scaled too, so its x coordinate is the scale factor.
    const auto w = whole_points(std::array{a, b, c, d, Vec3{1.0, 0.0, 0.0}});
    return Rational(whole_orient3d(w[0], w[1], w[2], w[3]), w[4][0] * w[4][0] * w[4][0]);
}

std::array<Rational, 3> exact_area_vector(const Vec3& a, const Vec3& b, const Vec3& c) {
    std::array<Rational, 3> ab;
    std::array<Rational, 3> ac;
    for (int axis = 0; axis < 3; ++axis) {
        ab[static_cast<std::size_t>(axis)] = exact(b[axis]) - exact(a[axis]);
        ac[static_cast<std::size_t>(axis)] = exact(c[axis]) - exact(a[axis]);
    }
    return {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]};
}

bool exact_segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto w = whole_points(std::array{p, q, a, b, c});
    // The variables t, beta, gamma satisfy p + t (q - p) = a + beta (b - a) + gamma (c - a).
    std::vector<LinearForm> equations;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        equations.push_back(
            {{w[1][axis] - w[0][axis], w[2][axis] - w[3][axis], w[2][axis] - w[4][axis]}, w[0][axis] - w[2][axis]});
    }
    const std::vector<LinearForm> inequalities{
        {{1, 0, 0}, 0}, {{-1, 0, 0}, 1}, {{0, 1, 0}, 0}, {{0, 0, 1}, 0}, {{0, -1, -1}, 1}};
    return has_solution(equations, inequalities);
}

Rational exact_crossing_fraction(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto w = whole_points(std::array{p, q, a, b, c});
    const Integer from_p = whole_orient3d(w[2], w[3], w[4], w[0]);
    const Integer from_q = whole_orient3d(w[2], w[3], w[4], w[1]);
    const Integer span = from_p - from_q;
    return span < 0 ? Rational(-from_p, -span) : Rational(from_p, span);
}

double unit_normal_error(const Vec3& normal, const Vec3& a, const Vec3& b, const Vec3& c) {
    using Digits = boost::multiprecision::cpp_bin_float_100;
    const std::array<Rational, 3> area = exact_area_vector(a, b, c);
    const Digits squared(Rational(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]));
    double worst = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const Digits component = Digits(area[static_cast<std::size_t>(axis)]) / boost::multiprecision::sqrt(squared);
        const Digits error = boost::multiprecision::abs(component - Digits(normal[axis]));
        worst = std::max(worst, static_cast<double>(error));
    }
    return worst;
}

double ulps_between(double value, const Rational& reference) {
    const double nearest = std::fabs(static_cast<double>(reference));
    const double ulp = std::nextafter(nearest, std::numeric_limits<double>::infinity()) - nearest;
    return static_cast<double>(Rational(boost::multiprecision::abs(exact(value) - reference) / exact(ulp)));
}

double relative_error(const DoubleDouble& value, const Rational& reference) {
    const Rational difference = exact(value) - reference;
    if (difference == 0) return 0.0;
    if (reference == 0) return std::numeric_limits<double>::infinity();
    return static_cast<double>(Rational(boost::multiprecision::abs(difference / reference)));
}

int sign_of(const Rational& x) { return x.sign(); }

}  // namespace ricochet::testing
