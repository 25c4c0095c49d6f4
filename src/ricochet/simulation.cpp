#include "ricochet/simulation.h"

#include <atomic>
#include <utility>

#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/simulation/cloud_motion.h"
#include "ricochet/simulation/counters/counter_tally.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

/// Returns true if energies include particle i. The next step will freeze a particle with a non-finite state.
bool has_energy(const Particles& p, std::size_t i) {
    return p.frozen[i] == 0 && is_finite(p.position[i]) && is_finite(p.velocity[i]);
}

}  // namespace

Simulation::Simulation(SimulationSetup setup) : impl_(std::make_unique<Impl>(setup, bytes_per_particle(setup))) {}
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
        const auto& curves = impl().emission.emitters()[particles.origin[i].emitter].description().curves;
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
    const CloudMotion* const clouds = impl().modules.hooks().clouds;
    return clouds != nullptr ? std::optional(clouds->parents()) : std::nullopt;
}
const std::vector<SpringFace>& Simulation::spring_faces() const {
    return impl().modules.find<SpringsModule>()->faces();
}
RankBalance Simulation::rank_balance() const {
    const SharedRun* const shared = impl().modules.find<SharedRun>();
    return shared != nullptr ? shared->balance() : RankBalance{};
}
std::uint64_t Simulation::common_memory_bytes() const { return impl().scene.shared_bytes(); }
void Simulation::have_meshes_in_common() {
    if (!impl().share.is_alone()) impl().scene.share_meshes(impl().share.ranks());
}
const SimulationStatistics& Simulation::statistics() const { return impl().recorder.statistics(); }
const std::vector<ColliderDescription>& Simulation::colliders() const { return impl().scene.list().all(); }
std::span<const Material> Simulation::materials() const { return impl().scene.materials(); }
const SpringNetwork& Simulation::springs() const { return impl().coupled().springs(); }
std::optional<TriangleMesh> Simulation::collider_mesh(std::size_t i) const {
    require_index(i, colliders().size(), "collider");
    return impl().scene.mesh_of(i, time());
}
MovingPose Simulation::collider_pose(std::size_t i, double time) const {
    require_index(i, colliders().size(), "collider");
    return impl().scene.pose_of(i, time);
}
std::size_t Simulation::triangle_count() const { return impl().scene.triangle_count(); }
std::size_t Simulation::degenerate_triangles() const { return impl().scene.degenerate_triangles(); }

const std::vector<ContactRecord>& Simulation::contact_records() const { return impl().recorder.contact_records(); }
const std::vector<PairImpactRecord>& Simulation::pair_records() const { return impl().recorder.pair_records(); }
bool Simulation::spawns_children() const { return impl().modules.hooks().offspring != nullptr; }
const std::vector<BirthRecord>& Simulation::birth_records() const {
    static const std::vector<BirthRecord> none;
    const ChildrenModule* const children = impl().modules.find<ChildrenModule>();
    return children != nullptr ? children->births() : none;
}
SurfacePosition Simulation::contact_point(const ContactRecord& record) const {
    require_index(record.surface, impl().scene.list().surface_count(), "surface");
    return impl().scene.closest_point(record.surface, record.position, record.time);
}
SurfaceName Simulation::surface_name(SurfaceId surface) const {
    require_index(surface, impl().scene.list().surface_count(), "surface");
    return impl().scene.list().name_of(surface);
}

TriangleTotals Simulation::triangle_totals(std::size_t i) const {
    require_index(i, colliders().size(), "collider");
    TriangleTotals result;
    const SurfaceTotals& totals = impl().recorder.totals();
    if (totals.empty()) return result;
    // The weights of sleeping particles are in the totals only during this call, and are removed exactly at the end.
    impl().mover.add_weights(time(), 1.0);
    const ColliderList& list = impl().scene.list();
    for (SurfaceId surface = list.first_surface_of(i); surface < list.first_surface_of(i + 1); ++surface) {
        // All surfaces of one shape share one entry.
        const std::size_t at = list.name_of(surface).triangle;
        result.hits.resize(at + 1);
        result.impulse.resize(at + 1);
        result.lasting_impulse.resize(at + 1);
        result.hits[at] += totals.hits(surface);
        result.impulse[at] += totals.impulse(surface);
        result.lasting_impulse[at] += totals.lasting_impulse(surface);
    }
    impl().mover.add_weights(time(), -1.0);
    return result;
}

const std::vector<ColliderTotals>& Simulation::collider_totals() const { return impl().recorder.loads(); }

const std::vector<CounterTotals>& Simulation::counters() const {
    static const std::vector<CounterTotals> none;
    const CounterTally* const counters = impl().modules.find<CounterTally>();
    return counters != nullptr ? counters->totals() : none;
}

std::vector<BodyState> Simulation::bodies() const {
    std::vector<BodyState> states;
    for (const DrivenBody& body : impl().modules.find<BodiesModule>()->bodies()) {
        states.push_back({body.description().frame, body.center(), body.velocity(), body.angular_velocity(),
                          body.angular_momentum(), body.description().mass, body.coordinate(), body.rate(),
                          body.kinetic_energy(), body.world_from_frame()});
    }
    return states;
}

const std::vector<Violation>& Simulation::last_violations() const { return impl().recorder.last_violations(); }

bool Simulation::is_penetrating(std::size_t i) const {
    require_index(i, impl().population.store().size(), "particle");
    const std::span<const SideMemory> sides = impl().population.store().sides_of(i);
    return std::ranges::any_of(sides, [](const SideMemory& memory) { return memory.penetrating; });
}

const std::vector<std::string>& Simulation::warnings() const { return impl().warnings.texts(); }

bool Simulation::has_spheres() const { return impl().emission.has_spheres(); }

const std::vector<Violation>& Simulation::violations() const { return impl().recorder.violations(); }

double Simulation::kinetic_energy() const {
    const Particles& particles = impl().particles();
    const std::vector<std::uint32_t> order = impl().particles().order_by_id();
    return ordered_sum(order.size(), kParticleBlock, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = order[k];
            if (!has_energy(particles, i)) continue;
            const double r = particles.radius[i];
            // Inertia of a solid sphere, 2/5 m r^2.
            const double turning = 0.4 * r * r * length_squared(particles.spin[i]);
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
            if (!has_energy(particles(), order[k])) continue;
            const auto energy = impl().forces.potential_energy(impl().population.store().force_input(order[k], now));
            if (!energy) defined = false;
            partial += energy.value_or(0.0);
        }
        return partial;
    });
    const double stored = impl().coupled().springs().potential_energy(particles().position);
    const std::optional<double> mutual = impl().coupled().mutual_energy(particles(), now);
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
