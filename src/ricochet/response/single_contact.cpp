#include "ricochet/response/single_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/sphere_contact.h"

namespace ricochet {
namespace {

/// Returns true if neither force changes the rate of the other, see CoulombProblem.
bool are_independent(const MotionVector& a, const MotionVector& b, double b_squared) {
    return std::fabs(dot(a, b)) <= kCoulombRounding * b_squared;
}

/// Returns true if no resistance changes the normal force, and the directions of each are independent.
bool are_independent(const CoulombContact& contact, std::span<const CoulombResistance> resistances,
                     double normal_squared) {
    return std::ranges::all_of(resistances, [&](const CoulombResistance& resistance) {
        const auto& [first, second] = resistance.direction;
        return are_independent(first, contact.direction, normal_squared) &&
               are_independent(second, contact.direction, normal_squared) &&
               are_independent(second, first, dot(first, first));
    });
}

/// Most passes over two resistances that both act with their bounds. Local: the result is checked.
constexpr int kMostPasses = 4;

/// The problem and its forces. Forces and rates are divided by the largest rate.
class SingleContact {
public:
    /// scale: the largest rate. Computes the normal force.
    SingleContact(const CoulombContact& contact, std::span<const CoulombResistance> resistances, double friction,
                  double scale, double normal_squared)
        : contact_(contact),
          resistances_(resistances),
          friction_(friction),
          scale_(scale),
          normal_squared_(normal_squared) {
        forces_.normal = std::max(0.0, -contact.rate / scale / normal_squared);
    }

    /// Computes the resistances. Returns false if no closed form holds.
    [[nodiscard]] bool resist() {
        for (std::size_t r = 0; r < resistances_.size(); ++r) {
            if (resistances_[r].is_moving) forces_.resistance[r] = wanted(r);
        }
        for (std::size_t r = 0; r < resistances_.size(); ++r) {
            if (resistances_[r].is_moving) continue;
            const std::optional<std::size_t> other = coupled_with(r);
            if (!other) forces_.resistance[r] = wanted(r);
            if (other && *other > r && !hold_one(r, *other) && !hold_one(*other, r) && !hold_none(r, *other))
                return false;
        }
        return true;
    }

    /// Returns the largest defect of the forces.
    [[nodiscard]] double residual() const {
        const double left = contact_.rate / scale_ + dot(contact_.direction, change());
        double residual = std::fabs(forces_.normal - std::max(0.0, forces_.normal - 1.0 / normal_squared_ * left));
        for (std::size_t r = 0; r < resistances_.size(); ++r) {
            const std::array<double, 2> right = wanted(r);
            for (std::size_t d = 0; d < 2; ++d) {
                residual = std::max(residual, std::fabs(forces_.resistance[r][d] - right[d]));
            }
        }
        return residual;
    }

    /// Returns the forces for the given rates.
    [[nodiscard]] SingleContactForces result() {
        for (std::size_t r = 0; r < resistances_.size(); ++r) {
            // Limits them again, because the heading is a unit vector only up to rounding.
            const double part = part_within(forces_.resistance[r], most(r));
            for (double& force : forces_.resistance[r]) force = part * force * scale_;
        }
        forces_.normal *= scale_;
        forces_.change = change();
        return forces_;
    }

private:
    using Pair = std::array<double, 2>;

    [[nodiscard]] static double part_within(const Pair& force, double most) {
        const double size = std::sqrt(force[0] * force[0] + force[1] * force[1]);
        return size > most ? most / size : 1.0;
    }
    [[nodiscard]] double most(std::size_t r) const { return friction_ * resistances_[r].bound * forces_.normal; }
    [[nodiscard]] static double size_squared(const CoulombResistance& resistance) {
        const auto& [first, second] = resistance.direction;
        return std::max(dot(first, first), dot(second, second));
    }

    [[nodiscard]] MotionVector change() const {
        MotionVector sum{};
        add_multiple(sum, forces_.normal, contact_.direction);
        for (std::size_t r = 0; r < resistances_.size(); ++r) {
            for (std::size_t d = 0; d < 2; ++d) {
                add_multiple(sum, forces_.resistance[r][d], resistances_[r].direction[d]);
            }
        }
        return sum;
    }

    /// Returns the rates that the present forces leave along the directions of a resistance.
    [[nodiscard]] Pair left(std::size_t r) const {
        const CoulombResistance& resistance = resistances_[r];
        const MotionVector change = this->change();
        Pair rate{};
        for (std::size_t d = 0; d < 2; ++d)
            rate[d] = resistance.rate[d] / scale_ + dot(resistance.direction[d], change);
        return rate;
    }

