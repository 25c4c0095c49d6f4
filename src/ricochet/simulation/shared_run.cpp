// Ranks that share a run: division and balancing of the particles, and gathering of the whole run on the first rank.
#include <algorithm>
#include <optional>
#include <utility>

#include "ricochet/core/merging_reader.h"
#include "ricochet/simulation/impl.h"

namespace ricochet {

/// Parts of a whole run. Only requested parts are present.
struct WholeRun {
    std::optional<std::vector<ContactRecord>> contacts;
    std::optional<ParticleStore> store;
    std::optional<SimulationStatistics> statistics;
    std::optional<std::vector<ColliderTotals>> loads;
    std::optional<SurfaceTotals> totals;

    /// Swaps these parts with the parts of this rank.
    void exchange(RunRecorder& recorder, Population& population);
};

namespace {

SimulationStatistics together(const std::vector<SimulationStatistics>& of_ranks, double unsimulated_time) {
    SimulationStatistics all = of_ranks.front();
    for (std::size_t k = 1; k < of_ranks.size(); ++k) add_part(all, of_ranks[k]);
    all.unsimulated_time = unsimulated_time;
    return all;
}

/// Returns the sums over all ranks on the first rank.
SurfaceTotals gather_totals(Ranks& ranks, SurfaceTotals& own) {
    SurfaceTotals all(own.size());
    for (const std::vector<std::byte>& part : ranks.gather(archived_bytes(own))) {
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

void SharedRun::take_share() {
    RankShare& share = parts_.share;
    RunRecorder& recorder = parts_.recorder;
    std::vector<std::uint8_t> keep;
    for (const std::uint64_t id : parts_.population.particles().id) keep.push_back(share.has_place_for(id) ? 1 : 0);
    share.begin(keep.size());
    share.begin_sums(recorder.statistics().unsimulated_time, recorder.loads());
    parts_.population.compact(keep);
    if (share.is_first()) return;
    SimulationStatistics none;
    none.steps = recorder.statistics().steps;
    recorder.statistics() = none;
    recorder.totals() = SurfaceTotals(recorder.totals().size());
}

void SharedRun::begin_step(const TimeSpan& /*step*/) {
    std::optional<RankTransfers> transfers = balancer_.check(parts_.share.ranks(), parts_.population.size());
    if (!transfers) return;
    FreeFlights& flights = parts_.population.flights();
    const bool defers = flights.is_deferring();
    flights.end_deferring();
    give_away(TransferChoice(std::move(*transfers)));
    if (defers) flights.begin_deferring();
}

void SharedRun::give_away(TransferChoice choice) {
    Population& population = parts_.population;
    const std::vector<std::uint64_t>& ids = population.particles().id;
    std::vector<std::uint32_t> goes_to(population.size());
    std::vector<std::uint8_t> keep(goes_to.size());
    for (std::size_t i = 0; i < goes_to.size(); ++i) {
        const bool flies = population.schedule().is_in_free_flight(i);
        const auto cost = population.schedule().is_left_alone(i) ? TransferChoice::Cost::idle
                          : flies                                ? TransferChoice::Cost::flying
                                                                 : TransferChoice::Cost::queried;
        goes_to[i] = parts_.share.stays(ids[i]) ? TransferChoice::kStays : choice.next(cost);
        keep[i] = goes_to[i] == TransferChoice::kStays ? 1 : 0;
    }
    std::vector<std::vector<std::byte>> gifts;
    for (std::uint32_t rank = 0; rank < parts_.share.ranks().size(); ++rank) gifts.push_back(bytes_for(rank, goes_to));
    population.compact(keep);
    balancer_.add_moved(keep.size() - population.size());
    std::vector<std::vector<std::byte>> parts = parts_.share.ranks().exchange(gifts);
    std::erase_if(parts, [](const auto& part) { return part.empty(); });
    if (!parts.empty()) population.merge(std::move(parts));
}

/// Returns the particles that move to a rank, as bytes. Returns no bytes if no particle moves to the rank.
std::vector<std::byte> SharedRun::bytes_for(std::uint32_t rank, const std::vector<std::uint32_t>& goes_to) const {
    if (std::ranges::find(goes_to, rank) == goes_to.end()) return {};
    std::vector<std::uint8_t> given;
    for (const std::uint32_t to : goes_to) given.push_back(to == rank ? 1 : 0);
    ParticleStore part = parts_.population.store();
    part.compact(given);
    return archived_bytes(part);
}

void SharedRun::before_substep(const ParticleRange& generation, const TimeSpan& /*substep*/) {
    work_.queried = parts_.population.schedule().count_active(generation.begin, generation.end);
}

void SharedRun::record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                       std::vector<ColliderLoad>& /*loads*/) {
    parts_.share.note(blocks, parts_.population.particles().id);
    work_.idle = parts_.population.schedule().count_left_alone(generation.begin, generation.end);
    work_.flying = generation.size() - std::min(generation.size(), work_.queried + work_.idle);
    work_.contacts = 0;
    for (const BlockRecord& block : blocks) work_.contacts += block.counts.contacts;
    balancer_.note(work_);
}

void SharedRun::end_step(SimulationStatistics& /*statistics*/) {
    parts_.share.end_step(parts_.population.size(), parts_.scene.list());
}

WholeRun SharedRun::gather(Shown what) {
    Ranks& ranks = parts_.share.ranks();
    RunRecorder& recorder = parts_.recorder;
    ParticleStore& store = parts_.population.store();
    WholeRun whole;
    if (recorder.shows_contacts()) {
        whole.contacts = gather_list(ranks, recorder.contact_records());
        RunRecorder::put_in_order(*whole.contacts);
    }
    if (what == Shown::contacts) return whole;
    parts_.share.add_up(parts_.scene.list());
    const auto statistics = gather_list(ranks, std::vector{recorder.statistics()});
    const bool has_particles = what == Shown::particles || what == Shown::all;
    const bool has_totals = what == Shown::all || what == Shown::all_but_particles;
    const auto stores = has_particles ? ranks.gather(archived_bytes(store)) : std::vector<std::vector<std::byte>>();
    if (has_totals) whole.totals = gather_totals(ranks, recorder.totals());
    if (!parts_.share.is_first()) return {};
    if (has_particles) {
        MergingReader reader(stores);
        whole.store = store.empty_copy();
        whole.store->archive(reader);
    }
    whole.statistics = together(statistics, parts_.share.unsimulated_time());
    whole.loads = parts_.share.loads();
    return whole;
}

void WholeRun::exchange(RunRecorder& recorder, Population& population) {
    if (contacts) std::swap(recorder.contact_records(), *contacts);
    if (store) std::swap(population.store(), *store);
    if (store && population.size() > 0) population.bind();
    if (statistics) std::swap(recorder.statistics(), *statistics);
    if (loads) std::swap(recorder.loads(), *loads);
    if (totals) std::swap(recorder.totals(), *totals);
}

void Simulation::show_whole(Shown what, const std::function<void()>& show) {
    SharedRun* const shared = impl().modules.find<SharedRun>();
    if (shared == nullptr && what != Shown::all_but_particles) return show();
    WholeRun whole = shared != nullptr ? shared->gather(what) : WholeRun{};
    if (!impl().share.is_first()) return;
    RunRecorder& recorder = impl().recorder;
    Population& population = impl().population;
    if (what == Shown::all_but_particles) {
        whole.store = population.store().empty_copy();
        whole.store->set_next_id(population.store().next_id());
    }
    whole.exchange(recorder, population);
    try {
        show();
    } catch (...) {
        whole.exchange(recorder, population);
        throw;
    }
    whole.exchange(recorder, population);
}

}  // namespace ricochet
