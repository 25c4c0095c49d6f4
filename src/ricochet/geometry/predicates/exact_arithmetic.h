/// \file
/// Exact and bounded arithmetic for the predicates after their floating-point filters. The first level uses
/// double-double arithmetic with error bounds. The second level uses floating-point expansions, which are stored on the
/// stack. The bounds are derived in docs/exactness.md.
///
/// Method: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
/// Discrete & Computational Geometry 18, 1997.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "ricochet/core/double_double.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

/// A number as the exact sum of at most Capacity doubles. The components are in increasing order of magnitude, strongly
/// non-overlapping and nonzero. The sum is exact as long as no component overflows or has bits below 2^-1074. If an
/// operand is not finite, sums and products are wrong, but they never exceed Capacity components. Only the first `size`
/// components are initialised.
template <int Capacity>
struct Expansion {
    std::array<double, static_cast<std::size_t>(Capacity)> components;
    int size = 0;

    // The components are not initialised, because this constructor runs in inner loops and each component is written
    // before it is read.
    Expansion() {}  // NOLINT(modernize-use-equals-default)
    explicit Expansion(const DoubleDouble& x) {
        static_assert(Capacity >= 2);
        append(x.lo);
        append(x.hi);
    }

    void append(double component) {
        if (component != 0.0) components[static_cast<std::size_t>(size++)] = component;
    }
    [[nodiscard]] double operator[](int i) const { return components[static_cast<std::size_t>(i)]; }
    /// Returns the sign of the number. It is the sign of the largest component, which exceeds the sum of the others in
    /// magnitude.
    [[nodiscard]] int sign() const {
        if (size == 0) return 0;
        return (*this)[size - 1] > 0.0 ? 1 : -1;
    }
};

/// Returns the exact sum (Shewchuk's fast-expansion-sum with zero elimination).
template <int M, int N>
[[nodiscard]] Expansion<M + N> operator+(const Expansion<M>& e, const Expansion<N>& f) {
    Expansion<M + N> sum;
    int i = 0;
    int j = 0;
    const auto next = [&] {
        const bool from_e = j == f.size || (i < e.size && std::fabs(e[i]) < std::fabs(f[j]));
        return from_e ? e[i++] : f[j++];
    };
    if (e.size + f.size == 0) return sum;
    double carried = next();
    while (i < e.size || j < f.size) {
        const DoubleDouble s = two_sum(carried, next());
        sum.append(s.lo);
        carried = s.hi;
    }
    sum.append(carried);
    return sum;
}

template <int N>
[[nodiscard]] Expansion<N> operator-(Expansion<N> e) {
    for (int i = 0; i < e.size; ++i) e.components[static_cast<std::size_t>(i)] = -e[i];
    return e;
}

template <int M, int N>
[[nodiscard]] Expansion<M + N> operator-(const Expansion<M>& e, const Expansion<N>& f) {
    return e + (-f);
}

/// Returns the exact product with a double (Shewchuk's scale-expansion with zero elimination).
template <int N>
[[nodiscard]] Expansion<2 * N> operator*(const Expansion<N>& e, double factor) {
    Expansion<2 * N> product;
    if (e.size == 0) return product;
    const DoubleDouble first = two_product(e[0], factor);
    product.append(first.lo);
    double carried = first.hi;
    for (int i = 1; i < e.size; ++i) {
        const DoubleDouble term = two_product(e[i], factor);
        const DoubleDouble low = two_sum(carried, term.lo);
        const DoubleDouble high = fast_two_sum(term.hi, low.hi);
        product.append(low.lo);
        product.append(high.lo);
        carried = high.hi;
    }
    product.append(carried);
    return product;
}

/// Returns the exact product with the sum of two doubles.
template <int N>
[[nodiscard]] Expansion<4 * N> operator*(const Expansion<N>& e, const DoubleDouble& factor) {
    return (e * factor.lo) + (e * factor.hi);
}

/// Returns the number rounded to double-double, with a relative error below 2^-100.
template <int N>
[[nodiscard]] DoubleDouble rounded(const Expansion<N>& e) {
    DoubleDouble sum;
    for (int i = 0; i < e.size; ++i) sum = sum + e[i];
    return sum;
}

/// The exact difference of two points. Each component is the sum of two doubles.
struct ExactDifference {
    DoubleDouble x;
    DoubleDouble y;
    DoubleDouble z;

    ExactDifference(const Vec3& to, const Vec3& from)
        : x(two_diff(to.x, from.x)), y(two_diff(to.y, from.y)), z(two_diff(to.z, from.z)) {}
    [[nodiscard]] Vec3 rounded() const { return {x.hi, y.hi, z.hi}; }
};

/// A number in double-double with a bound on its absolute error.
struct BoundedValue {
    DoubleDouble value;
    double error = 0.0;

    [[nodiscard]] bool sign_is_known() const { return std::fabs(value.hi) > error; }
    [[nodiscard]] bool is_accurate(double relative_error) const {
        return error <= relative_error * std::fabs(value.hi);
    }
};

/// The cross product u x v in double-double. Each component of `magnitude` is the sum of the magnitudes of that
/// component's two terms.
struct BoundedCross {
    // Local: half a unit in the last place of 1.
    static constexpr double kRoundoff = 0x1p-53;

    DoubleDouble x;
    DoubleDouble y;
    DoubleDouble z;
    Vec3 magnitude;

    BoundedCross(const ExactDifference& u, const ExactDifference& v)
        : x(u.y * v.z - u.z * v.y),
          y(u.z * v.x - u.x * v.z),
          z(u.x * v.y - u.y * v.x),
          magnitude(detail::filtered_cross(u.rounded(), v.rounded()).magnitude) {}

    /// Returns (u x v) . w with an error bound. Each of the six terms has the error of two products (7 u^2 each), a
    /// subtraction and at most two additions (3 u^2 each). The factor 32 u^2 also covers higher orders and the rounding
    /// of the magnitude.
    [[nodiscard]] BoundedValue dot(const ExactDifference& w) const {
        const double terms =
            magnitude.x * std::fabs(w.x.hi) + magnitude.y * std::fabs(w.y.hi) + magnitude.z * std::fabs(w.z.hi);
        return {x * w.x + y * w.y + z * w.z, 32.0 * kRoundoff * kRoundoff * terms};
    }
};

namespace detail {

using ExactMinor = Expansion<16>;
using ExactDeterminant = Expansion<192>;

/// Returns a d - b c exactly.
inline ExactMinor exact_minor(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                              const DoubleDouble& d) {
    return Expansion<2>(a) * d - Expansion<2>(b) * c;
}

/// Returns component 0, 1 or 2 of u x v.
inline ExactMinor exact_cross_component(const ExactDifference& u, const ExactDifference& v, int axis) {
    if (axis == 0) return exact_minor(u.y, u.z, v.y, v.z);
    if (axis == 1) return exact_minor(u.z, u.x, v.z, v.x);
    return exact_minor(u.x, u.y, v.x, v.y);
}

inline ExactDeterminant exact_determinant(const ExactDifference& u, const ExactDifference& v,
                                          const ExactDifference& w) {
    return exact_cross_component(u, v, 0) * w.x + exact_cross_component(u, v, 1) * w.y +
           exact_cross_component(u, v, 2) * w.z;
}

}  // namespace detail

}  // namespace ricochet
