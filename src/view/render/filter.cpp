#include "view/render/filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

// Distance between taps (sampled pixels of the filter kernel) in each pass, in pixels.
constexpr std::array<int, 3> kSteps = {1, 2, 4};
// Number of standard deviations above which a difference of brightness counts as an edge.
constexpr float kLightSigmas = 2.0F;
constexpr float kLightFloor = 2e-3F;  // standard deviation of brightness below which noise is invisible
constexpr float kNormalSharpness = 48.0F;
constexpr float kAlbedoSharpness = 260.0F;
constexpr float kSmallestAlbedo = 0.03F;  // added to the albedo before light is divided by the albedo

float bright(const Float3& c) { return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z; }

Float3 divided(const Float3& light, const Float3& albedo) {
    return {light.x / (albedo.x + kSmallestAlbedo), light.y / (albedo.y + kSmallestAlbedo),
            light.z / (albedo.z + kSmallestAlbedo)};
}

Float3 multiplied(const Float3& light, const Float3& albedo) {
    return {light.x * (albedo.x + kSmallestAlbedo), light.y * (albedo.y + kSmallestAlbedo),
            light.z * (albedo.z + kSmallestAlbedo)};
}

// Approximates exp(-x) for x >= 0 as (1 - x / 16)^16, which avoids a library call.
float falling(float x) {
    const float left = 1.0F - x * (1.0F / 16.0F);
    float t = 0.5F * (left + std::fabs(left));  // max(left, 0), without a branch
    t *= t;
    t *= t;
    t *= t;
    return t * t;
}

// Row of a picture. Each component has its own array, so that the compiler can vectorize the loops over pixels.
struct Row {
    std::vector<float> red, green, blue, bright, variance;
    std::vector<float> normal_x, normal_y, normal_z, albedo_x, albedo_y, albedo_z, distance;

    explicit Row(std::size_t width) {
        for (auto* values : {&red, &green, &blue, &bright, &variance, &normal_x, &normal_y, &normal_z, &albedo_x,
                             &albedo_y, &albedo_z, &distance}) {
            values->resize(width);
        }
    }

    void load(const NoisyPicture& picture, int y) {
        const std::size_t first = static_cast<std::size_t>(y) * red.size();
        for (std::size_t x = 0; x < red.size(); ++x) {
            const Float3& light = picture.light[first + x];
            const PixelFeatures& features = picture.features[first + x];
            red[x] = light.x;
            green[x] = light.y;
            blue[x] = light.z;
            bright[x] = ricochet::bright(light);
            variance[x] = picture.variance[first + x];
            normal_x[x] = features.normal.x;
            normal_y[x] = features.normal.y;
            normal_z[x] = features.normal.z;
            albedo_x[x] = features.albedo.x;
            albedo_y[x] = features.albedo.y;
            albedo_z[x] = features.albedo.z;
            distance[x] = features.distance;
        }
    }
};

// Sums over the taps of each pixel of a row.
struct Sums {
    std::vector<float> red, green, blue, variance, weights;

    explicit Sums(std::size_t width) : red(width), green(width), blue(width), variance(width), weights(width) {}
    void clear() {
        for (auto* values : {&red, &green, &blue, &variance, &weights}) std::fill(values->begin(), values->end(), 0.0F);
    }
};

float squared(float x) { return x * x; }

// Computes the dissimilarity of `count` pairs of pixels from their surface features and brightness. `scale` multiplies
// differences of brightness. `steep`, in 1/m, multiplies differences of distance. It is the inverse of the difference
// that is expected on an inclined surface.
void differences(const Row& here, std::size_t x, const Row& there, std::size_t u, std::size_t count,
                 const float* __restrict scale, const float* __restrict steep, float* __restrict out) {
    for (std::size_t i = 0; i < count; ++i) {
        const float apart = std::fabs(there.bright[u + i] - here.bright[x + i]) * scale[i];
        const float normals = squared(here.normal_x[x + i] - there.normal_x[u + i]) +
                              squared(here.normal_y[x + i] - there.normal_y[u + i]) +
                              squared(here.normal_z[x + i] - there.normal_z[u + i]);
        const float albedos = squared(here.albedo_x[x + i] - there.albedo_x[u + i]) +
                              squared(here.albedo_y[x + i] - there.albedo_y[u + i]) +
                              squared(here.albedo_z[x + i] - there.albedo_z[u + i]);
        const float difference = kNormalSharpness * normals + kAlbedoSharpness * albedos +
                                 std::fabs(here.distance[x + i] - there.distance[u + i]) * steep[i];
        out[i] = apart + difference;
    }
}

// One pass of the filter over the light of a picture. It reads one buffer and writes another.
class Pass {
public:
    Pass(const NoisyPicture& picture, int step)
        : picture_(picture),
          step_(step),
          width_(static_cast<std::size_t>(picture.width)),
          rows_(kRows, Row(width_)),
          sums_(width_),
          scale_(width_),
          steep_{std::vector<float>(width_), std::vector<float>(width_), std::vector<float>(width_)},
          weights_(width_) {}

