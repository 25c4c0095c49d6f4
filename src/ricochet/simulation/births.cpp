#include "ricochet/simulation/births.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation/memory_estimate.h"

namespace ricochet {
namespace {

/// Births that a thread makes at a time, in some hundred microseconds.
constexpr std::size_t kBirthBlock = 64;
/// Births that are taken off the schedule at a time. More need memory for the refused ones, fewer need more
/// communication.
constexpr std::uint64_t kMostInWave = std::uint64_t{1} << 20U;
/// Most births in a wave that every rank makes for itself if they may be refused. For so few this is faster than
/// communicating the refusals.
constexpr std::size_t kFewBirths = 16;

bool makes_spheres(const Emitter& emitter) {
    const MeanSpread& radius = emitter.description().radius;
    return radius.mean + radius.spread > 0.0;
}

}  // namespace

StepBirths::StepBirths(std::span<Emitter> emitters, const BirthLimits& limits, const BirthTests& tests,
                       const RankShare& share)
    : emitters_(emitters), limits_(limits), tests_(tests), share_(share), made_of_(emitters.size(), 0) {}

bool StepBirths::make() {
    std::uint64_t born_before = 0;
    for (const Emitter& emitter : emitters_) born_before += emitter.born();
    for (Wave wave = next_wave(); !wave.empty(); wave = next_wave()) {
        make(wave);
        if (std::min(limits_.room, made_here_) > limits_.fitting) return false;
        if (all_.empty()) {
            all_ = std::move(wave);
        } else {
            all_.insert(all_.end(), wave.begin(), wave.end());
        }
    }
    std::uint64_t born = 0;
    for (Emitter& emitter : emitters_) {
        emitter.skip_due(limits_.end);
        born += emitter.born();
    }
    give_ids();
    refused_by_population_ = born - born_before - refused_by_overlap_ - count_;
    return true;
}

// Takes at most as many births of an emitter as there is room for, so that few are made in vain. Without other ranks a
// wave ends with the first birth that does not fit into memory, so that make() can report it early.
StepBirths::Wave StepBirths::next_wave() {
    const bool may_end = share_.is_alone() && limits_.fitting < limits_.room;
    const std::uint64_t most = may_end ? std::min(kMostInWave, limits_.fitting + 1 - made_here_) : kMostInWave;
    Wave wave;
    for (std::uint32_t k = 0; k < emitters_.size() && wave.size() < most; ++k) {
        const std::uint64_t wanted = std::min(most - wave.size(), room_below(limits_.room, made_of_[k]));
        const std::vector<DueBirth> due = emitters_[k].take_due(limits_.end, wanted);
        grow_capacity_by(wave, due.size());
        for (const DueBirth& birth : due) wave.push_back({birth, k});
        if (tests_.among && !wave.empty()) break;
    }
    const auto by_time = [](const Entry& a, const Entry& b) { return a.due.time < b.due.time; };
    if (!std::is_sorted(wave.begin(), wave.end(), by_time)) std::stable_sort(wave.begin(), wave.end(), by_time);
    return wave;
}

bool StepBirths::may_be_refused(const Wave& wave) const {
    if (!tests_.alone && !tests_.among) return false;
    return std::any_of(wave.begin(), wave.end(),
                       [this](const Entry& entry) { return makes_spheres(emitters_[entry.emitter]); });
}

void StepBirths::make(Wave& wave) {
    const bool may_be_refused = this->may_be_refused(wave);
    const bool is_told = !share_.is_alone() && may_be_refused && wave.size() > kFewBirths;
    const bool all_make_all = may_be_refused && !is_told;
    std::vector<std::size_t> mine;
    for (std::size_t k = 0; k < wave.size(); ++k) {
        if (all_make_all || share_.has_place_for(limits_.first_id + taken_ + k)) mine.push_back(k);
    }
    std::vector<std::optional<Particle>>& made = made_.emplace_back(mine.size());
    make_by_threads(wave, mine, made);
    if (tests_.among) look_among(wave, mine, made);
    std::vector<std::uint64_t> refused;
    for (std::size_t j = 0; j < mine.size(); ++j) {
        if (!made[j]) refused.push_back(mine[j]);
    }
    keep_local(wave, mine, made);
    if (is_told) refused = gather_list_to_all(share_.ranks(), refused);
    for (const std::uint64_t k : refused) wave[k].is_refused = true;
    refused_by_overlap_ += refused.size();
    taken_ += wave.size();
    std::erase_if(wave, [](const Entry& entry) { return entry.is_refused; });
    for (const Entry& entry : wave) ++made_of_[entry.emitter];
}

// Keeps the accepted births of this rank until the step ends. If they are fewer than half of the births made, frees the
// memory of the others.
void StepBirths::keep_local(Wave& wave, std::span<const std::size_t> mine, std::vector<std::optional<Particle>>& made) {
    std::vector<std::size_t> here;
    for (std::size_t j = 0; j < mine.size(); ++j) {
        if (!made[j] || !share_.has_place_for(limits_.first_id + taken_ + mine[j])) continue;
        if (here.size() < j) made[here.size()] = std::move(made[j]);
        here.push_back(mine[j]);
    }
    made.resize(here.size());
    if (here.size() < mine.size() / 2) made.shrink_to_fit();
    for (std::size_t j = 0; j < here.size(); ++j) wave[here[j]].made = &*made[j];
    made_here_ += here.size();
}

void StepBirths::make_by_threads(const Wave& wave, std::span<const std::size_t> mine,
                                 std::vector<std::optional<Particle>>& made) const {
    parallel_for_blocks(mine.size(), kBirthBlock, [&](std::size_t /*block*/, std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            const Entry& entry = wave[mine[j]];
            made[j] = emitters_[entry.emitter].make(entry.due, tests_.alone);
        }
    });
}

// Tests births against those before them. A refused one is made again from its first draw. It repeats the refused
// position and continues from there.
void StepBirths::look_among(const Wave& wave, std::span<const std::size_t> mine,
                            std::vector<std::optional<Particle>>& made) const {
    const BirthTest both = [this](const Particle& particle) {
        return (!tests_.alone || tests_.alone(particle)) && tests_.among(particle);
    };
    for (std::size_t j = 0; j < mine.size(); ++j) {
        const Entry& entry = wave[mine[j]];
        if (made[j] && !tests_.among(*made[j])) made[j] = emitters_[entry.emitter].make(entry.due, both);
    }
}

void StepBirths::give_ids() {
    const auto by_order = [](const Entry& a, const Entry& b) {
        return std::tuple(a.due.time, a.emitter, a.due.number) < std::tuple(b.due.time, b.emitter, b.due.number);
    };
    if (made_.size() > 1) std::sort(all_.begin(), all_.end(), by_order);
    count_ = std::min<std::uint64_t>(all_.size(), limits_.room);
    for (std::uint64_t k = 0; k < count_; ++k) {
        if (all_[k].made == nullptr) continue;
        all_[k].made->id = limits_.first_id + k;
        here_.push_back(all_[k].made);
    }
    all_ = Wave();  // frees memory for the particles
}

}  // namespace ricochet
