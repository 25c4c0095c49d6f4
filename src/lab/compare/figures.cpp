#include "lab/compare/figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ricochet {
namespace {

constexpr double kHighShare = 0.95;

double median_of_sorted(const std::vector<double>& values) {
    if (values.empty()) return kNoNumber;
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double percentile_of_sorted(const std::vector<double>& values, double share) {
    if (values.empty()) return kNoNumber;
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
    return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

}  // namespace

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return median_of_sorted(values);
}

double percentile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return percentile_of_sorted(values, share);
}

ErrorSpread spread_of(const std::vector<double>& errors) {
    if (errors.empty()) return {};
    double squares = 0.0;
    for (const double error : errors) squares += error * error;
    std::vector<double> sorted = errors;
    std::sort(sorted.begin(), sorted.end());
    ErrorSpread spread;
    spread.count = errors.size();
    spread.median = median_of_sorted(sorted);
    spread.percentile_95 = percentile_of_sorted(sorted, kHighShare);
    spread.root_mean_square = std::sqrt(squares / static_cast<double>(errors.size()));
    spread.largest = sorted.back();
    return spread;
}

}  // namespace ricochet
