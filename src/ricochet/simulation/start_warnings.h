/// \file
/// Private to the simulation: warnings about a setup.
#pragma once

#include <string>
#include <vector>

#include "ricochet/simulation.h"
#include "ricochet/simulation/collision_scene.h"

namespace ricochet {

/// Sentences for the user about a setup that is valid but may not do what is expected of it.
class StartWarnings {
public:
    /// Compares the time step with the stability bounds of contacts, forces and springs.
    explicit StartWarnings(const SimulationSetup& setup);

    [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }
    /// Returns true if a message about diverging motion may suggest implicit_euler.
    [[nodiscard]] bool knows_implicit() const { return knows_implicit_; }
    /// Adds warnings of particles of the setup that overlap surfaces or, if spheres meet, each other. Counts the
    /// latter.
    void add_overlaps(const CollisionScene& scene, const Particles& particles, bool do_spheres_meet,
                      SimulationStatistics& statistics);

private:
    std::vector<std::string> texts_;
    bool knows_implicit_;
};

}  // namespace ricochet
