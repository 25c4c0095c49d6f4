/// \file
/// Pearson's chi-square statistic and its critical value, for claims about distributions.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace ricochet::test {

/// Returns the sum of (observed - expected)^2 / expected.
inline double chi_square(const std::vector<double>& observed, const std::vector<double>& expected) {
    double sum = 0.0;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        sum += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
    }
    return sum;
}

/// Returns the value that chi-square with the given degrees of freedom exceeds with probability 1e-6.
/// Method: E. B. Wilson and M. M. Hilferty, "The distribution of chi-square", PNAS 17(12), 1931.
inline double chi_square_limit(std::size_t degrees_of_freedom) {
    const double z = 4.753424;  // one-sided 1e-6 quantile of the normal distribution
    const double c = 2.0 / (9.0 * static_cast<double>(degrees_of_freedom));
    return static_cast<double>(degrees_of_freedom) * std::pow(1.0 - c + z * std::sqrt(c), 3.0);
}

}  // namespace ricochet::test
