#include "generators/build_near.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ricochet/core/error.h"

namespace ricochet::meshes {
namespace {

constexpr std::size_t kMaxTriangles = 100'000'000;
constexpr std::size_t kCalibrationTriangles =
    40'000;  // large enough that the fixed parts of the coarse shape do not matter
constexpr double kGoodEnough = 0.02;
constexpr int kAttempts = 5;

double misfit(std::size_t count, std::size_t target) {
    return std::fabs(std::log2(static_cast<double>(count) / static_cast<double>(target)));
}

/// Returns the edge length for a target. Triangle counts grow with the inverse square of the edge length.
double rescaled(double edge, std::size_t count, std::size_t target) {
    return edge * std::sqrt(static_cast<double>(count) / static_cast<double>(target));
}

}  // namespace

TriangleMesh build_near(std::size_t target, double coarse_edge, const ShapeBuilder& build) {
    if (target < 2 || target > kMaxTriangles) {
        throw InputError(fmt::format("--triangles must be between 2 and {}, got {}", kMaxTriangles, target));
    }
    TriangleMesh best = build(coarse_edge);
    double edge = coarse_edge;
    for (std::size_t reachable = std::min(target, kCalibrationTriangles);; reachable = target) {
        for (int attempt = 0; attempt < kAttempts; ++attempt) {
            if (misfit(best.triangles.size(), reachable) < kGoodEnough) break;
            const double next_edge = rescaled(edge, best.triangles.size(), reachable);
            TriangleMesh next = build(next_edge);
            if (misfit(next.triangles.size(), reachable) >= misfit(best.triangles.size(), reachable)) break;
            best = std::move(next);
            edge = next_edge;
        }
        if (reachable == target) return best;
    }
}

}  // namespace ricochet::meshes
