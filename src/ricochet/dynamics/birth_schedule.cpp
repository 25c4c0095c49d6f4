#include "ricochet/dynamics/birth_schedule.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/portable_math.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace {

double rate_at(std::span<const RatePoint> curve, double time) {
    if (time <= curve.front().time) return curve.front().rate;
    if (time >= curve.back().time) return curve.back().rate;
    const auto is_after = [](double t, const RatePoint& point) { return t < point.time; };
    const auto after = std::upper_bound(curve.begin(), curve.end(), time, is_after);
    const RatePoint& before = *(after - 1);
    return before.rate + (after->rate - before.rate) * ((time - before.time) / (after->time - before.time));
}

}  // namespace

double births_of_curve(std::span<const RatePoint> curve, double from, double to) {
    if (curve.empty() || !(from < to)) return 0.0;
    double sum = 0.0;
    RatePoint last{from, rate_at(curve, from)};
    const auto advance = [&](const RatePoint& next) {
        sum += 0.5 * (last.rate + next.rate) * (next.time - last.time);
        last = next;
    };
    for (const RatePoint& point : curve) {
        if (point.time > from && point.time < to) advance(point);
    }
    const double end = rate_at(curve, to);
    if (last.rate > 0.0 || end > 0.0) advance({to, end});
    return sum;
}

BirthSchedule::BirthSchedule(BirthPlan plan) : plan_(std::move(plan)) {
    if (!plan_.curve.empty()) make_nodes();
    if (plan_.spacing == BirthSpacing::poisson) arrival_ = gap_after(0);
}

void BirthSchedule::make_nodes() {
    nodes_.push_back({{plan_.start, rate_at(plan_.curve, plan_.start)}, 0.0});
    for (const RatePoint& point : plan_.curve) {
        if (!(point.time > plan_.start)) continue;
        const Node& last = nodes_.back();
        const double area = 0.5 * (last.point.rate + point.rate) * (point.time - last.point.time);
        nodes_.push_back({point, last.integral + area});
    }
}

std::vector<DueBirth> BirthSchedule::take(double to, std::uint64_t most) {
    Taken taken{most, true};
    take(to, taken);
    return std::move(taken.list);
}

void BirthSchedule::skip(double to) {
    Taken taken{std::numeric_limits<std::uint64_t>::max(), false};
    take(to, taken);
}

void BirthSchedule::take(double to, Taken& taken) {
    if (plan_.start < to) {
        const std::uint64_t left = plan_.burst - burst_born_;
        burst_born_ += take_at(plan_.start, left, taken);
    }
    const double end = std::min(to, plan_.stop);
    if (!nodes_.empty()) {
        take_by_curve(end, taken);
    } else if (plan_.period_rate.spread == 0.0) {
        take_steady(end, taken);
    } else {
        take_redrawn(end, taken);
    }
}

// Takes up to `count` births at the given time, within the limits of the emitter and of the call. Returns the number
// taken.
std::uint64_t BirthSchedule::take_at(double time, std::uint64_t count, Taken& taken) {
    const std::uint64_t allowed = std::min({count, plan_.limit - born_, taken.most - taken.count});
    if (taken.is_listed) {
        for (std::uint64_t i = 0; i < allowed; ++i) taken.list.push_back({born_ + i, time});
    }
    born_ += allowed;
    taken.count += allowed;
    return allowed;
}

void BirthSchedule::take_by_rate(double time, Taken& taken) {
    rate_born_ += take_at(time, 1, taken);
    if (plan_.spacing == BirthSpacing::poisson) arrival_ += gap_after(rate_born_);
}

// Returns the integral of the rate at the next birth.
double BirthSchedule::target() const {
    return plan_.spacing == BirthSpacing::poisson ? arrival_ : static_cast<double>(rate_born_) + 0.5;
}

// Takes births at a constant rate, in closed form.
void BirthSchedule::take_steady(double to, Taken& taken) {
    const double rate = plan_.period_rate.mean * plan_.periods_per_second;
    if (!(rate > 0.0)) return;
    while (is_open(taken)) {
        const double time = plan_.start + target() / rate;
        if (time >= to) return;
        take_by_rate(time, taken);
    }
}

// Takes births period by period (seconds or frames). The state remains in the last period visited, where the next call
// continues.
void BirthSchedule::take_redrawn(double to, Taken& taken) {
    if (!(plan_.period_rate.mean + plan_.period_rate.spread > 0.0)) return;
    while (is_open(taken)) {
        const double rate = rate_in_period(period_);
        const double next_expected = expected_ + rate;
        if (target() < next_expected) {
            const double fraction = (target() - expected_) / rate;
            const double time = plan_.start + (static_cast<double>(period_) + fraction) / plan_.periods_per_second;
            if (time >= to) return;
            take_by_rate(time, taken);
        } else {
            if (plan_.start + static_cast<double>(period_ + 1) / plan_.periods_per_second >= to) return;
            expected_ = next_expected;
            ++period_;
        }
    }
}

// Takes births piece by piece of the curve. The integral of the rate is a parabola in each piece, inverted in closed
// form.
void BirthSchedule::take_by_curve(double to, Taken& taken) {
    while (is_open(taken)) {
        const Node& node = nodes_[period_];
        const bool is_last = period_ + 1 == nodes_.size();
        const double missing = std::max(0.0, target() - node.integral);
        double slope = 0.0;
        double end = std::numeric_limits<double>::infinity();
        if (!is_last) {
            const Node& next = nodes_[period_ + 1];
            end = next.point.time;
            slope = (next.point.rate - node.point.rate) / (end - node.point.time);
            if (target() >= next.integral) {
                if (end >= to) return;
                ++period_;
                continue;
            }
        }
        const double rate = node.point.rate;
        if (is_last && !(rate > 0.0)) return;
        const double root = std::sqrt(std::max(0.0, rate * rate + 2.0 * slope * missing));
        const double time = std::min(end, node.point.time + (missing > 0.0 ? 2.0 * missing / (rate + root) : 0.0));
        if (time >= to) return;
        take_by_rate(time, taken);
    }
}

double BirthSchedule::rate_in_period(std::uint64_t period) const {
    RandomSequence random(plan_.seed, plan_.rate_stream, period);
    return std::max(0.0, random.uniform_around(plan_.period_rate.mean, plan_.period_rate.spread));
}

// Returns the integral of the rate from one birth to the next one.
double BirthSchedule::gap_after(std::uint64_t birth) const {
    return -portable_log(1.0 - RandomSequence(plan_.seed, plan_.spacing_stream, birth).uniform());
}

}  // namespace ricochet
