#include "ricochet/core/bisection.h"
#include "ricochet/dynamics/springs.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/settings_table.h"
#include "ricochet/geometry/mesh/edge_table.h"

namespace ricochet {

namespace {

double sinh_of(double x) { return 0.5 * (portable_exp(x) - portable_exp(-x)); }

double asinh_of(double t) {
    const double magnitude = std::fabs(t);
    return std::copysign(portable_log(magnitude + std::sqrt(magnitude * magnitude + 1.0)), t);
}

/// Returns x > 0 with sinh(x) / x = ratio, for ratio > 1, by bisection. sinh(x) / x increases from 1 at x = 0.
double solve_sinh_ratio(double ratio) {
    double high = 1.0;
    while (sinh_of(high) < ratio * high) high *= 2.0;
    constexpr int kHalvings = 100;
    const Bracket found = bisect(0.0, high, kHalvings, [&](double x) { return sinh_of(x) < ratio * x; });
    return 0.5 * (found.low + found.high);
}

void check(const RopeSettings& rope) {
    require_settings(rope, kRopeEndsTable, "rope: ");
    require_settings(rope, kRopeLengthTable, "rope: ");
    require_settings(rope, kRopeTable, "rope: ");
    require_settings(rope, kDampingTable<RopeSettings>, "rope: ");
    if (rope.nodes < 2) throw InputError(fmt::format("rope: it needs at least 2 nodes, found {}", rope.nodes));
    if (rope.stiffness.has_value() == rope.axial_stiffness.has_value()) {
        throw InputError("rope: expected either a stiffness or an axial stiffness");
    }
    if (rope.from == rope.to) throw InputError("rope: both ends are at the same position, expected two positions");
}

void check(const TriangleMesh& mesh, const ClothSettings& cloth) {
    if (mesh.triangles.empty()) throw InputError("cloth: the mesh has no triangle, so no edge to make springs of");
    detail::require_positive(cloth.mass_per_area, "cloth: the mass per area", "kg/m^2");
    require_settings(cloth, kClothTable, "cloth: ");
    require_settings(cloth, kDampingTable<ClothSettings>, "cloth: ");
    for (const std::uint32_t vertex : cloth.pinned) {
        if (vertex < mesh.vertices.size()) continue;
        throw InputError(fmt::format("cloth: there is no vertex {} to pin, the mesh has {} (numbered from 0)", vertex,
                                     mesh.vertices.size()));
    }
}

std::vector<Particle> cloth_particles(const TriangleMesh& mesh, const ClothSettings& settings) {
    std::vector<Particle> particles(mesh.vertices.size());
    std::vector<double> mass(mesh.vertices.size(), 0.0);
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        const double area = 0.5 * length(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
        for (const std::uint32_t corner : t) mass[corner] += area * settings.mass_per_area / 3.0;
    }
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!(mass[i] > 0.0)) {
            throw InputError(fmt::format("cloth: no triangle with an area uses vertex {}, so it has no mass", i));
        }
        particles[i].id = i;
        particles[i].position = mesh.vertices[i];
        particles[i].mass = mass[i];
        particles[i].radius = settings.radius;
    }
    for (const std::uint32_t vertex : settings.pinned) particles[vertex].pinned = true;
    return particles;
}

std::uint32_t number_of(const std::vector<MeshEdge>& edges, std::uint32_t a, std::uint32_t b) {
    const std::pair wanted(std::min(a, b), std::max(a, b));
    const auto found = std::lower_bound(edges.begin(), edges.end(), wanted, [](const MeshEdge& edge, const auto& key) {
        return std::pair(edge.first, edge.second) < key;
    });
    return static_cast<std::uint32_t>(found - edges.begin());
}

bool names_a_vertex_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

std::vector<SpringFace> cloth_faces(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges) {
    std::vector<SpringFace> faces;
    faces.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        if (names_a_vertex_twice(t)) continue;
        faces.push_back({{t[0], t[1], t[2]},
                         {number_of(edges, t[0], t[1]), number_of(edges, t[1], t[2]), number_of(edges, t[2], t[0])}});
    }
    return faces;
}

}  // namespace

// Let s be the arc length from the lowest point of a catenary with the parameter a. The horizontal coordinate is a
// asinh(s / a), and the vertical coordinate is sqrt(a^2 + s^2). At the ends of the rope, asinh(s / a) is middle - x and
// middle + x. With the length L, sinh(x) / x = sqrt(L^2 - rise^2) / across, tanh(middle) = rise / L, and a = across /
// (2 x).
std::vector<Vec3> catenary(const Vec3& from, const Vec3& to, double length_of_rope, const Vec3& up, std::size_t count) {
    const Vec3 chord = to - from;
    const double rise = dot(chord, up);
    const Vec3 level = chord - up * rise;
    const double across = length(level);
    const bool is_taut = length_of_rope <= length(chord) * (1.0 + kTautRope);
    const bool is_folded = across <= kFoldedRope * length_of_rope;
    const double depth = 0.5 * (length_of_rope - rise);  // depth of a folded rope, in m
    double x = 0.0;
    double middle = 0.0;
    double a = 0.0;
    if (!is_taut && !is_folded) {
        x = solve_sinh_ratio(std::sqrt((length_of_rope - rise) * (length_of_rope + rise)) / across);
        middle = 0.5 * portable_log((length_of_rope + rise) / (length_of_rope - rise));
        a = across / (2.0 * x);
    }
    const double first = a * sinh_of(middle - x);
    const auto height_at = [&](double s) { return std::sqrt(a * a + s * s); };
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < count; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(count - 1);
        const double s = part * length_of_rope;
        if (is_taut) {
            positions.push_back(from + chord * part);
        } else if (is_folded) {
            positions.push_back(from + level * part + up * (s < depth ? -s : s - 2.0 * depth));
        } else {
            const double aside = a * (asinh_of((first + s) / a) - (middle - x));
            const double height = height_at(first + s) - height_at(first);
            positions.push_back(from + level * (aside / across) + up * height);
        }
    }
    positions.front() = from;
    positions.back() = to;
    return positions;
}

