#include "ricochet/dynamics/numeric_quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

// Nodes and weights of the Gauss-Legendre rule with eight points on [-1, 1]. Local: constants of the method.
constexpr std::array<double, 4> kNodes{0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                                       0.96028985649753623168};
constexpr std::array<double, 4> kWeights{0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054,
                                         0.10122853629037625915};
/// Largest number of steps to a value. Bisection alone needs at most 60 for full accuracy in a cell.
constexpr int kMostSteps = 100;

}  // namespace

NumericQuantile::NumericQuantile(std::function<double(double)> density, std::vector<double> cells)
    : density_(std::move(density)), cells_(std::move(cells)), sums_{0.0} {
    for (std::size_t k = 1; k < cells_.size(); ++k) sums_.push_back(sums_.back() + integral(cells_[k - 1], cells_[k]));
    if (!(std::isfinite(sums_.back()) && sums_.back() > 0.0)) {
        throw InputError("the distribution cannot be integrated; expected values closer together");
    }
}

double NumericQuantile::integral(double from, double to) const {
    const double middle = 0.5 * (from + to);
    const double half = 0.5 * (to - from);
    double sum = 0.0;
    for (std::size_t k = 0; k < kNodes.size(); ++k) {
        sum += kWeights[k] * (density_(middle - half * kNodes[k]) + density_(middle + half * kNodes[k]));
    }
    return half * sum;
}

// Newton's method between bounds, which bisects if a step leaves them.
double NumericQuantile::operator()(double u) const {
    const double target = u * sums_.back();
    const auto above = std::upper_bound(sums_.begin(), sums_.end() - 1, target);
    const auto cell = std::max<std::ptrdiff_t>(above - sums_.begin(), 1);
    const double wanted = target - sums_[static_cast<std::size_t>(cell - 1)];
    const double begin = cells_[static_cast<std::size_t>(cell - 1)];
    double lower = begin;
    double upper = cells_[static_cast<std::size_t>(cell)];
    double x = 0.5 * (lower + upper);
    for (int step = 0; step < kMostSteps; ++step) {
        const double missing = wanted - integral(begin, x);
        (missing > 0.0 ? lower : upper) = x;
        const double rate = density_(x);
        const double next = x + (rate > 0.0 ? missing / rate : 0.0);
        const double better = next > lower && next < upper ? next : 0.5 * (lower + upper);
        if (std::fabs(better - x) <= 1e-15 * std::fabs(x)) return better;
        x = better;
    }
    return x;
}

}  // namespace ricochet
