/// \file
/// Groups and materials of a collider's triangles, and totals by group.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ricochet/collision/collider.h"
#include "ricochet/core/vec3.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/vtk.h"
#include "ricochet/response/material.h"
#include "ricochet/simulation.h"

namespace ricochet {

// Names of the arrays and texts in a collider's file.
inline constexpr const char* kGroupArray = "group";
inline constexpr const char* kMaterialArray = "material";
inline constexpr const char* kGroupNames = "group_names";
inline constexpr const char* kMaterialNames = "material_names";
inline constexpr const char* kNote = "note";

/// Name written for materials without a name, such as the material of colliders that name none.
inline constexpr const char* kDefaultMaterial = "default";

/// Totals of the triangles of one group.
struct GroupTotals {
    std::string name;
    std::uint64_t triangles = 0;
    std::uint64_t hits = 0;
    Vec3 impulse;          ///< N s
    Vec3 lasting_impulse;  ///< part of `impulse` that is not due to impacts, in N s
};

/// Returns the totals of each group, in the order of the names, summed in the order of the triangles. Returns nothing
/// if the mesh has no groups or the simulation records no totals.
[[nodiscard]] std::vector<GroupTotals> totals_by_group(const TriangleGroups& groups, const TriangleTotals& totals);

/// Impulses on surfaces, in N s, separated into impacts and lasting contact. Each member sums the magnitudes of the
/// triangles' total impulses.
struct ImpulseSizes {
    double of_impacts = 0.0;
    double lasting = 0.0;  ///< not due to impacts

    void add(const Vec3& impulse, const Vec3& lasting_impulse) {
        of_impacts += length(impulse - lasting_impulse);
        lasting += length(lasting_impulse);
    }
    void add(const TriangleTotals& totals);
    void add(const ImpulseSizes& other) { of_impacts += other.of_impacts, lasting += other.lasting; }
    /// Returns true if surfaces received any impulse.
    [[nodiscard]] bool any() const { return of_impacts + lasting > 0.0; }
    /// Returns the impulses of impacts divided by all impulses, from 0 to 1. Requires any().
    [[nodiscard]] double share_of_impacts() const { return of_impacts / (of_impacts + lasting); }
};

/// Adds the group number and the material number of each triangle to a collider's file, with their names as texts.
/// A mesh without groups gets no groups. Adds a note if the totals include lasting contact, because hits count only
/// impacts.
void add_surfaces(VtkPolyData& frame, const ColliderDescription& collider, std::span<const Material> materials,
                  const TriangleGroups& groups, const TriangleTotals& totals);

}  // namespace ricochet