void SpringBody::append(const SpringBody& body) {
    const std::uint64_t first_id = particles.size();
    const auto first_spring = static_cast<std::uint32_t>(springs.size());
    for (Particle particle : body.particles) {
        particle.id += first_id;
        particles.push_back(particle);
    }
    for (Spring spring : body.springs) {
        spring.first += first_id;
        spring.second += first_id;
        springs.push_back(spring);
    }
    for (SpringFace face : body.faces) {
        for (std::uint64_t& corner : face.corners) corner += first_id;
        for (std::uint32_t& spring : face.springs) spring += first_spring;
        faces.push_back(face);
    }
}

SpringBody make_rope(const RopeSettings& settings) {
    check(settings);
    const std::size_t segments = settings.nodes - 1;
    const double rope_length = settings.length.value_or(length(settings.to - settings.from));
    const double rest_length = rope_length / static_cast<double>(segments);
    const Vec3 up = -detail::unit_direction(settings.sag, "rope: the direction in which it sags");
    const std::vector<Vec3> positions = catenary(settings.from, settings.to, rope_length, up, settings.nodes);
    SpringBody rope;
    for (std::size_t i = 0; i < settings.nodes; ++i) {
        Particle node;
        node.id = i;
        node.position = positions[i];
        const double shares = i == 0 || i == segments ? 0.5 : 1.0;
        node.mass = shares * settings.mass / static_cast<double>(segments);
        node.radius = settings.radius;
        rope.particles.push_back(node);
    }
    rope.particles.front().pinned = settings.pin_from;
    rope.particles.back().pinned = settings.pin_to;
    const double stiffness = settings.stiffness ? *settings.stiffness : *settings.axial_stiffness / rest_length;
    for (std::size_t i = 0; i < segments; ++i) {
        rope.springs.push_back({i, i + 1, rest_length, stiffness, settings.damping, settings.breaking_stretch});
    }
    return rope;
}

SpringBody make_cloth(const TriangleMesh& mesh, const ClothSettings& settings) {
    require_corners(mesh);
    check(mesh, settings);
    const std::vector<MeshEdge> edges = edges_of(mesh);
    SpringBody cloth;
    cloth.particles = cloth_particles(mesh, settings);
    const auto distance = [&](std::uint32_t a, std::uint32_t b) { return length(mesh.vertices[b] - mesh.vertices[a]); };
    for (const MeshEdge& edge : edges) {
        const double rest_length = distance(edge.first, edge.second);
        // A spring with the rest length 0 has no relative stretch and cannot break.
        const double limit = rest_length > 0.0 ? settings.breaking_stretch : std::numeric_limits<double>::infinity();
        cloth.springs.push_back({edge.first, edge.second, rest_length, settings.stiffness, settings.damping, limit});
    }
    for (const MeshEdge& edge : edges) {
        const auto [a, b] = edge.opposite;
        if (settings.bending_stiffness == 0.0 || a == kNoVertex || b == kNoVertex || a == b) continue;
        Spring spring{a, b, distance(a, b), settings.bending_stiffness, settings.damping};
        spring.resists_bending = true;
        cloth.springs.push_back(spring);
    }
    cloth.faces = cloth_faces(mesh, edges);
    return cloth;
}

TriangleMesh sheet_mesh(const Vec3& corner, const Vec3& u, const Vec3& v, std::size_t cells_u, std::size_t cells_v) {
    if (cells_u == 0 || cells_v == 0) throw InputError("sheet: it needs at least one cell along either side");
    constexpr std::size_t kMostVertices = std::numeric_limits<std::uint32_t>::max();
    if (cells_u >= kMostVertices || cells_v >= kMostVertices || (cells_u + 1) * (cells_v + 1) > kMostVertices) {
        throw InputError(fmt::format("sheet: {} x {} cells have more vertices than 2^32 - 1", cells_u, cells_v));
    }
    detail::require_finite(corner, "sheet: the corner", "m");
    if (!(length(cross(u, v)) > 0.0)) throw InputError("sheet: the sides are parallel or without length");
    if (!std::isfinite(length(cross(u, v)))) throw InputError("sheet: the sides are not finite or too long");
    TriangleMesh sheet;
    const auto number = [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(j * (cells_u + 1) + i); };
    for (std::size_t j = 0; j <= cells_v; ++j) {
        for (std::size_t i = 0; i <= cells_u; ++i) {
            const double s = static_cast<double>(i) / static_cast<double>(cells_u);
            const double t = static_cast<double>(j) / static_cast<double>(cells_v);
            sheet.vertices.push_back(corner + s * u + t * v);
        }
    }
    for (std::size_t j = 0; j < cells_v; ++j) {
        for (std::size_t i = 0; i < cells_u; ++i) {
            const std::uint32_t a = number(i, j);
            const std::uint32_t b = number(i + 1, j);
            const std::uint32_t c = number(i + 1, j + 1);
            const std::uint32_t d = number(i, j + 1);
            if ((i + j) % 2 == 0) {
                sheet.triangles.push_back({a, b, c});
                sheet.triangles.push_back({a, c, d});
            } else {
                sheet.triangles.push_back({a, b, d});
                sheet.triangles.push_back({b, c, d});
            }
        }
    }
    return sheet;
}

}  // namespace ricochet
