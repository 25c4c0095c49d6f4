/// \file
/// Floating-point expansions: exact numbers as sums of doubles that do not overlap, in fixed storage on the stack.
///
/// Method: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
/// Discrete & Computational Geometry 18, 1997. Components stand in increasing order of magnitude, none is zero, and
/// every operation here keeps them strongly non-overlapping (rounding to nearest even). Exact as long as no component
/// overflows and none has bits below 2^-1074.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "ricochet/core/double_double.h"

namespace ricochet {

/// A number as the exact sum of at most Capacity doubles. Only the first `size` components have a value.
template <int Capacity>
struct Expansion {
    std::array<double, static_cast<std::size_t>(Capacity)> components;
    int size = 0;

    // No initialisation of the components: they are written before they are read, and this is an inner loop.
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
    /// Sign of the number: that of the largest component, which outweighs the others together.
    [[nodiscard]] int sign() const {
        if (size == 0) return 0;
        return (*this)[size - 1] > 0.0 ? 1 : -1;
    }
};

/// Exact sum (Shewchuk's fast-expansion-sum with zero elimination).
template <int M, int N>
[[nodiscard]] Expansion<M + N> operator+(const Expansion<M>& e, const Expansion<N>& f) {
    Expansion<M + N> sum;
    double carried = 0.0;
    int i = 0;
    int j = 0;
    while (i < e.size || j < f.size) {
        const bool from_e = j == f.size || (i < e.size && std::fabs(e[i]) < std::fabs(f[j]));
        const DoubleDouble s = two_sum(carried, from_e ? e[i++] : f[j++]);
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

/// Exact product with a double (Shewchuk's scale-expansion with zero elimination).
template <int N>
[[nodiscard]] Expansion<2 * N> operator*(const Expansion<N>& e, double factor) {
    Expansion<2 * N> product;
    double carried = 0.0;
    for (int i = 0; i < e.size; ++i) {
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

/// Exact product with the sum of two doubles.
template <int N>
[[nodiscard]] Expansion<4 * N> operator*(const Expansion<N>& e, const DoubleDouble& factor) {
    return (e * factor.lo) + (e * factor.hi);
}

/// The number rounded to double-double, relative error below 2^-100: summed from the smallest component up, each
/// addition errs by 2 u^2 of a partial sum, and partial sums of a strongly non-overlapping expansion shrink downwards.
template <int N>
[[nodiscard]] DoubleDouble rounded(const Expansion<N>& e) {
    DoubleDouble sum;
    for (int i = 0; i < e.size; ++i) sum = sum + e[i];
    return sum;
}

}  // namespace ricochet
