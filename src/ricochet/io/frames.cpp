#include "ricochet/io/frames.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ricochet {
namespace {

template <typename T>
std::vector<T> gathered(const std::vector<T>& values, const std::vector<std::uint32_t>& order) {
    std::vector<T> sorted;
    sorted.reserve(order.size());
    for (const std::uint32_t i : order) sorted.push_back(values[i]);
    return sorted;
}

std::vector<std::int64_t> as_signed(const std::vector<std::uint64_t>& values) { return {values.begin(), values.end()}; }

VtkArray attribute_array(const AttributeTable& attributes, std::size_t column,
                         const std::vector<std::uint32_t>& order) {
    const AttributeDescription& description = attributes.columns()[column];
    std::vector<Vec3> vectors;
    std::vector<double> numbers;
    for (const std::uint32_t i : order) {
        const Vec3 value = attributes.value(column, i);
        description.components == 3 ? vectors.push_back(value) : numbers.push_back(value.x);
    }
    if (description.components == 3) return {description.name, std::move(vectors)};
    return {description.name, std::move(numbers)};
}

std::vector<const SpringFace*> standing_faces(const SpringNetwork& springs, const std::vector<SpringFace>& faces) {
    std::vector<const SpringFace*> standing;
    for (const SpringFace& face : faces) {
        const bool stands = std::all_of(face.springs.begin(), face.springs.end(),
                                        [&](std::uint32_t spring) { return springs.is_intact(spring); });
        if (stands) standing.push_back(&face);
    }
    return standing;
}

// Its particles are there, since its springs are.
Triangle triangle_of(const SpringFace& face, const VtkPolyData& frame) {
    const auto& ids = std::get<std::vector<std::int64_t>>(find_array(frame.point_arrays, "id")->values);
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto found = std::lower_bound(ids.begin(), ids.end(), static_cast<std::int64_t>(face.corners[k]));
        triangle[k] = static_cast<std::uint32_t>(found - ids.begin());
    }
    return triangle;
}

// A simulation that keeps no totals per triangle gives none.
std::vector<VtkArray> total_arrays(const TriangleTotals& totals) {
    if (totals.hits.empty()) return {};
    return {{"hits", as_signed(totals.hits)}, {"impulse", totals.impulse}};
}

// A shape with a formula is one surface: every triangle that shows it has the whole surface's totals.
TriangleTotals repeated(const TriangleTotals& totals, std::size_t count) {
    return {std::vector<std::uint64_t>(count, totals.hits[0]), std::vector<Vec3>(count, totals.impulse[0])};
}

}  // namespace

VtkPolyData particle_frame(const Particles& particles, double time, bool has_spheres) {
    return particle_frame(particles, particles.attributes, time, has_spheres);
}

VtkPolyData particle_frame(const Particles& particles, const AttributeTable& attributes, double time,
                           bool has_spheres) {
    const std::vector<std::uint32_t> order = particles.order_by_id();
    std::vector<double> age = gathered(particles.birth_time, order);
    for (double& value : age) value = time - value;
    VtkPolyData frame;
    frame.time = time;
    frame.points = gathered(particles.position, order);
    frame.point_arrays = {{"id", as_signed(gathered(particles.id, order))},
                          {"velocity", gathered(particles.velocity, order)},
                          {"mass", gathered(particles.mass, order)},
                          {"radius", gathered(particles.radius, order)},
                          {"age", std::move(age)},
                          {"contacts", gathered(particles.contacts, order)},
                          {"resting", gathered(particles.resting, order)},
                          {"frozen", gathered(particles.frozen, order)},
                          {"unsimulated_time", gathered(particles.unsimulated_time, order)}};
    if (has_spheres) frame.point_arrays.push_back({"spin", gathered(particles.spin, order)});
    for (std::size_t k = 0; k < attributes.columns().size(); ++k) {
        frame.point_arrays.push_back(attribute_array(attributes, k, order));
    }
    return frame;
}

void add_springs(VtkPolyData& frame, const Particles& particles, const SpringNetwork& springs,
                 const std::vector<SpringFace>& faces) {
    const std::vector<std::uint32_t> order = particles.order_by_id();
    std::vector<std::uint32_t> place(order.size());  // in the frame
    for (std::uint32_t k = 0; k < order.size(); ++k) place[order[k]] = k;
    std::vector<double> stretch(springs.springs().size(), 0.0);
    for (const SpringNetwork::Bond& bond : springs.bonds()) {
        const double rest_length = springs.springs()[bond.spring].rest_length;
        const double distance = length(particles.position[bond.b] - particles.position[bond.a]);
        if (rest_length > 0.0) stretch[bond.spring] = distance / rest_length - 1.0;
    }
    std::vector<std::int64_t> numbers;
    std::vector<double> stretches;
    if (!frame.points.empty()) {
        numbers.push_back(-1);
        stretches.push_back(0.0);
    }
    std::vector<bool> is_in_cloth(stretch.size(), false);
    const std::vector<const SpringFace*> standing = standing_faces(springs, faces);
    for (const SpringFace* face : standing) {
        for (const std::uint32_t spring : face->springs) is_in_cloth[spring] = true;
    }
    for (const SpringNetwork::Bond& bond : springs.bonds()) {
        if (is_in_cloth[bond.spring] || springs.springs()[bond.spring].resists_bending) continue;
        frame.lines.push_back({place[bond.a], place[bond.b]});
        numbers.push_back(bond.spring);
        stretches.push_back(stretch[bond.spring]);
    }
    for (const SpringFace* face : standing) {
        frame.triangles.push_back(triangle_of(*face, frame));
        numbers.push_back(-1);
        const auto& [a, b, c] = face->springs;
        stretches.push_back(std::max({stretch[a], stretch[b], stretch[c]}));
    }
    frame.has_vertices = !frame.triangles.empty();
    frame.cell_arrays = {{"spring", std::move(numbers)}, {"stretch", std::move(stretches)}};
}

VtkPolyData mesh_collider_frame(const TriangleMesh& mesh, const TriangleTotals& totals, double time) {
    VtkPolyData frame;
    frame.time = time;
    frame.points = mesh.vertices;
    frame.triangles = mesh.triangles;
    const bool one_surface = totals.hits.size() == 1 && mesh.triangles.size() > 1;
    frame.cell_arrays = total_arrays(one_surface ? repeated(totals, mesh.triangles.size()) : totals);
    return frame;
}

VtkPolyData plane_collider_frame(const PlaneShape& plane, const Box3& region, const TriangleTotals& totals,
                                 double time) {
    const Vec3 normal = normalized(plane.normal);
    const Vec3 center = region.empty() ? plane.point : region.center();
    const Vec3 foot = center - dot(center - plane.point, normal) * normal;
    const double half = std::max(1.0, 2.0 * region.diagonal());
    const auto [u, v] = tangent_frame(normal);
    VtkPolyData frame;
    frame.time = time;
    frame.fields = {{"plane_point", {foot.x, foot.y, foot.z}}, {"plane_normal", {normal.x, normal.y, normal.z}}};
    frame.points = {foot - half * u - half * v, foot + half * u - half * v, foot + half * u + half * v,
                    foot - half * u + half * v};
    frame.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (!totals.hits.empty()) {
        const std::uint64_t hits = std::accumulate(totals.hits.begin(), totals.hits.end(), std::uint64_t{0});
        const Vec3 impulse = std::accumulate(totals.impulse.begin(), totals.impulse.end(), Vec3{});
        frame.cell_arrays = total_arrays({{hits, hits}, {impulse, impulse}});
    }
    return frame;
}

}  // namespace ricochet
