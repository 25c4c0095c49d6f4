/// \file
/// Times of pieces of work and what is made of several of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace ricochet::bench {

/// Runs the work and returns how long it took, s.
template <class Work>
[[nodiscard]] double time_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The middle value, or the mean of the middle two. At least one value.
[[nodiscard]] inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Median of numerators[i] / denominators[i], repeat by repeat, so that what slows both down drops out. Lists of the
/// same length.
[[nodiscard]] inline double median_ratio(const std::vector<double>& numerators,
                                         const std::vector<double>& denominators) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < numerators.size(); ++i) ratios.push_back(numerators[i] / denominators[i]);
    return median(ratios);
}

}  // namespace ricochet::bench
