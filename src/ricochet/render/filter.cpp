#include "ricochet/render/filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

constexpr std::array<int, 3> kSteps = {1, 2, 4};  // pixels between taps, one pass each
constexpr float kLightSigmas = 2.0F;              // differences of light beyond these deviations are edges
constexpr float kLightFloor = 2e-3F;              // deviation below which nothing is noise to the eye
constexpr float kNormalSharpness = 48.0F;
constexpr float kAlbedoSharpness = 260.0F;
constexpr float kSmallestAlbedo = 0.03F;  // added before light is divided by it

float bright(const Float3& c) { return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z; }

float squared_distance(const Float3& a, const Float3& b) {
    const float x = a.x - b.x;
    const float y = a.y - b.y;
    const float z = a.z - b.z;
    return x * x + y * y + z * z;
}

Float3 divided(const Float3& light, const Float3& albedo) {
    return {light.x / (albedo.x + kSmallestAlbedo), light.y / (albedo.y + kSmallestAlbedo),
            light.z / (albedo.z + kSmallestAlbedo)};
}

Float3 multiplied(const Float3& light, const Float3& albedo) {
    return {light.x * (albedo.x + kSmallestAlbedo), light.y * (albedo.y + kSmallestAlbedo),
            light.z * (albedo.z + kSmallestAlbedo)};
}

// exp(-x) for x >= 0 to some thousandths, without a call: (1 - x / 16)^16.
float falling(float x) {
    float t = std::max(0.0F, 1.0F - x * (1.0F / 16.0F));
    t *= t;
    t *= t;
    t *= t;
    return t * t;
}

// One pass of the filter over the light of a picture, from one buffer into another.
class Pass {
public:
    Pass(const NoisyPicture& picture, int step) : picture_(picture), step_(step) {}

    void row(int y, NoisyPicture& target) const {
        for (int x = 0; x < picture_.width; ++x) pixel(x, y, target);
    }

private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) + static_cast<std::size_t>(x);
    }

    // Of the variances around a pixel, which is less noisy than its own.
    [[nodiscard]] float variance_near(int x, int y) const {
        constexpr std::array<float, 2> kWeights = {0.5F, 0.25F};
        float sum = 0.0F;
        float weights = 0.0F;
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                const int u = x + dx;
                const int v = y + dy;
                if (u < 0 || v < 0 || u >= picture_.width || v >= picture_.height) continue;
                const float weight = kWeights[dx == 0 ? 0 : 1] * kWeights[dy == 0 ? 0 : 1];
                sum += weight * picture_.variance[index(u, v)];
                weights += weight;
            }
        }
        return sum / weights;
    }

    void pixel(int x, int y, NoisyPicture& target) const {
        constexpr std::array<float, 3> kKernel = {3.0F / 8.0F, 1.0F / 4.0F, 1.0F / 16.0F};
        const std::size_t here = index(x, y);
        const float mine = bright(picture_.light[here]);
        const float scale = 1.0F / (kLightSigmas * std::sqrt(variance_near(x, y)) + kLightFloor);
        Float3 sum;
        float variance = 0.0F;
        float weights = 0.0F;
        for (int dy = -2; dy <= 2; ++dy) {
            const int v = y + dy * step_;
            if (v < 0 || v >= picture_.height) continue;
            for (int dx = -2; dx <= 2; ++dx) {
                const int u = x + dx * step_;
                if (u < 0 || u >= picture_.width) continue;
                const std::size_t there = index(u, v);
                const float kernel =
                    kKernel[static_cast<std::size_t>(std::abs(dx))] * kKernel[static_cast<std::size_t>(std::abs(dy))];
                const float reach = static_cast<float>(step_ * std::max(std::abs(dx), std::abs(dy)));
                const float apart = std::fabs(bright(picture_.light[there]) - mine) * scale;
                const float weight = there == here ? kernel : kernel * falling(apart + difference(here, there, reach));
                sum.x += weight * picture_.light[there].x;
                sum.y += weight * picture_.light[there].y;
                sum.z += weight * picture_.light[there].z;
                variance += weight * weight * picture_.variance[there];
                weights += weight;
            }
        }
        target.light[here] = {sum.x / weights, sum.y / weights, sum.z / weights};
        target.variance[here] = variance / (weights * weights);
    }

    // How much speaks against two pixels showing the same surface.
    [[nodiscard]] float difference(std::size_t a, std::size_t b, float reach) const {
        const PixelFeatures& p = picture_.features[a];
        const PixelFeatures& q = picture_.features[b];
        const float allowed = 1.5F * reach * p.slope + 2e-3F * p.distance + 1e-30F;
        return kNormalSharpness * squared_distance(p.normal, q.normal) +
               kAlbedoSharpness * squared_distance(p.albedo, q.albedo) + std::fabs(p.distance - q.distance) / allowed;
    }

    const NoisyPicture& picture_;
    int step_;
};

}  // namespace

void filter_noise(NoisyPicture& picture) {
    const std::size_t pixels = picture.light.size();
    for (std::size_t i = 0; i < pixels; ++i) {
        const Float3& albedo = picture.features[i].albedo;
        picture.light[i] = divided(picture.light[i], albedo);
        const float scale = bright(albedo) + kSmallestAlbedo;
        picture.variance[i] /= scale * scale;
    }
    NoisyPicture next{picture.width, picture.height, std::vector<Float3>(pixels), std::vector<float>(pixels), {}};
    for (const int step : kSteps) {
        const Pass pass(picture, step);
        parallel_for_blocks(static_cast<std::size_t>(picture.height), 4,
                            [&](std::size_t, std::size_t begin, std::size_t end) {
                                for (std::size_t y = begin; y < end; ++y) pass.row(static_cast<int>(y), next);
                            });
        std::swap(picture.light, next.light);
        std::swap(picture.variance, next.variance);
    }
    for (std::size_t i = 0; i < pixels; ++i) {
        picture.light[i] = multiplied(picture.light[i], picture.features[i].albedo);
    }
}

}  // namespace ricochet
