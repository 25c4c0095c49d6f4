#include "ricochet/render/color_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ricochet/render/lettering.h"

namespace ricochet {
namespace {

constexpr int kDotsWide = 110;  // a bar, in dots of its letters
constexpr int kDotsHigh = 8;
constexpr int kMargin = 6;  // dots around

void draw_bar(Image& image, const ColorBar& bar, const BarPlace& place) {
    const int dot = place.dot;
    const int text_row = (kLetterHeight + 3) * dot;
    shade_rectangle(image, place.x - kMargin * dot / 2, place.y - text_row - kMargin * dot / 2,
                    place.width + kMargin * dot, place.height + 2 * text_row + kMargin * dot, 0.35);
    std::string title = bar.unit.empty() ? bar.name : fmt::format("{} ({})", bar.name, bar.unit);
    const std::size_t room = static_cast<std::size_t>(place.width / (kLetterWidth * dot));
    if (title.size() > room) title.resize(room);
    write_text(image, place.x, place.y - text_row, dot, title);
    for (int x = 0; x < place.width; ++x) {
        const Vec3 color = map_color(bar.map, place.width == 1 ? 0.0 : static_cast<double>(x) / (place.width - 1));
        for (int y = 0; y < place.height; ++y) set_pixel(image, place.x + x, place.y + y, color);
    }
    const int below = place.y + place.height + 3 * dot;
    const std::string high = bar_number(bar.range.high);
    const std::string middle = bar_number(0.5 * (bar.range.low + bar.range.high));
    write_text(image, place.x, below, dot, bar_number(bar.range.low));
    const int widths = text_width(bar_number(bar.range.low)) + text_width(middle) + text_width(high);
    if ((widths + 2 * kLetterWidth) * dot < place.width) {
        write_text(image, place.x + (place.width - text_width(middle) * dot) / 2, below, dot, middle);
    }
    write_text(image, place.x + place.width - text_width(high) * dot, below, dot, high);
}

}  // namespace

std::string bar_number(double value) {
    if (value == 0.0) return "0";  // not -0
    constexpr std::array<std::pair<double, char>, 3> kSuffixes = {{{1e9, 'G'}, {1e6, 'M'}, {1e3, 'k'}}};
    for (const auto& [size, suffix] : kSuffixes) {
        if (std::fabs(value) < size || std::fabs(value) >= 1e12) continue;
        return fmt::format("{:.3g}{}", value / size, suffix);
    }
    return fmt::format("{:.3g}", value);
}

BarPlace bar_place(int picture_width, int picture_height, std::size_t number) {
    BarPlace place;
    place.dot = std::max(1, std::min(picture_height / 360, picture_width / 480));
    place.width = kDotsWide * place.dot;
    place.height = kDotsHigh * place.dot;
    place.x = (2 * kMargin + static_cast<int>(number) * (kDotsWide + 3 * kMargin)) * place.dot;
    place.y = picture_height - (kDotsHigh + kLetterHeight + 3 + 2 * kMargin) * place.dot;
    return place;
}

void draw_color_bars(Image& image, const std::vector<ColorBar>& bars) {
    if (image.width < 200 || image.height < 100) return;
    for (std::size_t k = 0; k < bars.size(); ++k) draw_bar(image, bars[k], bar_place(image.width, image.height, k));
}

}  // namespace ricochet
