// Saving and restoring a running simulation.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/settings_table.h"
#include "ricochet/response/pair_materials.h"
#include "ricochet/response/settings_table.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

/// Begins every saved state; its last digits change with the layout.
constexpr std::uint64_t kStateFormat = 0x5249434f5354000dULL;

/// Number of slices of time in which emitters repeat their births, so that no list of births becomes long.
constexpr std::uint64_t kReplaySlices = 1000;

/// Archives the statistics with their layout in memory, so that no counter can be forgotten. The gap behind its only
/// short counter becomes zero.
template <class Archive>
void archive_statistics(Archive& a, SimulationStatistics& statistics) {
    static_assert(std::is_trivially_copyable_v<SimulationStatistics>);
    constexpr std::size_t kGap = offsetof(SimulationStatistics, bounces_per_step_max) + sizeof(std::uint32_t);
    static_assert(offsetof(SimulationStatistics, resting) == kGap + sizeof(std::uint32_t));
    std::array<std::byte, sizeof(SimulationStatistics)> bytes{};
    std::memcpy(bytes.data(), &statistics, sizeof(statistics));
    std::memset(bytes.data() + kGap, 0, sizeof(std::uint32_t));
    a(bytes);
    std::memcpy(&statistics, bytes.data(), sizeof(statistics));
}

/// Archives an expected value. When reading, throws InputError if another value is found.
template <class Archive, class T>
void expect(Archive& a, const T& expected, const char* complaint) {
    T value = expected;
    a(value);
    if (value != expected) throw InputError(complaint);
}

/// Adds the settings of a table to a fingerprint. Absent ones count as 0.
void add_settings(StateHash& hash, const auto& object, const auto& table) {
    const auto add = [&](auto member) {
        const auto& value = object.*member;
        if constexpr (requires { value.x; }) {
            hash.add(value);
        } else if constexpr (requires { value.value_or(0.0); }) {
            hash.add(value.value_or(0.0));
        } else {
            hash.add(static_cast<double>(value));
        }
    };
    for (const auto& line : table) std::visit(add, line.member);
}

}  // namespace

// Hashes the colliders in their frames, and the motion of these. A changed mesh file is a changed setup.
std::uint64_t Simulation::Impl::collider_hash() const {
    StateHash hash;
    const auto add = [&](const CollisionWorld& of) {
        for (const Vec3& vertex : of.vertices()) hash.add(vertex);
        for (const Triangle& triangle : of.triangles()) {
            for (const std::uint32_t corner : triangle) hash.add(static_cast<std::uint64_t>(corner));
        }
    };
    add(world);
    for (BodyId body = 0; bodies && body < bodies->size(); ++body) {
        add(bodies->world(body));
        hash.add(bodies->frames()->hash(bodies->frame_of(body)));
    }
    for (std::size_t k = 0; bodies && k < colliders->all().size(); ++k) {
        hash.add(static_cast<std::uint64_t>(bodies->body_of_collider(k)));
    }
    for (std::size_t i = 0; bodies && i < world.colliders().size(); ++i) {
        if (!bodies->deforming().is_mesh(i)) continue;
        const MeshMotion& motion = bodies->deforming().motion_of(i);
        hash.add(static_cast<double>(motion.ends() == MeshEnds::repeat));
        for (const Triangle& triangle : bodies->deforming().triangles_of(i)) {
            for (const std::uint32_t corner : triangle) hash.add(static_cast<std::uint64_t>(corner));
        }
        for (std::size_t key = 0; key < motion.key_count(); ++key) {
            hash.add(motion.times()[key]);
            for (const Vec3& vertex : motion.positions(key)) hash.add(vertex);
        }
    }
    hash.add(static_cast<std::uint64_t>(world.surface_count()));
    return hash.value();
}

/// Hashes the settings on which results depend. The duration is not one of them.
std::uint64_t Simulation::Impl::settings_hash() const {
    StateHash hash;
    const auto add = [&hash](auto... values) { (hash.add(static_cast<double>(values)), ...); };
    add(options.integrator.kind);
    add_settings(hash, options.integrator.tolerance, kToleranceTable);
    hash.add(options.seed);
    add(options.response, options.resting_speed, options.bounce_budget);
    add_settings(hash, options.rollback, kRollbackTable);
    add_settings(hash, options.project, kProjectTable);
    add_settings(hash, options.penalty, kPenaltyTable);
    add(options.walls, options.flow != nullptr, options.frame_rate, options.max_depth, options.most_particles);
    if (options.particle_contacts) {
        const PairContactSettings& p = *options.particle_contacts;
        const PairMaterials all(p);
        add_settings(hash, material_of_all(p), kSphereContactTable<PairMaterial>);
        add(p.method, p.impact_budget);
        for (std::uint32_t a = 0; a < p.materials.size(); ++a) {
            for (std::uint32_t b = 0; b <= a; ++b) add_settings(hash, all.of(a, b), kSphereContactTable<PairMaterial>);
        }
    }
    auto material_table = std::to_array(kMaterialTable);
    std::swap(material_table[1], material_table[2]);  // the order of saved states: friction, then the threshold
    for (const Material& m : materials) {
        add_settings(hash, m, material_table);
        if (!m.motion.is_none()) add_settings(hash, m.motion, kSurfaceMotionTable);
    }
    for (const DrivenBody& body : driven.bodies()) {
        const BodyDescription& b = body.description();
        add(b.mass, b.inertia.xx, b.inertia.yy, b.inertia.zz, b.inertia.xy, b.inertia.xz, b.inertia.yz, b.joint);
        add_settings(hash, b.settings, kJointTable);
        add(b.feels_forces);
        hash.add(b.center);
        hash.add(b.axis);
    }
    if (bounds) {
        hash.add(bounds->lower);
        hash.add(bounds->upper);
    }
    if (counters) counters->add_to(hash);
    return hash.value();
}

