#include "ricochet/simulation/load_relaxation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ricochet {
namespace {

Wrench sum(const Wrench& a, double factor, const Wrench& b) {
    return {a.impulse + factor * b.impulse, a.moment + factor * b.moment};
}

/// Returns the inner product of two wrenches, weighted with the body's inverse mass and inertia.
double product(const DrivenBody& body, const Wrench& a, const Wrench& b) {
    return 0.5 * (body.quadratic_energy(sum(a, 1.0, b)) - body.quadratic_energy(sum(a, -1.0, b)));
}

}  // namespace

// The residual of the first load defines the direction in which loads are too small.
void LoadRelaxation::keep(const DrivenBody& body, const Wrench& planned, const Wrench& lacks) {
    const Tried tried{planned, lacks, std::sqrt(product(body, lacks, lacks))};
    const bool is_low = !low_ || product(body, lacks, low_->lacks) >= 0.0;
    std::optional<Tried>& replaced = is_low ? low_ : high_;
    std::optional<Tried>& other = is_low ? high_ : low_;
    if (replaced && other) other->size *= 0.5;
    replaced = last_ = tried;
}

Wrench LoadRelaxation::next(const DrivenBody& body, const Wrench& planned, const Wrench& back, double heaviness) {
    if (heaviness > 0.0) heaviness_ = heaviness;
    const Wrench lacks = sum(back, -1.0, planned);
    const std::optional<Tried> before = last_;
    fitting_ = sum(planned, 1.0 / (1.0 + heaviness_), lacks);
    keep(body, planned, lacks);
    if (low_ && high_) {
        const double both = low_->size + high_->size;
        const double part = both > 0.0 ? low_->size / both : 0.5;
        return sum(low_->load, part, sum(high_->load, -1.0, low_->load));
    }
    if (!(heaviness > 0.0)) return {};  // the body escapes from the load
    double factor = 1.0 / (1.0 + heaviness_);
    if (before) {  // Aitken's method: along the line through the last two
        const Wrench change = sum(lacks, -1.0, before->lacks);
        const double size = product(body, change, change);
        const double step =
            std::sqrt(product(body, sum(planned, -1.0, before->load), sum(planned, -1.0, before->load)));
        if (size > 0.0) factor = std::clamp(step / std::sqrt(size), factor, 1.0);
    }
    return sum(planned, factor, lacks);
}

// The load is taken to change evenly from that of the first plan.
Wrench LoadRelaxation::shortened(double part) {
    begin_search();
    return sum(first_, part, sum(fitting_, -1.0, first_));
}

Wrench LoadRelaxation::variation(const Wrench& planned, const Wrench& back, double heaviness) const {
    const double weight = heaviness > 0.0 ? heaviness : heaviness_;
    const Wrench fitting = sum(planned, 1.0 / (1.0 + weight), sum(back, -1.0, planned));
    return sum(fitting, -1.0, first_);
}

void LoadRelaxation::end_substep(const RestingLoad& resting_load) {
    if (resting_load.heaviness > 0.0) heaviness_ = resting_load.heaviness;
    is_heavy_ = resting_load.heaviness > kHeavyLoad;
}

}  // namespace ricochet
