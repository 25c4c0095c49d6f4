/// \file
/// Inverse of a cumulative distribution that has no closed form, by numerical integration of the density.
#pragma once

#include <functional>
#include <vector>

namespace ricochet {

/// Inverse cumulative distribution of a density between two ends. The cumulative distribution is exact within 1e-12 if
/// the density is smooth in each cell, because eight points integrate each cell (Gauss-Legendre quadrature).
class NumericQuantile {
public:
    /// density: >= 0, in any unit. cells: ascending ends of the cells, at least two. Throws InputError unless the
    /// integral of the density is finite and above 0.
    NumericQuantile(std::function<double(double)> density, std::vector<double> cells);

    /// Returns the value below which the fraction u of the distribution lies, 0 <= u < 1.
    [[nodiscard]] double operator()(double u) const;

private:
    [[nodiscard]] double integral(double from, double to) const;

    std::function<double(double)> density_;
    std::vector<double> cells_;
    std::vector<double> sums_;  // integrals from the first end to each end
};

}  // namespace ricochet
