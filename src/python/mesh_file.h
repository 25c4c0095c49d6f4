/// \file
/// Reader of mesh files that also returns the names of faces.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "python/help_texts.h"

namespace ricochet::python {

/// Reads a mesh and the names of its faces. up: "y", "z", or nothing for the axis of the format. scale: one factor or
/// three, none of them 0. merge: tolerance within which vertices are joined, in m. Throws InputError for other values,
/// and for the same reasons as read_mesh().
[[nodiscard]] MeshObject read_named_mesh(const std::filesystem::path& file, const std::optional<std::string>& up,
                                         const py::object& scale, const py::object& merge);

}  // namespace ricochet::python
