/// \file
/// Tests whether the numbers of a mesh file can be metres.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ricochet/core/box3.h"

namespace ricochet {

/// Extent, in m, above which a mesh is probably in another unit. Terrain measures about 100 m. Machine parts have
/// extents of 50 and more if their unit is the millimetre. Only parts larger than this limit are therefore detected.
/// Local, because it decides only about a warning.
inline constexpr double kLargestPlausibleExtent = 200.0;

/// Limit that replaces kLargestPlausibleExtent for STL, in m. It is smaller, because STL files name no unit and are
/// usually in millimetres. Local, because it decides only about a warning.
inline constexpr double kLargestPlausibleStlExtent = 20.0;

/// Extent, in m, below which a mesh is implausible. Below a millimetre, air and adhesion dominate over impacts. Most
/// meshes of this size are results of converting the unit twice. Local, because it decides only about a warning.
inline constexpr double kSmallestPlausibleExtent = 1e-3;

/// Origin of a mesh's unit.
enum class SizeOrigin {
    file,      ///< a file without a usual unit
    stl_file,  ///< an STL file
    stated,    ///< metres, because the user has stated a unit
};

/// Returns the origin for a file format (ImportedMesh::format) or for an extension.
[[nodiscard]] SizeOrigin size_origin(std::string_view format_or_extension);

/// Returns a clause that describes the implausible size of a mesh, with its largest extent in m. Returns nullopt if the
/// size is plausible.
[[nodiscard]] std::optional<std::string> implausible_size(const Box3& bounds, SizeOrigin origin);

}  // namespace ricochet
