#include "view/render/tone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "view/render/color_map.h"

namespace ricochet {
namespace {

long rounded_channel(double linear) { return std::lround(255.0 * srgb_from_linear(linear)); }

// Lookup table for rounded_channel(), which avoids its power function. For each channel value 0..255, the table stores
// the smallest linear value that is rounded to it. The table also divides 0..1 into cells and stores the channel value
// at the lower end of each cell. A channel value above 0 covers an interval of linear values that is wider than a cell.
// A cell therefore contains at most two channel values.
class ChannelTable {
public:
    ChannelTable() {
        starts_[0] = 0.0;
        for (std::size_t k = 1; k < kChannels; ++k) starts_[k] = start_of(static_cast<long>(k));
        starts_[kChannels] = 2.0;  // above all values
        for (std::size_t cell = 0; cell <= kCells; ++cell) {
            channels_[cell] = static_cast<std::uint8_t>(rounded_channel(static_cast<double>(cell) / kCells));
        }
    }

    [[nodiscard]] std::uint8_t channel(double linear) const {
        if (!(linear > 0.0)) return 0;
        const double inside = std::min(linear, 1.0);
        const std::uint8_t lower = channels_[static_cast<std::size_t>(inside * kCells)];
        return static_cast<std::uint8_t>(lower + (inside >= starts_[lower + std::size_t{1}] ? 1 : 0));
    }

private:
    static constexpr std::size_t kChannels = 256;
    static constexpr std::size_t kCells = 4096;  // a power of two, so that `inside * kCells` is exact at the cell
                                                 // boundaries

    // Returns the smallest linear value that is rounded to a channel value of at least k.
    static double start_of(long k) {
        const double about = linear_from_srgb((static_cast<double>(k) - 0.5) / 255.0);
        double below = about * (1.0 - 1e-9);
        double above = about * (1.0 + 1e-9);
        while (std::nextafter(below, above) < above) {
            const double middle = below + 0.5 * (above - below);
            (rounded_channel(middle) < k ? below : above) = middle;
        }
        return above;
    }

    std::array<double, kChannels + 1> starts_{};
    std::array<std::uint8_t, kCells + 1> channels_{};
};

}  // namespace

std::uint8_t display_channel(double linear) {
    static const ChannelTable table;
    return table.channel(linear);
}

}  // namespace ricochet
