#include "lab/bench/measurement.h"

#include <list>
#include <memory>

#include "lab/bench/case_run.h"
#include "lab/bench/timing.h"
#include "ricochet/core/parallel.h"

namespace ricochet::bench {
namespace {

/// Measurement of one group of cases.
class Measurer {
public:
    Measurer(std::span<const Case> group, const MeasurementPlan& plan, const Hook& hook)
        : group_(group), plan_(plan), hook_(hook) {}

    std::optional<std::vector<Row>> run() {
        if (!prepare()) return std::nullopt;
        times_.assign(group_.size(), std::vector<CaseTimes>(plan_.threads.size()));
        for (std::uint32_t repeat = 1; repeat <= plan_.repeats; ++repeat) {
            progress_.repeat = repeat;
            if (!repeat_all()) return std::nullopt;
        }
        return rows();
    }

private:
    bool announce(std::string_view doing, std::uint64_t step) {
        progress_.doing = doing;
        progress_.step = step;
        return !hook_ || hook_(progress_);
    }

    bool prepare();
    bool repeat_all();
    [[nodiscard]] std::vector<Row> rows() const;
    [[nodiscard]] std::optional<std::size_t> single_thread() const;

    std::span<const Case> group_;
    const MeasurementPlan& plan_;
    const Hook& hook_;
    Progress progress_;
    std::list<CaseRun> runs_;
    std::vector<std::vector<CaseTimes>> times_;  ///< indexed by case and number of threads
    /// Numbers of threads of the plan, with 0 replaced by the number of all threads.
    std::vector<int> threads_;
};

bool Measurer::prepare() {
    if (!announce("mesh", 0)) return false;
    const std::shared_ptr<const TriangleMesh> mesh = make_mesh(group_.front());
    for (const int threads : plan_.threads) {
        const ThreadLimit limit(threads);
        threads_.push_back(thread_count());
    }
    for (const Case& c : group_) {
        progress_.name = c.name;
        if (!announce("particles", 0)) return false;
        runs_.emplace_back(c, mesh);
        if (!runs_.back().prepare([&](std::string_view doing, std::uint64_t step) { return announce(doing, step); })) {
            return false;
        }
    }
    return true;
}

bool Measurer::repeat_all() {
    for (std::size_t k = 0; k < plan_.threads.size(); ++k) {
        const ThreadLimit limit(plan_.threads[k]);
        progress_.threads = threads_[k];
        std::size_t i = 0;
        for (CaseRun& run : runs_) {
            progress_.name = run.description().name;
            const bool is_done = run.time(
                times_[i++][k], [&](std::string_view doing, std::uint64_t step) { return announce(doing, step); });
            if (!is_done) return false;
        }
    }
    return true;
}

/// Returns the rate count / seconds, divided by the rate reference_count / reference_seconds. It is the median over the
/// repeats.
double ratio_of(std::uint64_t count, const std::vector<double>& seconds, std::uint64_t reference_count,
                const std::vector<double>& reference_seconds) {
    return median_ratio(reference_seconds, seconds) * static_cast<double>(count) / static_cast<double>(reference_count);
}

Row row_of(const CaseRun& run, const CaseTimes& times) {
    const auto rate = [](std::uint64_t count, const std::vector<double>& seconds) {
        return static_cast<double>(count) / median(seconds);
    };
    const CaseResults& results = run.results();
    const Reference& reference = run.reference();
    const std::uint64_t rays = reference.rays();
    Row row;
    row.suite = run.description().suite;
    row.name = run.description().name;
    row.response = name_of(run.description().response);
    row.particles = run.particles();
    row.triangles = run.triangles();
    row.steps = run.description().steps;
    row.particle_steps = results.particle_steps;
    row.contacts = results.contacts;
    row.seconds = median(times.simulation);
    row.particle_steps_per_second = rate(results.particle_steps, times.simulation);
    row.contacts_per_second = rate(results.contacts, times.simulation);
    row.raw_rays_per_second = rate(rays, times.raw);
    row.ratio_raw = ratio_of(results.particle_steps, times.simulation, rays, times.raw);
    row.raw_sorted_rays_per_second = rate(rays, times.sorted);
    row.ratio_raw_sorted = ratio_of(results.particle_steps, times.simulation, rays, times.sorted);
    row.native_bounces_per_second = rate(reference.bounces(), times.bounces);
    if (reference.bounces() > 0) {
        row.ratio_native_bounces = ratio_of(results.contacts, times.simulation, reference.bounces(), times.bounces);
    }
    row.leaks = reference.leaks();
    if (!times.naive.empty()) row.ratio_naive = median_ratio(times.naive, times.simulation);
    row.naive_leaks = run.naive_leaks();
    if (run.description().spheres_meet) {
        const double simulated = static_cast<double>(row.steps) * run.description().time_step;
        row.seconds_a_simulated_second = row.seconds / simulated;
        row.largest_overlap = results.largest_overlap;
        if (results.pair_impacts > 0) row.seconds_an_impact = row.seconds / static_cast<double>(results.pair_impacts);
    }
    row.state_hash = results.state_hash;
    row.bytes_per_particle = run.memory().bytes_per_particle;
    row.bytes_per_triangle = run.memory().bytes_per_triangle;
    return row;
}

/// Returns the index of the measurement with one thread, or std::nullopt if there is none.
std::optional<std::size_t> Measurer::single_thread() const {
    for (std::size_t k = 0; k < threads_.size(); ++k) {
        if (threads_[k] == 1) return k;
    }
    return std::nullopt;
}

std::vector<Row> Measurer::rows() const {
    std::vector<Row> rows;
    const CaseRun& base = runs_.front();
    const std::optional<std::size_t> single = single_thread();
    std::size_t i = 0;
    for (const CaseRun& run : runs_) {
        const std::vector<CaseTimes>& times = times_[i++];
        for (std::size_t k = 0; k < times.size(); ++k) {
            Row row = row_of(run, times[k]);
            row.threads = threads_[k];
            if (single) {
                row.speedup = median_ratio(times[*single].simulation, times[k].simulation);
                row.speedup_raw = median_ratio(times[*single].raw, times[k].raw);
            }
            // Time of a particle-step of the case, relative to the base case.
            const double cost = ratio_of(base.results().particle_steps, times_.front()[k].simulation,
                                         run.results().particle_steps, times[k].simulation);
            if (run.description().against == Against::points) row.ratio_points = cost;
            if (run.description().against == Against::exact) row.ratio_exact = cost;
            if (run.description().against == Against::at_rest) row.ratio_rest = cost;
            if (run.description().against == Against::apart) row.ratio_apart = cost;
            rows.push_back(row);
        }
    }
    return rows;
}

}  // namespace

std::optional<std::vector<Row>> measure_group(std::span<const Case> group, const MeasurementPlan& plan,
                                              const Hook& hook) {
    return Measurer(group, plan, hook).run();
}

std::optional<std::vector<Row>> measure_case(const Case& c, const MeasurementPlan& plan, const Hook& hook) {
    return measure_group({&c, 1}, plan, hook);
}

}  // namespace ricochet::bench
