#include "ricochet/core/keyed_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

bool is_good(double value) { return std::isfinite(value); }
bool is_good(const Vec3& value) { return is_finite(value); }

double magnitude_of(double value) { return std::fabs(value); }
double magnitude_of(const Vec3& value) { return length(value); }

// Returns the mean slope of the segment that begins at a key.
template <class Value>
Value chord_slope(const std::vector<CurveKey<Value>>& keys, std::size_t k) {
    return (keys[k + 1].value - keys[k].value) / (keys[k + 1].time - keys[k].time);
}

template <class Value>
void check(const std::vector<CurveKey<Value>>& keys, CurveEnds ends) {
    if (keys.empty()) throw InputError("a curve has no keys, expected at least one");
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (!std::isfinite(keys[k].time) || !is_good(keys[k].value)) {
            throw InputError(fmt::format("key {} of a curve is not finite", k));
        }
        if (k == 0) continue;
        if (!(keys[k - 1].time < keys[k].time)) {
            throw InputError(fmt::format("key {} of a curve is at {} s, expected a time after key {}'s {} s", k,
                                         keys[k].time, k - 1, keys[k - 1].time));
        }
        if (!is_good(chord_slope(keys, k - 1))) {
            throw InputError(fmt::format("keys {} and {} of a curve are too near in time for their values", k - 1, k));
        }
    }
    if (ends == CurveEnds::repeat && keys.size() < 2) {
        throw InputError("a curve that repeats has one key, expected at least two");
    }
}

// Returns the slope, at the key between two segments, of the parabola through the three keys of both segments.
template <class Value>
Value parabola_slope(double before, const Value& slope_before, double after, const Value& slope_after) {
    const double weight = before / (before + after);
    return slope_before + weight * (slope_after - slope_before);
}

/// Tridiagonal system with rows lower x_(k-1) + middle x_k + upper x_(k+1) = right.
struct Tridiagonal {
    std::vector<double> lower, middle, upper;

    /// Solves the system by elimination. In each row `middle` must exceed the sum of `lower` and `upper`.
    template <class Value>
    [[nodiscard]] std::vector<Value> solve(std::vector<Value> right) const {
        const std::size_t rows = middle.size();
        std::vector<double> pivot = middle;
        for (std::size_t k = 1; k < rows; ++k) {
            const double factor = lower[k] / pivot[k - 1];
            pivot[k] -= factor * upper[k - 1];
            right[k] = right[k] - factor * right[k - 1];
        }
        for (std::size_t k = rows; k-- > 0;) {
            if (k + 1 < rows) right[k] = right[k] - upper[k] * right[k + 1];
            right[k] = right[k] / pivot[k];
        }
        return right;
    }
};

/// Returns the slopes for which the second derivative is equal on both sides of every key. In the equation of a key,
/// the weight of a neighbour's slope is the inverse of the time between both keys. Curves with CurveEnds::hold have
/// slope 0 at both ends.
/// The first and the last key of a repeated curve are the same key, which couples the first and the last row. The
/// slopes are then the solution of T x = right, less a multiple of the solution of T z = corner. T is the tridiagonal
/// matrix without the coupling (J. Sherman, W. J. Morrison, Annals of Mathematical Statistics 21, 1950).
template <class Value>
std::vector<Value> smooth_slopes(const std::vector<CurveKey<Value>>& keys, bool repeats) {
    const std::size_t segments = keys.size() - 1;
    std::vector<Value> slopes(keys.size());
    if (repeats && segments == 1) slopes[0] = slopes[1] = chord_slope(keys, 0);
    if (segments < 2) return slopes;
    const std::size_t first = repeats ? 0 : 1;
    Tridiagonal system;
    std::vector<Value> right;
    for (std::size_t k = first; k < segments; ++k) {
        const std::size_t before = (k + segments - 1) % segments;
        system.lower.push_back(1.0 / (keys[before + 1].time - keys[before].time));
        system.upper.push_back(1.0 / (keys[k + 1].time - keys[k].time));
        system.middle.push_back(2.0 * (system.lower.back() + system.upper.back()));
        right.push_back(3.0 *
                        (system.lower.back() * chord_slope(keys, before) + system.upper.back() * chord_slope(keys, k)));
    }
    std::vector<double> corner(right.size(), 0.0);
    if (repeats) {
        corner.front() = corner.back() = system.lower.front();
        system.middle.front() -= corner.front();
        system.middle.back() -= corner.back();
    }
    const std::vector<Value> open = system.solve(right);
    const std::vector<double> closing = system.solve(corner);
    const Value share = (open.front() + open.back()) / (1.0 + closing.front() + closing.back());
    for (std::size_t k = 0; k < open.size(); ++k) {
        slopes[k + first] = repeats ? open[k] - closing[k] * share : open[k];
    }
    if (repeats) slopes.back() = slopes.front();
    return slopes;
}

}  // namespace

