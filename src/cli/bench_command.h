/// \file
/// `ricochet bench`: what collisions cost, beside what the ray library does by itself on the same stretches.
#pragma once

#include <CLI/CLI.hpp>

namespace ricochet {

/// Adds the command; its callback throws InputError and RunError.
void add_bench_command(CLI::App& app, int& exit_code);

}  // namespace ricochet
