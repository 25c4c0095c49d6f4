/// \file
/// Polynomials in Bernstein form with bounds on the rounding of their coefficients, and vectors of such polynomials.
/// Private to the separation tests of moving triangles.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "ricochet/geometry/predicates/exact_arithmetic.h"

namespace ricochet::bernstein {

/// Relative error bound of a coefficient, with a safety factor. It covers about a hundred roundings, each of 2^-53
/// (double) or 7 x 2^-106 (double-double). Local: an error bound of this arithmetic.
template <class Real>
constexpr double kError = 0x1p-44;
template <>
constexpr double kError<DoubleDouble> = 0x1p-92;

/// Smallest magnitude of a coefficient with a certain sign. Smaller coefficients may contain products that were rounded
/// to zero. Local: a guard against the end of the range of doubles.
inline constexpr double kSmallestCoefficient = 0x1p-900;

/// A polynomial in Bernstein form. The coefficients `c` are stored multiplied by the binomials, so the product of two
/// polynomials is a convolution. `size` has the same form and accumulates the magnitudes of all added terms.
template <class Real, std::size_t Degree>
struct Polynomial {
    std::array<Real, Degree + 1> c{};
    std::array<double, Degree + 1> size{};

    /// Returns true if all coefficients certainly have the given sign, +1 or -1.
    [[nodiscard]] bool has_sign(int sign) const {
        for (std::size_t k = 0; k <= Degree; ++k) {
            const double value = static_cast<double>(sign) * high(c[k]);
            if (!(size[k] > kSmallestCoefficient) || !(value > kError<Real> * size[k]) || !std::isfinite(value))
                return false;
        }
        return true;
    }
};

template <class Real, std::size_t M, std::size_t N>
Polynomial<Real, M + N> operator*(const Polynomial<Real, M>& a, const Polynomial<Real, N>& b) {
    Polynomial<Real, M + N> product;
    for (std::size_t i = 0; i <= M; ++i) {
        for (std::size_t j = 0; j <= N; ++j) {
            product.c[i + j] = product.c[i + j] + a.c[i] * b.c[j];
            product.size[i + j] += a.size[i] * b.size[j];
        }
    }
    return product;
}

/// Returns a + factor b.
template <class Real, std::size_t N>
Polynomial<Real, N> sum(const Polynomial<Real, N>& a, const Polynomial<Real, N>& b, const Real& factor) {
    Polynomial<Real, N> result;
    for (std::size_t k = 0; k <= N; ++k) {
        result.c[k] = a.c[k] + factor * b.c[k];
        result.size[k] = a.size[k] + std::fabs(high(factor)) * b.size[k];
    }
    return result;
}

/// Returns the same polynomial with a higher degree.
template <std::size_t To, class Real, std::size_t N>
Polynomial<Real, To> raised(const Polynomial<Real, N>& p) {
    static_assert(To >= N);
    if constexpr (To == N) {
        return p;
    } else {
        Polynomial<Real, N + 1> next;
        for (std::size_t k = 0; k <= N; ++k) {
            next.c[k] = next.c[k] + p.c[k];
            next.c[k + 1] = p.c[k];
            next.size[k] += p.size[k];
            next.size[k + 1] = p.size[k];
        }
        return raised<To>(next);
    }
}

template <class Real, std::size_t N>
using Vector = std::array<Polynomial<Real, N>, 3>;

template <class Real, std::size_t M, std::size_t N>
Polynomial<Real, M + N> dot(const Vector<Real, M>& a, const Vector<Real, N>& b) {
    return sum(sum(a[0] * b[0], a[1] * b[1], Real(1.0)), a[2] * b[2], Real(1.0));
}

template <class Real, std::size_t M, std::size_t N>
Vector<Real, M + N> cross(const Vector<Real, M>& a, const Vector<Real, N>& b) {
    const auto minor = [&](std::size_t i, std::size_t j) { return sum(a[i] * b[j], a[j] * b[i], Real(-1.0)); };
    return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

/// Returns a - b. The degree of b is at most that of a.
template <class Real, std::size_t M, std::size_t N>
Vector<Real, M> difference(const Vector<Real, M>& a, const Vector<Real, N>& b) {
    return {sum(a[0], raised<M>(b[0]), Real(-1.0)), sum(a[1], raised<M>(b[1]), Real(-1.0)),
            sum(a[2], raised<M>(b[2]), Real(-1.0))};
}

template <class Real, std::size_t N>
Vector<Real, N> negative(const Vector<Real, N>& a) {
    return difference(Vector<Real, N>{}, a);
}

}  // namespace ricochet::bernstein
