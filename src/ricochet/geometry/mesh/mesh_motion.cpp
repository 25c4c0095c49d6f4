#include "ricochet/geometry/mesh/mesh_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Smallest time between two keys, as a fraction of the larger magnitude of their times. Local: a limit of input
/// values.
constexpr double kLeastSpacing = 0x1p-40;

[[noreturn]] void refuse(const std::string& what) { throw InputError("mesh that deforms: " + what); }

void require_times(const std::vector<double>& times, std::size_t keys) {
    if (times.size() != keys) {
        refuse("found " + std::to_string(times.size()) + " times for " + std::to_string(keys) +
               " sets of positions, expected one for each");
    }
    if (keys < 2) refuse("found " + std::to_string(keys) + " keys, expected at least 2");
    for (std::size_t k = 0; k < keys; ++k) {
        if (!std::isfinite(times[k]) || std::fabs(times[k]) > kLargestCoordinate) {
            refuse("the time of key " + std::to_string(k) + " is not finite or beyond 1e75 s");
        }
        if (k == 0) continue;
        const double least = kLeastSpacing * std::max(std::fabs(times[k]), std::fabs(times[k - 1]));
        if (times[k] - times[k - 1] > least) continue;
        refuse("the time of key " + std::to_string(k) + " is not after the one before, expected ascending times");
    }
}

void require_positions(const std::vector<std::vector<Vec3>>& positions) {
    for (std::size_t k = 0; k < positions.size(); ++k) {
        if (positions[k].size() != positions[0].size()) {
            refuse("found " + std::to_string(positions[k].size()) + " vertices at key " + std::to_string(k) +
                   ", expected the " + std::to_string(positions[0].size()) + " of the first");
        }
        for (const Vec3& p : positions[k]) {
            if (is_finite(p) && max_abs(p) <= kLargestCoordinate) continue;
            refuse("a vertex at key " + std::to_string(k) + " is not finite or beyond 1e75 m");
        }
    }
}

}  // namespace

MeshMotion::MeshMotion(std::vector<double> times, std::vector<std::vector<Vec3>> positions, MeshEnds ends)
    : times_(std::move(times)), positions_(std::move(positions)), ends_(ends) {
    require_times(times_, positions_.size());
    require_positions(positions_);
    if (ends_ == MeshEnds::repeat && positions_.front() != positions_.back()) {
        refuse("it repeats, and its last positions are not the first, expected the same");
    }
}

double MeshMotion::key_time(std::int64_t key) const {
    const auto in_round = static_cast<std::int64_t>(keys_a_round());
    std::int64_t round = key / in_round;
    if (key % in_round < 0) --round;
    const double period = times_.back() - times_.front();
    return times_[static_cast<std::size_t>(key - round * in_round)] + static_cast<double>(round) * period;
}

/// Returns the key before a time for repeating keys.
std::int64_t MeshMotion::key_before(double time) const {
    // Local: larger doubles have no fractional part.
    constexpr double kMostRounds = 0x1p52;
    const double period = times_.back() - times_.front();
    const double round = std::clamp(std::floor((time - times_.front()) / period), -kMostRounds, kMostRounds);
    const double local = time - round * period;
    const auto after = std::upper_bound(times_.begin(), times_.end() - 1, local);
    const auto in_round = static_cast<std::int64_t>(after - times_.begin()) - 1;
    std::int64_t key = static_cast<std::int64_t>(round) * static_cast<std::int64_t>(keys_a_round()) + in_round;
    while (key_time(key) > time) --key;
    while (key_time(key + 1) <= time) ++key;
    return key;
}

MeshMoment MeshMotion::at(double time) const {
    const auto between = [&](std::size_t k, double begin, double end) {
        return MeshMoment{positions_[k], positions_[k + 1], (time - begin) / (end - begin), end - begin};
    };
    if (ends_ == MeshEnds::repeat) {
        const std::int64_t key = key_before(time);
        const auto in_round = static_cast<std::int64_t>(keys_a_round());
        const auto k = static_cast<std::size_t>(((key % in_round) + in_round) % in_round);
        return between(k, key_time(key), key_time(key + 1));
    }
    if (time < times_.front()) return {positions_.front(), positions_.front(), 0.0, 0.0};
    if (time >= times_.back()) return {positions_.back(), positions_.back(), 0.0, 0.0};
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    const auto k = static_cast<std::size_t>(after - times_.begin()) - 1;
    return between(k, times_[k], times_[k + 1]);
}

double MeshMotion::next_key(double time) const {
    if (ends_ == MeshEnds::repeat) return key_time(key_before(time) + 1);
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    return after == times_.end() ? kInfinity : *after;
}

MeshMotion MeshMotion::mapped(const AffineMap& map) const {
    std::vector<std::vector<Vec3>> positions = positions_;
    for (std::vector<Vec3>& key : positions) {
        for (Vec3& p : key) p = flush_tiny(map.point(p));
    }
    return {times_, std::move(positions), ends_};
}

std::size_t MeshMotion::memory_bytes() const {
    return times_.capacity() * sizeof(double) +
           key_count() * (sizeof(std::vector<Vec3>) + vertex_count() * sizeof(Vec3));
}

MeshMotion sampled_motion(const std::function<std::vector<Vec3>(double time)>& positions_at, std::vector<double> times,
                          MeshEnds ends) {
    std::vector<std::vector<Vec3>> positions;
    positions.reserve(times.size());
    for (const double time : times) positions.push_back(positions_at(time));
    return {std::move(times), std::move(positions), ends};
}

}  // namespace ricochet
