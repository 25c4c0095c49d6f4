#include "inspect/scene_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "inspect/mesh_openings.h"
#include "inspect/shells.h"
#include "ricochet/collision_queries.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/geometry/mesh/winding_number.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Largest number of explicit particles that are tested.
constexpr std::size_t kMostExplicit = 2000;

/// Largest product of the numbers of triangles and start positions for which winding numbers are computed. Their cost
/// is proportional to this product. Local, because it limits only the cost of a warning.
constexpr double kMostSolidAngles = 2e7;

/// Diameter of an opening, relative to the diagonal of the mesh's box. Larger openings are intended, such as the mouth
/// of a funnel. Smaller openings are leaks. Local, because it decides only about a warning.
constexpr double kMouth = 0.25;

/// Width of an opening, relative to the diagonal of the mesh's box. Narrower openings are seams between parts, through
/// which no particles pass. Local, because it decides only about a warning.
constexpr double kCrack = 1e-3;

/// Largest product of kCandidateSlack and the largest coordinate, relative to the mean edge length. Above this limit,
/// the narrow phase tests many triangles that the path cannot hit. At 0.1, a contact costs 1.6 times as much as near
/// the origin. At 0.2, it costs 2.8 times as much. Local, because it decides only about a warning.
constexpr double kMostSlack = 0.1;

/// Sample of the particles of one emitter, or of the explicit particles.
struct Starts {
    std::string where;
    std::vector<Particle> particles;
    double largest_radius = 0.0;    ///< largest radius of all particles, in m
    std::uint64_t overlapping = 0;  ///< number of samples left out because they overlap a surface
    double fastest = 0.0;           ///< largest speed, in m/s
};

Starts explicit_starts(const Simulation& simulation) {
    const Particles& all = simulation.particles();
    Starts starts{"particles", {}, 0.0, 0, 0.0};
    const std::size_t count = std::min(all.size(), kMostExplicit);
    for (std::size_t k = 0; k < count; ++k) starts.particles.push_back(all.at(k * all.size() / count));
    for (const double radius : all.radius) starts.largest_radius = std::max(starts.largest_radius, radius);
    for (const Vec3& velocity : all.velocity) starts.fastest = std::max(starts.fastest, length(velocity));
    return starts;
}

/// A single collider and its queries, in the coordinates of its reference frame.
struct Solid {
    Solid(const Simulation& simulation, std::size_t i) : number(i), queries({in_its_frame(simulation, i)}) {}

    /// Returns a copy of the collider that has no frame and uses the mesh stored in the simulation.
    static ColliderDescription in_its_frame(const Simulation& simulation, std::size_t i) {
        ColliderDescription collider = simulation.colliders()[i];
        collider.frame.clear();
        if (!std::holds_alternative<MeshShape>(collider.shape)) return collider;
        auto mesh = std::make_shared<const TriangleMesh>(*simulation.collider_mesh(i));
        collider.shape = MeshShape{std::move(mesh), {}, ""};
        return collider;
    }

    std::size_t number;
    CollisionQueries queries;
};

/// Returns the colliders in reference frames, because the simulation's own queries cover only static colliders.
std::vector<Solid> moving_solids(const Simulation& simulation) {
    std::vector<Solid> solids;
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) {
        if (!simulation.colliders()[i].frame.empty()) solids.emplace_back(simulation, i);
    }
    return solids;
}

/// Returns a particle's start position in the collider's reference frame.
Vec3 start_in(const Simulation& simulation, std::size_t collider, const Particle& particle) {
    return simulation.collider_pose(collider, particle.birth_time).local_position(particle.position);
}

bool overlaps(const Simulation& simulation, std::span<const Solid> moving, const Particle& p) {
    if (!is_finite(p.position) || max_abs(p.position) > kLargestCoordinate) return false;
    const double least = p.radius - sphere_tolerance(p.radius, max_abs(p.position));
    if (!(least > 0.0) || simulation.colliders().empty()) return false;
    const auto is_within = [&](const CollisionQueries& queries, const Vec3& position) {
        const auto closest = queries.closest_point(position, p.radius);
        return closest && closest->distance < least;
    };
    return is_within(simulation.collisions(), p.position) ||
           std::any_of(moving.begin(), moving.end(), [&](const Solid& solid) {
               return is_within(solid.queries, start_in(simulation, solid.number, p));
           });
}

Starts starts_of(const Simulation& simulation, std::span<const Solid> moving, const EmitterDescription& emitter,
                 std::size_t index) {
    Starts starts{name_in_list("emitters", index, emitter.name),
                  {},
                  emitter.radius.most(),
                  0,
                  most_speed(emitter) + length(emitter.velocity)};
    for (const Particle& particle : drawn_starts(emitter, index, kDrawnStarts)) {
        if (overlaps(simulation, moving, particle)) {
            ++starts.overlapping;
        } else {
            starts.particles.push_back(particle);
        }
    }
    return starts;
}

