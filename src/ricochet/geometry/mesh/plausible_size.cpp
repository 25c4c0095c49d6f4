#include "ricochet/geometry/mesh/plausible_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ricochet {

SizeOrigin size_origin(std::string_view format_or_extension) {
    const bool is_stl =
        format_or_extension.starts_with("STL") || format_or_extension == ".stl" || format_or_extension == ".STL";
    return is_stl ? SizeOrigin::stl_file : SizeOrigin::file;
}

std::optional<std::string> implausible_size(const Box3& bounds, SizeOrigin origin) {
    const Vec3 size = bounds.size();
    const double extent = std::max({size.x, size.y, size.z});
    if (bounds.empty() || !std::isfinite(extent) || !(extent > 0.0)) return std::nullopt;
    const double largest = origin == SizeOrigin::stl_file ? kLargestPlausibleStlExtent : kLargestPlausibleExtent;
    if (extent >= kSmallestPlausibleExtent && extent <= largest) return std::nullopt;
    if (origin == SizeOrigin::stated) return fmt::format("the mesh is {:.3g} m large", extent);
    if (extent < kSmallestPlausibleExtent) {
        return fmt::format("the mesh is {:.3g} m large if its numbers are metres (were they converted twice?)", extent);
    }
    return fmt::format("the mesh is {:.4g} m large if its numbers are metres, {:.3g} m if they are millimetres", extent,
                       1e-3 * extent);
}

}  // namespace ricochet
