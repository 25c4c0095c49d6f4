/// \file
/// Times of the births of one emitter. They depend only on the plan, not on the division of time into calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/dynamics/distribution.h"

namespace ricochet {

/// Scheduled birth.
struct DueBirth {
    std::uint64_t number = 0;  ///< number of the birth within its emitter
    double time = 0.0;         ///< in s
};

/// Spacing of the births of a rate.
enum class BirthSpacing {
    regular,  ///< birth k when the integral of the rate reaches k + 1/2
    poisson,  ///< independent births: gaps of the integral are exponential numbers of mean 1
};

/// Point of a rate that changes over time.
struct RatePoint {
    double time = 0.0;  ///< simulation time, in s
    double rate = 0.0;  ///< particles per second, >= 0
};

/// Returns the integral of a rate over [from, to]. The rate is linear between the points, and constant before the first
/// and after the last one.
[[nodiscard]] double births_of_curve(std::span<const RatePoint> curve, double from, double to);

/// Rules of a schedule.
struct BirthPlan {
    std::uint64_t burst = 0;                                          ///< births at `start`
    std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();  ///< largest number of births
    double start = 0.0;                                               ///< in s
    double stop = std::numeric_limits<double>::infinity();            ///< end of the births by a rate, in s
    MeanSpread period_rate;                                           ///< births per period, drawn for every period
    double periods_per_second = 1.0;
    std::vector<RatePoint> curve{};  ///< rate instead of period_rate, if it is not empty; ascending times
    BirthSpacing spacing = BirthSpacing::regular;
    std::uint64_t seed = 0;
    std::uint32_t rate_stream = 0;     ///< stream of the rates that are drawn for the periods
    std::uint32_t spacing_stream = 0;  ///< stream of the gaps of BirthSpacing::poisson
};

/// Births of an emitter in the order of time.
class BirthSchedule {
public:
    explicit BirthSchedule(BirthPlan plan);

    /// Returns the next births before a time, in s, at most `most`. The next call continues after them.
    [[nodiscard]] std::vector<DueBirth> take(double to, std::uint64_t most);
    /// Skips all remaining births before a time, in s.
    void skip(double to);
    /// Returns the number of births taken or skipped so far.
    [[nodiscard]] std::uint64_t born() const { return born_; }

private:
    /// Births taken from the schedule.
    struct Taken {
        std::uint64_t most;  ///< largest allowed count
        bool is_listed;      ///< true: the births are stored in `list`
        std::uint64_t count = 0;
        std::vector<DueBirth> list{};
    };
    /// Point of the curve with the integral of the rate from `start` to it.
    struct Node {
        RatePoint point;
        double integral = 0.0;
    };
    void take(double to, Taken& taken);
    std::uint64_t take_at(double time, std::uint64_t count, Taken& taken);
    void take_by_rate(double time, Taken& taken);
    void take_steady(double to, Taken& taken);
    void take_redrawn(double to, Taken& taken);
    void take_by_curve(double to, Taken& taken);
    void make_nodes();
    [[nodiscard]] bool is_open(const Taken& taken) const { return born_ < plan_.limit && taken.count < taken.most; }
    [[nodiscard]] double rate_in_period(std::uint64_t period) const;
    [[nodiscard]] double gap_after(std::uint64_t birth) const;
    [[nodiscard]] double target() const;

    BirthPlan plan_;
    std::vector<Node> nodes_;
    std::uint64_t born_ = 0;
    std::uint64_t burst_born_ = 0;
    std::uint64_t rate_born_ = 0;
    std::uint64_t period_ = 0;  // whole periods since start that are included in expected_, or index of a node
    double expected_ = 0.0;     // integral of the rate up to period_
    double arrival_ = 0.0;      // integral of the rate at the next birth of BirthSpacing::poisson
};

}  // namespace ricochet
