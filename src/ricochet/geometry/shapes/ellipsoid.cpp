#include "ricochet/geometry/shapes/ellipsoid.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

using std::size_t;

/// Relative difference below which half axes are made equal. A rotation rounds the columns of a uniform scale by about
/// 2^-52. Local: rounding of an input value.
constexpr double kEqualAxes = 0x1p-49;

/// Maximum number of Newton steps for sigma. The method converges from below, at first cubically in the distance from a
/// pole and finally quadratically. At most a dozen steps were observed.
constexpr int kMaxSteps = 60;

/// Errors of a distance. The first one is relative to the distance. The second one applies away from the surface, and
/// is relative to the size of the shape and of the position. Both are four times the largest error observed in 40 000
/// random cases. Local: an error bound of this arithmetic.
constexpr double kRelativeError = 0x1p-48;
constexpr double kErrorOfSize = 0x1p-50;

double square(double x) { return x * x; }

std::array<double, 3> as_array(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

PreciseVec3 LocalPath::position(double s) const {
    const auto horner = [&](const std::array<DoubleDouble, 4>& m) {
        DoubleDouble sum = m[static_cast<size_t>(degree)];
        for (int k = degree - 1; k >= 0; --k) sum = sum * s + m[static_cast<size_t>(k)];
        return sum;
    };
    return {horner(component[0]), horner(component[1]), horner(component[2])};
}

Vec3 LocalPath::velocity(double s) const {
    const auto slope = [&](const std::array<DoubleDouble, 4>& m) {
        return m[1].hi + s * (2.0 * m[2].hi + s * (3.0 * m[3].hi));
    };
    return {slope(component[0]), slope(component[1]), slope(component[2])};
}

Vec3 LocalPath::acceleration(double s) const {
    const auto second = [&](const std::array<DoubleDouble, 4>& m) { return 2.0 * m[2].hi + s * (6.0 * m[3].hi); };
    return {second(component[0]), second(component[1]), second(component[2])};
}

Vec3 LocalPath::jerk() const { return {6.0 * component[0][3].hi, 6.0 * component[1][3].hi, 6.0 * component[2][3].hi}; }

Ellipsoid::Ellipsoid(const std::array<double, 3>& half_axes, int axes)
    : axes_(static_cast<size_t>(axes)), half_axes_(half_axes) {
    const double a = half_axes[0];
    const double b = half_axes[1];
    const double c = axes == 3 ? half_axes[2] : std::max(a, b);
    smallest_ = std::min({a, b, c});
    largest_ = std::max({a, b, c});
    is_round_ = largest_ - smallest_ <= kEqualAxes * smallest_;
    if (is_round_) {
        const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
        std::fill_n(half_axes_.begin(), axes_, middle);
        smallest_ = middle;
        largest_ = middle;
    }
    for (size_t i = 0; i < axes_; ++i) {
        const double half = half_axes_[i];
        weights_[i] = is_round_ ? DoubleDouble(1.0) : DoubleDouble(1.0) / two_product(half, half);
        ratio_[i] = square(half / smallest_);
        excess_[i] = (half - smallest_) / smallest_ * ((half + smallest_) / smallest_);
    }
    constant_ = is_round_ ? two_product(smallest_, smallest_) : DoubleDouble(1.0);
}

double Ellipsoid::value_error(const Vec3& y, double coordinate_error, double unit) const {
    const std::array<double, 3> magnitude = as_array(abs(y));
    double of_coordinates = 0.0;
    double terms = constant_.hi;
    for (size_t i = 0; i < axes_; ++i) {
        of_coordinates += weights_[i].hi * (2.0 * magnitude[i] + coordinate_error) * coordinate_error;
        terms += weights_[i].hi * square(magnitude[i]);
    }
    return (1.0 + 0x1p-40) * (of_coordinates + unit * terms);
}

Polynomial Ellipsoid::value_along(const LocalPath& path, int sign, const std::optional<DoubleDouble>& radius) const {
    Polynomial p;
    p.degree = 2 * path.degree;
    p.duration = path.duration;
    const auto degree = static_cast<size_t>(path.degree);
    for (size_t axis = 0; axis < axes_; ++axis) {
        const auto& m = path.component[axis];
        for (size_t i = 0; i <= degree; ++i) {
            const DoubleDouble weighted = is_round_ ? m[i] : weights_[axis] * m[i];
            p.coefficients[2 * i] = p.coefficients[2 * i] + weighted * m[i];
            for (size_t j = i + 1; j <= degree; ++j) {
                p.coefficients[i + j] = p.coefficients[i + j] + 2.0 * (weighted * m[j]);
            }
        }
    }
    p.coefficients[0] = p.coefficients[0] - (radius ? *radius * *radius : constant_);
    if (sign < 0) {
        for (DoubleDouble& c : p.coefficients) c = -c;
    }
    return p;
}

Vec3 Ellipsoid::normal_at(const Vec3& y) const {
    const Vec3 gradient{weights_[0].hi * y.x, weights_[1].hi * y.y, axes_ == 3 ? weights_[2].hi * y.z : 0.0};
    return normalized(gradient);
}

double Ellipsoid::support(const Vec3& n) const {
    const double sum = square(half_axes_[0] * n.x) + square(half_axes_[1] * n.y);
    return std::sqrt(axes_ == 3 ? sum + square(half_axes_[2] * n.z) : sum);
}

ShapePoint Ellipsoid::closest_point_of_round(const PreciseVec3& y) const {
    Vec3 radial = rounded(y);
    if (axes_ == 2) radial.z = 0.0;
    const double from_axis = length(radial);
    const double distance = value(y).hi / (from_axis + smallest_);
    const Vec3 normal = from_axis > 0.0 ? radial / from_axis : Vec3{1.0, 0.0, 0.0};
    Vec3 point = smallest_ * normal;
    if (axes_ == 2) point.z = y.z.hi;
    return {point, normal, distance};
}

double Ellipsoid::distance_error(double distance, const Vec3& y) const {
    const double relative = kRelativeError * std::fabs(distance);
    const bool is_near = std::fabs(distance) < 0.25 * square(smallest_) / largest_;
    return is_round_ || is_near ? relative : relative + kErrorOfSize * (length(y) + largest_);
}

/// Solves for sigma of the closest point. With t = distance / |gradient at the point|, the point is x_i = y_i a_i^2 /
/// (a_i^2 + t). Let sigma = 1 + t / smallest^2 and b_i = |y_i| a_i / smallest^2. The point lies on the surface if sum
/// (b_i / (excess_i + sigma))^2 = 1. The function returns the largest root, which is >= 0. A root of 0 means that y is
/// on the medial axis. This is possible only if b vanishes along the smallest axes.
double Ellipsoid::sigma_of(const std::array<double, 3>& y) const {
    std::array<double, 3> b{};
    double sum = 0.0;
    double largest_excess = 0.0;
    double sigma = 0.0;
    for (size_t i = 0; i < axes_; ++i) {
        b[i] = std::fabs(y[i]) / smallest_ * (half_axes_[i] / smallest_);
        sum += square(b[i]);
        largest_excess = std::max(largest_excess, excess_[i]);
        sigma = std::max(sigma, b[i] - excess_[i]);
    }
    sigma = std::max(sigma, std::sqrt(sum) - largest_excess);
    for (int step = 0; step < kMaxSteps; ++step) {
        double squares = 0.0;
        double cubes = 0.0;
        for (size_t i = 0; i < axes_; ++i) {
            if (b[i] == 0.0) continue;
            const double term = square(b[i] / (excess_[i] + sigma));
            squares += term;
            cubes += term / (excess_[i] + sigma);
        }
        if (sigma == 0.0 && squares <= 1.0) return 0.0;
        const double change = (std::sqrt(squares) - 1.0) * squares / cubes;
        const double next = std::max(sigma + change, 0.5 * sigma);
        if (std::fabs(next - sigma) <= 0x1p-51 * sigma) return next;
        sigma = next;
    }
    return sigma;
}

/// Makes two steps of Newton's method on value - sum (y_i / a_i)^2 (1 - (1 + tau_i)^-2) = 0 with tau_i = tau / ratio_i.
/// This form has no cancellation for small tau, so the relative error of tau is small.
double Ellipsoid::polished(double tau, const std::array<double, 3>& y, double value) const {
    for (int step = 0; step < 2; ++step) {
        double residual = value;
        double slope = 0.0;
        for (size_t i = 0; i < axes_; ++i) {
            const double q = square(y[i] / half_axes_[i]);
            const double tau_i = tau / ratio_[i];
            const double grown = 1.0 + tau_i;
            residual -= q * tau_i * (2.0 + tau_i) / square(grown);
            slope += 2.0 * q / (ratio_[i] * square(grown) * grown);
        }
        tau += residual / slope;
    }
    return tau;
}

ShapePoint Ellipsoid::closest_point(const PreciseVec3& y) const {
    if (is_round_) return closest_point_of_round(y);
    const std::array<double, 3> coordinates{y.x.hi, y.y.hi, y.z.hi};
    const double sigma = sigma_of(coordinates);
    double tau = sigma - 1.0;
    const double height = value(y).hi;
    if (sigma > 0.5 && height < 1.0) tau = polished(tau, coordinates, height);
    std::array<double, 3> point = coordinates;
    double rest = 1.0;  // remainder of sum (x_i / a_i)^2 = 1, for the smallest axis if y has no component along it
    for (size_t i = 0; i < axes_; ++i) {
        if (sigma == 0.0 && excess_[i] == 0.0) continue;
        // Deep inside, the form with sigma has no cancellation. Elsewhere, the form with tau has none.
        point[i] =
            sigma > 0.5 ? coordinates[i] / (1.0 + tau / ratio_[i]) : coordinates[i] * ratio_[i] / (excess_[i] + sigma);
        rest -= square(point[i] / half_axes_[i]);
    }
    if (sigma == 0.0) {
        const auto smallest = std::find(half_axes_.begin(), half_axes_.end(), smallest_) - half_axes_.begin();
        point[static_cast<size_t>(smallest)] = smallest_ * std::sqrt(std::max(0.0, rest));
    }
    Vec3 gradient;  // times smallest^2
    for (size_t i = 0; i < axes_; ++i) gradient[static_cast<int>(i)] = point[i] / ratio_[i];
    const double steepness = length(gradient);
    return {{point[0], point[1], point[2]}, gradient / steepness, tau * steepness};
}

}  // namespace ricochet
