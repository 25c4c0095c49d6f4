#include "ricochet/simulation/state_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <type_traits>
#include <utility>

#include "ricochet/core/binary_archive.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/pair_materials.h"
#include "ricochet/response/settings_table.h"

namespace ricochet {
namespace {

/// First number of every saved state. Its last digits change with the layout.
constexpr std::uint64_t kStateFormat = 0x5249434f5354000fULL;

/// Archives the number of entries of a list, which must be the same when reading.
template <class Archive>
void expect_count(Archive& a, const auto& list, const char* complaint) {
    expect(a, static_cast<std::uint64_t>(list.size()), complaint);
}

/// Archives the statistics with their layout in memory, so that no counter can be forgotten. The padding after the only
/// 32-bit counter is set to zero.
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

/// Adds the laws of impacts to a fingerprint, if they are in use. Other settings keep their fingerprint.
template <class Struct>
void add_impact_law(StateHash& hash, const Struct& law) {
    if (law.tangential_restitution == 0.0 && !law.restitution_speed) return;
    add_settings(hash, law, kImpactLawTable<Struct>);
}

void add_contact_settings(StateHash& hash, const PairContactSettings& settings) {
    const PairMaterials all(settings);
    add_settings(hash, material_of_all(settings), kSphereContactTable<PairMaterial>);
    add_impact_law(hash, material_of_all(settings));
    add_numbers(hash, settings.method, settings.impact_budget);
    for (std::uint32_t a = 0; a < settings.materials.size(); ++a) {
        for (std::uint32_t b = 0; b <= a; ++b) {
            add_settings(hash, all.of(a, b), kSphereContactTable<PairMaterial>);
            add_impact_law(hash, all.of(a, b));
        }
    }
}

void add_materials(StateHash& hash, const std::vector<Material>& materials) {
    auto table = std::to_array(kMaterialTable);
    std::swap(table[1], table[2]);  // the order of saved states: friction, then the threshold
    for (const Material& material : materials) {
        add_settings(hash, material, table);
        add_impact_law(hash, material);
        if (material.tangential_factor < 1.0 || material.static_friction)
            add_settings(hash, material, kSurfaceLawTable);
        for (const ImpactTableRow& row : material.impact_table) add_settings(hash, row, kImpactTableRowTable);
        if (!material.motion.is_none()) add_settings(hash, material.motion, kSurfaceMotionTable);
    }
}

/// Hashes the settings on which results depend. The duration is not included, because results do not depend on it.
std::uint64_t settings_hash(const ModuleParts& parts, const ModuleList& modules) {
    const SimulationOptions& options = parts.options;
    StateHash hash;
    add_numbers(hash, options.integrator.kind);
    add_settings(hash, options.integrator.tolerance, kToleranceTable);
    hash.add(options.seed);
    add_numbers(hash, options.response, options.resting_speed, options.bounce_budget);
    add_settings(hash, options.rollback, kRollbackTable);
    add_settings(hash, options.project, kProjectTable);
    add_settings(hash, options.penalty, kPenaltyTable);
    add_numbers(hash, options.walls, options.flow != nullptr, options.frame_rate, options.max_depth,
                options.most_particles);
    if (options.particle_contacts) add_contact_settings(hash, *options.particle_contacts);
    add_materials(hash, parts.scene.materials());
    modules.each([&](const Module& module) { module.add_to_fingerprint(hash); });
    return hash.value();
}

template <class Archive>
void archive(Archive& a, const ModuleParts& parts, const ModuleList& modules) {
    RunRecorder& recorder = parts.recorder;
    ParticleStore& store = parts.population.store();
    expect(a, kStateFormat, "not a state that this version can read");
    expect(a, parts.scene.hash(), "the state belongs to other colliders");
    expect(a, settings_hash(parts, modules),
           "the state belongs to other options, materials, bodies, bounds or counters");
    expect_count(a, parts.emitters, "the state belongs to other emitters");
    expect_count(a, parts.hooks.coupled->springs().springs(), "the state belongs to other springs");
    expect_count(a, store.particles().attributes.columns(), "the state belongs to other attributes");
    expect_count(a, recorder.totals(), "the state belongs to another choice of totals");
    expect(a, parts.options.time_step, "the state belongs to another time step");
    archive_statistics(a, recorder.statistics());
    store.archive(a);
    modules.each([&](Module& module) { module.archive_particles(a); });
    recorder.totals().archive(a);
    for (ColliderTotals& load : recorder.loads()) a(load.hits), a(load.impulse), a(load.moment), a(load.work);
    modules.each([&](Module& module) { module.archive(a); });
}

/// Returns the reason why no run can produce the restored state of particle i. Returns null for a valid state.
const char* fault_of(const ModuleParts& parts, const ModuleList& modules, std::size_t i) {
    const Particles& p = parts.population.particles();
    const MovingColliders& moving = parts.scene.moving();
    for (const SurfaceId surface : p.support[i]) {
        if (surface == kNoSupport) continue;
        if (surface >= parts.scene.world().surface_count()) return "a particle on an unknown surface";
        const bool is_moving = moving.body_of(surface) != kWorldBody;
        if (is_moving && p.held[i] != 0) return "a particle that sleeps on a moving surface";
    }
    const bool moves = p.frozen[i] == 0;
    if (moves && !(is_in_range(p.position[i]) && is_in_range(p.velocity[i]) && is_in_range(p.spin[i]))) {
        return "a moving particle with a position, velocity or spin out of range";
    }
    const bool is_body =
        p.mass[i] > 0.0 && std::isfinite(p.mass[i]) && p.radius[i] >= 0.0 && p.radius[i] <= kLargestCoordinate;
    if (!is_body) return "a mass or radius out of range";
    const char* fault = nullptr;
    modules.each([&](const Module& module) { fault = fault != nullptr ? fault : module.fault_of(i); });
    if (fault != nullptr) return fault;
    const bool is_released = p.cascade_left[i] < 0.0 && p.cascade_left[i] != ContactState::kPlaced;
    if (is_released && moving.empty()) return "a particle released by a body, without bodies";
    return parts.population.store().is_sound(i) ? nullptr : "a particle with an impossible history";
}

}  // namespace

void save_state(const ModuleParts& parts, const ModuleList& modules, const ByteSink& sink) {
    StateHash checksum;
    BinaryWriter writer([&](std::span<const std::byte> bytes) {
        checksum.add(bytes);
        sink(bytes);
    });
    archive(writer, parts, modules);
    writer(checksum.value());
}

void read_state(const ModuleParts& parts, const ModuleList& modules, const ByteSource& source) {
    StateHash checksum;
    BinaryReader reader([&](std::span<std::byte> bytes) {
        source(bytes);
        checksum.add(bytes);
    });
    archive(reader, parts, modules);
    expect(reader, checksum.value(), "the state is damaged: its checksum is wrong");
    require_sound_state(parts, modules);
}

void require_sound_state(const ModuleParts& parts, const ModuleList& modules) {
    const Particles& p = parts.population.particles();
    const auto require_none = [](const char* fault) {
        if (fault != nullptr) throw InputError(fmt::format("the state is damaged: it has {}", fault));
    };
    const auto require = [&](bool sound, const char* fault) { require_none(sound ? nullptr : fault); };
    require(p.size() < kNoSupport, "too many particles");
    require(std::ranges::adjacent_find(p.id, std::greater_equal<>()) == p.id.end(),
            "particles out of the order of their ids");
    require(p.id.empty() || p.id.back() < parts.population.store().next_id(), "an id above the last one of the run");
    for (std::size_t i = 0; i < p.size(); ++i) require_none(fault_of(parts, modules, i));
    const double now = parts.clock.time_at(parts.recorder.statistics().steps);
    modules.each([&](const Module& module) { require_none(module.fault(now)); });
    for (const Origin& origin : p.origin) {
        const bool is_known = origin.emitter == kNoEmitter || origin.emitter < parts.emitters.size();
        require(is_known, "a particle of an unknown emitter");
    }
}

}  // namespace ricochet
