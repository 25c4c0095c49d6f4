/// \file
/// Timing of functions, and statistics of times.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace ricochet::bench {

/// Calls `work` and returns the duration of the call, in s.
template <class Work>
[[nodiscard]] double time_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Returns the middle value, or the mean of the two middle values if their number is even. Requires at least one value.
[[nodiscard]] inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Returns the median of numerators[i] / denominators[i]. Noise that slows both times of a repeat cancels in their
/// ratio. Both lists must have the same length.
[[nodiscard]] inline double median_ratio(const std::vector<double>& numerators,
                                         const std::vector<double>& denominators) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < numerators.size(); ++i) ratios.push_back(numerators[i] / denominators[i]);
    return median(ratios);
}

}  // namespace ricochet::bench
