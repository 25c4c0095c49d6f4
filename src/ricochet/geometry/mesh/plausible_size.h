/// \file
/// Whether the numbers of a mesh file can be metres.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ricochet/core/box3.h"

namespace ricochet {

/// Extents, in m, beyond which a mesh is rather in another unit. Terrain measures some 100 m. Parts of machines in
/// millimetres measure 50 and more, so larger parts are found and small ones are not.
inline constexpr double kLargestPlausibleExtent = 200.0;

/// The same for STL, which names no unit and holds millimetres by custom.
inline constexpr double kLargestPlausibleStlExtent = 20.0;

/// Below a millimetre air and adhesion decide, not impacts; most meshes of this size were converted twice.
inline constexpr double kSmallestPlausibleExtent = 1e-3;

/// Where the numbers of a mesh come from.
enum class SizeOrigin {
    file,      ///< a file without a custom unit
    stl_file,  ///< an STL file
    stated,    ///< metres, by a unit that the user has stated
};

/// Returns the origin of a mesh that was read from a file of this format, as ImportedMesh::format names it, or with
/// this extension.
[[nodiscard]] SizeOrigin size_origin(std::string_view format_or_extension);

/// Returns a clause that says what is odd about the size of a mesh, with its largest extent in m, or nothing where
/// that is plausible.
[[nodiscard]] std::optional<std::string> implausible_size(const Box3& bounds, SizeOrigin origin);

}  // namespace ricochet
