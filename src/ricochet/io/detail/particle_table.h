/// \file
/// Particles from a text table.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/dynamics/particles.h"

namespace ricochet::detail {

/// What a table holds, and what is wrong with it.
struct ParticleTable {
    std::vector<Particle> particles;
    std::vector<std::string> errors;               ///< "start.csv:12: found ..., expected ..."; the first few
    std::vector<AttributeDescription> attributes;  ///< those that were declared, and those for looks that the table has
    std::vector<std::string> unused_columns;       ///< of a run's own final state, which mean nothing at a start
};

/// Comma-separated values: a header line with the columns x, y, z and, where wanted, vx, vy, vz, mass, radius in any
/// order, and attributes (name, or name_x, name_y, name_z): those declared, and those for looks; then a line a
/// particle. The final state that a run writes can be read back. Never throws for bad contents.
[[nodiscard]] ParticleTable parse_particle_table(std::string_view text, const std::string& name,
                                                 std::vector<AttributeDescription> declared = {});

/// Reads a .csv file. Throws InputError when it cannot be read or is another kind of file.
[[nodiscard]] ParticleTable read_particle_table(const std::filesystem::path& path,
                                                std::vector<AttributeDescription> declared = {});

}  // namespace ricochet::detail
