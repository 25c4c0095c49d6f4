#include "ricochet/io/frames.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

/// Particles per unit of parallel work.
constexpr std::size_t kFramesBlock = 1 << 14;

// List of a frame's arrays, which are filled in order. Each array reuses the memory of the same array in the previous
// frame.
class ArrayList {
public:
    ArrayList(std::vector<VtkArray>& arrays, std::size_t length) : arrays_(arrays), length_(length) {}

    // Returns storage for the values of the next array.
    template <typename T>
    T* next(std::string_view name) {
        if (used_ == arrays_.size()) arrays_.emplace_back();
        VtkArray& array = arrays_[used_++];
        array.name = name;
        if (!std::holds_alternative<std::vector<T>>(array.values)) array.values = std::vector<T>();
        auto& values = std::get<std::vector<T>>(array.values);
        values.resize(length_);
        return values.data();
    }
    void end() { arrays_.resize(used_); }

private:
    std::vector<VtkArray>& arrays_;
    std::size_t length_;
    std::size_t used_ = 0;
};

// Copies the values of all particles to `to`. order: indices of the particles in the order of their ids.
template <typename To, typename From>
void gather(const std::vector<From>& from, const std::vector<std::uint32_t>& order, To* to) {
    require_same_length(from.size(), order.size(), "array of the particles");
    parallel_for_blocks(order.size(), kFramesBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) to[k] = static_cast<To>(from[order[k]]);
    });
}

void add_attribute(ArrayList& list, const AttributeTable& attributes, std::size_t column,
                   const std::vector<std::uint32_t>& order) {
    const AttributeDescription& description = attributes.columns()[column];
    const bool is_vector = description.components == 3;
    Vec3* const vectors = is_vector ? list.next<Vec3>(description.name) : nullptr;
    double* const numbers = is_vector ? nullptr : list.next<double>(description.name);
    parallel_for_blocks(order.size(), kFramesBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Vec3 value = attributes.value(column, order[k]);
            is_vector ? void(vectors[k] = value) : void(numbers[k] = value.x);
        }
    });
}

std::vector<std::int64_t> as_signed(const std::vector<std::uint64_t>& values) { return {values.begin(), values.end()}; }

std::vector<const SpringFace*> intact_faces(const SpringNetwork& springs, const std::vector<SpringFace>& faces) {
    std::vector<const SpringFace*> intact;
    for (const SpringFace& face : faces) {
        const bool is_intact = std::all_of(face.springs.begin(), face.springs.end(),
                                           [&](std::uint32_t spring) { return springs.is_intact(spring); });
        if (is_intact) intact.push_back(&face);
    }
    return intact;
}

// Returns the triangle of a face. Its corners are the rows of the face's particles in the frame. The particles of a
// face exist while its springs are intact.
Triangle triangle_of(const SpringFace& face, const VtkPolyData& frame) {
    const VtkArray* array = find_array(frame.point_arrays, "id");
    if (array == nullptr || !std::holds_alternative<std::vector<std::int64_t>>(array->values)) {
        throw InputError("springs of a frame: found no array id, expected a frame of particles");
    }
    const auto& ids = std::get<std::vector<std::int64_t>>(array->values);
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto found = std::lower_bound(ids.begin(), ids.end(), static_cast<std::int64_t>(face.corners[k]));
        triangle[k] = static_cast<std::uint32_t>(found - ids.begin());
        require_index(triangle[k], frame.points.size(), "corner of cloth");
    }
    return triangle;
}

// Returns the cell arrays of the totals; no arrays if the simulation records no totals for triangles.
std::vector<VtkArray> total_arrays(const TriangleTotals& totals) {
    if (totals.hits.empty()) return {};
    std::vector<VtkArray> arrays =
        list_of(VtkArray{"hits", as_signed(totals.hits)}, VtkArray{"impulse", totals.impulse});
    if (!totals.lasting_impulse.empty()) arrays.push_back({"lasting_impulse", totals.lasting_impulse});
    return arrays;
}

