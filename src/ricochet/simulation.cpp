#include "ricochet/simulation.h"

#include <atomic>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
Simulation::Simulation(SimulationSetup setup) : impl_(std::make_unique<Impl>(std::move(setup))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::Impl& Simulation::impl() const {
    if (!impl_) throw RunError("this simulation has been moved from; use the one that it was moved to");
    return *impl_;
}
bool Simulation::finished() const { return impl().recorder.statistics().steps >= impl().clock.steps(); }
double Simulation::time() const { return impl().clock.time_at(impl().recorder.statistics().steps); }
std::uint64_t Simulation::step_index() const { return impl().recorder.statistics().steps; }
std::uint64_t Simulation::step_count() const { return impl().clock.steps(); }
CollisionQueries Simulation::queries_of(std::shared_ptr<const CollisionWorld> world) {
    return CollisionQueries(std::move(world));
}
const CollisionQueries& Simulation::collisions() const { return impl().queries; }
const SimulationOptions& Simulation::options() const { return impl().options; }
const Particles& Simulation::particles() const { return impl().particles(); }
AttributeTable Simulation::shown_attributes() const {
    const Particles& particles = impl().particles();
    AttributeTable shown = particles.attributes;
    if (!particles.keeps_origin || shown.empty()) return shown;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (particles.origin[i].emitter == kNoEmitter) continue;
        const auto& curves = impl().emitters[particles.origin[i].emitter].description().curves;
        if (curves.empty()) continue;
        for (std::size_t k = 0; k < shown.columns().size(); ++k) {
            const double age = time() - particles.birth_time[i];
            shown.set(k, i,
                      shown_value(curves, shown.columns()[k].name, shown.value(k, i), age, particles.lifetime[i]));
        }
    }
    return shown;
}
std::optional<std::vector<std::int64_t>> Simulation::cloud_parents() const {
    if (!impl().clouds) return std::nullopt;
    return impl().clouds->parents();
}
const std::vector<SpringFace>& Simulation::spring_faces() const { return impl().spring_faces; }
RankBalance Simulation::rank_balance() const { return impl().balancer.balance(); }
std::uint64_t Simulation::common_memory_bytes() const { return impl().common_memory_bytes; }
void Simulation::have_meshes_in_common() {
    if (!impl().share.is_alone()) impl().have_meshes_in_common();
}
const SimulationStatistics& Simulation::statistics() const { return impl().recorder.statistics(); }
const std::vector<ColliderDescription>& Simulation::colliders() const { return impl().world.colliders(); }
std::span<const Material> Simulation::materials() const { return impl().materials; }
const SpringNetwork& Simulation::springs() const { return impl().coupled.springs(); }
std::optional<TriangleMesh> Simulation::collider_mesh(std::size_t i) const {
    require_index(i, impl().world.colliders().size(), "collider");
    const ColliderShape& shape = impl().world.colliders()[i].shape;
    if (const auto* ball = std::get_if<BallShape>(&shape)) return ball_mesh(ball->radius, ball->placement);
    if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
        return cylinder_mesh(cylinder->radius, cylinder->height, cylinder->placement);
    }
    if (impl().bodies && impl().bodies->deforming().is_mesh(i)) {
        return impl().bodies->deforming().mesh_at(i, time());
    }
    return impl().world_of(i).mesh_of(i);
}
MovingPose Simulation::collider_pose(std::size_t i, double time) const {
    require_index(i, impl().world.colliders().size(), "collider");
    return impl().bodies ? impl().bodies->pose(impl().bodies->body_of_collider(i), time) : MovingPose{};
}
std::size_t Simulation::triangle_count() const {
    std::size_t count = impl().world.triangles().size();
    for (BodyId body = 0; impl().bodies && body < impl().bodies->size(); ++body) {
        count += impl().bodies->world(body).triangles().size();
    }
    for (std::size_t i = 0; impl().bodies && i < colliders().size(); ++i) {
        const DeformingColliders& deforming = impl().bodies->deforming();
        if (deforming.is_mesh(i)) count += deforming.triangles_of(i).size();
    }
    return count;
}
std::size_t Simulation::degenerate_triangles() const {
    std::size_t count = impl().world.degenerate_triangles();
    for (BodyId body = 0; impl().bodies && body < impl().bodies->size(); ++body) {
        count += impl().bodies->world(body).degenerate_triangles();
    }
    return count;
}

const std::vector<ContactRecord>& Simulation::contact_records() const { return impl().recorder.contact_records(); }
const std::vector<PairImpactRecord>& Simulation::pair_records() const { return impl().recorder.pair_records(); }
bool Simulation::spawns_children() const { return impl().offspring != nullptr; }
const std::vector<BirthRecord>& Simulation::birth_records() const { return impl().birth_records; }
SurfacePosition Simulation::contact_point(const ContactRecord& record) const {
    require_index(record.surface, impl().world.surface_count(), "surface");
    const std::uint32_t collider = impl().world.name_of(record.surface).collider;
    const MovingPose pose = collider_pose(collider, record.time);
    if (impl().bodies && impl().bodies->deforming().is_mesh(collider)) {
        const auto [a, b, c] = impl().bodies->deforming().corners_at(record.surface, record.time);
        const ClosestPointOnTriangle closest = closest_point_on_triangle(record.position, a, b, c);
        return {closest.point, barycentric_coordinates(closest, a, b, c)};
    }
    const CollisionWorld& world = impl().world_of(collider);
    if (&world == &impl().world) return world.closest_point_on(record.surface, record.position);
    SurfacePosition position = world.closest_point_on(record.surface, pose.local_position(record.position));
    position.point = pose.point(position.point);
    return position;
}
SurfaceName Simulation::surface_name(SurfaceId surface) const {
    require_index(surface, impl().world.surface_count(), "surface");
    return impl().world.name_of(surface);
}

