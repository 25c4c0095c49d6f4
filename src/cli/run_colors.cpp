// Colours in a run's pictures: colours of colliders by a quantity, and the colour bars.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/run_pictures.h"
#include "run/vtp_reader.h"

namespace ricochet::cli {
namespace {

// Returns the unit of a built-in array. Units of user-defined arrays are unknown.
std::string unit_of(const std::string& array) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kUnits = {{{"speed", "m/s"},
                                                                                      {"velocity", "m/s"},
                                                                                      {"mass", "kg"},
                                                                                      {"radius", "m"},
                                                                                      {"size", "m"},
                                                                                      {"age", "s"},
                                                                                      {"unsimulated_time", "s"},
                                                                                      {"spin", "rad/s"},
                                                                                      {"temperature", "K"}}};
    for (const auto& [name, unit] : kUnits) {
        if (name == array) return std::string(unit);
    }
    return "";
}

}  // namespace

// Colours all colliders by the chosen quantity, with one common range.
void RunPictures::color_colliders(const RunFolder& folder) {
    const ColliderQuantity& quantity = *style_.collider_quantity;
    TriangleEnergies energies;
    if (quantity.kind == ColliderQuantity::Kind::energy) energies = triangle_energies(folder);
    std::vector<std::vector<double>> values;
    std::vector<std::pair<double, double>> all;
    std::vector<std::filesystem::path> files = mesh_files_;
    for (const auto& [number, file] : moving_files_) files.push_back(file);
    for (const std::filesystem::path& file : files) {
        const VtkPolyData data = read_vtp(file);
        ColliderInfo info;
        for (const ColliderInfo& one : folder.info.colliders) {
            if (one.file == file.filename().string()) info = one;
        }
        add_impulse_sizes(data, info, impulse_sizes_);
        if (has_incomplete_totals(folder, data.time))
            totals_end_ = std::min(totals_end_.value_or(data.time), data.time);
        const auto index = static_cast<std::uint32_t>(index_of_collider_file(file.filename().string()).value_or(0));
        values.push_back(quantity_values(quantity, data, info, index, energies, data.time));
        const std::vector<double> areas = triangle_areas(data, info);
        for (std::size_t t = 0; t < areas.size(); ++t) all.emplace_back(values.back()[t], areas[t]);
    }
    collider_range_ = style_.collider_range ? *style_.collider_range : ValueRange{0.0, upper_value(std::move(all))};
    const double scale = 1.0 / (collider_range_.high - collider_range_.low);
    const auto colors_of = [&](const std::vector<double>& of_triangles) {
        std::vector<Vec3> colors;
        for (const double value : of_triangles) {
            colors.push_back(kParticleAlbedo * map_color(ColorMap::viridis, (value - collider_range_.low) * scale));
        }
        return colors;
    };
    for (std::size_t m = 0; m < meshes_.size(); ++m) meshes_[m].triangle_colors = colors_of(values[m]);
    std::size_t next = meshes_.size();
    for (const auto& [number, file] : moving_files_) moving_colors_[number] = colors_of(values[next++]);
}

std::vector<ColorBar> RunPictures::color_bars() const {
    std::vector<ColorBar> bars;
    if (!own_colors_ && !plain_image_ && !embers_)
        bars.push_back({style_.color_by, unit_of(style_.color_by), range_, style_.map});
    if (style_.collider_quantity) {
        const ColliderQuantity& quantity = *style_.collider_quantity;
        bars.push_back(
            {quantity.name(), quantity.unit(), collider_range_, ColorMap::viridis, quantity.note(impulse_sizes_)});
    }
    return bars;
}

}  // namespace ricochet::cli
