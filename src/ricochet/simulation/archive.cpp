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
constexpr std::uint64_t kStateFormat = 0x5249434f53540002ULL;

/// Slices of time in which emitters go through what they have emitted, so that no long list of births is held.
constexpr std::uint64_t kReplaySlices = 1000;

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
    expect(a, static_cast<std::uint64_t>(particles().attributes.columns().size()),
           "the state belongs to other attributes");
    expect(a, static_cast<std::uint64_t>(recorder.totals().size()), "the state belongs to another choice of totals");
    expect(a, options.time_step, "the state belongs to another time step");
    archive_statistics(a, recorder.statistics());
    store.archive(a);
    recorder.totals().archive(a);
    coupled.archive(a);
}

// What emitters have emitted does not depend on how time was cut, so they are simply run again.
void Simulation::Impl::replay_emitters() {
    const std::uint64_t steps = recorder.statistics().steps;
    const double now = clock.time_at(steps);
    const std::uint64_t slices = std::min(steps, kReplaySlices);
    for (Emitter& emitter : emitters) {
        double from = 0.0;
        for (std::uint64_t k = 1; k <= slices; ++k) {
            const double to = k == slices ? now : now * static_cast<double>(k) / static_cast<double>(slices);
            (void)emitter.births(from, to);
            from = to;
        }
    }
}

// What is known of queries serves speed only.
void Simulation::Impl::forget_queries() {
    schedule.reset(store.size());
    for (std::size_t i = 0; i < store.size(); ++i) {
        if (store.is_fixed(i) || store.is_asleep(i)) schedule.leave_alone(i);
    }
}

void Simulation::save(const ByteSink& sink) const {
    BinaryWriter writer(sink);
    impl_->archive(writer);
}

void Simulation::restore(const ByteSource& source) {
    BinaryReader reader(source);
    impl_->free_flights.drop_deferred();
    impl_->inside_step = true;  // until all is there
    impl_->archive(reader);
    impl_->forget_queries();
    for (const double radius : impl_->particles().radius) impl_->world.prepare_radius(radius);
    impl_->replay_emitters();
    if (impl_->coupled.is_active()) impl_->coupled.bind(impl_->particles());
    if (impl_->check) impl_->check->restart(impl_->particles());
    impl_->inside_step = false;
}

}  // namespace ricochet
