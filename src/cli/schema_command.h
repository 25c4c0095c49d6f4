/// \file
/// `ricochet schema [--markdown]`: the scene format for editors and for people.
#pragma once

#include <CLI/CLI.hpp>

namespace ricochet {

/// Adds the command.
void add_schema_command(CLI::App& app, int& exit_code);

}  // namespace ricochet