/// A mesh collider with boundary loops.
struct OpenMesh {
    std::size_t number;
    std::string where;
    TriangleMesh mesh;
    Box3 box;
    std::vector<MeshOpening> openings;  ///< largest first
};

class SceneReview {
public:
    SceneReview(const Simulation& simulation, std::span<const EmitterDescription> emitters, const Vec3& fall)
        : simulation_(simulation), emitters_(emitters), fall_(fall) {
        const std::vector<Solid> moving = moving_solids(simulation);
        if (!simulation.particles().empty()) starts_.push_back(explicit_starts(simulation));
        for (std::size_t k = 0; k < emitters.size(); ++k) {
            if (!emitters[k].parent) starts_.push_back(starts_of(simulation, moving, emitters[k], k));
        }
    }

    std::vector<std::string> lines() {
        review_surfaces();
        review_emitted_volumes();
        if (auto line = long_step_warning(simulation_.options(), extent(), fall_)) lines_.push_back(std::move(*line));
        std::ranges::move(pair_method_warnings(simulation_, fall_), std::back_inserter(lines_));
        for (std::size_t i = 0; i < simulation_.colliders().size(); ++i) review_collider(i);
        const std::optional<Box3> near = still_surfaces();
        for (const Starts& starts : starts_) {
            review_positions(starts);
            if (auto line = small_radius_warning(starts.where, starts.particles)) lines_.push_back(std::move(*line));
            if (!near) continue;
            const double path = starts.fastest * simulation_.options().duration;
            if (auto line = far_starts_warning(starts.where, starts.particles, *near, path)) {
                lines_.push_back(std::move(*line));
            }
        }
        return std::move(lines_);
    }

private:
    [[nodiscard]] Box3 extent() const;
    [[nodiscard]] Box3 surfaces() const;
    [[nodiscard]] std::optional<Box3> still_surfaces() const;
    void review_surfaces();
    void review_area(const TriangleMesh& mesh, const std::string& where);
    void review_shells(const TriangleMesh& mesh, const std::string& where);
    void review_emitted_volumes();
    void review_collider(std::size_t i);
    void review_precision(const TriangleMesh& mesh, const std::string& where);
    void review_sides(const Starts& starts, const Solid& solid, const std::string& where);
    void review_leaks(const Starts& starts, const OpenMesh& open);
    void review_fit(const Starts& starts, const OpenMesh& open);
    void review_positions(const Starts& starts);
    [[nodiscard]] bool falls_to(const Particle& particle, const OpenMesh& open) const;

    const Simulation& simulation_;
    std::span<const EmitterDescription> emitters_;
    Vec3 fall_;
    std::vector<Starts> starts_;
    std::vector<std::string> lines_;
};

/// Returns the bounding box of all colliders except planes, at the start of the run.
Box3 SceneReview::surfaces() const {
    Box3 box;
    for (std::size_t i = 0; i < simulation_.colliders().size(); ++i) {
        if (std::holds_alternative<PlaneShape>(simulation_.colliders()[i].shape)) continue;
        const TriangleMesh mesh = *simulation_.collider_mesh(i);
        const MovingPose pose = simulation_.collider_pose(i, 0.0);
        for (const Vec3& vertex : mesh.vertices) box.include(pose.point(vertex));
    }
    return box;
}

/// Returns the bounding box of all colliders. Returns nothing if a collider is a plane or moves, because such a
/// collider can be near any start position.
std::optional<Box3> SceneReview::still_surfaces() const {
    for (const ColliderDescription& collider : simulation_.colliders()) {
        const bool moves = !collider.frame.empty() || is_deforming(collider);
        if (moves || std::holds_alternative<PlaneShape>(collider.shape)) return std::nullopt;
    }
    return surfaces();
}

/// Returns the bounding box of all start positions and colliders. A plane contributes only its reference point.
Box3 SceneReview::extent() const {
    Box3 box = surfaces();
    for (const Starts& starts : starts_) {
        for (const Particle& particle : starts.particles) {
            if (is_finite(particle.position)) box.include(particle.position);
        }
    }
    for (const ColliderDescription& collider : simulation_.colliders()) {
        const auto* const plane = std::get_if<PlaneShape>(&collider.shape);
        if (plane) box.include(plane->point);
    }
    return box;
}

