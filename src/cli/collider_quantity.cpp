#include "cli/collider_quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>
#include <utility>
#include <variant>

#include "ricochet/core/error.h"
#include "run/vtp_reader.h"

namespace ricochet::cli {
namespace {

using Kind = ColliderQuantity::Kind;
constexpr std::array<std::string_view, 3> kNames = {"hits", "impulse", "energy"};

bool is_one_surface(const ColliderInfo& info) { return info.type == "sphere" || info.type == "cylinder"; }

}  // namespace

std::string ColliderQuantity::name() const { return std::string(kNames[static_cast<std::size_t>(kind)]); }

std::string ColliderQuantity::unit() const {
    constexpr std::array<std::string_view, 3> kUnits = {"", "N s", "J"};
    std::string below = per_area && per_time ? "m2 s" : per_area ? "m2" : per_time ? "s" : "";
    const std::string above(kUnits[static_cast<std::size_t>(kind)]);
    if (below.empty()) return above;
    if (per_area && per_time) below = "(" + below + ")";
    return (above.empty() ? "1" : above) + "/" + below;
}

std::string ColliderQuantity::note(const ImpulseSizes& sizes) const {
    if (kind == Kind::impulse || !(sizes.lasting > 0.0)) return "";
    return fmt::format("impacts only: {:.3g} % of impulse", 100.0 * sizes.share_of_impacts());
}

std::optional<ColliderQuantity> collider_quantity_from(const std::string& text) {
    const std::string name = text.substr(0, text.find('/'));
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) return std::nullopt;
    ColliderQuantity quantity{static_cast<Kind>(found - kNames.begin())};
    const std::string rest = text.substr(name.size());
    if (rest.empty()) return quantity;
    quantity.per_area = rest == "/area" || rest == "/area/time" || rest == "/time/area";
    quantity.per_time = rest == "/time" || rest == "/area/time" || rest == "/time/area";
    if (!quantity.per_area && !quantity.per_time) return std::nullopt;
    return quantity;
}

TriangleEnergies triangle_energies(const RunFolder& folder) {
    if (folder.contacts.empty()) {
        throw InputError(
            "--collider-color energy: the run has no contact log; run the scene with --set output.contacts=true");
    }
    TriangleEnergies energies;
    for (const FrameFile& file : folder.contacts) {
        const VtkPolyData log = read_vtp(file.path);
        const auto column = [&]<class Value>(const char* name, Value) -> const std::vector<Value>& {
            const VtkArray* array = find_array(log.point_arrays, name);
            const auto* values = array == nullptr ? nullptr : std::get_if<std::vector<Value>>(&array->values);
            if (values == nullptr) throw InputError(file.path.string() + ": has no array " + name);
            return *values;
        };
        const auto& colliders = column("collider", std::uint32_t{});
        const auto& triangles = column("triangle", std::int64_t{});
        const auto& impulses = column("impulse", Vec3{});
        const auto& before = column("velocity_before", Vec3{});
        const auto& after = column("velocity_after", Vec3{});
        for (std::size_t i = 0; i < colliders.size(); ++i) {
            energies[{colliders[i], triangles[i]}] += 0.5 * dot(impulses[i], before[i] + after[i]);
        }
    }
    return energies;
}

std::vector<double> quantity_values(const ColliderQuantity& quantity, const VtkPolyData& collider,
                                    const ColliderInfo& info, std::uint32_t index, const TriangleEnergies& energies,
                                    double seconds) {
    std::vector<double> values(collider.triangles.size(), 0.0);
    const VtkArray* array = find_array(collider.cell_arrays, quantity.kind == Kind::hits ? "hits" : "impulse");
    if (quantity.kind != Kind::energy && array != nullptr) values = scalar_values(*array);
    for (std::size_t t = 0; quantity.kind == Kind::energy && t < values.size(); ++t) {
        const auto found = energies.find({index, is_one_surface(info) ? -1 : static_cast<std::int64_t>(t)});
        if (found != energies.end()) values[t] = found->second;
    }
    const std::vector<double> areas = triangle_areas(collider, info);
    for (std::size_t t = 0; t < std::min(values.size(), areas.size()); ++t) {
        if (quantity.per_time && seconds > 0.0) values[t] /= seconds;
        if (quantity.per_area) values[t] = areas[t] > 0.0 ? values[t] / areas[t] : 0.0;
    }
    return values;
}

void add_impulse_sizes(const VtkPolyData& collider, const ColliderInfo& info, ImpulseSizes& sizes) {
    const VtkArray* const impulses = find_array(collider.cell_arrays, "impulse");
    const VtkArray* const lasting = find_array(collider.cell_arrays, "lasting_impulse");
    if (impulses == nullptr || lasting == nullptr) return;
    const auto* const of_all = std::get_if<std::vector<Vec3>>(&impulses->values);
    const auto* const of_lasting = std::get_if<std::vector<Vec3>>(&lasting->values);
    if (of_all == nullptr || of_lasting == nullptr) return;
    // If the collider is a single surface, each triangle has the totals of the whole surface. Only one triangle is then
    // added.
    const bool is_single = is_one_surface(info) || info.type == "plane";
    const std::size_t count = std::min<std::size_t>(of_all->size(), is_single ? 1 : of_all->size());
    for (std::size_t t = 0; t < count; ++t) sizes.add((*of_all)[t], (*of_lasting)[t]);
}

std::vector<double> triangle_areas(const VtkPolyData& collider, const ColliderInfo& info) {
    std::vector<double> areas;
    for (const Triangle& triangle : collider.triangles) {
        const Vec3& a = collider.points[triangle[0]];
        areas.push_back(0.5 * length(cross(collider.points[triangle[1]] - a, collider.points[triangle[2]] - a)));
    }
    if (is_one_surface(info)) areas.assign(areas.size(), std::accumulate(areas.begin(), areas.end(), 0.0));
    return areas;
}

double upper_value(std::vector<std::pair<double, double>> values_and_areas) {
    std::erase_if(values_and_areas, [](const auto& one) { return !(one.first > 0.0); });
    if (values_and_areas.empty()) return 1.0;
    std::sort(values_and_areas.begin(), values_and_areas.end());
    double total = 0.0;
    for (const auto& [value, area] : values_and_areas) total += area;
    double sum = 0.0;
    for (const auto& [value, area] : values_and_areas) {
        sum += area;
        if (sum >= 0.99 * total) return value;
    }
    return values_and_areas.back().first;
}

}  // namespace ricochet::cli
