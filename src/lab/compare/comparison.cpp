/// \file
/// Runs one scene many times. A simulation takes ownership of its setup, so every run needs a copy.
#include "lab/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lab/compare/measured_run.h"
#include "ricochet/core/error.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Factory of setups that share only constant data (forces, meshes).
class SetupCopies {
public:
    explicit SetupCopies(SimulationSetup setup);
    /// Returns a setup with these options.
    [[nodiscard]] SimulationSetup make(const SimulationOptions& options) const;
    [[nodiscard]] const SimulationOptions& options() const { return setup_.options; }

private:
    SimulationSetup setup_;  // without its forces
    std::vector<std::shared_ptr<const Force>> forces_;
};

namespace {

/// Force that several simulations share. Sharing is safe, because forces are pure functions.
class SharedForce final : public Force {
public:
    explicit SharedForce(std::shared_ptr<const Force> force) : force_(std::move(force)) {}

    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override { return force_->acceleration(input); }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return force_->potential_energy(input);
    }
    [[nodiscard]] bool is_uniform() const override { return force_->is_uniform(); }
    [[nodiscard]] bool is_steady() const override { return force_->is_steady(); }
    [[nodiscard]] bool is_conservative() const override { return force_->is_conservative(); }
    [[nodiscard]] std::optional<Vec3> common_acceleration() const override { return force_->common_acceleration(); }

private:
    std::shared_ptr<const Force> force_;
};

}  // namespace

SetupCopies::SetupCopies(SimulationSetup setup) : setup_(std::move(setup)) {
    for (std::unique_ptr<Force>& force : setup_.forces) forces_.emplace_back(std::move(force));
    setup_.forces.clear();
}

// Copies the members one by one, in order of declaration. If SimulationSetup gets a new member, this function does not
// compile until it copies the member.
SimulationSetup SetupCopies::make(const SimulationOptions& options) const {
    const auto& [own_options, acceleration, no_forces, materials, colliders, frames, bodies, emitters, particles,
                 springs, spring_faces, particles_forces, solver, bounds, attributes, reference_camera, heat, counters,
                 ranks] = setup_;
    (void)own_options;
    (void)no_forces;
    std::vector<std::unique_ptr<Force>> forces;
    for (const auto& force : forces_) forces.push_back(std::make_unique<SharedForce>(force));
    return {options, acceleration, std::move(forces), materials,        colliders,    frames,
            bodies,  emitters,     particles,         springs,          spring_faces, particles_forces,
            solver,  bounds,       attributes,        reference_camera, heat,         counters,
            ranks};
}

namespace {

constexpr ResponseChoice kExact{ResponseKind::exact, false};

/// Executes a measured run of a comparison. If the run diverges, the error names it. Timed runs do not need this
/// function, because a run that diverges has already failed as a measured run.
template <class Run>
auto named(std::string_view part, const ResponseChoice& response, double time_step, const Run& run) {
    try {
        return run();
    } catch (const DivergedError& error) {
        throw DivergedError(
            fmt::format("{}, {} at {} s, cannot be compared: {}; or compare other steps (--time-steps, "
                        "--reference-step) or responses (--responses)",
                        part, name_of(response), time_step, error.what()));
    }
}

/// Returns the end of an error message that suggests the option --responses with the accepted responses.
std::string without_refused(const std::vector<ResponseChoice>& accepted) {
    std::string names;
    for (const ResponseChoice& choice : accepted) names += (names.empty() ? "" : ",") + name_of(choice);
    return fmt::format("or leave it out (--responses {})", names.empty() ? name_of(kExact) : names);
}

/// Creates a simulation of each response at the time step, in s, without running it. Throws InputError for the first
/// response that the scene does not accept.
void require_runs(const SetupCopies& copies, const std::vector<ResponseChoice>& responses, double time_step) {
    const auto make = [&](const ResponseChoice& response) {
        const Simulation simulation(copies.make(options_for(copies.options(), response, time_step)));
    };
    make(kExact);  // an error here is an error of the scene, not of a row
    std::vector<ResponseChoice> accepted;
    std::string refusal;
    for (const ResponseChoice& response : responses) {
        try {
            if (response != kExact) make(response);
            accepted.push_back(response);
        } catch (const InputError& error) {
            if (!refusal.empty()) continue;
            refusal =
                fmt::format("simulation.response: the rows of {} cannot be run: {}", name_of(response), error.what());
        }
    }
    if (!refusal.empty()) throw InputError(fmt::format("{}; {}", refusal, without_refused(accepted)));
}

/// Runner of a plan.
class Comparer {
public:
    Comparer(SimulationSetup setup, const ComparisonPlan& plan, const ComparisonHook& hook)
        : copies_(std::move(setup)), hook_(hook) {
        require_runs(copies_, plan.responses, plan.reference_step);
        result_.plan = plan;
        result_.options = copies_.options();
        for (const ResponseChoice& response : plan.responses) add_rows(response, true);
        const bool has_exact = std::find(plan.responses.begin(), plan.responses.end(), kExact) != plan.responses.end();
        if (!has_exact) add_rows(kExact, false);
        progress_.runs = 1 + result_.rows.size() * (1 + plan.repeats);
    }

