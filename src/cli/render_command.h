/// \file
/// `ricochet render DIR --output FILE.png|.mp4`: pictures and films of a run.
#pragma once

#include <CLI/CLI.hpp>

namespace ricochet {

/// Adds the command; its callback throws InputError and RunError and sets exit_code to 128 + signal when interrupted.
void add_render_command(CLI::App& app, int& exit_code);

}  // namespace ricochet
