#include "view/render/color_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "view/render/lettering.h"

namespace ricochet {
namespace {

constexpr int kDotsWide = 110;  // least width of a bar, in dots of its letters
constexpr int kDotsHigh = 8;
constexpr int kColorBarMargin = 6;              // margin on each side, in dots
constexpr int kLineHeight = kLetterHeight + 3;  // height of a line of text, in dots

int dot_of(int picture_width, int picture_height) {
    return std::max(1, std::min(picture_height / 360, picture_width / 480));
}

/// Texts of a bar, broken into lines that fit the picture.
struct BarTexts {
    std::vector<std::string> title;
    std::vector<std::string> note;

    BarTexts(const ColorBar& bar, int picture_width, int dot) {
        const auto letters =
            static_cast<std::size_t>(std::max(1, (picture_width / dot - 4 * kColorBarMargin) / kLetterWidth));
        title = broken_text(bar.unit.empty() ? bar.name : fmt::format("{} ({})", bar.name, bar.unit), letters);
        note = broken_text(bar.note, letters);
    }
    /// Returns the width in dots.
    [[nodiscard]] int width() const {
        int width = kDotsWide;
        for (const auto* lines : {&title, &note}) {
            for (const std::string& line : *lines) width = std::max(width, text_width(line));
        }
        return width;
    }
    [[nodiscard]] int above() const { return kLineHeight * static_cast<int>(title.size()); }
    [[nodiscard]] int below() const { return kLineHeight * (1 + static_cast<int>(note.size())); }
};

void write_numbers(Image& image, const ValueRange& range, const BarPosition& bar_position, int y) {
    const std::string low = bar_number(range.low);
    const std::string middle = bar_number(0.5 * (range.low + range.high));
    const std::string high = bar_number(range.high);
    write_text(image, bar_position.x, y, bar_position.dot, low);
    const int widths = text_width(low) + text_width(middle) + text_width(high);
    if ((widths + 2 * kLetterWidth) * bar_position.dot < bar_position.width) {
        write_text(image, bar_position.x + (bar_position.width - text_width(middle) * bar_position.dot) / 2, y,
                   bar_position.dot, middle);
    }
    write_text(image, bar_position.x + bar_position.width - text_width(high) * bar_position.dot, y, bar_position.dot,
               high);
}

void draw_bar(Image& image, const ColorBar& bar, const BarPosition& bar_position) {
    const int dot = bar_position.dot;
    const BarTexts texts(bar, image.width, dot);
    const int top = bar_position.y - texts.above() * dot;
    shade_rectangle(image, bar_position.x - kColorBarMargin * dot / 2, top - kColorBarMargin * dot / 2,
                    bar_position.width + kColorBarMargin * dot,
                    bar_position.height + (texts.above() + texts.below() + kColorBarMargin) * dot, 0.35);
    int y = top;
    for (const std::string& line : texts.title) write_text(image, bar_position.x, y, dot, line), y += kLineHeight * dot;
    for (int x = 0; x < bar_position.width; ++x) {
        const Vec3 color =
            map_color(bar.map, bar_position.width == 1 ? 0.0 : static_cast<double>(x) / (bar_position.width - 1));
        for (int row = 0; row < bar_position.height; ++row)
            set_pixel(image, bar_position.x + x, bar_position.y + row, color);
    }
    y = bar_position.y + bar_position.height + 3 * dot;
    write_numbers(image, bar.range, bar_position, y);
    for (const std::string& line : texts.note) y += kLineHeight * dot, write_text(image, bar_position.x, y, dot, line);
}

}  // namespace

std::string bar_number(double value) {
    if (value == 0.0) return "0";  // also for -0
    constexpr std::array<std::pair<double, char>, 3> kSuffixes = {{{1e9, 'G'}, {1e6, 'M'}, {1e3, 'k'}}};
    for (const auto& [size, suffix] : kSuffixes) {
        if (std::fabs(value) < size || std::fabs(value) >= 1e12) continue;
        return fmt::format("{:.3g}{}", value / size, suffix);
    }
    return fmt::format("{:.3g}", value);
}

std::vector<std::string> broken_text(const std::string& text, std::size_t letters) {
    std::vector<std::string> lines;
    std::string rest = text;
    while (rest.size() > letters) {
        // A space directly after the last character that fits is also a valid break.
        const std::size_t space = rest.rfind(' ', letters);
        const bool at_space = space != std::string::npos && space > 0;
        lines.push_back(rest.substr(0, at_space ? space : letters));
        rest.erase(0, at_space ? space + 1 : letters);
    }
    if (!rest.empty()) lines.push_back(std::move(rest));
    return lines;
}

std::vector<BarPosition> compute_bar_positions(int picture_width, int picture_height,
                                               const std::vector<ColorBar>& bars) {
    const int dot = dot_of(picture_width, picture_height);
    std::vector<BarPosition> bar_positions;
    int x = 2 * kColorBarMargin;       // left edge of the next bar, in dots
    int bottom = 2 * kColorBarMargin;  // distance of the current row from the picture's lower edge, in dots
    int tallest = 0;                   // height of the tallest bar in the row, in dots
    for (const ColorBar& bar : bars) {
        const BarTexts texts(bar, picture_width, dot);
        if (x > 2 * kColorBarMargin && (x + texts.width() + kColorBarMargin) * dot > picture_width) {
            x = 2 * kColorBarMargin;
            bottom += tallest + 2 * kColorBarMargin;
            tallest = 0;
        }
        bar_positions.push_back({x * dot, picture_height - (bottom + kDotsHigh + texts.below()) * dot,
                                 texts.width() * dot, kDotsHigh * dot, dot});
        x += texts.width() + 3 * kColorBarMargin;
        tallest = std::max(tallest, texts.above() + kDotsHigh + texts.below());
    }
    return bar_positions;
}

void draw_color_bars(Image& image, const std::vector<ColorBar>& bars) {
    if (image.width < 200 || image.height < 100) return;
    const std::vector<BarPosition> bar_positions = compute_bar_positions(image.width, image.height, bars);
    for (std::size_t k = 0; k < bars.size(); ++k) draw_bar(image, bars[k], bar_positions[k]);
}

}  // namespace ricochet
