#include "ricochet/compare/detail/setup_copies.h"

#include <utility>

namespace ricochet::detail {
namespace {

/// A force that several simulations have in common; forces are pure.
class SharedForce final : public Force {
public:
    explicit SharedForce(std::shared_ptr<const Force> force) : force_(std::move(force)) {}

    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override { return force_->acceleration(input); }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return force_->potential_energy(input);
    }
    [[nodiscard]] bool is_uniform() const override { return force_->is_uniform(); }
    [[nodiscard]] bool is_steady() const override { return force_->is_steady(); }

private:
    std::shared_ptr<const Force> force_;
};

}  // namespace

SetupCopies::SetupCopies(SimulationSetup setup) : setup_(std::move(setup)) {
    for (std::unique_ptr<Force>& force : setup_.forces) forces_.emplace_back(std::move(force));
    setup_.forces.clear();
}

SimulationSetup SetupCopies::make(const SimulationOptions& options) const {
    SimulationSetup copy;
    copy.options = options;
    for (const auto& force : forces_) copy.forces.push_back(std::make_unique<SharedForce>(force));
    copy.materials = setup_.materials;
    copy.colliders = setup_.colliders;
    copy.emitters = setup_.emitters;
    copy.particles = setup_.particles;
    copy.bounds = setup_.bounds;
    copy.attributes = setup_.attributes;
    copy.reference_camera = setup_.reference_camera;
    return copy;
}

}  // namespace ricochet::detail
