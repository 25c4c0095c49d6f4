/// \file
/// Slopes of errors on logarithmic axes, which give orders of convergence.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace ricochet::testing {

/// Returns the slope of log(y) against log(x) by least squares.
inline double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
    double sx = 0.0;
    double sy = 0.0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double u = std::log(x[k]);
        const double v = std::log(y[k]);
        sx += u;
        sy += v;
        sxx += u * u;
        sxy += u * v;
    }
    const auto n = static_cast<double>(x.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace ricochet::testing
