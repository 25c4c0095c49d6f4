#include "view/render/sphere_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1024;  // spheres per unit of parallel work
// Largest ratio of the pixels that spheres cover, summed over all spheres, to the pixels of the picture. Above this
// ratio, ray tracing is faster.
constexpr double kMostCovered = 24.0;
constexpr double kMargin = 0.01;  // margin of spots for rounding errors, in pixels

// Returns the slopes of the two tangents from the origin to a circle with its centre at (ahead, across). `ahead` must
// exceed the radius.
std::array<double, 2> slopes_of(double across, double ahead, double radius) {
    const double under = ahead * ahead - radius * radius;
    const double spread = radius * std::sqrt(across * across + under);
    return {(across * ahead - spread) / under, (across * ahead + spread) / under};
}

// Returns the first of `count` pixels whose middle is at or above the coordinate `at`, or `count` if there is none. Any
// value of `at` is valid.
int pixel_from(double at, int count) {
    return static_cast<int>(std::clamp(std::ceil(at - 0.5), 0.0, static_cast<double>(count)));
}

// Sphere, and the tiles [begin, end) of a row in which it can be visible.
struct KeptSpot {
    NearSphere sphere;
    std::size_t begin = 0;
    std::size_t end = 0;
};

bool is_nearer(const KeptSpot& a, const KeptSpot& b) {
    return a.sphere.nearest != b.sphere.nearest ? a.sphere.nearest < b.sphere.nearest
                                                : a.sphere.sphere < b.sphere.sphere;
}

}  // namespace

SphereView::SphereView(const DrawnSpheres& spheres, const Camera& camera, int width, int height, WithinPixel where)
    : spheres_(spheres),
      camera_(camera),
      frame_(camera_frame(camera)),
      width_(width),
      height_(height),
      spread_(where == WithinPixel::middle ? 0.0 : 0.5) {
    const double tangent = half_height(camera);
    const double aspect = static_cast<double>(width) / height;
    for (int x = 0; x < width; ++x) across_.push_back((2.0 * (x + 0.5) / width - 1.0) * aspect * tangent);
    for (int y = 0; y < height; ++y) up_.push_back((1.0 - 2.0 * (y + 0.5) / height) * tangent);
    std::vector<Spot> spots(spheres.centers.size());
    parallel_for_blocks(spots.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) spots[i] = spot_of(spheres.centers[i], spheres.radii[i]);
    });
    const int bands = (height + band_rows() - 1) / band_rows();
    first_.assign(static_cast<std::size_t>(bands) + 1, 0);
    double covered = 0.0;
    for (std::size_t i = 0; i < spots.size(); ++i) {
        const Spot& spot = spots[i];
        if (spot.left >= spot.right || spot.top >= spot.bottom) continue;
        covered += static_cast<double>(spot.right - spot.left) * (spot.bottom - spot.top);
        spots_.push_back(spot);
        numbers_.push_back(static_cast<std::uint32_t>(i));
    }
    pays_ = covered <= kMostCovered * width * height;
    if (pays_) sort_into_bands();
}

// Lists the spots of each band in the order of the spheres.
void SphereView::sort_into_bands() {
    const auto each_band = [this](auto&& visit) {
        for (std::size_t k = 0; k < spots_.size(); ++k) {
            const int last = (spots_[k].bottom - 1) / band_rows();
            for (int band = spots_[k].top / band_rows(); band <= last; ++band) visit(static_cast<std::size_t>(band), k);
        }
    };
    each_band([this](std::size_t band, std::size_t) { ++first_[band + 1]; });
    for (std::size_t band = 1; band < first_.size(); ++band) first_[band] += first_[band - 1];
    in_band_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    each_band([&](std::size_t band, std::size_t k) { in_band_[next[band]++] = static_cast<std::uint32_t>(k); });
}

