#include "view/render/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace ricochet {
namespace {

constexpr std::size_t kKnots = 9;
constexpr std::array<std::string_view, 5> kNames = {"viridis", "plasma", "turbo", "inferno", "magma"};
constexpr std::array<std::array<std::uint32_t, kKnots>, 5> kMaps = {{
    {0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c, 0x28ae80, 0x5ec962, 0xaddc30, 0xfde725},
    {0x0d0887, 0x4c02a1, 0x7e03a8, 0xaa2395, 0xcc4778, 0xe66c5c, 0xf89540, 0xfdc527, 0xf0f921},
    {0x30123b, 0x466be3, 0x28bbec, 0x31f299, 0xa2fc3c, 0xedd03a, 0xfb8022, 0xd23105, 0x7a0403},
    {0x000004, 0x210c4a, 0x57106e, 0x8a226a, 0xbc3754, 0xe45a31, 0xf98e09, 0xf9cb35, 0xfcffa4},
    {0x000004, 0x1d1147, 0x51127c, 0x822681, 0xb73779, 0xe75263, 0xfc8961, 0xfec488, 0xfcfdbf},
}};

Vec3 srgb(std::uint32_t code) {
    return {((code >> 16) & 0xffU) / 255.0, ((code >> 8) & 0xffU) / 255.0, (code & 0xffU) / 255.0};
}

}  // namespace

std::optional<ColorMap> color_map_from_name(std::string_view name) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) return std::nullopt;
    return static_cast<ColorMap>(found - kNames.begin());
}

std::vector<std::string_view> color_map_names() { return {kNames.begin(), kNames.end()}; }

Vec3 map_color(ColorMap map, double t) {
    if (std::isnan(t)) return {0.3, 0.3, 0.3};
    const auto& knots = kMaps[static_cast<std::size_t>(map)];
    const double position = std::clamp(t, 0.0, 1.0) * (kKnots - 1);
    const auto knot = std::min(static_cast<std::size_t>(position), kKnots - 2);
    const double weight = position - static_cast<double>(knot);
    // Colours between knots are interpolated in sRGB, because the maps are perceptually uniform in sRGB.
    const Vec3 mix = (1.0 - weight) * srgb(knots[knot]) + weight * srgb(knots[knot + 1]);
    return {linear_from_srgb(mix.x), linear_from_srgb(mix.y), linear_from_srgb(mix.z)};
}

double linear_from_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double srgb_from_linear(double value) {
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

ValueRange robust_range(std::vector<double> values) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    if (values.empty()) return {};
    const auto value_at = [&](std::size_t rank) {
        const auto value = values.begin() + static_cast<std::ptrdiff_t>(rank);
        std::nth_element(values.begin(), value, values.end());
        return *value;
    };
    // The same number of values is cut off at both ends. Lists of at most 100 values are not cut.
    const std::size_t strays = (values.size() - 1) / 100;
    const double low = value_at(strays);
    const double high = value_at(values.size() - 1 - strays);
    if (low < high) return {low, high};
    const double widening = std::max(std::fabs(low) * 1e-3, 1e-12);
    return {low - widening, low + widening};
}

}  // namespace ricochet
