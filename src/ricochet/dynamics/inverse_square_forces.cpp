// Gravity and electrostatic forces between all particles.
#include <fmt/format.h>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/inverse_square.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/dynamics/stability.h"

namespace ricochet {
namespace {

/// Particles per unit of parallel work.
constexpr std::size_t kInverseSquareForcesBlock = 4096;

bool takes_tree(const InverseSquareSettings& settings, std::size_t particles) {
    if (settings.method == SumMethod::automatic) return particles > kMostDirect;
    return settings.method == SumMethod::tree;
}

/// Common base of both forces: sources with weights of one kind, and one softening length.
class InverseSquareForce : public ParticlesForce {
public:
    explicit InverseSquareForce(const InverseSquareSettings& settings) : settings_(settings) {}

    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        std::vector<Vec3> field(particles.size());
        const Sources sources{particles.positions, weights_of(particles), settings_.softening};
        if (takes_tree(settings_, particles.size())) {
            SourceTree(sources).field(settings_.opening, field);
        } else {
            direct_field(sources, field);
        }
        parallel_for_blocks(field.size(), kInverseSquareForcesBlock,
                            [&](std::size_t, std::size_t begin, std::size_t end) {
                                for (std::size_t k = begin; k < end; ++k) result[k] += factor(particles, k) * field[k];
                            });
    }

    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView& particles) const override {
        std::vector<double> potential(particles.size());
        const std::span<const double> weights = weights_of(particles);
        const Sources sources{particles.positions, weights, settings_.softening};
        if (takes_tree(settings_, particles.size())) {
            SourceTree(sources).potential(settings_.opening, potential);
        } else {
            direct_potential(sources, potential);
        }
        return ordered_sum(potential.size(), kInverseSquareForcesBlock, [&](std::size_t begin, std::size_t end) {
            double sum = 0.0;
            for (std::size_t k = begin; k < end; ++k) {
                sum -= 0.5 * particles.masses[k] * factor(particles, k) * potential[k];
            }
            return sum;
        });
    }

    [[nodiscard]] bool depends_on_velocity() const override { return false; }
    [[nodiscard]] double softening() const { return settings_.softening; }

protected:
    [[nodiscard]] virtual std::span<const double> weights_of(const ParticlesView& particles) const = 0;
    /// Returns the acceleration of particle k divided by the field at its position.
    [[nodiscard]] virtual double factor(const ParticlesView& particles, std::size_t k) const = 0;

private:
    InverseSquareSettings settings_;
};

class MutualGravity final : public InverseSquareForce {
public:
    explicit MutualGravity(const GravitySettings& settings)
        : InverseSquareForce(settings), constant_(settings.constant) {}

protected:
    [[nodiscard]] std::span<const double> weights_of(const ParticlesView& particles) const override {
        return particles.masses;
    }
    [[nodiscard]] double factor(const ParticlesView& /*particles*/, std::size_t /*k*/) const override {
        return constant_;
    }

private:
    double constant_;
};

class CoulombForce final : public InverseSquareForce {
public:
    explicit CoulombForce(const ChargeSettings& settings)
        : InverseSquareForce(settings), constant_(settings.constant), attribute_(settings.attribute) {}
    [[nodiscard]] std::vector<std::string> attributes() const override { return {attribute_}; }

protected:
    [[nodiscard]] std::span<const double> weights_of(const ParticlesView& particles) const override {
        if (particles.attributes.size() != 1 || particles.attributes[0].size() != particles.size()) {
            throw InputError(fmt::format(
                "charges: found another list, expected the attribute \"{}\" with one component", attribute_));
        }
        return particles.attributes[0];
    }
    [[nodiscard]] double factor(const ParticlesView& particles, std::size_t k) const override {
        return -constant_ * particles.attributes[0][k] / particles.masses[k];
    }

private:
    double constant_;
    std::string attribute_;
};

void require_sound(const InverseSquareSettings& settings, const std::string& name) {
    detail::require_not_negative(settings.softening, name + ": the softening", "m");
    if (!(settings.opening > 0.0 && settings.opening <= 1.0)) {
        throw InputError(
            fmt::format("{}: the opening: found {}, expected a number above 0 and up to 1", name, settings.opening));
    }
    if (settings.softening > kLargestCoordinate) {
        throw InputError(fmt::format("{}: the softening: found {}, expected at most {:g} m", name, settings.softening,
                                     kLargestCoordinate));
    }
}

}  // namespace

bool lacks_softening(const ParticlesForce& force) {
    const auto* const law = dynamic_cast<const InverseSquareForce*>(&force);
    return law != nullptr && law->softening() == 0.0;
}

std::string_view name_of(SumMethod method) {
    switch (method) {
        case SumMethod::direct:
            return "direct";
        case SumMethod::tree:
            return "tree";
        case SumMethod::automatic:
            break;
    }
    return "auto";
}

std::shared_ptr<const ParticlesForce> make_mutual_gravity(const GravitySettings& settings) {
    require_sound(settings, "gravity between particles");
    detail::require_finite(settings.constant, "gravity between particles: the constant", "m^3/(kg s^2)");
    return std::make_shared<MutualGravity>(settings);
}

std::shared_ptr<const ParticlesForce> make_coulomb_force(const ChargeSettings& settings) {
    require_sound(settings, "charges");
    detail::require_finite(settings.constant, "charges: the constant", "N m^2/C^2");
    if (settings.attribute.empty()) throw InputError("charges: the attribute has no name");
    return std::make_shared<CoulombForce>(settings);
}

}  // namespace ricochet