    std::optional<Comparison> run() {
        if (!measure() || !take_times()) return std::nullopt;
        settle_costs();
        return std::move(result_);
    }

private:
    void add_rows(const ResponseChoice& response, bool listed) {
        for (const double step : result_.plan.time_steps) {
            ComparisonRow row;
            row.response = response;
            row.time_step = step;
            row.listed = listed;
            result_.rows.push_back(std::move(row));
        }
    }

    [[nodiscard]] SimulationSetup setup_for(const ResponseChoice& response, double time_step) const {
        return copies_.make(options_for(copies_.options(), response, time_step));
    }

    /// Returns the hook of the next run, which passes the progress to the hook of the comparison.
    StepHook next_run(const ResponseChoice& response, double time_step, std::uint32_t repeat) {
        ++progress_.run;
        progress_.response = name_of(response);
        progress_.time_step = time_step;
        progress_.repeat = repeat;
        return [this](const Simulation& simulation) {
            progress_.step = simulation.step_index();
            progress_.steps = simulation.step_count();
            return !hook_ || hook_(progress_);
        };
    }

    bool measure() {
        const double step = result_.plan.reference_step;
        const auto reference = named("the reference", kExact, step,
                                     [&] { return measure_run(setup_for(kExact, step), next_run(kExact, step, 0)); });
        if (!reference) return false;
        result_.reference = {reference->figures, energy_scale(reference->trace), reference->trace.has_potential};
        return std::all_of(result_.rows.begin(), result_.rows.end(), [&](ComparisonRow& row) {
            const auto run = named("a row", row.response, row.time_step, [&] {
                return measure_run(setup_for(row.response, row.time_step), next_run(row.response, row.time_step, 0));
            });
            if (!run) return false;
            row.figures = run->figures;
            row.errors = errors_against(run->trace, reference->trace);
            return true;
        });
    }

    bool take_times() {
        for (std::uint32_t repeat = 1; repeat <= result_.plan.repeats; ++repeat) {
            for (const double step : result_.plan.time_steps) {
                for (ComparisonRow& row : result_.rows) {
                    if (row.time_step == step && !take_time(row, repeat)) return false;
                }
            }
        }
        return true;
    }

    bool take_time(ComparisonRow& row, std::uint32_t repeat) {
        const auto run =
            time_run(setup_for(row.response, row.time_step), next_run(row.response, row.time_step, repeat));
        if (!run) return false;
        if (run->state_hash != row.figures.state_hash) {
            throw RunError(
                fmt::format("{} at {} s ends in the state {:016x} when it is timed and in {:016x} when it is "
                            "measured; the comparison would compare different things",
                            name_of(row.response), row.time_step, run->state_hash, row.figures.state_hash));
        }
        row.cost.seconds_each.push_back(run->seconds);
        return true;
    }

    void settle_costs() {
        std::vector<const ComparisonRow*> exact;
        for (const ComparisonRow& row : result_.rows) {
            if (row.response == kExact) exact.push_back(&row);
        }
        for (ComparisonRow& row : result_.rows) {
            const auto equal = std::find_if(exact.begin(), exact.end(), [&](const ComparisonRow* candidate) {
                return candidate->time_step == row.time_step;
            });
            settle_cost(row, **equal, exact);
        }
    }

    SetupCopies copies_;
    const ComparisonHook& hook_;
    Comparison result_;
    ComparisonProgress progress_;
};

}  // namespace

std::vector<const ComparisonRow*> Comparison::listed_rows() const {
    std::vector<const ComparisonRow*> listed;
    for (const ComparisonRow& row : rows) {
        if (row.listed) listed.push_back(&row);
    }
    return listed;
}

std::vector<const ComparisonRow*> Comparison::rows_of(const ResponseChoice& response) const {
    std::vector<const ComparisonRow*> found;
    for (const ComparisonRow* row : listed_rows()) {
        if (row->response == response) found.push_back(row);
    }
    return found;
}

void require_comparable(SimulationSetup setup, const ComparisonPlan& plan) {
    require_runs(SetupCopies(std::move(setup)), plan.responses, plan.reference_step);
}

std::optional<Comparison> compare_responses(SimulationSetup setup, const ComparisonPlan& plan,
                                            const ComparisonHook& hook) {
    return Comparer(std::move(setup), plan, hook).run();
}

}  // namespace ricochet