/// Warns about settings that need a collider in a scene without colliders. Other scenes without colliders are common
/// and cause no warning.
void SceneReview::review_surfaces() {
    if (!simulation_.colliders().empty() || starts_.empty()) return;
    const std::string advice = "add colliders, or leave it out";
    for (std::size_t k = 0; k < emitters_.size(); ++k) {
        if (!emitters_[k].parent || emitters_[k].parent->on != BirthEvent::impact) continue;
        lines_.push_back(fmt::format("{}: its particles are born at impacts, and there is nothing to hit: {}",
                                     name_in_list("emitters", k, emitters_[k].name), advice));
    }
    if (simulation_.options().response != ResponseKind::exact) {
        lines_.push_back(
            fmt::format("simulation.response: a response is chosen, and there is nothing to hit: {}", advice));
    }
    if (simulation_.options().record_contacts) {
        lines_.push_back(
            fmt::format("output.contacts: contacts are asked for, and there is nothing to hit: {}", advice));
    }
}

std::optional<OpenMesh> open_mesh(const Simulation& simulation, std::size_t i, std::string where) {
    if (!std::holds_alternative<MeshShape>(simulation.colliders()[i].shape)) return std::nullopt;
    OpenMesh open{i, std::move(where), *simulation.collider_mesh(i), {}, {}};
    open.openings = openings_of(open.mesh);
    if (open.openings.empty()) return std::nullopt;
    std::sort(open.openings.begin(), open.openings.end(),
              [](const MeshOpening& a, const MeshOpening& b) { return a.diameter > b.diameter; });
    for (const Vec3& vertex : open.mesh.vertices) open.box.include(vertex);
    return open;
}

void SceneReview::review_collider(std::size_t i) {
    const ColliderDescription& collider = simulation_.colliders()[i];
    const std::string where = name_in_list("colliders", i, collider.name);
    if (std::holds_alternative<PlaneShape>(collider.shape)) return;
    if (std::holds_alternative<MeshShape>(collider.shape)) {
        const TriangleMesh mesh = *simulation_.collider_mesh(i);
        review_precision(mesh, where);
        review_area(mesh, where);
        review_shells(mesh, where);
    }
    if (const std::optional<OpenMesh> open = open_mesh(simulation_, i, where)) {
        for (const Starts& starts : starts_) {
            review_leaks(starts, *open);
            review_fit(starts, *open);
        }
        return;
    }
    const Solid solid(simulation_, i);
    for (const Starts& starts : starts_) review_sides(starts, solid, where);
}

void SceneReview::review_area(const TriangleMesh& mesh, const std::string& where) {
    const auto has_area = [&](const Triangle& t) {
        return !are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    };
    if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(), has_area)) return;
    lines_.push_back(
        fmt::format("{}: none of its triangles ({}) has an area, so that nothing hits it: look at the file", where,
                    mesh.triangles.size()));
}

/// Warns about overlapping shells. Skips open meshes, because they have no interior.
void SceneReview::review_shells(const TriangleMesh& mesh, const std::string& where) {
    if (!is_closed(mesh) || !shells_overlap(mesh)) return;
    lines_.push_back(where +
                     ": shells of its mesh overlap: every triangle stops particles, but an overlap of two counts as "
                     "outside for emitters and inside tests; join the shells if that is not meant");
}

void SceneReview::review_emitted_volumes() {
    for (std::size_t k = 0; k < emitters_.size(); ++k) {
        const auto* const volume = std::get_if<MeshVolumeShape>(&emitters_[k].shape);
        if (volume != nullptr && volume->mesh)
            review_shells(*volume->mesh, name_in_list("emitters", k, emitters_[k].name));
    }
}

/// Warns if coordinates far from the origin are too coarse for small triangles.
void SceneReview::review_precision(const TriangleMesh& mesh, const std::string& where) {
    double largest = 0.0;
    for (const Vec3& vertex : mesh.vertices) largest = std::max(largest, max_abs(vertex));
    double edges = 0.0;
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges += length(mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]);
        }
    }
    const double mean = mesh.triangles.empty() ? 0.0 : edges / (3.0 * static_cast<double>(mesh.triangles.size()));
    if (kCandidateSlack * largest <= kMostSlack * mean) return;
    lines_.push_back(fmt::format(
        "{}: edges of {:.2g} m on average at coordinates of {:.2g} m, where {:.1g} m lie between one number "
        "and the next: contacts keep some {:.1g} m off and cost more; move the scene to the origin",
        where, mean, largest, ulp(largest), contact_offset({largest, 0.0, 0.0})));
}

