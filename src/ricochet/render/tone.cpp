#include "ricochet/render/tone.h"

#include <algorithm>
#include <cmath>

#include "ricochet/render/color_map.h"

namespace ricochet {

Vec3 tone_mapped(const Vec3& light) {
    constexpr double kWhite = 3.0;
    const double bright = luminance(light);
    if (!(bright > 0.0)) return {};
    const double shown = bright * (1.0 + bright / (kWhite * kWhite)) / (1.0 + bright);
    return light * (shown / bright);
}

std::uint8_t display_channel(double linear) {
    return static_cast<std::uint8_t>(std::lround(255.0 * srgb_from_linear(std::clamp(linear, 0.0, 1.0))));
}

}  // namespace ricochet
