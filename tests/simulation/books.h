/// \file
/// Books of mass, momentum and energy: particles in a box without gravity, so that all that they lose the walls have
/// got, with any of the features that add to the books or take from them.
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
inline constexpr double kMass = 0.5;         ///< kg, of each at the start
inline constexpr double kChildMass = 0.125;  ///< kg
inline constexpr double kLaunch = 0.4;       ///< m/s, of fragments
inline constexpr double kStiffness = 40.0;   ///< N/m
inline constexpr double kDuration = 0.6;     ///< s
inline constexpr double kEnergy = 12.0;      ///< J, of the start: twelve of half a kilogram at 2 m/s

/// What a scene may have; several are bits of one number.
enum class Feature : std::uint32_t {
    springs = 1,     ///< between explicit particles: all, or half of them where others are emitted
    children = 2,    ///< born at rest all the life of emitted particles
    absorbing = 4,   ///< walls swallow 30 % of what hits them
    shattering = 8,  ///< emitted particles break into three at their first impact
    flow = 16,       ///< which carries all
};
inline constexpr std::array kFeatures{Feature::springs, Feature::children, Feature::absorbing, Feature::shattering,
                                      Feature::flow};

/// A scene of the matrix.
struct BookCase {
    ResponseKind response = ResponseKind::exact;
    bool global = false;  ///< rollback takes the whole system back
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
/// Every response (rollback twice) with every integrator.
[[nodiscard]] std::vector<BookCase> all_methods();
/// A part of the line with which a setup that cannot be is refused; nothing for the others.
[[nodiscard]] std::optional<std::string> refusal(const BookCase& c);
[[nodiscard]] SimulationSetup setup_of(const BookCase& c);

/// What somebody has.
struct Account {
    double mass = 0.0;      ///< kg
    Vec3 momentum;          ///< N s
    double energy = 0.0;    ///< J
    std::size_t count = 0;  ///< particles
};

/// A run whose books are kept step by step from what it says: births, contacts, totals of the walls.
class BookedRun {
public:
    explicit BookedRun(const BookCase& c);
    void run();

    [[nodiscard]] const Simulation& simulation() const { return simulation_; }
    [[nodiscard]] const Account& start() const {
        return start_;
    }  ///< once all that emitters make by themselves is there
    [[nodiscard]] Account living() const;
    [[nodiscard]] const Account& swallowed() const { return swallowed_; }  ///< by walls; momentum is in `walls` too
    [[nodiscard]] const Account& born() const { return born_; }            ///< at rest
    [[nodiscard]] Vec3 walls() const;                                      ///< N s, that they were given

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
