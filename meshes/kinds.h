/// \file
/// The shapes that the program offers, with their options.
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
    /// Adds the shape's options to its subcommand; the options' values live in the returned function, which makes the
    /// mesh with about the given number of triangles once the command line has been read.
    std::function<std::function<TriangleMesh(std::size_t triangles)>(cli::Command command)> add_options;
};

/// All shapes, in the order in which they are listed.
[[nodiscard]] const std::vector<Kind>& kinds();

}  // namespace ricochet::meshes
