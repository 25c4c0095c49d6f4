#include "ricochet/dynamics/force.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

class Gravity final : public Force {
public:
    explicit Gravity(const Vec3& acceleration) : acceleration_(acceleration) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput&) const override { return acceleration_; }
    // Zero at the world's origin.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return -input.mass * dot(acceleration_, input.position);
    }
    [[nodiscard]] bool is_uniform() const override { return true; }

private:
    Vec3 acceleration_;
};

class LinearDrag final : public Force {
public:
    explicit LinearDrag(double coefficient) : coefficient_(coefficient) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        return input.velocity * (-coefficient_ / input.mass);
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput&) const override { return 0.0; }
    [[nodiscard]] bool is_steady() const override { return true; }

private:
    double coefficient_;
};

class CallableForce final : public Force {
public:
    explicit CallableForce(std::function<Vec3(const ForceInput&)> force) : force_(std::move(force)) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override { return force_(input) / input.mass; }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput&) const override { return std::nullopt; }

private:
    std::function<Vec3(const ForceInput&)> force_;
};

}  // namespace

std::unique_ptr<Force> make_gravity(const Vec3& acceleration) {
    if (!is_finite(acceleration)) throw InputError("gravity: the acceleration must be finite (m/s^2)");
    return std::make_unique<Gravity>(acceleration);
}

std::unique_ptr<Force> make_linear_drag(double coefficient) {
    if (!(coefficient >= 0.0) || !std::isfinite(coefficient)) {
        throw InputError(
            fmt::format("drag: the coefficient must be a finite number >= 0 (kg/s), found {}", coefficient));
    }
    return std::make_unique<LinearDrag>(coefficient);
}

std::unique_ptr<Force> make_force(std::function<Vec3(const ForceInput&)> force) {
    if (!force) throw InputError("force: an empty function cannot be called");
    return std::make_unique<CallableForce>(std::move(force));
}

ForceField::ForceField(std::vector<std::unique_ptr<Force>> forces)
    : forces_(std::move(forces)),
      uniform_(std::all_of(forces_.begin(), forces_.end(), [](const auto& force) { return force->is_uniform(); })),
      steady_(std::all_of(forces_.begin(), forces_.end(), [](const auto& force) { return force->is_steady(); })) {}

Vec3 ForceField::acceleration(const ForceInput& input) const {
    Vec3 sum;
    for (const auto& force : forces_) sum += force->acceleration(input);
    return sum;
}

std::optional<double> ForceField::potential_energy(const ForceInput& input) const {
    double sum = 0.0;
    for (const auto& force : forces_) {
        const std::optional<double> energy = force->potential_energy(input);
        if (!energy) return std::nullopt;
        sum += *energy;
    }
    return sum;
}

}  // namespace ricochet
