#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/stability.h"

namespace ricochet {

namespace {

class Gravity final : public Force {
public:
    explicit Gravity(const Vec3& acceleration) : acceleration_(acceleration) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput&) const override { return acceleration_; }
    // The potential is zero at the world's origin.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return -input.mass * dot(acceleration_, input.position);
    }
    [[nodiscard]] bool is_uniform() const override { return true; }
    [[nodiscard]] bool is_conservative() const override { return true; }
    [[nodiscard]] std::optional<Vec3> common_acceleration() const override { return acceleration_; }

private:
    Vec3 acceleration_;
};

enum class Returns { force, acceleration };

class CallableForce final : public Force {
public:
    CallableForce(std::function<Vec3(const ForceInput&)> call, Returns returns, CallableTraits traits)
        : call_(std::move(call)), returns_(returns), traits_(std::move(traits)) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        return returns_ == Returns::force ? call_(input) / input.mass : call_(input);
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        if (!traits_.potential) return std::nullopt;
        return traits_.potential(input);
    }
    [[nodiscard]] bool is_uniform() const override { return traits_.is_uniform; }
    [[nodiscard]] bool is_steady() const override { return traits_.is_uniform || traits_.is_steady; }
    [[nodiscard]] bool is_conservative() const override { return traits_.is_conservative && traits_.potential; }

private:
    std::function<Vec3(const ForceInput&)> call_;
    Returns returns_;
    CallableTraits traits_;
};

// Force on selected particles. The force is never uniform, because it does not act on the other particles.
class ForceOnSome final : public Force {
public:
    ForceOnSome(std::vector<std::uint64_t> ids, std::unique_ptr<Force> force)
        : ids_(std::move(ids)), force_(std::move(force)) {
        std::ranges::sort(ids_);
    }
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        return holds(input.id) ? force_->acceleration(input) : Vec3{};
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return holds(input.id) ? force_->potential_energy(input) : 0.0;
    }
    [[nodiscard]] bool is_steady() const override { return force_->is_steady(); }
    [[nodiscard]] bool is_conservative() const override { return force_->is_conservative(); }
    [[nodiscard]] bool needs_temperature() const override { return force_->needs_temperature(); }
    [[nodiscard]] const Force& force() const { return *force_; }

private:
    [[nodiscard]] bool holds(std::uint64_t id) const { return std::ranges::binary_search(ids_, id); }

    std::vector<std::uint64_t> ids_;  // sorted
    std::unique_ptr<Force> force_;
};

ForceInput whole(ForceInput input) {
    input.radius = std::exchange(input.whole_radius, 0.0);
    return input;
}

/// Returns true if a force in this state must be finite. Integrators may try states that are out of range.
bool is_in_range(const ForceInput& input) {
    return is_finite(input.position) && is_finite(input.velocity) && max_abs(input.position) <= kLargestJudged &&
           max_abs(input.velocity) <= kLargestJudged;
}

void refuse_if_not_finite(const std::vector<std::unique_ptr<Force>>& forces, const ForceInput& input) {
    for (std::size_t k = 0; k < forces.size() && is_in_range(input); ++k) {
        const std::optional<EnergyLaw> law = energy_law_of(*forces[k]);
        if (law && law->varies) continue;  // a valid force of this kind can overflow, for example next to its centre
        const Vec3 a = forces[k]->acceleration(input);
        if (is_finite(a)) continue;
        const Vec3& x = input.position;
        throw RunError(
            fmt::format("forces[{}]: found the acceleration [{}, {}, {}] m/s^2 of particle {} at [{:.6g}, {:.6g}, "
                        "{:.6g}] m and {:.6g} s, expected finite numbers",
                        k, a.x, a.y, a.z, input.id, x.x, x.y, x.z, input.time));
    }
}

