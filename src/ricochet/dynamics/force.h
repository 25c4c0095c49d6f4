/// \file
/// Forces as composable objects: what one is, sums of them, uniform gravity and any callable.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/dynamics/particles.h"

namespace ricochet {

/// What a force may look at: one particle's own state at a time.
struct ForceInput {
    Vec3 position;  ///< m
    Vec3 velocity;  ///< m/s
    double mass;    ///< kg
    double radius;  ///< m
    double time;    ///< s
    /// Which particle it is, for forces that act on some only.
    std::uint64_t id = 0;
    /// What other particles do to it, m/s^2: held from a bounce to the end of the step, zero where nothing couples.
    Vec3 coupling{};
};

/// One force on particles. Implementations are pure: same input, same bits, from any thread.
class Force {
public:
    virtual ~Force() = default;
    /// Force divided by mass, m/s^2.
    [[nodiscard]] virtual Vec3 acceleration(const ForceInput& input) const = 0;
    /// Potential energy of the particle in this force, J. Dissipative forces store none and return 0; a force without a
    /// potential returns nothing.
    [[nodiscard]] virtual std::optional<double> potential_energy(const ForceInput& input) const = 0;
    /// True when the acceleration depends on neither position, velocity nor time.
    [[nodiscard]] virtual bool is_uniform() const { return false; }
    /// The acceleration where it is the same for all particles, everywhere and always, m/s^2.
    [[nodiscard]] virtual std::optional<Vec3> common_acceleration() const { return std::nullopt; }
    /// True when the acceleration does not depend on time: a particle at rest then stays at rest (it may sleep).
    [[nodiscard]] virtual bool is_steady() const { return is_uniform(); }
};

/// Uniform gravity: the given acceleration, m/s^2.
[[nodiscard]] std::unique_ptr<Force> make_gravity(const Vec3& acceleration);

/// What is known of a callable force. Pure like the force itself.
struct CallableTraits {
    std::function<double(const ForceInput&)> potential = {};  ///< J; empty: it has none
    bool is_uniform = false;  ///< its acceleration depends on neither position, velocity nor time
    bool is_steady = false;   ///< its acceleration does not depend on time
};
/// Any callable as a force: returns the force in newton. It must be pure.
[[nodiscard]] std::unique_ptr<Force> make_force(std::function<Vec3(const ForceInput&)> force,
                                                CallableTraits traits = {});
/// Any callable as an acceleration, m/s^2. It must be pure.
[[nodiscard]] std::unique_ptr<Force> make_acceleration(std::function<Vec3(const ForceInput&)> acceleration,
                                                       CallableTraits traits = {});

/// A force on the particles of these ids only; it does nothing to others.
[[nodiscard]] std::unique_ptr<Force> make_force_on(std::vector<std::uint64_t> particles, std::unique_ptr<Force> force);

/// A sum of forces, added in the order given.
class ForceField {
public:
    ForceField() = default;
    explicit ForceField(std::vector<std::unique_ptr<Force>> forces);
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const;
    /// Sum of the potentials, J; nothing when one force has none.
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const;
    [[nodiscard]] bool empty() const { return forces_.empty(); }
    /// True when the acceleration depends on neither position, velocity nor time.
    [[nodiscard]] bool is_uniform() const { return uniform_; }
    /// The acceleration where it is the same for all particles, everywhere and always, m/s^2: that of acceleration(),
    /// with the same bits, for particles that nothing couples.
    [[nodiscard]] const std::optional<Vec3>& common_acceleration() const { return common_; }
    /// True when no force depends on time.
    [[nodiscard]] bool is_steady() const { return steady_; }

private:
    std::vector<std::unique_ptr<Force>> forces_;
    bool uniform_ = true;
    bool steady_ = true;
    std::optional<Vec3> common_ = Vec3{};
};

}  // namespace ricochet
