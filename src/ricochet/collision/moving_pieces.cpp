// Division of a MovingSweep's path into pieces.
#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/collision/broad_phase.h"
#include "ricochet/collision/moving_sweep.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Least distance of a cut at a deforming mesh's key from the ends of a path, as a fraction of the path's duration.
/// Local: a guard against pieces without duration.
constexpr double kLeastPart = 0x1p-45;

/// Divisor in the error bound of a cubic Hermite path: over a time h it deviates from the function by at most h^4 /
/// kHermiteError times the largest fourth derivative. Local: a bound of this interpolation.
constexpr double kHermiteError = 384.0;

/// Largest length, relative to a fine piece, of the rest of a path that is still taken as one fine piece. It covers
/// rounding. Local: it covers rounding, and only the cost depends on it.
constexpr double kAlmostOne = 1.0 + 1e-9;

/// Largest length of a piece without contacts, in fine pieces. The error of its cubic is larger by the fourth power of
/// this number. Local, because boxes are enlarged by that error, so only the cost depends on it.
constexpr double kLongestPiece = 16.0;

/// Largest number of fine pieces in sequence before a longer one is tried again.
constexpr int kMostFinePieces = 64;

}  // namespace

/// Cuts the path at the keys of all bodies nearby, and evenly between the keys.
void MovingSweep::cut() {
    const double duration = query_.path.duration;
    const PathClock& clock = view_.clock();
    if (view_.reference() == kWorldBody && lists_.near.empty() && deforming_.empty()) {
        lists_.cuts.assign({0.0, duration});
        return;
    }
    std::vector<double>& keys = lists_.keys;
    keys.assign(1, 0.0);
    const auto add_keys = [&](BodyId body) {
        double key = view_.bodies().next_key(body, clock.begin);
        for (int count = 0; count < kMostKeysInStep && key < clock.end;
             ++count, key = view_.bodies().next_key(body, key)) {
            const double at = key - clock.base - clock.offset;
            if (at > 0.0 && at < duration) keys.push_back(at);
        }
    };
    add_keys(view_.reference());
    for (const BodyId body : lists_.near) add_keys(body);
    for (const double key : deforming_keys()) keys.push_back(path_time_of(key));
    keys.push_back(duration);
    std::sort(keys.begin(), keys.end());
    find_rates();
    lists_.cuts.assign(1, 0.0);
    for (const double key : keys) {
        if (key > lists_.cuts.back()) lists_.cuts.push_back(key);
    }
    if (lists_.cuts.size() == 1) lists_.cuts.push_back(duration);
    if (deforming_.empty()) return;
    cut_finely();
    set_times();
}

void MovingSweep::find_rates() {
    lists_.fourth.clear();
    rate_ = 0.0;
    if (lists_.near.empty() && deforming_.empty()) return;
    const DerivativeBounds world = world_bounds();
    const auto rate_of = [](double fourth, double tolerance) {
        return std::sqrt(std::sqrt(fourth / (kHermiteError * tolerance)));
    };
    for (const BodyId body : lists_.near) {
        lists_.fourth.push_back(fourth_derivative(body, world));
        rate_ = std::max(rate_, rate_of(lists_.fourth.back(), tolerance_of(body)));
    }
    if (view_.reference() != kWorldBody && !deforming_.empty()) {
        rate_ = std::max(rate_, rate_of(fourth_derivative(kWorldBody, world), tolerance_of(kWorldBody)));
    }
}

double MovingSweep::pieces_within(double span) const {
    return std::clamp(std::ceil(span * rate_), 1.0, kMostMovingPieces);
}

void MovingSweep::cut_finely() {
    const std::vector<double> keys = std::exchange(lists_.cuts, {0.0});
    for (std::size_t k = 1; k < keys.size(); ++k) {
        const double span = keys[k] - keys[k - 1];
        const double count = pieces_within(span);
        for (double i = 1.0; i < count; ++i) lists_.cuts.push_back(keys[k - 1] + span * (i / count));
        lists_.cuts.push_back(keys[k]);
    }
}

