#include "generators/rock.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "generators/icosphere.h"
#include "generators/lattice_noise.h"
#include "generators/require.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"

namespace ricochet::meshes {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr double kNearestCut = 0.05;   // smallest distance from the centre, fraction of the radius
constexpr int kCutCandidates = 12;     // per cutting plane; spreads the planes over the sphere
constexpr double kFacetCrumble = 0.8;  // size of the bumps that vary along facets, fraction of the radius

/// Plane dot(normal, p) = distance that cuts away the material beyond it.
struct Cut {
    Vec3 normal;
    double distance = 1.0;
};

/// Returns the one of several random directions that is farthest from the cuts made so far.
/// Method: D. Mitchell, "Spectrally Optimal Sampling for Distribution Ray Tracing", SIGGRAPH 1991 (best candidate).
Vec3 spread_direction(RandomSequence& random, const std::vector<Cut>& cuts) {
    Vec3 best;
    double best_nearness = 2.0;
    for (int i = 0; i < kCutCandidates; ++i) {
        const Vec3 candidate = random.unit_vector();
        double nearness = -1.0;
        for (const Cut& cut : cuts) nearness = std::max(nearness, dot(cut.normal, candidate));
        if (nearness >= best_nearness) continue;
        best = candidate;
        best_nearness = nearness;
    }
    return best;
}

std::vector<Cut> random_cuts(const RockShape& shape) {
    RandomSequence random(shape.seed, 0, 0);
    std::vector<Cut> cuts;
    for (int i = 0; i < shape.cuts; ++i) {
        const Vec3 normal = spread_direction(random, cuts);
        cuts.push_back({normal, 1.0 - shape.cut_depth * (0.25 + 0.75 * random.uniform())});
    }
    return cuts;
}

/// Returns the minimum of a and b, with the crease rounded over a width.
double smooth_min(double a, double b, double width) {
    if (width <= 0.0) return std::min(a, b);
    const double overlap = std::max(0.0, width - std::fabs(a - b)) / width;
    return std::min(a, b) - 0.25 * width * overlap * overlap;
}

/// Returns the distance along a unit ray to the nearest cut, at most 1.
double cut_radius(const Vec3& ray, const std::vector<Cut>& cuts, double rounding) {
    double radius = 1.0;
    for (const Cut& cut : cuts) {
        const double approach = dot(cut.normal, ray);
        if (approach > 0.2) radius = smooth_min(radius, cut.distance / approach, rounding);
    }
    return radius;
}

/// Returns a unit icosphere with every vertex moved along its ray to the given position.
TriangleMesh displaced(int divisions, const std::function<Vec3(const Vec3& ray)>& position) {
    TriangleMesh mesh = unit_icosphere(divisions);
    parallel_for_blocks(mesh.vertices.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) mesh.vertices[i] = position(mesh.vertices[i]);
    });
    return mesh;
}

void check(const RockShape& shape) {
    require_length("rock", "radius", shape.radius);
    require_between("rock", "cuts", shape.cuts, 0, 200);
    require_between("rock", "cut-depth", shape.cut_depth, 0.0, 0.7);
    require_between("rock", "rounding", shape.rounding, 0.0, 0.5);
    require_between("rock", "roughness", shape.roughness, 0.0, 0.5);
    for (const double stretch : {shape.stretch_x, shape.stretch_y, shape.stretch_z}) {
        require_between("rock", "stretch", stretch, 0.05, 20.0);
    }
}

}  // namespace

TriangleMesh make_rock(const RockShape& shape, double edge_length) {
    check(shape);
    const std::vector<Cut> cuts = random_cuts(shape);
    const Vec3 stretch{shape.stretch_x, shape.stretch_y, shape.stretch_z};
    const Octaves grain{6, 2.03, 0.55};
    const auto position = [&](const Vec3& ray) {
        const Vec3 crumbled = normalized(ray + 0.5 * shape.roughness * gradient_noise(3.0 * ray, shape.seed).gradient);
        const double facets = cut_radius(crumbled, cuts, shape.rounding);
        const double bumps = fractal_noise(ray / kFacetCrumble, grain, shape.seed + 1);
        const double r = shape.radius * std::max(kNearestCut, facets + 2.0 * shape.roughness * bumps);
        return Vec3{r * ray.x * stretch.x, r * ray.y * stretch.y, r * ray.z * stretch.z};
    };
    const double widest = shape.radius * std::max({stretch.x, stretch.y, stretch.z});
    return displaced(icosphere_divisions(widest, edge_length), position);
}

TriangleMesh make_cavity(const CavityShape& shape, double edge_length) {
    require_length("cavity", "radius", shape.radius);
    require_between("cavity", "roughness", shape.roughness, 0.0, 0.8);
    require_between("cavity", "wavelength", shape.wavelength, 0.1, 10.0);
    const Octaves bays{6, 2.1, 0.5};
    const auto position = [&](const Vec3& ray) {
        const Vec3 p = ray / shape.wavelength;
        const double noses = ridged_noise(p, bays, shape.seed);
        const double swell = fractal_noise(0.7 * p, Octaves{3, 2.0, 0.5}, shape.seed + 1);
        const double r = 1.0 + shape.roughness * (1.2 * swell + 1.0 - 2.0 * noses);
        return (shape.radius * std::max(kNearestCut, r)) * ray;
    };
    return displaced(icosphere_divisions(shape.radius, edge_length), position);
}

}  // namespace ricochet::meshes
