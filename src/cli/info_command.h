/// \file
/// `ricochet info MESH [--json]`: what a mesh file holds and what its defects mean.
#pragma once

#include <CLI/CLI.hpp>

namespace ricochet {

/// Adds the command; its callback throws InputError when the file is refused.
void add_info_command(CLI::App& app, int& exit_code);

}  // namespace ricochet