void SceneReview::review_sides(const Starts& starts, const Solid& solid, const std::string& where) {
    const auto is_inside = [&](const Particle& p) {
        const Vec3 position = start_in(simulation_, solid.number, p);
        return is_finite(position) && solid.queries.is_inside(position);
    };
    const auto inside = std::count_if(starts.particles.begin(), starts.particles.end(), is_inside);
    if (inside == 0 || inside == std::ssize(starts.particles)) return;
    lines_.push_back(
        fmt::format("{}: {} of {} begin inside {}, which is closed, the others outside: none ever changes sides; "
                    "move them to one side if that is not meant",
                    starts.where, inside, starts.particles.size(), where));
}

/// Warns about particles inside a mesh with small holes, because the author may believe that the mesh is closed.
void SceneReview::review_leaks(const Starts& starts, const OpenMesh& open) {
    if (starts.particles.empty() || open.openings[0].diameter > kMouth * open.box.diagonal()) return;
    const double affordable = kMostSolidAngles / static_cast<double>(open.mesh.triangles.size());
    const auto looked_at = static_cast<std::size_t>(
        std::clamp(affordable, 1.0, static_cast<double>(std::min<std::size_t>(starts.particles.size(), 64))));
    std::size_t inside = 0;
    for (std::size_t k = 0; k < looked_at; ++k) {
        const Particle& particle = starts.particles[k * starts.particles.size() / looked_at];
        const Vec3 position = start_in(simulation_, open.number, particle);
        if (!open.box.contains(position)) continue;
        inside += std::fabs(winding_number(open.mesh, position)) > 0.5 ? 1 : 0;
    }
    if (2 * inside < looked_at) return;  // most starts are outside, so the mesh is not meant as a container
    lines_.push_back(
        fmt::format("{}: {} of {} begin inside {}, which is open: {} {}, the largest {:.3g} m across, let "
                    "them out; close the mesh (`ricochet info` tells more) if that is not meant",
                    starts.where, inside, looked_at, open.where, open.openings.size(),
                    open.openings.size() == 1 ? "hole" : "holes", open.openings[0].diameter));
}

/// Warns about spheres too large for the outlet of a mesh with a mouth and an outlet, such as a funnel.
void SceneReview::review_fit(const Starts& starts, const OpenMesh& open) {
    if (open.openings.size() < 2 || open.openings[0].diameter < kMouth * open.box.diagonal()) return;
    double narrowest = open.openings[0].width;
    for (const MeshOpening& opening : open.openings) {
        if (opening.width > kCrack * open.box.diagonal()) narrowest = std::min(narrowest, opening.width);
    }
    if (starts.particles.empty() || !(2.0 * starts.largest_radius > narrowest)) return;
    const auto falls = std::count_if(starts.particles.begin(), starts.particles.end(),
                                     [&](const Particle& particle) { return falls_to(particle, open); });
    if (2 * falls < std::ssize(starts.particles)) return;
    lines_.push_back(
        fmt::format("{}: spheres of up to {:.3g} m across do not fit through the narrowest opening of {}, {:.3g} m "
                    "wide: use smaller ones, or a wider opening, if they are to pass",
                    starts.where, 2.0 * starts.largest_radius, open.where, narrowest));
}

/// Returns true if the particle starts in the box of the mesh, or falls into the box along a straight line.
bool SceneReview::falls_to(const Particle& particle, const OpenMesh& open) const {
    const Box3& box = open.box;
    const MovingPose pose = simulation_.collider_pose(open.number, particle.birth_time);
    const Vec3 from = pose.local_position(particle.position);
    const Vec3 fall = pose.local_direction(fall_);
    if (box.contains(from)) return true;
    double begin = 0.0;
    double end = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double low = (box.lower[axis] - from[axis]) / fall[axis];
        const double high = (box.upper[axis] - from[axis]) / fall[axis];
        if (fall[axis] == 0.0) {
            const double x = from[axis];
            if (x < box.lower[axis] || x > box.upper[axis]) return false;
            continue;
        }
        begin = std::max(begin, std::min(low, high));
        end = std::min(end, std::max(low, high));
    }
    return begin <= end && fall != Vec3{};
}

/// Warns about emitters that find few free positions. Explicit particles need no warning, because the simulation
/// refuses overlapping ones.
void SceneReview::review_positions(const Starts& starts) {
    // The limit is 5 % free positions. At this limit, one birth in thirty finds no free position in all its attempts.
    if (20 * starts.overlapping < 19 * kDrawnStarts) return;
    lines_.push_back(
        fmt::format("{}: {} of {} positions that were tried overlap a surface: births there are refused; "
                    "make the spheres smaller or move the emitter off",
                    starts.where, starts.overlapping, kDrawnStarts));
}

}  // namespace

std::vector<std::string> scene_warnings(const Simulation& simulation, std::span<const EmitterDescription> emitters,
                                        const Vec3& fall) {
    return SceneReview(simulation, emitters, fall).lines();
}

}  // namespace ricochet
