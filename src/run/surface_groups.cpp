#include "run/surface_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace ricochet {
namespace {

std::vector<std::uint32_t> materials_of(const ColliderDescription& collider, std::size_t triangles) {
    const auto* const mesh = std::get_if<MeshShape>(&collider.shape);
    if (mesh != nullptr && mesh->triangle_materials.size() == triangles) return mesh->triangle_materials;
    return std::vector<std::uint32_t>(triangles, collider.material);
}

std::vector<std::string> names_of(std::span<const Material> materials) {
    std::vector<std::string> names;
    for (const Material& material : materials)
        names.push_back(material.name.empty() ? kDefaultMaterial : material.name);
    return names;
}

std::string note_of(const ImpulseSizes& sizes) {
    return fmt::format(
        "hits counts impacts, which gave {:.3g} % of the impulse; the rest is contact that lasts: lasting_impulse",
        100.0 * sizes.share_of_impacts());
}

}  // namespace

std::vector<GroupTotals> totals_by_group(const TriangleGroups& groups, const TriangleTotals& totals) {
    std::vector<GroupTotals> result;
    if (groups.empty() || totals.hits.size() != groups.triangles.size()) return result;
    for (const std::string& name : groups.names) result.push_back({name, 0, 0, {}, {}});
    for (std::size_t t = 0; t < groups.triangles.size(); ++t) {
        GroupTotals& group = result[groups.triangles[t]];
        ++group.triangles;
        group.hits += totals.hits[t];
        group.impulse += totals.impulse[t];
        group.lasting_impulse += totals.lasting_impulse[t];
    }
    return result;
}

void ImpulseSizes::add(const TriangleTotals& totals) {
    for (std::size_t t = 0; t < std::min(totals.impulse.size(), totals.lasting_impulse.size()); ++t) {
        add(totals.impulse[t], totals.lasting_impulse[t]);
    }
}

void add_surfaces(VtkPolyData& frame, const ColliderDescription& collider, std::span<const Material> materials,
                  const TriangleGroups& groups, const TriangleTotals& totals) {
    const std::size_t count = frame.triangles.size();
    if (!groups.empty() && groups.triangles.size() == count) {
        frame.cell_arrays.push_back({kGroupArray, groups.triangles});
        frame.texts.push_back({kGroupNames, groups.names});
    }
    frame.cell_arrays.push_back({kMaterialArray, materials_of(collider, count)});
    frame.texts.push_back({kMaterialNames, names_of(materials)});
    ImpulseSizes sizes;
    sizes.add(totals);
    if (sizes.lasting > 0.0) frame.texts.push_back({kNote, {note_of(sizes)}});
}

}  // namespace ricochet
