/// \file
/// Private to the simulation: the energy of coupled particles, and the report of a motion that diverges.
#pragma once

#include <span>
#include <vector>

#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/dynamics/system_integrator.h"

namespace ricochet {

/// Returns the kinetic energy of the members of a system with these velocities, in J.
[[nodiscard]] double kinetic_energy(const ParticleSystem& system, std::span<const Vec3> velocities);

/// Adds up the energy that a method of integration creates. Energy comes from the start, from forces and from walls.
/// More is an error of the method, and far more makes the motion nonsense.
class EnergyWatch {
public:
    /// Both must outlive it. knows_implicit: a report may advise implicit_euler.
    EnergyWatch(const ParticleSystem& system, const SpringNetwork& springs, bool knows_implicit);

    /// Returns the energy of the members and their springs, in J.
    [[nodiscard]] double of(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) const;
    /// Returns an energy, in J, that rounding explains.
    [[nodiscard]] double least() const { return least_; }
    /// Takes a planned step of the system. Throws DivergedError if the method has created too much energy.
    void watch(const SystemStep& step);
    /// Saves or restores the sums; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        a(given_), a(gained_), a(after_plan_), a(is_watching_);
    }

private:
    [[noreturn]] void report_divergence(const SystemStep& step) const;

    const ParticleSystem& system_;
    bool knows_implicit_;
    double least_;
    // In J: energy from the start, from forces and from walls, and energy that the method has created.
    double given_ = 0.0;
    double gained_ = 0.0;
    double after_plan_ = 0.0;
    bool is_watching_ = false;
};

}  // namespace ricochet
