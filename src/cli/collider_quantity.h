// Quantities of a collider's triangles that can be shown as colours: hits, impulses and energies of the run's
// particles.
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

/// A quantity of triangles. It is used as recorded, or divided by area, by time, or by both.
struct ColliderQuantity {
    enum class Kind { hits, impulse, energy } kind = Kind::hits;
    bool per_area = false;
    bool per_time = false;

    [[nodiscard]] std::string name() const;
    [[nodiscard]] std::string unit() const;
    /// Returns a note if the quantity omits lasting contact, because hits and energies count impacts only. Returns an
    /// empty text if nothing is omitted.
    [[nodiscard]] std::string note(const ImpulseSizes& sizes) const;
};

/// Parses hits, impulse or energy with an optional /area, /time or both. Returns nothing for other texts.
[[nodiscard]] std::optional<ColliderQuantity> collider_quantity_from(const std::string& text);

/// Energy that impacts transferred to each triangle, in J, indexed by collider and triangle. The energy is the loss of
/// translational kinetic energy of the particles, from the contact log. Planes, spheres and cylinders have the triangle
/// -1.
using TriangleEnergies = std::map<std::pair<std::uint32_t, std::int64_t>, double>;
/// Sums the energies of the contact log. Throws InputError if the run has no contact log.
[[nodiscard]] TriangleEnergies triangle_energies(const RunFolder& folder);

/// Returns the quantity of every triangle of a collider's file. `info` describes the collider with the number `index`
/// in the run. `seconds` is the duration of the run. Balls and cylinders are single surfaces, so each of their
/// triangles gets the value of the whole surface.
[[nodiscard]] std::vector<double> quantity_values(const ColliderQuantity& quantity, const VtkPolyData& collider,
                                                  const ColliderInfo& info, std::uint32_t index,
                                                  const TriangleEnergies& energies, double seconds);

/// Adds the impulses on a collider, separated into impacts and lasting contact.
void add_impulse_sizes(const VtkPolyData& collider, const ColliderInfo& info, ImpulseSizes& sizes);

/// Returns the areas of a collider's triangles, in m^2. If the collider is a single surface, each triangle gets the
/// area of the whole surface.
[[nodiscard]] std::vector<double> triangle_areas(const VtkPolyData& collider, const ColliderInfo& info);

/// Returns the 99 % quantile of the positive values, weighted by area. Returns 1 if no value is positive.
[[nodiscard]] double upper_value(std::vector<std::pair<double, double>> values_and_areas);

}  // namespace ricochet::cli
