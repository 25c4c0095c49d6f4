#include "bench/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include "bench/case_setup.h"
#include "bench/insides.h"
#include "bench/memory_use.h"
#include "bench/reference.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"

namespace ricochet::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_of(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

template <class Work>
double time_of(const Work& work) {
    const Clock::time_point start = Clock::now();
    work();
    return seconds_of(Clock::now() - start);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Times of one number of threads, s, one entry a repeat.
struct Times {
    std::vector<double> simulation;
    std::vector<double> raw;
    std::vector<double> sorted;
    std::vector<double> bounces;
};

/// What the measured steps do, found out once before anything is timed.
struct Course {
    std::vector<std::byte> start;  ///< saved state after the warm-up
    std::uint64_t particle_steps = 0;
    std::uint64_t contacts = 0;
    std::uint64_t state_hash = 0;
};

/// Measures one case.
class Measurer {
public:
    Measurer(const Case& c, const MeasurementPlan& plan, const Hook& hook)
        : case_(c), plan_(plan), hook_(hook), mesh_(make_mesh(c)), particles_(make_particles(c, *mesh_)) {}

    std::optional<std::vector<Row>> run() {
        if (!go_on("memory")) return std::nullopt;
        memory_ = measure_memory(case_, mesh_, particles_);
        if (!scout()) return std::nullopt;
        std::vector<Row> rows;
        for (const int threads : plan_.threads) {
            const ThreadLimit limit(threads);
            progress_.threads = thread_count();
            Times times;
            for (std::uint32_t repeat = 1; repeat <= plan_.repeats; ++repeat) {
                progress_.repeat = repeat;
                if (!time_all(times)) return std::nullopt;
            }
            rows.push_back(row_of(times));
        }
        return rows;
    }

private:
    bool go_on(std::string_view doing) {
        progress_.doing = doing;
        return !hook_ || hook_(progress_);
    }

    [[nodiscard]] Simulation make_simulation() const {
        SimulationSetup setup = make_setup(case_, mesh_);
        setup.particles = particles_;
        return Simulation(std::move(setup));
    }

    bool scout();
    bool time_all(Times& times);
    bool time_simulation(Times& times);
    [[nodiscard]] Row row_of(const Times& times) const;

    const Case& case_;
    const MeasurementPlan& plan_;
    const Hook& hook_;
    Progress progress_;
    std::shared_ptr<const TriangleMesh> mesh_;
    std::vector<Particle> particles_;
    MemoryUse memory_;
    Course course_;
    std::optional<Reference> reference_;
};

std::vector<Flight> flights_of(const Particles& particles) {
    std::vector<Flight> flights;
    flights.reserve(particles.size());
    for (const std::uint32_t i : particles.order_by_id()) {
        flights.push_back({particles.position[i], particles.velocity[i]});
    }
    return flights;
}

/// True before the steps whose stretches the references get: evenly spaced, kMostSnapshots at most.
bool is_snapshot(std::uint64_t step, std::uint64_t steps) {
    const std::uint64_t snapshots = std::min(steps, kMostSnapshots);
    return step == 0 || step * snapshots / steps != (step - 1) * snapshots / steps;
}

bool Measurer::scout() {
    Simulation simulation = make_simulation();
    for (std::uint64_t step = 0; step < case_.warm_up; ++step) {
        if (!go_on("warm-up")) return false;
        simulation.step();
    }
    simulation.save([&](std::span<const std::byte> bytes) {
        course_.start.insert(course_.start.end(), bytes.begin(), bytes.end());
    });
    const SimulationStatistics before = simulation.statistics();
    std::vector<std::vector<Flight>> states;
    for (std::uint64_t step = 0; step < case_.steps; ++step) {
        if (!go_on("first run")) return false;
        if (is_snapshot(step, case_.steps)) states.push_back(flights_of(simulation.particles()));
        simulation.step();
    }
    course_.particle_steps = simulation.statistics().particle_steps - before.particle_steps;
    course_.contacts = simulation.statistics().contacts - before.contacts;
    course_.state_hash = simulation.state_hash();
    if (!go_on("reference")) return false;
    reference_.emplace(*mesh_, states, NativeRays::BounceRules{case_.time_step, case_.restitution});
    if (const std::optional<Vec3> heart = heart_of(case_.ground)) reference_->count_leaks(*mesh_, *heart);
    return true;
}

bool Measurer::time_simulation(Times& times) {
    Simulation simulation = make_simulation();
    std::size_t place = 0;
    simulation.restore([&](std::span<std::byte> bytes) {
        if (bytes.size() > course_.start.size() - place) throw RunError("the benchmark's saved state is too short");
        std::memcpy(bytes.data(), course_.start.data() + place, bytes.size());
        place += bytes.size();
    });
    double seconds = 0.0;
    for (std::uint64_t step = 0; step < case_.steps; ++step) {
        if (!go_on("simulation")) return false;
        seconds += time_of([&] { simulation.step(); });
    }
    if (simulation.state_hash() != course_.state_hash) {
        throw RunError(
            fmt::format("{} of suite {}: a repeat with {} threads has ended in another state than the first run",
                        case_.name, case_.suite, thread_count()));
    }
    times.simulation.push_back(seconds);
    return true;
}

bool Measurer::time_all(Times& times) {
    if (!time_simulation(times)) return false;
    if (!go_on("raw rays")) return false;
    times.raw.push_back(time_of([&] { reference_->trace(); }));
    if (!go_on("raw rays in spatial order")) return false;
    times.sorted.push_back(time_of([&] { reference_->trace_sorted(); }));
    if (!go_on("native bounces")) return false;
    times.bounces.push_back(time_of([&] { reference_->bounce(); }));
    return true;
}

/// Median of what the simulation does in the time in which the reference does `reference_count`.
double ratio_of(std::uint64_t count, const std::vector<double>& seconds, std::uint64_t reference_count,
                const std::vector<double>& reference_seconds) {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < seconds.size(); ++k) {
        ratios.push_back(static_cast<double>(count) / seconds[k] /
                         (static_cast<double>(reference_count) / reference_seconds[k]));
    }
    return median(ratios);
}

Row Measurer::row_of(const Times& times) const {
    const auto rate = [](std::uint64_t count, const std::vector<double>& seconds) {
        return static_cast<double>(count) / median(seconds);
    };
    const std::uint64_t rays = reference_->rays();
    Row row;
    row.suite = case_.suite;
    row.name = case_.name;
    row.response = name_of(ResponseKind::exact);
    row.particles = particles_.size();
    row.triangles = mesh_->triangles.size();
    row.threads = progress_.threads;
    row.steps = case_.steps;
    row.particle_steps = course_.particle_steps;
    row.contacts = course_.contacts;
    row.seconds = median(times.simulation);
    row.particle_steps_per_second = rate(course_.particle_steps, times.simulation);
    row.contacts_per_second = rate(course_.contacts, times.simulation);
    row.raw_rays_per_second = rate(rays, times.raw);
    row.ratio_raw = ratio_of(course_.particle_steps, times.simulation, rays, times.raw);
    row.raw_sorted_rays_per_second = rate(rays, times.sorted);
    row.ratio_raw_sorted = ratio_of(course_.particle_steps, times.simulation, rays, times.sorted);
    row.native_bounces_per_second = rate(reference_->bounces(), times.bounces);
    if (reference_->bounces() > 0) {
        row.ratio_native_bounces = ratio_of(course_.contacts, times.simulation, reference_->bounces(), times.bounces);
    }
    row.leaks = reference_->leaks();
    row.state_hash = course_.state_hash;
    row.bytes_per_particle = memory_.bytes_per_particle;
    row.bytes_per_triangle = memory_.bytes_per_triangle;
    return row;
}

}  // namespace

std::optional<std::vector<Row>> measure_case(const Case& c, const MeasurementPlan& plan, const Hook& hook) {
    return Measurer(c, plan, hook).run();
}

}  // namespace ricochet::bench