DerivativeBounds product(const DerivativeBounds& f, const DerivativeBounds& g) {
    constexpr std::array<DerivativeBounds, 5> kBinomials{
        {{1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}}};
    DerivativeBounds result{};
    for (std::size_t n = 0; n < result.size(); ++n) {
        for (std::size_t k = 0; k <= n; ++k) result[n] += kBinomials[n][k] * f[k] * g[n - k];
    }
    return result;
}

std::string_view name_of(Interpolation interpolation) {
    constexpr std::array<std::string_view, 4> kNames{"linear", "slow_in_slow_out", "spline", "cubic_spline"};
    const auto number = static_cast<std::size_t>(interpolation);
    return number < kNames.size() ? kNames[number] : "";
}

template <class Value>
KeyedCurve<Value>::KeyedCurve(const Value& constant) : keys_{{0.0, constant}}, slopes_{Value{}} {
    check(keys_, CurveEnds::hold);
}

template <class Value>
KeyedCurve<Value>::KeyedCurve(std::vector<CurveKey<Value>> keys, Interpolation interpolation, CurveEnds ends)
    : keys_(std::move(keys)), interpolation_(interpolation), ends_(ends) {
    if (name_of(interpolation).empty()) throw InputError("a curve has an interpolation that does not exist");
    if (ends != CurveEnds::hold && ends != CurveEnds::repeat) throw InputError("a curve has ends that do not exist");
    check(keys_, ends_);
    if (interpolation == Interpolation::cubic_spline) {
        slopes_ = smooth_slopes(keys_, ends_ == CurveEnds::repeat);
    } else {
        set_slopes();
    }
}

// A curve with CurveEnds::hold has slope 0 at both ends. In a repeated curve, the last segment precedes the first key.
template <class Value>
void KeyedCurve<Value>::set_slopes() {
    const std::size_t count = keys_.size();
    slopes_.assign(count, Value{});
    const auto span = [&](std::size_t k) { return keys_[k + 1].time - keys_[k].time; };
    for (std::size_t k = 1; k + 1 < count; ++k) {
        slopes_[k] = parabola_slope(span(k - 1), chord_slope(keys_, k - 1), span(k), chord_slope(keys_, k));
    }
    if (ends_ == CurveEnds::hold) return;
    slopes_.front() = parabola_slope(span(count - 2), chord_slope(keys_, count - 2), span(0), chord_slope(keys_, 0));
    slopes_.back() = slopes_.front();
}

template <class Value>
bool KeyedCurve<Value>::is_held(double time) const {
    return ends_ == CurveEnds::hold && !(time >= keys_.front().time && time < keys_.back().time);
}

template <class Value>
typename KeyedCurve<Value>::Phase KeyedCurve<Value>::phase_of(double time) const {
    const double first = keys_.front().time;
    const double last = keys_.back().time;
    if (ends_ == CurveEnds::hold || (time >= first && time < last)) return {std::clamp(time, first, last), 0.0};
    const double period = last - first;
    double rounds = std::floor((time - first) / period);
    double phase = time - rounds * period;
    if (phase >= last) {  // caused by rounding
        phase = first;
        rounds += 1.0;
    }
    return {std::max(phase, first), rounds};
}

template <class Value>
std::size_t KeyedCurve<Value>::segment_at(double time) const {
    const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                        [](double t, const CurveKey<Value>& key) { return t < key.time; });
    const auto next = static_cast<std::size_t>(after - keys_.begin());
    return std::min(std::max<std::size_t>(next, 1), keys_.size() - 1) - 1;
}

