#include "ricochet/simulation/counters/counter.h"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

/// Smallest sine of the angle between the directions of a rectangle. Local: a limit of input values, far above rounding
/// and below any angle that is meant.
constexpr double kSmallestSine = 1e-9;

}  // namespace

bool has_two_sides(const RectangleCounter& rectangle) {
    const Vec3 normal = normalized(rectangle.normal / max_abs(rectangle.normal));
    const Vec3 along = normalized(rectangle.along / max_abs(rectangle.along));
    return length(cross(normal, along)) > kSmallestSine;
}

const char* name_of(PassageQuantity quantity) {
    constexpr std::array<const char*, 6> kNames{"speed", "angle", "radius", "spin", "energy", "time"};
    return kNames[static_cast<std::size_t>(quantity)];
}

double PassageHistogram::edge(std::size_t bin) const {
    const auto& [lower, upper] = description.range;
    if (bin >= description.bins) return upper;
    return lower + (upper - lower) * (static_cast<double>(bin) / description.bins);
}

double CounterTotals::transmission() const {
    if (particles == 0) return 0.0;
    return static_cast<double>(first_passage.count) / static_cast<double>(particles);
}

double CounterTotals::transmission_error() const {
    if (particles == 0) return 0.0;
    const double share = std::min(transmission(), 1.0);
    return std::sqrt(share * (1.0 - share) / static_cast<double>(particles));
}

}  // namespace ricochet
