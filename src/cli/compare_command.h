/// \file
/// `ricochet compare SCENE --output DIR`: one scene with several answers to collisions at several time steps, what each
/// costs and gets wrong. docs/compare.md describes what it writes.
#pragma once

#include <CLI/CLI.hpp>

namespace ricochet {

/// Adds the command; its callback throws InputError and RunError.
void add_compare_command(CLI::App& app, int& exit_code);

}  // namespace ricochet