TriangleTotals Simulation::triangle_totals(std::size_t i) const {
    require_index(i, impl().world.colliders().size(), "collider");
    TriangleTotals result;
    if (impl().recorder.totals().empty()) return result;
    // Adds the weights of sleeping particles to the totals for the time of this call. They are removed exactly.
    impl().add_weights_of_sleepers(1.0);
    const std::size_t first = impl().world.first_surface_of(i);
    for (std::size_t k = 0; k < impl().world.surface_count_of(i); ++k) {
        // All parts of a shape share one entry.
        const std::size_t at = impl().world.name_of(static_cast<SurfaceId>(first + k)).triangle;
        result.hits.resize(at + 1);
        result.impulse.resize(at + 1);
        result.lasting_impulse.resize(at + 1);
        result.hits[at] += impl().recorder.totals().hits(first + k);
        result.impulse[at] += impl().recorder.totals().impulse(first + k);
        result.lasting_impulse[at] += impl().recorder.totals().lasting_impulse(first + k);
    }
    impl().add_weights_of_sleepers(-1.0);
    return result;
}

const std::vector<ColliderTotals>& Simulation::collider_totals() const { return impl().recorder.loads(); }

const std::vector<CounterTotals>& Simulation::counters() const {
    static const std::vector<CounterTotals> none;
    return impl().counters ? impl().counters->totals() : none;
}

std::vector<BodyState> Simulation::bodies() const {
    std::vector<BodyState> states;
    for (const DrivenBody& body : impl().driven.bodies()) {
        states.push_back({body.description().frame, body.center(), body.velocity(), body.angular_velocity(),
                          body.angular_momentum(), body.description().mass, body.coordinate(), body.rate(),
                          body.kinetic_energy(), body.world_from_frame()});
    }
    return states;
}

const std::vector<Violation>& Simulation::last_violations() const { return impl().recorder.last_violations(); }

bool Simulation::is_penetrating(std::size_t i) const {
    require_index(i, impl().store.size(), "particle");
    const std::span<const SideMemory> sides = impl().store.sides_of(i);
    return std::any_of(sides.begin(), sides.end(), [](const SideMemory& memory) { return memory.penetrating; });
}

const std::vector<std::string>& Simulation::warnings() const { return impl().warnings; }

bool Simulation::has_spheres() const { return impl().has_spheres; }

// Impulses too large for the totals are counted when the weight is added permanently.
void Simulation::Impl::add_weights_of_sleepers(double sign) {
    const double now = clock.time_at(recorder.statistics().steps);
    for (std::size_t i = 0; i < store.size(); ++i) (void)mover.add_weight(i, now, sign);
}

// A state that is not finite counts as frozen, because the next step will freeze it.
bool Simulation::Impl::has_energy(std::size_t i) const {
    const Particles& p = particles();
    return p.frozen[i] == 0 && is_finite(p.position[i]) && is_finite(p.velocity[i]);
}
const std::vector<Violation>& Simulation::violations() const { return impl().recorder.violations(); }

double Simulation::kinetic_energy() const {
    const Particles& particles = impl().particles();
    const std::vector<std::uint32_t> order = impl().particles().order_by_id();
    return ordered_sum(order.size(), kParticleBlock, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = order[k];
            if (!impl().has_energy(i)) continue;
            const double r = particles.radius[i];
            const double turning = 0.4 * r * r * length_squared(particles.spin[i]);  // solid sphere, 2/5 m r^2
            sum += 0.5 * particles.mass[i] * (length_squared(particles.velocity[i]) + turning);
        }
        return sum;
    });
}

std::optional<double> Simulation::potential_energy() const {
    const std::vector<std::uint32_t> order = impl().particles().order_by_id();
    std::atomic<bool> defined{true};
    const double now = time();
    const double sum = ordered_sum(order.size(), kParticleBlock, [&](std::size_t begin, std::size_t end) {
        double partial = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            if (!impl().has_energy(order[k])) continue;
            const auto energy = impl().forces.potential_energy(impl().store.force_input(order[k], now));
            if (!energy) defined = false;
            partial += energy.value_or(0.0);
        }
        return partial;
    });
    const double stored = impl().coupled.springs().potential_energy(particles().position);
    const std::optional<double> mutual = impl().coupled.mutual_energy(particles(), now);
    return defined && mutual ? std::optional(sum + stored + *mutual) : std::nullopt;
}

std::uint64_t Simulation::state_hash() const {
    StateHash hash;
    for (const std::uint32_t i : impl().particles().order_by_id()) {
        hash.add(impl().particles().id[i]);
        hash.add(impl().particles().position[i]);
        hash.add(impl().particles().velocity[i]);
    }
    for (const BodyState& body : bodies()) {
        for (const Vec3& v : {body.center, body.velocity, body.angular_velocity}) hash.add(v);
        hash.add(body.coordinate);
    }
    return hash.value();
}

}  // namespace ricochet