void require_lengths(const TriangleTotals& totals) {
    require_same_length(totals.impulse.size(), totals.hits.size(), "impulses of a collider");
    if (totals.lasting_impulse.empty()) return;
    require_same_length(totals.lasting_impulse.size(), totals.hits.size(), "lasting impulses of a collider");
}

// Returns a list with the totals of the whole surface for each of its triangles. Planes, balls and cylinders are single
// surfaces with one total.
TriangleTotals repeated(const TriangleTotals& totals, std::size_t count) {
    const std::size_t lasting = totals.lasting_impulse.empty() ? 0 : count;
    return {std::vector<std::uint64_t>(count, totals.hits[0]), std::vector<Vec3>(count, totals.impulse[0]),
            std::vector<Vec3>(lasting, lasting == 0 ? Vec3{} : totals.lasting_impulse[0])};
}

}  // namespace

VtkPolyData particle_frame(const Particles& particles, double time, bool has_spheres) {
    return particle_frame(particles, particles.attributes, time, has_spheres);
}

VtkPolyData particle_frame(const Particles& particles, const AttributeTable& attributes, double time,
                           bool has_spheres) {
    VtkPolyData frame;
    fill_particle_frame(frame, particles, attributes, time, has_spheres);
    return frame;
}

void fill_particle_frame(VtkPolyData& frame, const Particles& particles, const AttributeTable& attributes, double time,
                         bool has_spheres) {
    require_same_length(particles.spin.size(), particles.size(), "array of the particles");
    if (!attributes.empty()) require_same_length(attributes.size(), particles.size(), "attributes of the particles");
    const std::vector<std::uint32_t> order = particles.order_by_id();
    frame.time = time;
    frame.fields.clear();
    frame.lines.clear();
    frame.triangles.clear();
    frame.has_vertices = false;
    frame.cell_arrays.clear();
    frame.points.resize(order.size());
    ArrayList list(frame.point_arrays, order.size());
    gather(particles.position, order, frame.points.data());
    gather(particles.id, order, list.next<std::int64_t>("id"));
    gather(particles.velocity, order, list.next<Vec3>("velocity"));
    gather(particles.mass, order, list.next<double>("mass"));
    gather(particles.radius, order, list.next<double>("radius"));
    double* const age = list.next<double>("age");
    gather(particles.birth_time, order, age);
    std::for_each(age, age + order.size(), [time](double& value) { value = time - value; });
    gather(particles.contacts, order, list.next<std::uint32_t>("contacts"));
    gather(particles.resting, order, list.next<std::uint8_t>("resting"));
    gather(particles.frozen, order, list.next<std::uint8_t>("frozen"));
    gather(particles.unsimulated_time, order, list.next<double>("unsimulated_time"));
    if (has_spheres) gather(particles.spin, order, list.next<Vec3>("spin"));
    for (std::size_t k = 0; k < attributes.columns().size(); ++k) add_attribute(list, attributes, k, order);
    list.end();
}

void add_cloud_parents(VtkPolyData& frame, const Particles& particles, const std::vector<std::int64_t>& parents) {
    require_same_length(parents.size(), particles.size(), "parents of the particles");
    std::vector<std::int64_t> values;
    values.reserve(parents.size());
    for (const std::uint32_t i : particles.order_by_id()) values.push_back(parents[i]);
    frame.point_arrays.push_back({"cloud_parent", std::move(values)});
}