std::vector<std::unique_ptr<Force>> without_null(std::vector<std::unique_ptr<Force>> forces) {
    for (std::size_t k = 0; k < forces.size(); ++k) {
        if (!forces[k]) throw InputError(fmt::format("force {}: found a null pointer, expected a force", k));
    }
    return forces;
}

}  // namespace

std::unique_ptr<Force> make_force_on(std::vector<std::uint64_t> particles, std::unique_ptr<Force> force) {
    if (!force) throw InputError("force on some particles: there is no force");
    return std::make_unique<ForceOnSome>(std::move(particles), std::move(force));
}

bool is_drag(const Force& force) {
    const auto* const on_some = dynamic_cast<const ForceOnSome*>(&force);
    return on_some ? is_drag(on_some->force()) : is_drag_law(force);
}

std::optional<EnergyLaw> energy_law_of(const Force& force) {
    if (force.common_acceleration()) return EnergyLaw{};
    const auto* const on_some = dynamic_cast<const ForceOnSome*>(&force);
    return on_some ? energy_law_of(on_some->force()) : energy_law_of_global_force(force);
}

std::unique_ptr<Force> make_gravity(const Vec3& acceleration) {
    detail::require_finite(acceleration, "gravity: the acceleration", "m/s^2");
    return std::make_unique<Gravity>(acceleration);
}

std::unique_ptr<Force> make_force(std::function<Vec3(const ForceInput&)> force, CallableTraits traits) {
    if (!force) throw InputError("force: an empty function cannot be called");
    return std::make_unique<CallableForce>(std::move(force), Returns::force, std::move(traits));
}

std::unique_ptr<Force> make_acceleration(std::function<Vec3(const ForceInput&)> acceleration, CallableTraits traits) {
    if (!acceleration) throw InputError("acceleration: an empty function cannot be called");
    return std::make_unique<CallableForce>(std::move(acceleration), Returns::acceleration, std::move(traits));
}

ForceField::ForceField(std::vector<std::unique_ptr<Force>> forces, bool adds_coupling)
    : forces_(without_null(std::move(forces))),
      adds_coupling_(adds_coupling),
      uniform_(std::ranges::all_of(forces_, [](const auto& force) { return force->is_uniform(); })),
      steady_(std::ranges::all_of(forces_, [](const auto& force) { return force->is_steady(); })),
      conservative_(std::ranges::all_of(forces_, [](const auto& force) { return force->is_conservative(); })),
      needs_temperature_(std::ranges::any_of(forces_, [](const auto& force) { return force->needs_temperature(); })) {
    for (std::size_t k = 0; k < forces_.size(); ++k) {
        const std::optional<Vec3> acceleration = forces_[k]->common_acceleration();
        if (acceleration && !is_finite(*acceleration)) {
            throw InputError(
                fmt::format("forces[{}]: found the acceleration [{}, {}, {}] m/s^2 of all particles, expected "
                            "finite numbers",
                            k, acceleration->x, acceleration->y, acceleration->z));
        }
        common_ = common_ && acceleration ? std::optional(*common_ + *acceleration) : std::nullopt;
    }
}

Vec3 ForceField::acceleration(const ForceInput& input) const {
    if (input.whole_radius > 0.0) return acceleration(whole(input));
    Vec3 sum = input.coupling != nullptr && adds_coupling_ ? input.coupling->acceleration(input) : Vec3{};
    if (input.coupling != nullptr && adds_coupling_ && input.coupling->replaces_forces()) return sum;
    for (const auto& force : forces_) sum += force->acceleration(input);
    if (!is_finite(sum)) refuse_if_not_finite(forces_, input);
    return sum;
}

std::optional<double> ForceField::potential_energy(const ForceInput& input) const {
    if (input.whole_radius > 0.0) return potential_energy(whole(input));
    double sum = 0.0;
    for (const auto& force : forces_) {
        const std::optional<double> energy = force->potential_energy(input);
        if (!energy) return std::nullopt;
        sum += *energy;
    }
    return sum;
}

}  // namespace ricochet
