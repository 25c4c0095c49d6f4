// What colours a collider's triangles: what particles have done to them in the run.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/io/run_folder.h"
#include "ricochet/io/surface_groups.h"
#include "ricochet/io/vtk.h"

namespace ricochet::cli {

/// A quantity of triangles, by itself, or over their area, the run's time, or both.
struct ColliderQuantity {
    enum class Kind { hits, impulse, energy } kind = Kind::hits;
    bool per_area = false;
    bool per_time = false;

    [[nodiscard]] std::string name() const;
    [[nodiscard]] std::string unit() const;
    /// What pictures leave out by it: impacts alone are hits, and have a known energy. Empty where nothing is.
    [[nodiscard]] std::string note(const ImpulseSizes& sizes) const;
};

/// hits, impulse or energy, with /area, /time or both behind it; nothing for other texts.
[[nodiscard]] std::optional<ColliderQuantity> collider_quantity_from(const std::string& text);

/// Energy that impacts gave to each triangle, J, by collider and triangle: what they took from the motion of the
/// particles' centres. Planes, spheres and cylinders have the triangle -1. From the contact log.
using TriangleEnergies = std::map<std::pair<std::uint32_t, std::int64_t>, double>;
/// Throws InputError where the run has no contact log.
[[nodiscard]] TriangleEnergies triangle_energies(const RunFolder& folder);

/// The quantity of every triangle of a collider's file. info: the collider's, whose number in the run is `index`;
/// seconds: of the run. Balls and cylinders are single surfaces: their triangles all carry the whole surface's.
[[nodiscard]] std::vector<double> quantity_values(const ColliderQuantity& quantity, const VtkPolyData& collider,
                                                  const ColliderInfo& info, std::uint32_t index,
                                                  const TriangleEnergies& energies, double seconds);

/// Adds the impulses on a collider, by where they came from.
void add_impulse_sizes(const VtkPolyData& collider, const ColliderInfo& info, ImpulseSizes& sizes);

/// Areas of the triangles of a collider's file, m^2; of a single surface the whole area for each.
[[nodiscard]] std::vector<double> triangle_areas(const VtkPolyData& collider, const ColliderInfo& info);

/// The value below which 99 hundredths of the area lie whose value is above 0; 1 where there is none.
[[nodiscard]] double upper_value(std::vector<std::pair<double, double>> values_and_areas);

}  // namespace ricochet::cli
