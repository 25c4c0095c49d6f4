/// \file
/// Private: results of queries without any hit.
#pragma once

#include <cstddef>
#include <limits>

#include "ricochet/queries/mesh_queries.h"

namespace ricochet {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns `count` results without a hit.
[[nodiscard]] inline MeshHits no_hits(std::size_t count) {
    MeshHits hits;
    hits.triangle.assign(count, kNoHit);
    hits.distance.assign(count, kInfinity);
    hits.point.assign(count, Vec3{kNan, kNan, kNan});
    return hits;
}

}  // namespace ricochet
