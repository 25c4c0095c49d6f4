#include "ricochet/verify/space_time.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace ricochet::verify {
namespace {

/// Halvings of the time, and pieces of it, before nothing is said.
constexpr int kDeepest = 50;
constexpr int kMostPieces = 2000;

/// Numbers of 113 bits tell nearly all that doubles leave in doubt, at a third of what a hundred digits cost.
using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;
using Digits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_100::backend_type,
                                             boost::multiprecision::et_off>;

/// What a sum of some hundred rounded products may err by, relative to the sum of magnitudes.
template <class Real>
Real error_of() {
    return 1024 * std::numeric_limits<Real>::epsilon();
}

/// What is certain of the signs of some values. What the others are more digits may tell.
struct Signs {
    bool all_positive = false;
    bool all_negative = false;
    bool any_positive = false;
    bool any_negative = false;
};

/// Of a factor, and of a product.
constexpr std::size_t kMostDegree = 3;
constexpr std::size_t kMostValues = kMostDegree + 2;

/// Values of a polynomial in time that is bounded by them (its Bernstein coefficients), each with the sum of magnitudes
/// that it was made from.
template <class Real>
struct Bounded {
    std::array<Real, kMostValues> values{};
    std::array<Real, kMostValues> sizes{};
    std::size_t count = 0;

    void add(const Real& value, const Real& size) {
        values[count] = value;
        sizes[count++] = size;
    }

    [[nodiscard]] Signs signs() const {
        Signs found{true, true, false, false};
        for (std::size_t k = 0; k < count; ++k) {
            const Real bound = error_of<Real>() * sizes[k];
            const bool is_known = bound > Real(1e-280);
            const bool is_positive = is_known && values[k] > bound;
            const bool is_negative = is_known && values[k] < -bound;
            found.all_positive = found.all_positive && is_positive;
            found.all_negative = found.all_negative && is_negative;
            found.any_positive = found.any_positive || is_positive;
            found.any_negative = found.any_negative || is_negative;
        }
        return found;
    }
};

template <class Real>
Real size_of(const Real& x) {
    return x < 0 ? Real(-x) : x;
}

double choose(std::size_t n, std::size_t k) {
    double value = 1.0;
    for (std::size_t i = 0; i < k; ++i) value = value * static_cast<double>(n - i) / static_cast<double>(i + 1);
    return value;
}

/// Of the products of values of two polynomials of degrees m and n, up to kMostDegree, in that of theirs.
template <class Real>
class Weights {
public:
    Weights() {
        for (std::size_t k = 0; k < weights_.size(); ++k) {
            const std::size_t m = k / (kSize * kSize * kSize);
            const std::size_t n = k / (kSize * kSize) % kSize;
            const std::size_t i = k / kSize % kSize;
            const std::size_t j = k % kSize;
            if (i <= m && j <= n) weights_[k] = Real(choose(m, i) * choose(n, j)) / Real(choose(m + n, i + j));
        }
    }
    [[nodiscard]] const Real& of(std::size_t m, std::size_t n, std::size_t i, std::size_t j) const {
        return weights_[((m * kSize + n) * kSize + i) * kSize + j];
    }

private:
    static constexpr std::size_t kSize = kMostDegree + 1;
    std::array<Real, kSize * kSize * kSize * kSize> weights_{};
};

/// The product: each value is the mean, with weights, of all products of two that it may come from.
template <class Real>
Bounded<Real> operator*(const Bounded<Real>& a, const Bounded<Real>& b) {
    const std::size_t m = a.count - 1;
    const std::size_t n = b.count - 1;
    static const Weights<Real> weights;
    Bounded<Real> product;
    for (std::size_t k = 0; k <= m + n; ++k) product.add(Real(0), Real(0));
    for (std::size_t i = 0; i <= m; ++i) {
        for (std::size_t j = 0; j <= n; ++j) {
            const Real& weight = weights.of(m, n, i, j);
            product.values[i + j] += weight * a.values[i] * b.values[j];
            product.sizes[i + j] += weight * a.sizes[i] * b.sizes[j];
        }
    }
    return product;
}

template <class Real>
Bounded<Real> combined(Bounded<Real> a, const Bounded<Real>& b, int sign) {
    for (std::size_t k = 0; k < a.count; ++k) {
        a.values[k] += sign * b.values[k];
        a.sizes[k] += b.sizes[k];
    }
    return a;
}

template <class Real>
using Offset = std::array<Bounded<Real>, 3>;

template <class Real>
Offset<Real> cross_of(const Offset<Real>& a, const Offset<Real>& b) {
    return {combined(a[1] * b[2], a[2] * b[1], -1), combined(a[2] * b[0], a[0] * b[2], -1),
            combined(a[0] * b[1], a[1] * b[0], -1)};
}

template <class Real>
Bounded<Real> dot_of(const Offset<Real>& a, const Offset<Real>& b) {
    return combined(combined(a[0] * b[0], a[1] * b[1], 1), a[2] * b[2], 1);
}

/// From one moving point to another, over a part of the time.
template <class Real>
Offset<Real> offset_of(const Way& from, const Way& to, double begin, double end) {
    Offset<Real> offset;
    for (int axis = 0; axis < 3; ++axis) {
        const Real first = Real(to.from[axis]) - Real(from.from[axis]);
        const Real last = Real(to.to[axis]) - Real(from.to[axis]);
        Bounded<Real>& bounded = offset[static_cast<std::size_t>(axis)];
        for (const double at : {begin, end}) {
            const Real part(at);
            bounded.add((1 - part) * first + part * last, (1 - part) * size_of(first) + part * size_of(last));
        }
    }
    return offset;
}

Vec3 at(const Way& way, double part) { return (1.0 - part) * way.from + part * way.to; }

/// From the nearest point of the longest edge to p: what has hardly an area is seen as that edge.
Vec3 away_from_longest_edge(const std::array<Vec3, 3>& corners, const Vec3& p) {
    Vec3 begin = corners[2];
    Vec3 edge = corners[0] - corners[2];
    for (std::size_t k = 0; k < 2; ++k) {
        const Vec3 other = corners[k + 1] - corners[k];
        if (dot(other, other) > dot(edge, edge)) begin = corners[k], edge = other;
    }
    const double squared = dot(edge, edge);
    if (!(squared > 0.0)) return p - begin;
    return p - begin - std::clamp(dot(p - begin, edge) / squared, 0.0, 1.0) * edge;
}

class Pair {
public:
    Pair(const Way& point, const MovingCorners& triangle)
        : point_(point),
          corners_{Way{triangle.from.a, triangle.to.a}, Way{triangle.from.b, triangle.to.b},
                   Way{triangle.from.c, triangle.to.c}} {}

