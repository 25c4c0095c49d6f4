/// \file
/// Private to the exact response: a contact interval on flat surfaces, under forces that may vary in it.
#pragma once

#include <optional>

#include "ricochet/geometry/sweep/path.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/response/turning_slip.h"

namespace ricochet {

/// A contact interval, and the forces per unit mass, in m/s^2, with which it was planned.
struct PlannedInterval {
    ContactInterval interval;
    Vec3 forces;
};

/// A contact interval along flat surfaces, planned with the forces at its start and in its middle. Accelerations are
/// linear in time through both values. This is the midpoint rule if the interval is completed, and still of second
/// order if it ends earlier. If the friction on a single surface changes its direction, the interval integrates the
/// slip equations instead, under constant forces.
class FlatInterval {
public:
    /// Creates an interval under constant forces.
    explicit FlatInterval(const PlannedInterval& plan) : begin_(plan), middle_(plan) {}
    FlatInterval(const PlannedInterval& begin, const PlannedInterval& middle)
        : begin_(begin), middle_(middle), varies_(true) {}
    FlatInterval(const PlannedInterval& plan, const TurningSlip& slip) : begin_(plan), middle_(plan), slip_(slip) {}

    [[nodiscard]] double duration() const { return middle_.interval.duration; }
    [[nodiscard]] const Motion& motion() const { return middle_.interval.motion; }
    /// Returns true if surface k presses on the particle in the middle of the interval.
    [[nodiscard]] bool is_held_by(std::size_t k) const { return middle_.interval.reaction[k] != Vec3{}; }
    /// Returns true if the path only approximates the motion between its ends, to fourth order.
    [[nodiscard]] bool turns() const { return slip_.has_value(); }
    /// Returns the path from x in the first `time` seconds.
    [[nodiscard]] Path path(const Vec3& x, double time) const;
    /// Returns an interval with constant accelerations and forces that gives the same motion after `time` seconds.
    [[nodiscard]] PlannedInterval mean_until(double time) const;
    /// Returns the work of the forces per unit mass, in m^2/s^2, in the first `time` seconds. displacement:
    /// displacement in this time, in m.
    [[nodiscard]] double work_until(double time, const Vec3& displacement) const;

private:
    PlannedInterval begin_;
    PlannedInterval middle_;
    bool varies_ = false;
    std::optional<TurningSlip> slip_{};
};

}  // namespace ricochet
