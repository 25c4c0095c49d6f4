// Puts a run that ranks share together on the first rank.
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/core/merging_reader.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {
namespace {

SimulationStatistics together(const std::vector<SimulationStatistics>& of_ranks, double unsimulated_time) {
    SimulationStatistics all = of_ranks.front();
    for (std::size_t k = 1; k < of_ranks.size(); ++k) add_part(all, of_ranks[k]);
    all.unsimulated_time = unsimulated_time;
    return all;
}

template <class Archived>
std::vector<std::byte> archived(Archived& what) {
    std::vector<std::byte> bytes;
    BinaryWriter writer([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    what.archive(writer);
    return bytes;
}

/// Returns the sums over all ranks on the first one.
SurfaceTotals gather_totals(Ranks& ranks, SurfaceTotals& own) {
    SurfaceTotals all(own.size());
    for (const std::vector<std::byte>& part : ranks.gather(archived(own))) {
        SurfaceTotals of_rank(own.size());
        std::size_t at = 0;
        BinaryReader reader([&](std::span<std::byte> into) {
            std::copy_n(part.begin() + static_cast<std::ptrdiff_t>(at), into.size(), into.begin());
            at += into.size();
        });
        of_rank.archive(reader);
        all.add(of_rank);
    }
    return all;
}

}  // namespace

std::vector<std::byte> Simulation::Impl::bytes_of(ParticleStore& particles) { return archived(particles); }

void Simulation::Impl::keep_springs_together() {
    std::vector<std::uint64_t> ids;
    for (const Spring& spring : coupled.springs().springs()) ids.insert(ids.end(), {spring.first, spring.second});
    share.keep_together(std::move(ids));
    if (!share.is_first()) coupled.disable();
}

void Simulation::Impl::have_meshes_in_common() {
    std::vector<std::span<const std::byte>> pages;
    world.add_pages_to(pages);
    for (BodyId body = 0; bodies && body < bodies->size(); ++body) bodies->world(body).add_pages_to(pages);
    common_memory_bytes = share.ranks().have_in_common(pages);
}

void Simulation::Impl::keep_share() {
    std::vector<std::uint8_t> keep(store.size());
    for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = share.has_place_for(particles().id[i]) ? 1 : 0;
    share.begin(store.size());
    share.begin_sums(recorder.statistics().unsimulated_time, recorder.loads());
    compact(keep);
    if (share.is_first()) return;
    SimulationStatistics none;
    none.steps = recorder.statistics().steps;
    recorder.statistics() = none;
    recorder.totals() = SurfaceTotals(recorder.totals().size());
}

WholeRun Simulation::Impl::gather(Shown what) {
    Ranks& ranks = share.ranks();
    WholeRun whole;
    if (recorder.shows_contacts()) {
        whole.contacts = gather_list(ranks, recorder.contact_records());
        RunRecorder::put_in_order(*whole.contacts);
    }
    if (what == Shown::contacts) return whole;
    share.add_up(*colliders);
    const auto statistics = gather_list(ranks, std::vector{recorder.statistics()});
    const bool has_particles = what == Shown::particles || what == Shown::all;
    const bool has_totals = what == Shown::all || what == Shown::all_but_particles;
    const auto stores = has_particles ? ranks.gather(bytes_of(store)) : std::vector<std::vector<std::byte>>();
    if (has_totals) whole.totals = gather_totals(ranks, recorder.totals());
    if (!share.is_first()) return {};
    if (has_particles) {
        MergingReader reader(stores);
        whole.store = store.empty_copy();
        whole.store->archive(reader);
    }
    whole.statistics = together(statistics, share.unsimulated_time());
    whole.loads = share.loads();
    return whole;
}

void Simulation::Impl::exchange(WholeRun& whole) {
    if (whole.contacts) std::swap(recorder.contact_records(), *whole.contacts);
    if (whole.store) std::swap(store, *whole.store);
    if (whole.store && store.size() > 0) bind_modules();
    if (whole.statistics) std::swap(recorder.statistics(), *whole.statistics);
    if (whole.loads) std::swap(recorder.loads(), *whole.loads);
    if (whole.totals) std::swap(recorder.totals(), *whole.totals);
}

ParticleStore Simulation::Impl::no_particles() const {
    ParticleStore none = store.empty_copy();
    none.set_next_id(store.next_id());
    return none;
}

void Simulation::show_whole(Shown what, const std::function<void()>& show) {
    const bool is_alone = impl().share.is_alone();
    if (is_alone && what != Shown::all_but_particles) return show();
    WholeRun whole = is_alone ? WholeRun{} : impl().gather(what);
    if (!impl().share.is_first()) return;
    if (what == Shown::all_but_particles) whole.store = impl().no_particles();
    impl().exchange(whole);
    try {
        show();
    } catch (...) {
        impl().exchange(whole);
        throw;
    }
    impl().exchange(whole);
}

}  // namespace ricochet
