// Colours of a collider's triangles from the effects of particles in the run.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/io/vtk.h"
#include "run/run_folder.h"
#include "run/surface_groups.h"

namespace ricochet::cli {

/// A quantity of triangles: as recorded, or divided by area, by time, or by both.
struct ColliderQuantity {
    enum class Kind { hits, impulse, energy } kind = Kind::hits;
    bool per_area = false;
    bool per_time = false;

    [[nodiscard]] std::string name() const;
    [[nodiscard]] std::string unit() const;
    /// Returns a note about the omission of lasting contact: hits and energies count impacts only. It is empty if
    /// nothing is omitted.
    [[nodiscard]] std::string note(const ImpulseSizes& sizes) const;
};

/// Parses hits, impulse or energy with an optional /area, /time or both. Returns nothing for other texts.
[[nodiscard]] std::optional<ColliderQuantity> collider_quantity_from(const std::string& text);

/// Energy that impacts transferred to each triangle, in J, by collider and triangle. It is the loss of kinetic energy
/// of the particles' centres, from the contact log. Planes, spheres and cylinders have the triangle -1.
using TriangleEnergies = std::map<std::pair<std::uint32_t, std::int64_t>, double>;
/// Sums the energies of the contact log. Throws InputError if the run has no contact log.
[[nodiscard]] TriangleEnergies triangle_energies(const RunFolder& folder);

/// Returns the quantity of every triangle of a collider's file. `info` describes the collider with the number `index`
/// in the run. `seconds` is the duration of the run. Balls and cylinders are single surfaces: all their triangles have
/// the value of the whole surface.
[[nodiscard]] std::vector<double> quantity_values(const ColliderQuantity& quantity, const VtkPolyData& collider,
                                                  const ColliderInfo& info, std::uint32_t index,
                                                  const TriangleEnergies& energies, double seconds);

/// Adds the impulses on a collider, separated into impacts and lasting contact.
void add_impulse_sizes(const VtkPolyData& collider, const ColliderInfo& info, ImpulseSizes& sizes);

/// Returns the areas of a collider's triangles, in m^2. Triangles of a single surface all get the whole area.
[[nodiscard]] std::vector<double> triangle_areas(const VtkPolyData& collider, const ColliderInfo& info);

/// Returns the value below which 99 % of the area with positive values lies. Returns 1 if there is none.
[[nodiscard]] double upper_value(std::vector<std::pair<double, double>> values_and_areas);

}  // namespace ricochet::cli