/// Returns the end of the next piece, in s along the path: the next cut, or before it the end of a fine piece or of a
/// longer piece without contacts.
double MovingSweep::end_of_piece(const PathPoint& start) {
    is_clear_ = false;
    const double cut = lists_.cuts[next_];
    if (!deforming_.empty()) return cut;
    const double whole = cut - lists_.cuts[next_ - 1];
    const double fine = whole / pieces_within(whole);
    if (!(cut - begin_ > kAlmostOne * fine)) return cut;
    if (fine_left_ == 0) {
        const double clear = clear_until(start, fine);
        is_clear_ = clear > begin_;
        if (is_clear_) return clear;
        fine_left_ = fine_after_next_;
        fine_after_next_ = std::min(2 * fine_after_next_, kMostFinePieces);
    }
    --fine_left_;
    return begin_ + fine;
}

/// Returns the time, in s along the path, until which no surface of other frames comes near it. If that is within less
/// than a fine piece, returns the start of the piece. The search extends as far as the errors of the cubics are within
/// the margins of all bodies' boxes.
double MovingSweep::clear_until(const PathPoint& start, double fine) {
    double longest = kLongestPiece * fine;
    std::vector<double>& besides = lists_.besides;
    besides.clear();
    for (std::size_t k = 0; k < lists_.near.size(); ++k) {
        const CollisionWorld& world = view_.bodies().world(lists_.near[k]);
        double error = kLongestPiece * kLongestPiece * kLongestPiece * kLongestPiece * lists_.tolerances[k];
        if (!world.triangles().empty()) {
            error = std::min(error, (world.bvh_for(query_.radius).margin() - query_.radius) / 32.0);
        }
        longest = std::min(longest, std::sqrt(std::sqrt(kHermiteError * error / lists_.fourth[k])));
        // The pieces cut from it can deviate as much from the true path, on its other side.
        besides.push_back(beside_in_bodies() + 2.0 * error);
    }
    if (!(longest >= 2.0 * fine)) return begin_;
    set_piece(std::min(lists_.cuts[next_], begin_ + longest), start);
    const MovingView view(view_.bodies(), view_.reference(), clock_);
    double clear = piece_.duration;
    lists_.clear.clear();
    for (std::size_t k = 0; k < lists_.near.size() && clear > 0.0; ++k) {
        const CollisionWorld& world = view.bodies().world(lists_.near[k]);
        const Path& path = lists_.clear.emplace_back(path_in(lists_.near[k], view, {start.position, 0.0, start.world}));
        const QueryMargins margins(world, path, query_.radius, besides[k]);
        clear = std::min(clear, time_clear_of(world, margins, path, fine));
    }
    return clear < piece_.duration ? begin_ + clear : begin_ + piece_.duration;
}

/// Returns all keys of deforming meshes within the path's time, in s, if such a mesh is near.
std::vector<double> MovingSweep::deforming_keys() const {
    std::vector<double> keys;
    if (deforming_.empty()) return keys;
    const DeformingColliders& deforming = view_.bodies().deforming();
    const PathClock& clock = view_.clock();
    for (double key = deforming.next_key(clock.begin); key < clock.end; key = deforming.next_key(key)) {
        keys.push_back(key);
    }
    return keys;
}

/// Returns the time along the path of a key. It is inside the path even if rounding would put it at an end.
double MovingSweep::path_time_of(double key) const {
    const PathClock& clock = view_.clock();
    const double least = kLeastPart * query_.path.duration;
    return std::clamp(key - clock.base - clock.offset, least, query_.path.duration - least);
}

/// Sets the simulation times of the cuts. A piece that ends at a key ends exactly at the key's time.
void MovingSweep::set_times() {
    const PathClock& clock = view_.clock();
    const std::vector<double> keys = deforming_keys();
    times_.clear();
    for (const double cut : lists_.cuts) times_.push_back(clock.at(cut));
    times_.back() = clock.end;
    for (const double key : keys) {
        const auto at = std::find(lists_.cuts.begin(), lists_.cuts.end(), path_time_of(key)) - lists_.cuts.begin();
        for (std::ptrdiff_t k = 0; k < std::ssize(times_); ++k) {
            double& time = times_[static_cast<std::size_t>(k)];
            time = k < at ? std::min(time, key) : (k > at ? std::max(time, key) : key);
        }
    }
}

}  // namespace ricochet