template <class Value>
Value KeyedCurve<Value>::value(double time) const {
    if (is_held(time)) return time < keys_.front().time ? keys_.front().value : keys_.back().value;
    const auto [phase, rounds] = phase_of(time);
    const std::size_t k = segment_at(phase);
    const double span = keys_[k + 1].time - keys_[k].time;
    const double s = (phase - keys_[k].time) / span;
    const Value change = keys_[k + 1].value - keys_[k].value;
    const double ease = s * s * (3.0 - 2.0 * s);
    Value value = keys_[k].value + (interpolation_ == Interpolation::linear ? s : ease) * change;
    if (is_spline()) {
        const double r = 1.0 - s;
        value += (span * s * r) * (r * slopes_[k] - s * slopes_[k + 1]);
    }
    return rounds == 0.0 ? value : value + rounds * (keys_.back().value - keys_.front().value);
}

template <class Value>
Value KeyedCurve<Value>::derivative(double time) const {
    if (is_held(time)) return Value{};
    const double phase = phase_of(time).time;
    const std::size_t k = segment_at(phase);
    const Value chord = chord_slope(keys_, k);
    if (interpolation_ == Interpolation::linear) return chord;
    const double s = (phase - keys_[k].time) / (keys_[k + 1].time - keys_[k].time);
    const double r = 1.0 - s;
    const Value eased = (6.0 * s * r) * chord;
    if (interpolation_ == Interpolation::slow_in_slow_out) return eased;
    return eased + (r * (1.0 - 3.0 * s)) * slopes_[k] + (s * (3.0 * s - 2.0)) * slopes_[k + 1];
}

template <class Value>
Value KeyedCurve<Value>::second_derivative(double time) const {
    if (is_held(time) || interpolation_ == Interpolation::linear) return Value{};
    const double phase = phase_of(time).time;
    const std::size_t k = segment_at(phase);
    const double span = keys_[k + 1].time - keys_[k].time;
    const double s = (phase - keys_[k].time) / span;
    const Value eased = ((6.0 - 12.0 * s) / span) * chord_slope(keys_, k);
    if (!is_spline()) return eased;
    return eased + ((6.0 * s - 4.0) / span) * slopes_[k] + ((6.0 * s - 2.0) / span) * slopes_[k + 1];
}

/// Extends the bounds to include the cubic on a segment. The factors in its derivatives have these bounds for s from 0
/// to 1: |6 s (1 - s)| <= 3/2, |6 - 12 s| <= 6, |(1 - s) (1 - 3 s)| <= 1, |6 s - 4| <= 4.
template <class Value>
void KeyedCurve<Value>::include_segment(std::size_t k, DerivativeBounds& bounds) const {
    const double span = keys_[k + 1].time - keys_[k].time;
    const double chord = magnitude_of(chord_slope(keys_, k));
    const bool is_linear = interpolation_ == Interpolation::linear;
    const double slopes = is_spline() ? magnitude_of(slopes_[k]) + magnitude_of(slopes_[k + 1]) : 0.0;
    const auto include = [&](std::size_t order, double size) { bounds[order] = std::max(bounds[order], size); };
    include(1, is_linear ? chord : 1.5 * chord + slopes);
    if (is_linear) return;
    include(2, (6.0 * chord + 4.0 * slopes) / span);
    include(3, (12.0 * chord + 6.0 * slopes) / span / span);
}

template <class Value>
DerivativeBounds KeyedCurve<Value>::bounds(double from, double to) const {
    DerivativeBounds bounds{};
    const bool repeats = ends_ == CurveEnds::repeat;
    for (std::size_t k = 0; k + 1 < keys_.size(); ++k) {
        if (repeats || (keys_[k].time < to && keys_[k + 1].time > from)) include_segment(k, bounds);
    }
    bounds[0] = magnitude_of(value(from)) + bounds[1] * (to - from);
    return bounds;
}

template <class Value>
double KeyedCurve<Value>::next_key(double time) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    if (ends_ == CurveEnds::hold && time >= keys_.back().time) return kNever;
    if (ends_ == CurveEnds::hold && time < keys_.front().time) return keys_.front().time;
    const auto [phase, rounds] = phase_of(time);
    const double offset = rounds * (keys_.back().time - keys_.front().time);
    for (std::size_t k = segment_at(phase); k < keys_.size(); ++k) {
        if (keys_[k].time + offset > time) return keys_[k].time + offset;
    }
    return kNever;
}

template class KeyedCurve<double>;
template class KeyedCurve<Vec3>;

}  // namespace ricochet