    bool is_apart(double begin, double end, int depth) {
        bool is_in_doubt = false;
        if (is_apart_in<double>(begin, end, is_in_doubt)) return true;
        if (std::exchange(is_in_doubt, false) && is_apart_in<Quad>(begin, end, is_in_doubt)) return true;
        if (is_in_doubt && is_apart_in<Digits>(begin, end, is_in_doubt)) return true;
        if (depth == 0 || ++pieces_ > kMostPieces) return false;
        const double middle = 0.5 * (begin + end);
        return is_apart(begin, middle, depth - 1) && is_apart(middle, end, depth - 1);
    }

private:
    /// On one side of the plane all the time, beyond one of the edges, or apart along a direction. Where it is none of
    /// these `is_in_doubt` is set if more digits could tell otherwise.
    template <class Real>
    [[nodiscard]] bool is_apart_in(double begin, double end, bool& is_in_doubt) const {
        std::array<Offset<Real>, 3> to_point;
        std::array<Offset<Real>, 3> edges;
        for (std::size_t k = 0; k < 3; ++k) {
            to_point[k] = offset_of<Real>(corners_[k], point_, begin, end);
            edges[k] = offset_of<Real>(corners_[k], corners_[(k + 1) % 3], begin, end);
        }
        if (is_separated(to_point, begin, end, is_in_doubt)) return true;
        const Offset<Real> normal = cross_of(edges[0], edges[1]);
        const Signs side = dot_of(normal, to_point[0]).signs();
        if (side.all_positive || side.all_negative) return true;
        is_in_doubt = is_in_doubt || !(side.any_positive && side.any_negative);
        for (std::size_t k = 0; k < 3; ++k) {
            const Signs beyond = dot_of(cross_of(edges[k], normal), to_point[k]).signs();
            if (beyond.all_positive) return true;
            is_in_doubt = is_in_doubt || !beyond.any_negative;
        }
        return false;
    }

    template <class Real>
    [[nodiscard]] bool is_separated(const std::array<Offset<Real>, 3>& to_point, double begin, double end,
                                    bool& is_in_doubt) const {
        const double middle = 0.5 * (begin + end);
        const Vec3 p = at(point_, middle);
        const std::array<Vec3, 3> c{at(corners_[0], middle), at(corners_[1], middle), at(corners_[2], middle)};
        const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
        const std::array<Vec3, 6> directions{p - (c[0] + c[1] + c[2]) / 3.0,
                                             cross(c[1] - c[0], normal),
                                             cross(c[2] - c[1], normal),
                                             cross(c[0] - c[2], normal),
                                             dot(normal, p - c[0]) < 0.0 ? -normal : normal,
                                             away_from_longest_edge(c, p)};
        return std::any_of(directions.begin(), directions.end(), [&](const Vec3& n) {
            Offset<Real> direction;
            for (int axis = 0; axis < 3; ++axis) {
                direction[static_cast<std::size_t>(axis)].add(Real(n[axis]), Real(std::fabs(n[axis])));
            }
            bool is_beyond = true;
            for (const Offset<Real>& offset : to_point) {
                const Signs signs = dot_of(offset, direction).signs();
                if (signs.any_negative) return false;
                is_beyond = is_beyond && signs.all_positive;
            }
            is_in_doubt = is_in_doubt || !is_beyond;
            return is_beyond;
        });
    }

    Way point_;
    std::array<Way, 3> corners_;
    int pieces_ = 0;
};

}  // namespace

bool are_apart(const Way& point, const MovingCorners& triangle) {
    return Pair(point, triangle).is_apart(0.0, 1.0, kDeepest);
}

}  // namespace ricochet::verify
