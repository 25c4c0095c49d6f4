/// \file
/// `ricochet run SCENE --output DIR`: simulates a scene and writes frames and a summary.
#pragma once

#include <CLI/CLI.hpp>

namespace ricochet {

/// Adds the command; its callback throws InputError and RunError and sets exit_code to 128 + signal when interrupted.
void add_run_command(CLI::App& app, int& exit_code);

}  // namespace ricochet