    // Filters the rows [begin, end). Rows that are `step_` apart are filtered one after the other. Most of their taps
    // are in the same rows, which are then still in the cache.
    void rows(int begin, int end, NoisyPicture& target) {
        for (int first = begin; first < std::min(begin + step_, end); ++first) {
            for (int y = first; y < end; y += step_) row(y, target);
        }
    }

private:
    void row(int y, NoisyPicture& target) {
        const Row& here = loaded(y);
        for (std::size_t x = 0; x < width_; ++x) {
            scale_[x] = 1.0F / (kLightSigmas * std::sqrt(variance_near(static_cast<int>(x), y)) + kLightFloor);
            const PixelFeatures& features = picture_.features[index(static_cast<int>(x), y)];
            for (std::size_t away = 0; away < steep_.size(); ++away) {
                const float reach = static_cast<float>(step_) * static_cast<float>(away);
                steep_[away][x] = 1.0F / (1.5F * reach * features.slope + 2e-3F * features.distance + 1e-30F);
            }
        }
        sums_.clear();
        for (int dy = -2; dy <= 2; ++dy) {
            const int v = y + dy * step_;
            if (v < 0 || v >= picture_.height) continue;
            const Row& there = loaded(v);
            for (int dx = -2; dx <= 2; ++dx) add_tap(here, there, dx, dy);
        }
        const std::size_t first = index(0, y);
        for (std::size_t x = 0; x < width_; ++x) {
            const float weights = sums_.weights[x];
            target.light[first + x] = {sums_.red[x] / weights, sums_.green[x] / weights, sums_.blue[x] / weights};
            target.variance[first + x] = sums_.variance[x] / (weights * weights);
        }
    }

    // Returns a row of the picture. Loads the row if it is not in the cache of the last rows.
    const Row& loaded(int y) {
        const auto slot = static_cast<std::size_t>(y / step_) % kRows;
        if (loaded_[slot] != y) {
            rows_[slot].load(picture_, y);
            loaded_[slot] = y;
        }
        return rows_[slot];
    }

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) + static_cast<std::size_t>(x);
    }

    // Returns a weighted mean of the variances around a pixel, which is less noisy than the pixel's own variance.
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

    // Adds the tap at offset (dx, dy) to the sums of a row. Pixels whose tap is outside the picture are skipped.
    void add_tap(const Row& here, const Row& there, int dx, int dy) {
        constexpr std::array<float, 3> kKernel = {3.0F / 8.0F, 1.0F / 4.0F, 1.0F / 16.0F};
        const auto across = static_cast<std::size_t>(std::abs(dx));
        const auto along = static_cast<std::size_t>(std::abs(dy));
        const float kernel = kKernel[across] * kKernel[along];
        const std::size_t shift = across * static_cast<std::size_t>(step_);
        if (shift >= width_) return;
        const std::size_t x = dx < 0 ? shift : 0;
        const std::size_t u = dx < 0 ? 0 : shift;
        const std::size_t count = width_ - shift;
        float* __restrict weights = weights_.data();
        if (dx == 0 && dy == 0) {
            std::fill(weights_.begin(), weights_.end(), kernel);
        } else {
            differences(here, x, there, u, count, scale_.data() + x, steep_[std::max(across, along)].data() + x,
                        weights);
            for (std::size_t i = 0; i < count; ++i) weights[i] = kernel * falling(weights[i]);
        }
        add(there.red, u, sums_.red, x, count);
        add(there.green, u, sums_.green, x, count);
        add(there.blue, u, sums_.blue, x, count);
        float* __restrict variance = sums_.variance.data() + x;
        float* __restrict all = sums_.weights.data() + x;
        for (std::size_t i = 0; i < count; ++i) {
            variance[i] += weights[i] * weights[i] * there.variance[u + i];
            all[i] += weights[i];
        }
    }

    void add(const std::vector<float>& values, std::size_t u, std::vector<float>& sums, std::size_t x,
             std::size_t count) const {
        float* __restrict to = sums.data() + x;
        const float* __restrict from = values.data() + u;
        const float* __restrict weights = weights_.data();
        for (std::size_t i = 0; i < count; ++i) to[i] += weights[i] * from[i];
    }

    const NoisyPicture& picture_;
    int step_;
    std::size_t width_;
    static constexpr std::size_t kRows = 5;  // number of rows that contain the taps of a pixel
    std::vector<Row> rows_;
    std::array<int, kRows> loaded_{-1, -1, -1, -1, -1};
    Sums sums_;
    std::vector<float> scale_;
    std::array<std::vector<float>, 3> steep_;  // index: distance of the tap, in steps
    std::vector<float> weights_;               // weights of one tap
};

}  // namespace

void filter_noise(NoisyPicture& picture) {
    const std::size_t pixels = picture.light.size();
    const auto for_each_pixel = [&](const auto& change) {
        parallel_for_blocks(pixels, 8192, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) change(i);
        });
    };
    for_each_pixel([&](std::size_t i) {
        const Float3& albedo = picture.features[i].albedo;
        picture.light[i] = divided(picture.light[i], albedo);
        const float scale = bright(albedo) + kSmallestAlbedo;
        picture.variance[i] /= scale * scale;
    });
    NoisyPicture next{picture.width, picture.height, std::vector<Float3>(pixels), std::vector<float>(pixels), {}};
    for (const int step : kSteps) {
        parallel_for_blocks(static_cast<std::size_t>(picture.height), 16,
                            [&](std::size_t, std::size_t begin, std::size_t end) {
                                Pass pass(picture, step);
                                pass.rows(static_cast<int>(begin), static_cast<int>(end), next);
                            });
        std::swap(picture.light, next.light);
        std::swap(picture.variance, next.variance);
    }
    for_each_pixel([&](std::size_t i) { picture.light[i] = multiplied(picture.light[i], picture.features[i].albedo); });
}

}  // namespace ricochet