    /// Returns the force that removes the rate which the present forces leave, limited to the bound. If the resistance
    /// is moving, returns the bound against its heading. gain: of the force by the rate.
    [[nodiscard]] Pair wanted(std::size_t r, double gain) const {
        const CoulombResistance& resistance = resistances_[r];
        if (resistance.is_moving) return {most(r) * -resistance.heading[0], most(r) * -resistance.heading[1]};
        const Pair rate = left(r);
        Pair force{};
        for (std::size_t d = 0; d < 2; ++d) force[d] = forces_.resistance[r][d] - gain * rate[d];
        const double part = part_within(force, most(r));
        return {part * force[0], part * force[1]};
    }
    [[nodiscard]] Pair wanted(std::size_t r) const { return wanted(r, 1.0 / size_squared(resistances_[r])); }

    /// Returns another resistance that does not move and that depends on this one.
    [[nodiscard]] std::optional<std::size_t> coupled_with(std::size_t r) const {
        for (std::size_t other = 0; other < resistances_.size(); ++other) {
            if (other != r && !resistances_[other].is_moving && coupling(r, other) != 0.0) return other;
        }
        return std::nullopt;
    }
    /// Returns the rate of one resistance that a unit force of the other causes, or 0 if it is a rounding error. It is
    /// the same for all directions along the surface.
    [[nodiscard]] double coupling(std::size_t r, std::size_t other) const {
        const auto& [first, second] = resistances_[other].direction;
        const MotionVector& own = resistances_[r].direction[0];
        const double along = std::sqrt(dot(own, first) * dot(own, first) + dot(own, second) * dot(own, second));
        return along > kCoulombRounding * dot(own, own) ? along : 0.0;
    }

    /// Lets one resistance, `within`, remove its whole rate, and limits the other one to its bound. Returns false if
    /// `within` exceeds its bound. Rolling and sliding turn the sphere about the same axes, so that both couple alike
    /// in all directions.
    [[nodiscard]] bool hold_one(std::size_t limited, std::size_t within) {
        const double own = size_squared(resistances_[within]);
        const double both = coupling(limited, within);
        forces_.resistance[limited] = forces_.resistance[within] = {};
        const Pair alone = left(within);
        for (std::size_t d = 0; d < 2; ++d) forces_.resistance[within][d] = -alone[d] / own;
        forces_.resistance[limited] = wanted(limited, 1.0 / (size_squared(resistances_[limited]) - both * both / own));
        const Pair rest = left(within);
        for (std::size_t d = 0; d < 2; ++d) forces_.resistance[within][d] -= rest[d] / own;
        return part_within(forces_.resistance[within], most(within)) == 1.0;
    }

    /// Lets both resistances act with their bounds, each against the rate that the other one leaves. Returns false if
    /// the directions do not settle. They do at once if all rates have one direction, as under forces on the centre.
    [[nodiscard]] bool hold_none(std::size_t first, std::size_t second) {
        forces_.resistance[second] = {};
        for (int pass = 0; pass < kMostPasses; ++pass) {
            for (const std::size_t r : {first, second}) {
                forces_.resistance[r] = {};
                const Pair rate = left(r);
                const double size = std::sqrt(rate[0] * rate[0] + rate[1] * rate[1]);
                if (size > 0.0) forces_.resistance[r] = {-most(r) * rate[0] / size, -most(r) * rate[1] / size};
            }
            if (residual() <= kCoulombResidual) return true;
        }
        return false;
    }

    const CoulombContact& contact_;
    std::span<const CoulombResistance> resistances_;
    double friction_;
    double scale_;
    double normal_squared_;
    SingleContactForces forces_;
};

}  // namespace

std::optional<SingleContactForces> solve_single_contact(const CoulombContact& contact,
                                                        std::span<const CoulombResistance> resistances,
                                                        double friction) {
    const double normal_squared = dot(contact.direction, contact.direction);
    if (!are_independent(contact, resistances, normal_squared)) return std::nullopt;
    double scale = std::fabs(contact.rate);
    for (const CoulombResistance& resistance : resistances) {
        scale = std::max({scale, std::fabs(resistance.rate[0]), std::fabs(resistance.rate[1])});
    }
    if (scale == 0.0) return SingleContactForces{};
    if (!(scale < std::numeric_limits<double>::infinity())) return std::nullopt;
    SingleContact single(contact, resistances, friction, scale, normal_squared);
    if (!single.resist() || !(single.residual() <= kCoulombResidual)) return std::nullopt;
    return single.result();
}

Motion along_single_surface(const Motion& motion, double radius, const Vec3& n, double braked_from) {
    const MotionVector direction = normal_direction(n / length(n));
    const double left_along = -dot(Vec3{}, n) / length(n);  // 0, with the sign that the general method gives it
    MotionVector all = motion_vector(motion.velocity, (radius / kTurning) * motion.spin);
    const double before = std::max(std::sqrt(dot(all, all)), braked_from);
    // Projects twice, because the first projection leaves the rounding of the part that it removes.
    for (int pass = 0; pass < 2; ++pass) add_multiple(all, left_along - dot(all, direction), direction);
    if (std::sqrt(dot(all, all)) <= kStopRounding * before) return {};
    return {velocity_of(all), radius > 0.0 ? (kTurning / radius) * turning_of(all) : Vec3{}};
}

}  // namespace ricochet