SphereView::Spot SphereView::spot_of(const Vec3& center, double radius) const {
    const Vec3 away = center - camera_.position;
    Spot spot;
    spot.ahead = dot(away, frame_.forward);
    spot.across = dot(away, frame_.right);
    spot.up = dot(away, frame_.up);
    spot.power = dot(away, away) - radius * radius;
    if (spot.ahead <= -radius) return spot;
    if (spot.ahead <= radius * (1.0 + 1e-9)) {  // the sphere extends behind the camera's plane
        spot.right = width_;
        spot.bottom = height_;
        return spot;
    }
    const double scale = 0.5 * height_ / half_height(camera_);  // pixels per unit slope
    const auto [left, right] = slopes_of(spot.across, spot.ahead, radius);
    const auto [low, high] = slopes_of(spot.up, spot.ahead, radius);
    const double margin = spread_ + kMargin;
    spot.left = pixel_from(0.5 * width_ + scale * left - margin, width_);
    spot.right = pixel_from(0.5 * width_ + scale * right + margin, width_);
    spot.top = pixel_from(0.5 * height_ - scale * high - margin, height_);
    spot.bottom = pixel_from(0.5 * height_ - scale * low + margin, height_);
    return spot;
}

void SphereView::find(int band, std::span<SphereFind> finds) const {
    std::fill(finds.begin(), finds.end(), SphereFind{});
    const int top = band * band_rows();
    const int bottom = std::min(top + band_rows(), height_);
    const auto which = static_cast<std::size_t>(band);
    for (std::size_t k = first_[which]; k < first_[which + 1]; ++k) {
        const Spot& spot = spots_[in_band_[k]];
        for (int row = std::max(top, spot.top); row < std::min(bottom, spot.bottom); ++row) {
            const std::size_t begin = static_cast<std::size_t>(row - top) * static_cast<std::size_t>(width_);
            cover_row(spot, numbers_[in_band_[k]], row, finds.subspan(begin, static_cast<std::size_t>(width_)));
        }
    }
}

// The ray of a pixel has the direction d = forward + x right + y up, which is not normalized. It hits the sphere at the
// solutions t of |d|^2 t^2 - 2 (d . away) t + power = 0.
void SphereView::cover_row(const Spot& spot, std::uint32_t sphere, int row, std::span<SphereFind> finds) const {
    const double slope = up_[static_cast<std::size_t>(row)];
    const double row_middle = spot.ahead + slope * spot.up;
    for (auto x = static_cast<std::size_t>(spot.left); x < static_cast<std::size_t>(spot.right); ++x) {
        const double square = 1.0 + across_[x] * across_[x] + slope * slope;
        const double middle = row_middle + across_[x] * spot.across;
        const double under = middle * middle - square * spot.power;
        if (!(under >= 0.0)) continue;
        const double half = std::sqrt(under);
        const double norm = std::sqrt(square);
        double distance = (middle - half) / norm;
        if (!(distance > 0.0)) distance = (middle + half) / norm;
        if (distance > 0.0 && distance < finds[x].distance) finds[x] = {distance, sphere};
    }
}

NearSphere SphereView::near_sphere(std::uint32_t spot) const {
    const std::uint32_t sphere = numbers_[spot];
    const Vec3 away = spheres_.centers[sphere] - camera_.position;
    return {away, spots_[spot].power, length(away) - spheres_.radii[sphere], spheres_.radii[sphere], sphere};
}

