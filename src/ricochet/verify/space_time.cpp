#include "ricochet/verify/space_time.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstddef>
#include <limits>
#include <utility>

#include "ricochet/verify/wide_vector.h"

namespace ricochet::verify {
namespace {

/// Largest number of successive halvings of the time interval, and largest number of pieces. Beyond these limits the
/// test ends undecided.
constexpr int kDeepest = 50;
constexpr int kMostPieces = 2000;

/// Numbers with 113 bits decide nearly all cases that doubles cannot decide. They cost a third of the time of numbers
/// with a hundred digits.
using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;
using Digits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_100::backend_type,
                                             boost::multiprecision::et_off>;

/// Returns the error bound of a sum of about a hundred rounded products, relative to the sum of their magnitudes.
template <class Real>
Real error_of() {
    return 1024 * std::numeric_limits<Real>::epsilon();
}

/// Certain signs of a set of values. The signs of other values may be decided with more digits.
struct Signs {
    bool all_positive = false;
    bool all_negative = false;
    bool any_positive = false;
    bool any_negative = false;
};

/// Largest degree of a factor of a product, and largest number of Bernstein coefficients of a product.
constexpr std::size_t kMostDegree = 3;
constexpr std::size_t kMostValues = kMostDegree + 2;

/// Bernstein coefficients of a polynomial in time. The polynomial lies between the smallest and the largest
/// coefficient. Each coefficient is stored with the sum of the magnitudes of its terms.
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

/// Weights for the product of two polynomials in Bernstein form. The degrees m and n of the polynomials are at most
/// kMostDegree.
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

/// Returns the product of two polynomials. Each of its coefficients is a weighted mean of products of the factors'
/// coefficients.
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

/// Returns the offset from one moving point to another as polynomials in time, over the fractions `begin` to `end` of
/// the time interval.
template <class Real>
Offset<Real> offset_of(const StepPath& from, const StepPath& to, double begin, double end) {
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

template <class Real>
Vector<Real> at(const StepPath& path, double part) {
    const Real rest = 1 - Real(part);
    Vector<Real> point;
    for (std::size_t k = 0; k < 3; ++k) {
        const int axis = static_cast<int>(k);
        point[k] = rest * Real(path.from[axis]) + Real(part) * Real(path.to[axis]);
    }
    return point;
}

/// Returns the direction or its opposite, such that its scalar product with the offset is not negative.
template <class Real>
Vector<Real> towards(const Vector<Real>& direction, const Vector<Real>& offset) {
    return product(direction, offset) < 0 ? times(Real(-1), direction) : direction;
}

template <class Real>
using Triple = std::array<Vector<Real>, 3>;

/// Returns the index of the first corner of the longest edge. The edge ends at the next corner.
template <class Real>
std::size_t longest_edge(const Triple<Real>& c) {
    std::size_t longest = 0;
    Real largest = -1;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector<Real> edge = less(c[(k + 1) % 3], c[k]);
        const Real squared = product(edge, edge);
        if (!(squared > largest)) continue;
        largest = squared;
        longest = k;
    }
    return longest;
}

/// Returns the parameter of the point on an edge that is nearest to a given point: 0 at the start of the edge, 1 at the
/// end. offset: from the start of the edge to the given point.
template <class Real>
Real part_of(const Vector<Real>& edge, const Vector<Real>& offset) {
    const Real squared = product(edge, edge);
    if (!(squared > 0)) return Real(0);
    const Real part = product(offset, edge) / squared;
    return part < 0 ? Real(0) : (part > 1 ? Real(1) : part);
}

class Pair {
public:
    Pair(const StepPath& point, const MovingCorners& triangle)
        : point_(point),
          corners_{StepPath{triangle.from.a, triangle.to.a}, StepPath{triangle.from.b, triangle.to.b},
                   StepPath{triangle.from.c, triangle.to.c}} {}

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
    /// Returns true if the point is proven to be apart from the triangle. It must be on one side of the triangle's
    /// plane, beyond one of the edges, or apart along a fixed direction, during the whole interval. Otherwise sets
    /// `is_in_doubt` if a computation with more digits could prove it.
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
        const std::array<Vector<Real>, 7> directions = directions_at<Real>(0.5 * (begin + end), begin, end);
        return std::any_of(directions.begin(), directions.end(), [&](const Vector<Real>& n) {
            Offset<Real> direction;
            for (std::size_t axis = 0; axis < 3; ++axis) direction[axis].add(n[axis], size_of(n[axis]));
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

    /// Returns candidate directions along which the point may be beyond the whole triangle. Near an edge, a direction
    /// perpendicular to the edge depends on the square of the distance, which doubles may lose. The last two directions
    /// are for triangles with almost no area, which are treated as their longest edge. The first of these leads from
    /// the edge to the point. The second is perpendicular to the edge and to the path of the point relative to the
    /// edge.
    template <class Real>
    [[nodiscard]] std::array<Vector<Real>, 7> directions_at(double middle, double begin, double end) const {
        const Vector<Real> p = at<Real>(point_, middle);
        const Triple<Real> c{at<Real>(corners_[0], middle), at<Real>(corners_[1], middle),
                             at<Real>(corners_[2], middle)};
        const Vector<Real> normal = across(less(c[1], c[0]), less(c[2], c[0]));
        const Vector<Real> from_center = less(times(Real(3), p), sum_of(c));
        const std::size_t k = longest_edge(c);
        const Vector<Real> edge = less(c[(k + 1) % 3], c[k]);
        const Real part = part_of(edge, less(p, c[k]));
        const auto away_from_edge = [&](double time) {
            const Vector<Real> first = at<Real>(corners_[k], time);
            const Vector<Real> along = less(at<Real>(corners_[(k + 1) % 3], time), first);
            return less(less(at<Real>(point_, time), first), times(part, along));
        };
        const Vector<Real> away = away_from_edge(middle);
        const Vector<Real> path = less(away_from_edge(end), away_from_edge(begin));
        return {from_center,
                across(less(c[1], c[0]), normal),
                across(less(c[2], c[1]), normal),
                across(less(c[0], c[2]), normal),
                towards(normal, less(p, c[0])),
                away,
                towards(across(edge, path), away)};
    }

    template <class Real>
    [[nodiscard]] static Vector<Real> sum_of(const Triple<Real>& c) {
        return {Real(c[0][0] + c[1][0] + c[2][0]), Real(c[0][1] + c[1][1] + c[2][1]),
                Real(c[0][2] + c[1][2] + c[2][2])};
    }

    StepPath point_;
    std::array<StepPath, 3> corners_;
    int pieces_ = 0;
};

}  // namespace

bool are_apart(const StepPath& point, const MovingCorners& triangle) {
    return Pair(point, triangle).is_apart(0.0, 1.0, kDeepest);
}

}  // namespace ricochet::verify
