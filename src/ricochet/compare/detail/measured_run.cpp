#include "ricochet/compare/detail/measured_run.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "ricochet/compare/detail/surface_normals.h"
#include "ricochet/compare/detail/tunnel_judge.h"

namespace ricochet::detail {
namespace {

/// Watches a run from step to step.
class Measurement {
public:
    explicit Measurement(const Simulation& simulation)
        : normals_(simulation),
          judge_(collider_kinds(simulation), [this](const Violation& crossing) { return normals_.at(crossing); }) {
        note_energy(simulation);
    }
    Measurement(const Measurement&) = delete;  // the judge asks the normals of this one
    Measurement& operator=(const Measurement&) = delete;
    ~Measurement() = default;

    void note_step(const Simulation& simulation) {
        judge_.add_step(simulation.last_violations());
        note_impacts(simulation);
        note_penetrating(simulation);
        note_energy(simulation);
    }

    [[nodiscard]] MeasuredRun finish(const Simulation& simulation) {
        note_end(simulation);
        MeasuredRun run;
        run.figures.statistics = simulation.statistics();
        run.figures.tunnel = judge_.verdict([this](std::uint64_t id) { return penetrating_[id] != 0; });
        run.figures.alive = simulation.particles().size();
        run.figures.state_hash = simulation.state_hash();
        run.figures.warnings = simulation.warnings();
        run.trace = std::move(trace_);
        return run;
    }

private:
    void note_energy(const Simulation& simulation) {
        const double kinetic = simulation.kinetic_energy();
        trace_.times.push_back(simulation.time());
        trace_.kinetic.push_back(kinetic);
        if (!trace_.has_potential) return;
        const std::optional<double> potential = simulation.potential_energy();
        trace_.has_potential = potential.has_value();
        if (potential) trace_.total.push_back(kinetic + *potential);
    }

    void note_impacts(const Simulation& simulation) {
        trace_.first_impact.resize(simulation.statistics().emitted, kNoNumber);
        for (const ContactRecord& record : simulation.contact_records()) {
            double& first = trace_.first_impact[record.particle];
            if (std::isnan(first)) first = record.time;
        }
    }

    void note_penetrating(const Simulation& simulation) {
        penetrating_.resize(simulation.statistics().emitted, 0);
        const Particles& particles = simulation.particles();
        for (std::size_t i = 0; i < particles.size(); ++i) {
            penetrating_[particles.id[i]] = simulation.is_penetrating(i) ? 1 : 0;
        }
    }

    void note_end(const Simulation& simulation) {
        const std::size_t born = simulation.statistics().emitted;
        trace_.first_impact.resize(born, kNoNumber);
        trace_.alive.assign(born, 0);
        trace_.end_position.assign(born, Vec3{});
        const Particles& particles = simulation.particles();
        for (std::size_t i = 0; i < particles.size(); ++i) {
            trace_.alive[particles.id[i]] = 1;
            trace_.end_position[particles.id[i]] = particles.position[i];
        }
    }

    SurfaceNormals normals_;
    TunnelJudge judge_;
    RunTrace trace_;
    std::vector<std::uint8_t> penetrating_;
};

}  // namespace

std::optional<MeasuredRun> measure_run(SimulationSetup setup, const StepHook& go_on) {
    setup.options.verify = true;
    setup.options.record_contacts = true;
    Simulation simulation(std::move(setup));
    Measurement measurement(simulation);
    while (!simulation.finished()) {
        simulation.step();
        measurement.note_step(simulation);
        if (!go_on(simulation)) return std::nullopt;
    }
    return measurement.finish(simulation);
}

}  // namespace ricochet::detail
