#include "view/render/black_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "view/render/tone.h"

namespace ricochet {
namespace {

constexpr double kFirst = 380.0;  // first sampled wavelength, in nm
constexpr double kStep = 5.0;
constexpr std::size_t kSamples = 81;

double lobe(double wavelength, double middle, double below, double above) {
    const double away = (wavelength - middle) / (wavelength < middle ? below : above);
    return std::exp(-0.5 * away * away);
}

Vec3 matching(double w) {
    return {
        1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442.0, 16.0, 26.7) - 0.065 * lobe(w, 501.1, 20.4, 26.2),
        0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1),
        1.217 * lobe(w, 437.0, 11.8, 36.0) + 0.681 * lobe(w, 459.0, 26.0, 13.8)};
}

const std::array<Vec3, kSamples>& matching_samples() {
    static const std::array<Vec3, kSamples> samples = [] {
        std::array<Vec3, kSamples> all{};
        for (std::size_t i = 0; i < kSamples; ++i) all[i] = matching(kFirst + kStep * static_cast<double>(i));
        return all;
    }();
    return samples;
}

}  // namespace

Vec3 black_body_xyz(double kelvin) {
    constexpr double kSecondRadiation = 1.438776877e7;  // second radiation constant h c / k, in nm K
    Vec3 sum;
    if (!(kelvin > 0.0)) return sum;
    for (std::size_t i = 0; i < kSamples; ++i) {
        const double wavelength = kFirst + kStep * static_cast<double>(i);
        const double micrometres = 1e-3 * wavelength;
        const double radiance =
            1.0 / (std::pow(micrometres, 5.0) * std::expm1(kSecondRadiation / (wavelength * kelvin)));
        sum += kStep * radiance * matching_samples()[i];
    }
    return sum;
}

BlackBody::BlackBody(double reference) : scale_(1.0 / black_body_xyz(reference).y) {}

Vec3 BlackBody::light(double kelvin) const {
    const Vec3 xyz = scale_ * black_body_xyz(kelvin);
    Vec3 rgb{3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z, -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
             0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
    for (int channel = 0; channel < 3; ++channel) rgb[channel] = std::max(rgb[channel], 0.0);
    const double bright = luminance(rgb);
    return bright > 0.0 && std::isfinite(bright) ? (xyz.y / bright) * rgb : Vec3{};
}

}  // namespace ricochet