template <class Archive>
void Simulation::Impl::archive(Archive& a) {
    expect(a, kStateFormat, "not a state that this version can read");
    if (!known_collider_hash) known_collider_hash = collider_hash();
    expect(a, *known_collider_hash, "the state belongs to other colliders");
    expect(a, settings_hash(), "the state belongs to other options, materials, bodies, bounds or counters");
    expect(a, static_cast<std::uint64_t>(emitters.size()), "the state belongs to other emitters");
    expect(a, static_cast<std::uint64_t>(coupled.springs().springs().size()), "the state belongs to other springs");
    expect(a, static_cast<std::uint64_t>(particles().attributes.columns().size()),
           "the state belongs to other attributes");
    expect(a, static_cast<std::uint64_t>(recorder.totals().size()), "the state belongs to another choice of totals");
    expect(a, options.time_step, "the state belongs to another time step");
    archive_statistics(a, recorder.statistics());
    store.archive(a);
    if (clouds) clouds->archive(a, store.size());
    recorder.totals().archive(a);
    for (ColliderTotals& load : recorder.loads()) a(load.hits), a(load.impulse), a(load.moment), a(load.work);
    coupled.archive(a);
    if (pairs) pairs->archive(a);
    expect(a, static_cast<std::uint64_t>(driven.bodies().size()), "the state belongs to other bodies");
    driven.archive(a);
    modules.each([&](Module& module) { module.archive(a); });
}

/// Throws InputError if a restored state contains values that no run produces, such as indices out of range.
void Simulation::Impl::require_sound_state() const {
    const Particles& p = particles();
    const auto require = [](bool sound, const char* what) {
        if (!sound) throw InputError(fmt::format("the state is damaged: it has {}", what));
    };
    const auto require_none = [&](const char* fault) { require(fault == nullptr, fault); };
    const auto in_range = [](const Vec3& v) { return is_finite(v) && max_abs(v) <= kLargestCoordinate; };
    require(p.size() < kNoSupport, "too many particles");
    require(std::adjacent_find(p.id.begin(), p.id.end(), std::greater_equal<>()) == p.id.end(),
            "particles out of the order of their ids");
    require(p.id.empty() || p.id.back() < store.next_id(), "an id above the last one of the run");
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (const SurfaceId surface : p.support[i]) {
            require(surface == kNoSupport || surface < world.surface_count(), "a particle on an unknown surface");
            const bool may_sleep_there =
                surface == kNoSupport || !bodies || bodies->body_of(surface) == kWorldBody || p.held[i] == 0;
            require(may_sleep_there, "a particle that sleeps on a moving surface");
        }
        const bool moves = p.frozen[i] == 0;
        require(!moves || (in_range(p.position[i]) && in_range(p.velocity[i]) && in_range(p.spin[i])),
                "a moving particle with a position, velocity or spin out of range");
        require(p.mass[i] > 0.0 && std::isfinite(p.mass[i]) && p.radius[i] >= 0.0 && p.radius[i] <= kLargestCoordinate,
                "a mass or radius out of range");
        modules.each([&](const Module& module) { require_none(module.fault_of(i)); });
        const bool is_released = p.cascade_left[i] < 0.0 && p.cascade_left[i] != ContactState::kPlaced;
        require(!is_released || bodies, "a particle released by a body, without bodies");
        require(store.is_sound(i), "a particle with an impossible history");
    }
    const double now = clock.time_at(recorder.statistics().steps);
    modules.each([&](const Module& module) { require_none(module.fault(now)); });
    for (const DrivenBody& body : driven.bodies()) {
        require(in_range(body.center()) && in_range(body.velocity()) && in_range(body.angular_velocity()),
                "a body with a position or velocity out of range");
    }
    for (const Origin& origin : p.origin) {
        require(origin.emitter == kNoEmitter || origin.emitter < emitters.size(), "a particle of an unknown emitter");
    }
}

