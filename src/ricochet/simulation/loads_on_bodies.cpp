#include "ricochet/simulation/loads_on_bodies.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/impact_tally.h"

namespace ricochet {

std::optional<std::size_t> LoadsOnBodies::body_of(const ColliderLoad& load) const {
    if (colliders_ == nullptr) return std::nullopt;
    const BodyId id = colliders_->body_of(load.surface);
    const auto found = std::find(collider_of_.begin(), collider_of_.end(), id);
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

}  // namespace ricochet
