#include "ricochet/dynamics/field_force.h"

#include <numbers>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/detail/checks.h"

namespace ricochet {
namespace {

class FieldForce final : public Force {
public:
    FieldForce(FlowPointer field, FieldMeaning meaning) : field_(std::move(field)), meaning_(meaning) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override {
        const Vec3 value = field_->velocity(input.position, input.time);
        return meaning_ == FieldMeaning::force ? value / input.mass : value;
    }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput&) const override { return std::nullopt; }
    [[nodiscard]] bool is_uniform() const override { return field_->is_uniform() && field_->is_steady(); }
    [[nodiscard]] bool is_steady() const override { return field_->is_steady(); }

private:
    FlowPointer field_;
    FieldMeaning meaning_;
};

}  // namespace

std::unique_ptr<Force> make_field_force(FlowPointer field, FieldMeaning meaning) {
    if (!field) throw InputError("field force: found a null pointer, expected a field");
    return std::make_unique<FieldForce>(std::move(field), meaning);
}

std::unique_ptr<Force> make_swirl(const Vec3& point, const Vec3& axis, double acceleration, double core_radius) {
    detail::require_finite(point, "swirl: the point on the axis", "m");
    detail::require_finite(acceleration, "swirl: the acceleration", "m/s^2");
    detail::require_positive(core_radius, "swirl: the core radius", "m");
    // A Rankine vortex whose speed at the rim of its core is that number.
    const double circulation = 2.0 * std::numbers::pi * core_radius * acceleration;
    return make_field_force(
        make_vortex({point, detail::unit_direction(axis, "swirl: the axis"), circulation, core_radius}),
        FieldMeaning::acceleration);
}

}  // namespace ricochet