void add_springs(VtkPolyData& frame, const Particles& particles, const SpringNetwork& springs,
                 const std::vector<SpringFace>& faces) {
    const std::vector<std::uint32_t> order = particles.order_by_id();
    require_same_length(particles.position.size(), order.size(), "positions of the particles");
    require_same_length(frame.points.size(), order.size(), "points of the particles' frame");
    std::vector<std::uint32_t> row(order.size());  // row of each particle in the frame
    for (std::uint32_t k = 0; k < order.size(); ++k) row[order[k]] = k;
    std::vector<double> stretch(springs.springs().size(), 0.0);
    for (const SpringNetwork::Bond& bond : springs.bonds()) {
        const double rest_length = springs.springs()[bond.spring].rest_length;
        require_index(std::max(bond.a, bond.b), order.size(), "end of a spring");
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
    const std::vector<const SpringFace*> intact = intact_faces(springs, faces);
    for (const SpringFace* face : intact) {
        for (const std::uint32_t spring : face->springs) is_in_cloth[spring] = true;
    }
    for (const SpringNetwork::Bond& bond : springs.bonds()) {
        if (is_in_cloth[bond.spring] || springs.springs()[bond.spring].resists_bending) continue;
        frame.lines.push_back({row[bond.a], row[bond.b]});
        numbers.push_back(bond.spring);
        stretches.push_back(stretch[bond.spring]);
    }
    for (const SpringFace* face : intact) {
        frame.triangles.push_back(triangle_of(*face, frame));
        numbers.push_back(-1);
        const auto& [a, b, c] = face->springs;
        stretches.push_back(std::max({stretch[a], stretch[b], stretch[c]}));
    }
    frame.has_vertices = !frame.triangles.empty();
    frame.cell_arrays = list_of(VtkArray{"spring", std::move(numbers)}, VtkArray{"stretch", std::move(stretches)});
}

VtkPolyData mesh_collider_frame(const TriangleMesh& mesh, const TriangleTotals& totals, double time) {
    require_corners(mesh);
    require_lengths(totals);
    VtkPolyData frame;
    frame.time = time;
    frame.points = mesh.vertices;
    frame.triangles = mesh.triangles;
    const bool one_surface = totals.hits.size() == 1 && mesh.triangles.size() > 1;
    if (!one_surface && !totals.hits.empty()) {
        require_same_length(totals.hits.size(), mesh.triangles.size(), "hits of a collider");
    }
    frame.cell_arrays = total_arrays(one_surface ? repeated(totals, mesh.triangles.size()) : totals);
    return frame;
}

VtkPolyData plane_collider_frame(const PlaneShape& plane, const Box3& region, const TriangleTotals& totals,
                                 double time) {
    if (!is_finite(plane.point) || !is_finite(normalized(plane.normal))) {
        throw InputError("plane: found one that is not finite or has no normal, expected a point and a direction");
    }
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
        frame.cell_arrays = total_arrays(repeated({{hits}, {impulse}, totals.lasting_impulse}, 2));
    }
    return frame;
}

bool is_moving(const ColliderDescription& collider) { return !collider.frame.empty() || is_deforming(collider); }

VtkPolyData moving_collider_frame(const Simulation& simulation, const Box3& region) {
    VtkPolyData frame;
    frame.time = simulation.time();
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) {
        const ColliderDescription& collider = simulation.colliders()[i];
        if (!is_moving(collider)) continue;
        const MovingPose pose = simulation.collider_pose(i, simulation.time());
        TriangleMesh mesh;
        if (const auto* plane = std::get_if<PlaneShape>(&collider.shape)) {
            const PlaneShape placed{pose.point(plane->point), pose.world_from_frame.direction(plane->normal)};
            const VtkPolyData shown = plane_collider_frame(placed, region, {}, frame.time);
            mesh = {shown.points, shown.triangles};
        } else {
            mesh = *simulation.collider_mesh(i);
            for (Vec3& vertex : mesh.vertices) vertex = pose.point(vertex);
        }
        const auto base = static_cast<std::uint32_t>(frame.points.size());
        frame.points.insert(frame.points.end(), mesh.vertices.begin(), mesh.vertices.end());
        for (const Triangle& t : mesh.triangles) frame.triangles.push_back({base + t[0], base + t[1], base + t[2]});
        numbers.resize(frame.triangles.size(), static_cast<std::uint32_t>(i));
    }
    frame.cell_arrays = list_of(VtkArray{"collider", std::move(numbers)});
    return frame;
}

}  // namespace ricochet
