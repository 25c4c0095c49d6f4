/// \file
/// The particles as text, for people and scripts.
#pragma once

#include <filesystem>

#include "ricochet/dynamics/particles.h"

namespace ricochet {

/// Writes a header line and one line a particle in the order of the ids: id, x, y, z, vx, vy, vz, radius, mass, age,
/// contacts, resting, unsimulated_time, then the attributes (vectors as name_x, name_y, name_z). Numbers carry 17
/// significant digits, so that they read back to the same bits. time: simulation time, s. Throws RunError or InputError
/// like AtomicFile; nothing half-written appears.
void write_state_csv(const std::filesystem::path& path, const Particles& particles, double time);
/// The same with the attributes as they are shown (Simulation::shown_attributes()).
void write_state_csv(const std::filesystem::path& path, const Particles& particles, const AttributeTable& attributes,
                     double time);

}  // namespace ricochet