// Repeats the births of the emitters. They do not depend on the division of time.
void Simulation::Impl::replay_emitters() {
    const std::uint64_t steps = recorder.statistics().steps;
    const double now = clock.time_at(steps);
    const std::uint64_t slices = std::min(steps, kReplaySlices);
    for (Emitter& emitter : emitters) {
        double from = 0.0;
        for (std::uint64_t k = 1; k <= slices; ++k) {
            const double to = k == slices ? now : now * static_cast<double>(k) / static_cast<double>(slices);
            (void)emitter.births(from, to, 0);
            from = to;
        }
    }
}

// Knowledge about queries affects only speed.
void Simulation::Impl::forget_queries() {
    schedule.reset(store.size());
    for (std::size_t i = 0; i < store.size(); ++i) {
        if (store.is_fixed(i) || store.is_asleep(i)) schedule.leave_alone(i);
    }
}

void Simulation::save(const ByteSink& sink) const {
    if (!sink) throw InputError("save: found an empty function, expected one that takes the bytes");
    if (impl().inside_step)
        throw RunError("save: the last step or restore() of this simulation has ended with an error");
    impl().save(sink);
}

void Simulation::Impl::save(const ByteSink& sink) {
    StateHash checksum;
    BinaryWriter writer([&](std::span<const std::byte> bytes) {
        checksum.add(bytes);
        sink(bytes);
    });
    archive(writer);
    writer(checksum.value());
}

/// Reads a whole state, or throws.
void Simulation::Impl::read_state(const ByteSource& source) {
    StateHash checksum;
    BinaryReader reader([&](std::span<std::byte> bytes) {
        source(bytes);
        checksum.add(bytes);
    });
    archive(reader);
    expect(reader, checksum.value(), "the state is damaged: its checksum is wrong");
    require_sound_state();
    for (std::size_t i = 0; i < store.size(); ++i) note_speed(i);
}

// A particle that slept when the state was saved may not sleep in this run. Until now it has pressed on its support.
void Simulation::Impl::wake_all_sleepers() {
    store.set_may_sleep(true);
    add_weights_of_sleepers(1.0);
    store.set_may_sleep(false);
    for (std::size_t i = 0; i < store.size(); ++i) store.wake(i);
}

void Simulation::restore(const ByteSource& source) {
    if (!source) throw InputError("restore: found an empty function, expected one that gives the bytes");
    if (!impl().emitters.empty() && step_index() > 0) {
        throw InputError(
            fmt::format("restore: found a simulation with emitters that has made {} steps, expected one "
                        "before its first step",
                        step_index()));
    }
    impl().return_point.invalidate();
    impl().free_flights.drop_deferred();
    impl().inside_step = true;  // until all is there
    impl().read_state(source);
    impl().forget_queries();
    for (const double radius : impl().particles().radius) impl().prepare_radius(radius);
    impl().replay_emitters();
    impl().bind_modules();
    if (!impl().share.is_alone()) impl().keep_share();
    if (!impl().store.may_sleep()) impl().wake_all_sleepers();
    impl().modules.each([&](Module& module) { module.restart(time()); });
    impl().inside_step = false;
}

void Simulation::save_particles(const ByteSink& sink) const {
    if (!sink) throw InputError("save_particles: found an empty function, expected one that takes the bytes");
    if (!springs().empty())
        throw InputError("save_particles: found springs, expected none: a part does not know both ends");
    if (impl().inside_step) {
        throw RunError("save_particles: the last step or restore() of this simulation has ended with an error");
    }
    const std::vector<std::byte> bytes = Impl::bytes_of(impl().store);
    sink(bytes);
}

void Simulation::restore_particles(const ByteSource& source) {
    if (!source) throw InputError("restore_particles: found an empty function, expected one that gives the bytes");
    impl().return_point.invalidate();
    impl().inside_step = true;  // until all is there
    ParticleStore part = impl().store.empty_copy();
    BinaryReader reader(source);
    part.archive(reader);
    const std::size_t count = part.size();
    if (part.next_id() != impl().store.next_id()) throw InputError("the particles belong to another state");
    std::vector<std::uint8_t> keep(count);
    for (std::size_t i = 0; i < count; ++i) keep[i] = impl().share.has_place_for(part.particles().id[i]) ? 1 : 0;
    if (!std::is_sorted(part.particles().id.begin(), part.particles().id.end())) {
        throw InputError("the particles are damaged: they are not in the order of their ids");
    }
    part.compact(keep);
    impl().insert_particles({Impl::bytes_of(part)});
    impl().require_sound_state();
    impl().share.add_births(count);
    if (!impl().store.may_sleep()) impl().wake_all_sleepers();
    impl().inside_step = false;
}

}  // namespace ricochet