SphereTiles SphereView::tiles(int top, int bottom, int tile_width) const {
    std::vector<KeptSpot> kept;
    const auto band = static_cast<std::size_t>(top / band_rows());
    for (std::size_t k = first_[band]; k < first_[band + 1]; ++k) {
        const Spot& spot = spots_[in_band_[k]];
        if (spot.top >= bottom || spot.bottom <= top) continue;
        kept.push_back({near_sphere(in_band_[k]), static_cast<std::size_t>(spot.left / tile_width),
                        static_cast<std::size_t>((spot.right - 1) / tile_width) + 1});
    }
    std::sort(kept.begin(), kept.end(), is_nearer);
    SphereTiles out;
    out.first.assign(static_cast<std::size_t>((width_ + tile_width - 1) / tile_width) + 1, 0);
    for (const KeptSpot& spot : kept) {
        for (std::size_t tile = spot.begin; tile < spot.end; ++tile) ++out.first[tile + 1];
    }
    for (std::size_t tile = 1; tile < out.first.size(); ++tile) out.first[tile] += out.first[tile - 1];
    out.spheres.resize(out.first.back());
    std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
    for (const KeptSpot& spot : kept) {
        for (std::size_t tile = spot.begin; tile < spot.end; ++tile) out.spheres[next[tile]++] = spot.sphere;
    }
    return out;
}

// A ray with the unit direction d hits a sphere at the solutions t of t^2 - 2 (d . away) t + power = 0. The first loop
// tests all rays without branches, because most spheres are hit by no ray.
void meet_spheres(std::span<const NearSphere> spheres, std::span<const PreviewRay> rays, std::span<SphereFind> finds) {
    std::array<double, kPacketRays> x{};
    std::array<double, kPacketRays> y{};
    std::array<double, kPacketRays> z{};
    for (std::size_t k = 0; k < rays.size(); ++k) {
        const Vec3& direction = rays[k].direction;
        x[k] = direction.x;
        y[k] = direction.y;
        z[k] = direction.z;
        finds[k] = {};
    }
    double farthest = std::numeric_limits<double>::infinity();
    std::array<double, kPacketRays> middle;
    std::array<double, kPacketRays> under;
    for (const NearSphere& sphere : spheres) {
        if (sphere.nearest >= farthest) break;
        for (std::size_t k = 0; k < kPacketRays; ++k) {
            middle[k] = x[k] * sphere.away.x + y[k] * sphere.away.y + z[k] * sphere.away.z;
            under[k] = middle[k] * middle[k] - sphere.power;
        }
        bool is_found = false;
        for (std::size_t k = 0; k < rays.size(); ++k) {
            if (!(under[k] >= 0.0)) continue;
            const double half = std::sqrt(under[k]);
            const double distance = middle[k] > half ? middle[k] - half : middle[k] + half;
            if (!(distance > 0.0) || distance >= finds[k].distance) continue;
            finds[k] = {distance, sphere.sphere};
            is_found = true;
        }
        if (!is_found) continue;
        farthest = 0.0;
        for (const SphereFind& find : finds.first(rays.size())) farthest = std::max(farthest, find.distance);
    }
}

// Spheres are processed nearest first. If a sphere covers the whole neighbourhood of a ray, it hides all outlines
// behind it.
std::array<bool, kPacketRays> outlines_about(std::span<const PreviewRay> rays, std::span<const NearSphere> spheres,
                                             double slope) {
    std::array<bool, kPacketRays> found{};
    std::array<bool, kPacketRays> done{};
    std::size_t left = rays.size();
    for (const NearSphere& sphere : spheres) {
        if (left == 0) break;
        const double square = sphere.power + sphere.radius * sphere.radius;
        for (std::size_t k = 0; k < rays.size(); ++k) {
            if (done[k] || sphere.nearest > rays[k].reach) continue;
            const double middle = dot(rays[k].direction, sphere.away);
            if (middle <= 0.0 && sphere.power > 0.0) continue;  // the sphere is behind the camera on this ray
            const double off = square - middle * middle;        // squared distance of the ray from the sphere's centre
            const double margin = slope * middle;
            const double outer = sphere.radius + margin;
            const double inner = sphere.radius - margin;
            if (!(off < outer * outer)) continue;
            found[k] = !(inner > 0.0 && off < inner * inner);
            done[k] = true;
            --left;
        }
    }
    return found;
}

}  // namespace ricochet
