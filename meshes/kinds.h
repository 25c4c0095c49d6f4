/// \file
/// The shapes of the program, with their options.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "generators/build_near.h"

namespace ricochet::meshes {

/// One shape on the command line.
struct Kind {
    std::string name;     ///< subcommand
    std::string summary;  ///< one line for `list` and help
    /// Adds the shape's options to its subcommand. Returns a function that makes the mesh with about the given number
    /// of triangles. It stores the option values, so call it after the command line has been read.
    std::function<std::function<TriangleMesh(std::size_t triangles)>(cli::Command command)> add_options;
};

/// Returns all shapes, in the order of the list.
[[nodiscard]] const std::vector<Kind>& kinds();

}  // namespace ricochet::meshes
