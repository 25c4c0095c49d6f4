/// \file
/// Forces between particles: what one is, and gravity and charge of all on all.
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

/// The particles that a force acts between, in the order of the simulation; all lists have the same length. Those that
/// are pinned are there too: they act on others and do not move.
struct ParticlesView {
    double time = 0.0;                   ///< s
    std::span<const std::uint64_t> ids;  ///< which particles they are
    std::span<const Vec3> positions;     ///< m
    std::span<const Vec3> velocities;    ///< m/s
    std::span<const double> masses;      ///< kg
    std::span<const double> radii;       ///< m
    /// One list for each name of ParticlesForce::attributes(), in that order; a vector's components side by side.
    std::vector<std::span<const double>> attributes = {};

    [[nodiscard]] std::size_t size() const { return positions.size(); }
};

/// A force on a set of particles by each other, or by anything that looks at all of them. Implementations are pure:
/// same input, same bits, for any number of threads (core/parallel.h), also when two simulations share one.
class ParticlesForce {
public:
    virtual ~ParticlesForce() = default;
    /// Adds to each entry of `result` what the force does to that particle, divided by its mass, m/s^2. result is as
    /// long as the lists.
    virtual void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const = 0;
    /// Potential energy of all together, J. Dissipative forces store none and return 0; a force without a potential
    /// returns nothing.
    [[nodiscard]] virtual std::optional<double> potential_energy(const ParticlesView& particles) const = 0;
    /// False when the accelerations do not depend on velocities.
    [[nodiscard]] virtual bool depends_on_velocity() const { return true; }
    /// Names of the particles' attributes that it wants to see.
    [[nodiscard]] virtual std::vector<std::string> attributes() const { return {}; }
    /// How messages name it; empty: as a force between particles, by its number.
    [[nodiscard]] virtual std::string name() const { return {}; }
};

/// A force of a simulation, and the particles between which it acts: those of these ids and those born of these
/// emitters (numbers in the setup); all where both are empty.
struct ParticlesForceEntry {
    std::shared_ptr<const ParticlesForce> force;
    std::vector<std::uint64_t> particles = {};
    std::vector<std::uint32_t> emitters = {};
};

// All on all, falling with the square of the distance.

/// How the sum over all others is made.
enum class SumMethod {
    automatic,  ///< direct up to kMostDirect particles, by a tree beyond
    direct,     ///< every pair
    tree        ///< distant groups of particles by their moments
};
inline constexpr std::size_t kMostDirect = 1500;
[[nodiscard]] std::string_view name_of(SumMethod method);

/// Settings that gravity and charge share.
struct InverseSquareSettings {
    double softening = 0.0;  ///< m, >= 0: the force is that of balls smeared out over this length (Plummer's law)
    SumMethod method = SumMethod::automatic;
    /// Of a tree, 0 < opening <= 1: groups are taken by their moments from where they look smaller than this (the
    /// farthest of their particles from their centre over the distance of the centre). docs/particle-forces.md says
    /// what error follows.
    double opening = 0.5;
};

struct GravitySettings : InverseSquareSettings {
    double constant = 6.6743e-11;  ///< G, m^3/(kg s^2), CODATA 2018; negative repels
};
/// a_i = G sum_j m_j (x_j - x_i) / (|x_j - x_i|^2 + softening^2)^(3/2). Particles at one place do nothing to each
/// other. Potential -G m_i m_j / (|x_j - x_i|^2 + softening^2)^(1/2) a pair.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_mutual_gravity(const GravitySettings& settings);

struct ChargeSettings : InverseSquareSettings {
    double constant = 8.9875517862e9;  ///< Coulomb's, N m^2/C^2, CODATA 2018
    std::string attribute = "charge";  ///< the particles' attribute, of one component, that holds the charge, C
};
/// F_i = k q_i sum_j q_j (x_i - x_j) / (|x_i - x_j|^2 + softening^2)^(3/2): Coulomb's law; like charges repel.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_coulomb_force(const ChargeSettings& settings);

}  // namespace ricochet
