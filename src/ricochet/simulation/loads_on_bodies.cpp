#include "ricochet/simulation/loads_on_bodies.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "ricochet/simulation/impact_tally.h"

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

std::optional<std::size_t> LoadsOnBodies::body_of(const ColliderLoad& load) const {
    const BodyId id = colliders_->body_of(load.surface);
    const auto found = std::ranges::find(collider_of_, id);
    if (id == kWorldBody || found == collider_of_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - collider_of_.begin());
}

std::vector<Wrench> LoadsOnBodies::sums(std::span<const ColliderLoad> loads) const {
    std::vector<Wrench> wrenches(bodies_.size());
    for (const ColliderLoad& load : loads) {
        if (const auto body = body_of(load)) wrenches[*body] += wrench_of(load, bodies_[*body].moment_center());
    }
    return wrenches;
}

bool LoadsOnBodies::lies_on(std::size_t body, const ColliderLoad& load) const {
    return (!load.impact || load.approach <= slow_) && body_of(load) == body;
}

RestingLoad LoadsOnBodies::resting_load_on(std::size_t body, std::span<const ColliderLoad> loads, double until) const {
    RestingLoad resting_load;
    std::optional<std::uint64_t> last;
    for (const ColliderLoad& load : loads) {
        if (load.time > until || !lies_on(body, load)) continue;
        resting_load.wrench += wrench_of(load, bodies_[body].moment_center());
        const double size = dot(load.impulse, load.impulse);
        if (last == load.particle || !(size > 0.0)) continue;
        last = load.particle;
        resting_load.heaviness += heaviness_on(body, load);
    }
    return resting_load;
}

double LoadsOnBodies::left_at(std::size_t body, std::span<const ColliderLoad> loads) const {
    double all = 0.0;
    for (const ColliderLoad& load : loads) all += lies_on(body, load) ? length(load.impulse) : 0.0;
    double last = all > 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    for (const ColliderLoad& load : loads) {
        if (lies_on(body, load) && length(load.impulse) > kNegligibleLoad * all) last = std::max(last, load.time);
    }
    return last;
}

double LoadsOnBodies::heaviness_on(std::size_t body, const ColliderLoad& load) const {
    const double size = dot(load.impulse, load.impulse);
    if (!(size > 0.0)) return 0.0;
    const Wrench wrench = wrench_of(load, bodies_[body].moment_center());
    return load.mass * dot(bodies_[body].velocity_change(wrench, load.particle_center), load.impulse) / size;
}

// Stores a tried load as the low or high end of the search: low if its residual has the direction of the first one.
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
    if (!(heaviness > 0.0)) return {};  // the body escapes from the particles
    double factor = 1.0 / (1.0 + heaviness_);
    if (before) {  // Aitken's method, on the line through the last two loads
        const Wrench change = sum(lacks, -1.0, before->lacks);
        const double size = product(body, change, change);
        const double step =
            std::sqrt(product(body, sum(planned, -1.0, before->load), sum(planned, -1.0, before->load)));
        if (size > 0.0) factor = std::clamp(step / std::sqrt(size), factor, 1.0);
    }
    return sum(planned, factor, lacks);
}

// Assumes that the load changes linearly in time, from the load of the first plan to the fitting load.
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
