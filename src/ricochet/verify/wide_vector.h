/// \file
/// Vectors of numbers that may have more digits than doubles. Private to the verifier.
#pragma once

#include <array>

#include "ricochet/core/vec3.h"

namespace ricochet::verify {

template <class Real>
using Vector = std::array<Real, 3>;

/// Returns to - from.
template <class Real>
Vector<Real> difference(const Vec3& to, const Vec3& from) {
    return {Real(Real(to.x) - Real(from.x)), Real(Real(to.y) - Real(from.y)), Real(Real(to.z) - Real(from.z))};
}

template <class Real>
Vector<Real> less(const Vector<Real>& a, const Vector<Real>& b) {
    return {Real(a[0] - b[0]), Real(a[1] - b[1]), Real(a[2] - b[2])};
}

template <class Real>
Vector<Real> times(const Real& factor, const Vector<Real>& a) {
    return {Real(factor * a[0]), Real(factor * a[1]), Real(factor * a[2])};
}

template <class Real>
Real product(const Vector<Real>& a, const Vector<Real>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Real>
Vector<Real> across(const Vector<Real>& a, const Vector<Real>& b) {
    return {Real(a[1] * b[2] - a[2] * b[1]), Real(a[2] * b[0] - a[0] * b[2]), Real(a[0] * b[1] - a[1] * b[0])};
}

}  // namespace ricochet::verify
