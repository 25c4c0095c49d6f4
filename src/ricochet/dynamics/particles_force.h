/// \file
/// Forces between particles: the ParticlesForce interface, and gravity and electrostatic forces between all particles.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Particles between which a force acts, in the order of the simulation. All lists have the same length. Pinned
/// particles are included, because they act on other particles although they do not move.
struct ParticlesView {
    double time = 0.0;                   ///< in s
    std::span<const std::uint64_t> ids;  ///< ids of the particles
    std::span<const Vec3> positions;     ///< in m
    std::span<const Vec3> velocities;    ///< in m/s
    std::span<const double> masses;      ///< in kg
    std::span<const double> radii;       ///< in m
    /// One list for each name of ParticlesForce::attributes(), in the same order. Vector components are interleaved.
    std::vector<std::span<const double>> attributes = {};

    [[nodiscard]] std::size_t size() const { return positions.size(); }
};

/// Force on a set of particles. The force on a particle may depend on all of them. Implementations are pure: the same
/// input gives the same bits for any number of threads (core/parallel.h), even if two simulations share one force.
class ParticlesForce {
public:
    virtual ~ParticlesForce() = default;
    /// Adds the acceleration of each particle by this force, in m/s^2, to its entry in `result`.
    virtual void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const = 0;
    /// Returns the total potential energy, in J. Dissipative forces store no energy and return 0. Returns nothing if
    /// the force has no potential.
    [[nodiscard]] virtual std::optional<double> potential_energy(const ParticlesView& particles) const = 0;
    /// Returns false if the accelerations do not depend on velocities.
    [[nodiscard]] virtual bool depends_on_velocity() const { return true; }
    /// Returns the names of the particle attributes that the force reads.
    [[nodiscard]] virtual std::vector<std::string> attributes() const { return {}; }
    /// Returns the name for messages. If the name is empty, messages identify the force by its index.
    [[nodiscard]] virtual std::string name() const { return {}; }
};

/// Force of a simulation, and the particles between which it acts: all particles with an id in `particles` or from an
/// emitter in `emitters`. If both lists are empty, the force acts on all particles.
struct ParticlesForceEntry {
    std::shared_ptr<const ParticlesForce> force;
    std::vector<std::uint64_t> particles = {};
    std::vector<std::uint32_t> emitters = {};
};

// Inverse-square forces between all particles.

/// Method for the sum over all other particles.
enum class SumMethod {
    automatic,  ///< direct for at most kMostDirect particles, otherwise by a tree
    direct,     ///< sum over all pairs
    tree        ///< distant groups of particles are replaced by their moments
};
inline constexpr std::size_t kMostDirect = 1500;
[[nodiscard]] std::string_view name_of(SumMethod method);

/// Settings shared by gravity and charge.
struct InverseSquareSettings {
    /// Softening length, in m, >= 0; the masses or charges are spread over about this length (Plummer's law).
    double softening = 0.0;
    SumMethod method = SumMethod::automatic;
    /// Opening criterion of the tree, 0 < opening <= 1. A group is replaced by its moments if the distance from its
    /// centre to its farthest particle, divided by that to the evaluated particles, is below this value. The resulting
    /// error is described in docs/particle-forces.md.
    double opening = 0.5;
};

struct GravitySettings : InverseSquareSettings {
    double constant = 6.6743e-11;  ///< G, in m^3/(kg s^2), CODATA 2018; negative values repel
};
/// Returns gravity with a_i = G sum_j m_j (x_j - x_i) / (|x_j - x_i|^2 + softening^2)^(3/2). Particles at the same
/// position do not interact. The potential is -G m_i m_j / (|x_j - x_i|^2 + softening^2)^(1/2) per pair.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_mutual_gravity(const GravitySettings& settings);

struct ChargeSettings : InverseSquareSettings {
    double constant = 8.9875517862e9;  ///< Coulomb's constant, in N m^2/C^2, CODATA 2018
    std::string attribute = "charge";  ///< name of the particle attribute with the charge, in C; it has one component
};
/// Returns Coulomb's law F_i = k q_i sum_j q_j (x_i - x_j) / (|x_i - x_j|^2 + softening^2)^(3/2). Like charges repel.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_coulomb_force(const ChargeSettings& settings);

}  // namespace ricochet
