/// \file
/// Private to the exact response: one contact interval on flat surfaces under forces that may vary in it.
#pragma once

#include "ricochet/geometry/sweep/path.h"
#include "ricochet/response/contact_interval.h"

namespace ricochet {

/// A contact interval and the forces that it was planned with, over the mass, m/s^2.
struct PlannedInterval {
    ContactInterval interval;
    Vec3 forces;
};

/// A contact interval along flat surfaces, as planned with the forces of its start and of its middle. In between
/// accelerations change evenly: the midpoint rule at its end, and of second order wherever something else ends it.
class FlatInterval {
public:
    /// Under forces that stay as they are.
    explicit FlatInterval(const PlannedInterval& plan) : begin_(plan), middle_(plan), varies_(false) {}
    FlatInterval(const PlannedInterval& begin, const PlannedInterval& middle)
        : begin_(begin), middle_(middle), varies_(true) {}

    [[nodiscard]] double duration() const { return middle_.interval.duration; }
    [[nodiscard]] const Motion& motion() const { return middle_.interval.motion; }
    /// Whether a surface holds it in its middle.
    [[nodiscard]] bool is_held_by(std::size_t k) const { return middle_.interval.reaction[k] != Vec3{}; }
    /// The way from x, as far as it goes in `time` seconds.
    [[nodiscard]] Path path(const Vec3& x, double time) const;
    /// The same motion after `time` seconds, with accelerations and forces that stay.
    [[nodiscard]] PlannedInterval mean_until(double time) const;
    /// Work of the forces over the mass, m^2/s^2, in the first `time` seconds, which lead this way.
    [[nodiscard]] double work_until(double time, const Vec3& displacement) const;

private:
    PlannedInterval begin_;
    PlannedInterval middle_;
    bool varies_;
};

}  // namespace ricochet
