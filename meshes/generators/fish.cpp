#include "generators/fish.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "generators/planar_region.h"
#include "generators/require.h"
#include "generators/unit_circle.h"

namespace ricochet::meshes {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr int kFewestRings = 12;
constexpr int kFewestAround = 8;

constexpr double kTailBegins = 0.8;    // fraction of the distance from nose to tail
constexpr double kTailHeight = 0.17;   // half height, fraction of the length, like the sizes below
constexpr double kTailWidth = 0.006;   // half width
constexpr double kTailFork = 0.14;     // distance of the tips of the tail fin behind its middle
constexpr double kFinHeight = 0.09;    // of the fin on the back
constexpr double kFinBegins = 0.28;    // fraction of the distance
constexpr double kFinEnds = 0.68;      // fraction of the distance
constexpr double kHeadSwing = 0.15;    // fraction of the swing of the tail
constexpr double kWavesOnTheBody = 1;  // from nose to tail

double smooth_step(double x) {
    const double s = std::clamp(x, 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
}

/// Returns the relative thickness of the body: 0 at the nose and at the tail's root, 1 at its thickest.
double thickness_at(double s) {
    constexpr double kLargest = 0.3258;  // maximum of the expression without it, near s = 0.28
    return std::sqrt(s) * (1.0 - s) * (1.0 - 0.5 * s) / kLargest;
}

/// Cross-section: an ellipse with a fin on its back, sheared backwards at the tail. All lengths are in metres.
struct Section {
    double half_height = 0.0;
    double half_width = 0.0;
    double fin = 0.0;
    double fork = 0.0;

    Section(const FishShape& shape, double s) {
        const double tail = smooth_step((s - kTailBegins) / (1.0 - kTailBegins));
        const double body = thickness_at(s);
        half_height = shape.length * (0.5 * shape.height * body + kTailHeight * tail);
        half_width = shape.length * (0.5 * shape.width * body + kTailWidth * std::sqrt(s));
        const double on_fin = (s - kFinBegins) / (kFinEnds - kFinBegins);
        // The fin rises slowly and falls steeply.
        fin = on_fin > 0.0 && on_fin < 1.0 ? shape.length * kFinHeight * 4.0 * on_fin * on_fin * (1.0 - on_fin) * 1.6875
                                           : 0.0;
        fork = shape.length * kTailFork * tail;
    }

    /// Returns the offset along the body, to its side, and up, from the section's middle.
    [[nodiscard]] Vec3 point(const CirclePoint& c) const {
        double up = half_height * c.sin;
        if (c.sin > 0.0) {
            const double square = c.sin * c.sin;
            up += fin * square * square * square * square;
        }
        return {fork * c.sin * c.sin, half_width * c.cos, up};
    }
};

/// Middle of the body, and its direction.
struct Spine {
    Vec3 position;
    Vec3 along;
    Vec3 side;

    Spine(const FishShape& shape, double s) {
        const CirclePoint wave = point_on_circle(kWavesOnTheBody * s - (shape.phase - std::floor(shape.phase)));
        const double size = shape.swing * (kHeadSwing + (1.0 - kHeadSwing) * s * s);
        const double growth = 2.0 * shape.swing * (1.0 - kHeadSwing) * s;
        const double slope = growth * wave.sin + size * kTwoPi * kWavesOnTheBody * wave.cos;
        position = shape.length * Vec3{s, size * wave.sin, 0.0};
        along = normalized({1.0, slope, 0.0});
        side = {-along.y, along.x, 0.0};
    }

    [[nodiscard]] Vec3 point(const Vec3& local) const {
        return position + local.x * along + local.y * side + Vec3{0.0, 0.0, local.z};
    }
};

void add_fan(TriangleMesh& mesh, std::uint32_t ring, std::uint32_t tip, std::uint32_t around, bool faces_back) {
    for (std::uint32_t j = 0; j < around; ++j) {
        const std::uint32_t next = ring + (j + 1) % around;
        if (faces_back) {
            mesh.triangles.push_back({ring + j, next, tip});
        } else {
            mesh.triangles.push_back({tip, next, ring + j});
        }
    }
}

void join_rings(TriangleMesh& mesh, std::uint32_t ring, std::uint32_t around) {
    for (std::uint32_t j = 0; j < around; ++j) {
        const std::uint32_t next = (j + 1) % around;
        mesh.triangles.push_back({ring + j, ring + next, ring + around + next});
        mesh.triangles.push_back({ring + j, ring + around + next, ring + around + j});
    }
}

void check(const FishShape& shape) {
    require_length("fish", "length", shape.length);
    require_between("fish", "height", shape.height, 0.05, 0.6);
    require_between("fish", "width", shape.width, 0.05, 0.4);
    require_between("fish", "swing", shape.swing, 0.0, 0.2);
    require_between("fish", "phase", shape.phase, -1e6, 1e6);
}

}  // namespace

TriangleMesh make_fish(const FishShape& shape, double edge_length) {
    check(shape);
    const int rings = steps_in(shape.length, edge_length, kFewestRings);
    const int around = 4 * steps_in(0.25 * kTwoPi * 0.25 * (shape.height + shape.width) * shape.length, edge_length,
                                    kFewestAround / 4);
    TriangleMesh mesh;
    mesh.vertices.push_back(Spine(shape, 0.0).point({}));
    for (int i = 1; i <= rings; ++i) {
        // Rings are denser at the nose, which is round.
        const double even = static_cast<double>(i) / rings;
        const double s = even * std::sqrt(even);
        const Section section(shape, s);
        const Spine spine(shape, s);
        for (int j = 0; j < around; ++j) {
            const CirclePoint c = point_on_circle(static_cast<double>(j) / around);
            mesh.vertices.push_back(spine.point(section.point(c)));
        }
    }
    mesh.vertices.push_back(Spine(shape, 1.0).point({}));
    const auto columns = static_cast<std::uint32_t>(around);
    const auto rows = static_cast<std::uint32_t>(rings);
    add_fan(mesh, 1, 0, columns, false);
    for (std::uint32_t i = 0; i + 1 < rows; ++i) join_rings(mesh, 1 + i * columns, columns);
    add_fan(mesh, 1 + (rows - 1) * columns, 1 + rows * columns, columns, true);
    return mesh;
}

}  // namespace ricochet::meshes
