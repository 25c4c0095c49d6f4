/// \file
/// Balances of mass, momentum and energy for particles in a box without gravity. The walls receive everything that the
/// particles lose. Optional features add to the balances or subtract from them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet::test {

inline constexpr std::uint32_t kParticles = 12;
inline constexpr double kMass = 0.5;         ///< kg, of each particle at the start
inline constexpr double kChildMass = 0.125;  ///< kg
inline constexpr double kLaunch = 0.4;       ///< m/s, of fragments
inline constexpr double kStiffness = 40.0;   ///< N/m
inline constexpr double kDuration = 0.6;     ///< s
inline constexpr double kEnergy = 12.0;      ///< J, at the start: twelve particles of half a kilogram at 2 m/s

/// Features of a scene; several are combined as bits of one number.
enum class Feature : std::uint32_t {
    springs = 1,     ///< between explicit particles: all of them, or half if others are emitted
    children = 2,    ///< born at rest during the whole life of emitted particles
    absorbing = 4,   ///< walls absorb 30 % of the particles that hit them
    shattering = 8,  ///< emitted particles break into three at their first impact
    flow = 16,       ///< moves all particles
};
inline constexpr std::array kFeatures{Feature::springs, Feature::children, Feature::absorbing, Feature::shattering,
                                      Feature::flow};

/// A scene of the test matrix.
struct BookCase {
    ResponseKind response = ResponseKind::exact;
    bool global = false;  ///< rollback of the whole system
    IntegratorKind integrator = IntegratorKind::velocity_verlet;
    std::uint32_t features = 0;
    double time_step = 0.002;  ///< s
    std::uint64_t seed = 12;

    [[nodiscard]] bool has(Feature feature) const { return (features & static_cast<std::uint32_t>(feature)) != 0; }
    [[nodiscard]] bool emits() const { return has(Feature::children) || has(Feature::shattering); }
};

[[nodiscard]] inline std::uint32_t both(Feature a, Feature b) {
    return static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b);
}

/// "rollback.global, rk4, springs and absorbing".
[[nodiscard]] std::string name(const BookCase& c);
/// Returns every response (rollback twice) with every integrator.
[[nodiscard]] std::vector<BookCase> all_methods();
/// Returns part of the error for an invalid combination; nothing for a valid one.
[[nodiscard]] std::optional<std::string> refusal(const BookCase& c);
[[nodiscard]] SimulationSetup setup_of(const BookCase& c);

/// The content of a balance.
struct Account {
    double mass = 0.0;      ///< kg
    Vec3 momentum;          ///< N s
    double energy = 0.0;    ///< J
    std::size_t count = 0;  ///< particles
};

/// A run with balances updated in every step from its reports: births, contacts, totals of the walls.
class BookedRun {
public:
    explicit BookedRun(const BookCase& c);
    void run();

    [[nodiscard]] const Simulation& simulation() const { return simulation_; }
    [[nodiscard]] const Account& start() const { return start_; }  ///< after the first births of independent emitters
    [[nodiscard]] Account living() const;
    [[nodiscard]] const Account& swallowed() const { return swallowed_; }  ///< momentum is in `walls` too
    [[nodiscard]] const Account& born() const { return born_; }            ///< at rest
    [[nodiscard]] Vec3 walls() const;                                      ///< impulse on the walls, in N s

private:
    BookedRun(const BookCase& c, SimulationSetup setup);
    void note_step();

    std::vector<std::uint32_t> bearing_;
    Simulation simulation_;
    Account start_;
    Account swallowed_;
    Account born_;
};

}  // namespace ricochet::test
