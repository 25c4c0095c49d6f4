/// \file
/// `ricochet check SCENE [--set PATH=VALUE ...]`: all that is wrong with a scene, without running it.
#pragma once

#include <CLI/CLI.hpp>

namespace ricochet {

/// Adds the command; its callback throws InputError (SceneError where several things are wrong).
void add_check_command(CLI::App& app, int& exit_code);

}  // namespace ricochet
