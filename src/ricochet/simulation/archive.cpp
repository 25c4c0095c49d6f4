// A running simulation as bytes and back.
#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "ricochet/core/binary_archive.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

/// Begins every saved state; its last digits change with the layout.
constexpr std::uint64_t kStateFormat = 0x5249434f53540001ULL;

/// Slices of time in which emitters go through what they have emitted, so that no long list of births is held.
constexpr std::uint64_t kReplaySlices = 1000;

template <class Archive>
void archive_origins(Archive& a, std::vector<Origin>& origins) {
    auto count = static_cast<std::uint64_t>(origins.size());
    a(count);
    if constexpr (Archive::kReads) origins.resize(count);
    for (Origin& origin : origins) {
        a(origin.emitter);
        a(origin.generation);
        a(origin.lineage);
        a(origin.birth_impacts);
        a(origin.impact_children);
    }
}

template <class Archive>
void archive_particles(Archive& a, Particles& particles) {
    a(particles.id);
    a(particles.position);
    a(particles.velocity);
    a(particles.spin);
    a(particles.mass);
    a(particles.radius);
    a(particles.birth_time);
    a(particles.lifetime);
    a(particles.unsimulated_time);
    a(particles.contacts);
    a(particles.frozen);
    a(particles.resting);
    a(particles.held);
    a(particles.absorbed);
    a(particles.pinned);
    a(particles.draws);
    a(particles.support);
    a(particles.cascade_left);
    a(particles.accounted_until);
    particles.attributes.archive(a);
    archive_origins(a, particles.origin);
}

template <class Archive>
void archive_sides(Archive& a, std::vector<SideMemory>& sides) {
    auto count = static_cast<std::uint64_t>(sides.size());
    a(count);
    if constexpr (Archive::kReads) sides.resize(count);
    for (SideMemory& memory : sides) {
        a(memory.side);
        a(memory.penetrating);
        a(memory.touching);
        a(memory.depth);
    }
}

template <class Archive>
void archive_sum(Archive& a, FixedPointSum& sum) {
    auto words = sum.words();
    a(words);
    if constexpr (Archive::kReads) sum.set_words(words);
}

template <class Archive>
void archive_totals(Archive& a, std::vector<SurfaceTotals>& totals) {
    for (SurfaceTotals& total : totals) {
        std::uint64_t hits = total.hits.load(std::memory_order_relaxed);
        a(hits);
        if constexpr (Archive::kReads) total.hits.store(hits, std::memory_order_relaxed);
        archive_sum(a, total.x);
        archive_sum(a, total.y);
        archive_sum(a, total.z);
    }
}

/// As it lies in memory, so that no counter can be forgotten; the gap behind its one short counter is made zero, since
/// what it holds is nobody's.
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

/// Reading only: what is read must be what is expected.
template <class Archive, class T>
void expect(Archive& a, const T& expected, const char* complaint) {
    T value = expected;
    a(value);
    if (value != expected) throw InputError(complaint);
}

}  // namespace

// Colliders in world coordinates; a changed mesh file is a changed setup.
std::uint64_t Simulation::Impl::collider_hash() const {
    StateHash hash;
    for (const Vec3& vertex : world.vertices()) hash.add(vertex);
    for (const Triangle& triangle : world.triangles()) {
        for (const std::uint32_t corner : triangle) hash.add(static_cast<std::uint64_t>(corner));
    }
    hash.add(static_cast<std::uint64_t>(world.surface_count()));
    return hash.value();
}

template <class Archive>
void Simulation::Impl::archive(Archive& a) {
    expect(a, kStateFormat, "not a state that this version can read");
    expect(a, collider_hash(), "the state belongs to other colliders");
    expect(a, static_cast<std::uint64_t>(emitters.size()), "the state belongs to other emitters");
    expect(a, static_cast<std::uint64_t>(coupled.springs().springs().size()), "the state belongs to other springs");
    expect(a, static_cast<std::uint64_t>(particles.attributes.columns().size()),
           "the state belongs to other attributes");
    expect(a, static_cast<std::uint64_t>(totals.size()), "the state belongs to another choice of totals");
    expect(a, options.time_step, "the state belongs to another time step");
    archive_statistics(a, statistics);
    a(next_id);
    archive_particles(a, particles);
    archive_sides(a, sides);
    archive_totals(a, totals);
    coupled.archive(a);
}

// What emitters have emitted does not depend on how time was cut, so they are simply run again.
void Simulation::Impl::replay_emitters() {
    const double now = time_at(statistics.steps);
    const std::uint64_t slices = std::min(statistics.steps, kReplaySlices);
    for (Emitter& emitter : emitters) {
        double from = 0.0;
        for (std::uint64_t k = 1; k <= slices; ++k) {
            const double to = k == slices ? now : now * static_cast<double>(k) / static_cast<double>(slices);
            (void)emitter.births(from, to);
            from = to;
        }
    }
}

// What is known of free ways serves speed only.
void Simulation::Impl::forget_queries() {
    next_query_step.resize(particles.size());
    candidates.assign(particles.size(), ContactCandidates{});
    for (std::size_t i = 0; i < particles.size(); ++i)
        next_query_step[i] = stands_still(i) || is_asleep(i) ? kStill : 0;
}

void Simulation::save(const ByteSink& sink) const {
    BinaryWriter writer(sink);
    impl_->archive(writer);
}

void Simulation::restore(const ByteSource& source) {
    BinaryReader reader(source);
    impl_->deferred.reset();
    impl_->inside_step = true;  // until all is there
    impl_->archive(reader);
    impl_->forget_queries();
    for (const double radius : impl_->particles.radius) impl_->world.prepare_radius(radius);
    impl_->replay_emitters();
    if (impl_->coupled.is_active()) impl_->coupled.bind(impl_->particles);
    if (impl_->check) {
        impl_->check = std::make_unique<RunCheck>(impl_->world);
        impl_->check->watch_spawned(impl_->particles);
    }
    impl_->inside_step = false;
}

}  // namespace ricochet
