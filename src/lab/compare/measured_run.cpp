/// \file
/// Runs one measured or timed simulation, and computes its errors and costs.
#include "lab/compare/measured_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "lab/compare/figures.h"
#include "lab/compare/tunnel_judge.h"
#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// Surfaces of a simulation, for the normals at crossings that the verifier reports.
class SurfaceNormals {
public:
    explicit SurfaceNormals(const Simulation& simulation);
    /// Returns the normal at a crossing, which can have any length. Triangles are counter-clockwise when seen from the
    /// tip of their normal. Normals of balls and cylinders point outward. They are computed at the reported position,
    /// which is the end of the segment. Returns zero for planes.
    [[nodiscard]] Vec3 at(const Violation& crossing) const;

private:
    struct Shape {
        AffineMap world_from_unit;
        bool is_cylinder = false;
    };
    struct Surface {
        std::optional<TriangleMesh> mesh;
        std::optional<Shape> shape;
    };
    [[nodiscard]] static Vec3 shape_normal(const Shape& shape, const Vec3& position);

    std::vector<Surface> surfaces_;
};

SurfaceNormals::SurfaceNormals(const Simulation& simulation) {
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) {
        const ColliderShape& shape = simulation.colliders()[i].shape;
        Surface& surface = surfaces_.emplace_back();
        if (const auto* ball = std::get_if<BallShape>(&shape)) {
            surface.shape = Shape{world_from_unit(*ball), false};
        } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
            surface.shape = Shape{world_from_unit(*cylinder), true};
        } else if (!std::holds_alternative<PlaneShape>(shape)) {
            surface.mesh = simulation.collider_mesh(i);
        }
    }
}

Vec3 SurfaceNormals::at(const Violation& crossing) const {
    const Surface& surface = surfaces_[*crossing.collider];
    if (surface.shape) return shape_normal(*surface.shape, crossing.position);
    if (!surface.mesh || !crossing.triangle) return {};
    const auto [a, b, c] = surface.mesh->triangles[*crossing.triangle];
    const auto& vertices = surface.mesh->vertices;
    return cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
}

// Normals are transformed to world coordinates by the transposed inverse of the map. The columns of the transposed
// inverse are the cross products of the map's columns, divided by the determinant.
Vec3 SurfaceNormals::shape_normal(const Shape& shape, const Vec3& position) {
    const AffineMap& map = shape.world_from_unit;
    const Vec3 x{map.row_x.x, map.row_y.x, map.row_z.x};
    const Vec3 y{map.row_x.y, map.row_y.y, map.row_z.y};
    const Vec3 z{map.row_x.z, map.row_y.z, map.row_z.z};
    const double determinant = map.determinant();
    const Vec3 along_x = cross(y, z) / determinant;
    const Vec3 along_y = cross(z, x) / determinant;
    const Vec3 along_z = cross(x, y) / determinant;
    const Vec3 from_centre = position - map.translation;
    Vec3 unit{dot(along_x, from_centre), dot(along_y, from_centre), dot(along_z, from_centre)};
    if (shape.is_cylinder) {
        const double to_side = std::fabs(1.0 - std::hypot(unit.x, unit.y)) * length(x);
        const double to_cap = std::fabs(1.0 - std::fabs(unit.z)) * length(z);
        unit = to_cap < to_side ? Vec3{0.0, 0.0, unit.z} : Vec3{unit.x, unit.y, 0.0};
    }
    return unit.x * along_x + unit.y * along_y + unit.z * along_z;
}

namespace {

/// Recorder of a run's data, step by step.
class Measurement {
public:
    explicit Measurement(const Simulation& simulation)
        : normals_(simulation),
          judge_(collider_kinds(simulation), [this](const Violation& crossing) { return normals_.at(crossing); }) {
        note_energy(simulation);
        if (simulation.spawns_children()) note_births(simulation);
    }
    Measurement(const Measurement&) = delete;  // not copyable, because judge_ refers to normals_ of this object
    Measurement& operator=(const Measurement&) = delete;
    ~Measurement() = default;

    void note_step(const Simulation& simulation) {
        judge_.add_step(simulation.last_violations());
        if (simulation.spawns_children()) note_births(simulation);
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

    // Records the keys of new particles. Particles that exist from the start have no emitter, and their key has their
    // id.
    void note_births(const Simulation& simulation) {
        for (const BirthRecord& birth : simulation.birth_records()) {
            while (trace_.keys.size() < birth.particle) trace_.keys.push_back({kNoEmitter, trace_.keys.size()});
            const bool is_emitted = birth.origin.emitter != kNoEmitter;
            trace_.keys.push_back({birth.origin.emitter, is_emitted ? birth.origin.lineage : birth.particle});
        }
        while (trace_.keys.size() < simulation.statistics().emitted) {
            trace_.keys.push_back({kNoEmitter, trace_.keys.size()});
        }
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

namespace {

constexpr double kNanoseconds = 1e9;

double per_count(double seconds, std::uint64_t count) {
    return count == 0 ? kNoNumber : kNanoseconds * seconds / static_cast<double>(count);
}

bool is_as_good(const ReferenceErrors& exact, const ReferenceErrors& row) {
    if (row.position.count > 0 && exact.position.count > 0) {
        return exact.position.root_mean_square <= row.position.root_mean_square;
    }
    return exact.impact.median <= row.impact.median;  // false if one of them is kNoNumber
}

}  // namespace

std::optional<TimedRun> time_run(SimulationSetup setup, const StepHook& go_on) {
    using Clock = std::chrono::steady_clock;
    setup.options.verify = false;
    setup.options.record_contacts = false;
    Simulation simulation(std::move(setup));
    bool goes_on = true;
    Clock::duration asked{};
    const auto ask = [&] {
        const Clock::time_point start = Clock::now();
        goes_on = go_on(simulation);
        asked += Clock::now() - start;
        return goes_on;
    };
    const Clock::time_point start = Clock::now();
    simulation.advance(simulation.step_count(), ask);
    const Clock::duration spent = Clock::now() - start - asked;
    if (!goes_on) return std::nullopt;
    return TimedRun{std::chrono::duration<double>(spent).count(), simulation.state_hash()};
}

double ratio_of_times(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) ratios.push_back(a[k] / b[k]);
    return median(ratios);
}

const ComparisonRow* equally_good(const ComparisonRow& row, const std::vector<const ComparisonRow*>& exact) {
    const auto found = std::find_if(exact.begin(), exact.end(), [&](const ComparisonRow* candidate) {
        return is_as_good(candidate->errors, row.errors);
    });
    return found == exact.end() ? nullptr : *found;
}

void settle_cost(ComparisonRow& row, const ComparisonRow& at_equal_step,
                 const std::vector<const ComparisonRow*>& exact) {
    RunCost& cost = row.cost;
    cost.seconds = median(cost.seconds_each);
    cost.ns_per_particle_step = per_count(cost.seconds, row.figures.statistics.particle_steps);
    cost.ns_per_contact = per_count(cost.seconds, row.figures.statistics.contacts);
    cost.ratio_at_equal_step = ratio_of_times(cost.seconds_each, at_equal_step.cost.seconds_each);
    if (const ComparisonRow* const equal = equally_good(row, exact)) {
        cost.ratio_at_equal_error = ratio_of_times(cost.seconds_each, equal->cost.seconds_each);
        row.equal_error_step = equal->time_step;
    }
}

namespace {

/// Returns true if the series of at most kMostEnergyPoints entries includes this step. The series includes the first
/// step, the last step, and evenly spaced steps between them.
bool is_kept(std::size_t step, std::size_t count) {
    if (count <= kMostEnergyPoints || step == 0) return true;
    const std::size_t intervals = kMostEnergyPoints - 1;
    return step * intervals / (count - 1) != (step - 1) * intervals / (count - 1);
}

void add_energy_errors(const RunTrace& run, const RunTrace& reference, ReferenceErrors& errors) {
    const bool has_potential = run.has_potential && reference.has_potential;
    const std::vector<double>& energy = has_potential ? run.total : run.kinetic;
    const std::vector<double>& expected = has_potential ? reference.total : reference.kinetic;
    const double scale = energy_scale(reference);
    if (!(scale > 0.0)) return;
    errors.energy_largest = 0.0;
    for (std::size_t k = 0; k < energy.size(); ++k) {
        const double error = (energy[k] - interpolate(reference.times, expected, run.times[k])) / scale;
        if (std::isnan(error) || std::fabs(error) > errors.energy_largest) errors.energy_largest = std::fabs(error);
        errors.energy_final = error;
        if (is_kept(k, energy.size())) errors.energy.push_back({run.times[k], error});
    }
}

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

std::size_t born(const RunTrace& trace) {
    return std::max({trace.first_impact.size(), trace.alive.size(), trace.keys.size()});
}

/// Returns, for each particle of the run, the id of the same particle in the reference. The id is kNobody if the
/// particle does not exist in the reference.
std::vector<std::size_t> partners(const RunTrace& run, const RunTrace& reference) {
    std::vector<std::size_t> result(born(run), kNobody);
    const std::size_t known = born(reference);
    if (run.keys.empty() && reference.keys.empty()) {
        for (std::size_t id = 0; id < std::min(result.size(), known); ++id) result[id] = id;
        return result;
    }
    std::vector<std::pair<ParticleKey, std::size_t>> by_key;
    for (std::size_t id = 0; id < reference.keys.size(); ++id) by_key.emplace_back(reference.keys[id], id);
    std::sort(by_key.begin(), by_key.end());
    for (std::size_t id = 0; id < run.keys.size(); ++id) {
        const auto found = std::lower_bound(by_key.begin(), by_key.end(), std::pair(run.keys[id], std::size_t{0}));
        if (found != by_key.end() && found->first == run.keys[id]) result[id] = found->second;
    }
    return result;
}

void add_impact_errors(const RunTrace& run, const RunTrace& reference, std::span<const std::size_t> partner,
                       ReferenceErrors& errors) {
    const auto first = [](const RunTrace& trace, std::size_t id) {
        return id < trace.first_impact.size() ? trace.first_impact[id] : kNoNumber;
    };
    std::vector<double> differences;
    std::uint64_t matched = 0;
    for (std::size_t id = 0; id < partner.size(); ++id) {
        const double here = first(run, id);
        const double there = partner[id] == kNobody ? kNoNumber : first(reference, partner[id]);
        matched += std::isnan(there) ? 0 : 1;
        if (std::isnan(here) && !std::isnan(there)) ++errors.impacts_missed;
        if (!std::isnan(here) && std::isnan(there)) ++errors.impacts_extra;
        if (!std::isnan(here) && !std::isnan(there)) differences.push_back(std::fabs(here - there));
    }
    const auto all = std::count_if(reference.first_impact.begin(), reference.first_impact.end(),
                                   [](double time) { return !std::isnan(time); });
    // The reference's other impacts belong to particles that do not exist in this run.
    errors.impacts_missed += static_cast<std::uint64_t>(all) - matched;
    errors.impact = spread_of(differences);
}

void add_position_errors(const RunTrace& run, const RunTrace& reference, std::span<const std::size_t> partner,
                         ReferenceErrors& errors) {
    const auto lives = [](const RunTrace& trace, std::size_t id) {
        return id < trace.alive.size() && trace.alive[id] != 0;
    };
    std::vector<double> distances;
    for (std::size_t id = 0; id < partner.size(); ++id) {
        if (!lives(run, id) || partner[id] == kNobody || !lives(reference, partner[id])) continue;
        const double distance = length(run.end_position[id] - reference.end_position[partner[id]]);
        if (std::isfinite(distance)) distances.push_back(distance);
    }
    errors.position = spread_of(distances);
}

}  // namespace

double interpolate(std::span<const double> times, std::span<const double> values, double time) {
    const auto after = std::lower_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return values.front();
    if (after == times.end()) return values.back();
    const auto k = static_cast<std::size_t>(after - times.begin());
    const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
    return share == 1.0 ? values[k] : values[k - 1] + share * (values[k] - values[k - 1]);
}

double energy_scale(const RunTrace& reference) {
    const std::vector<double>& energy = reference.energy();
    const auto [least, most] = std::minmax_element(energy.begin(), energy.end());
    return std::max(*most - *least, *std::max_element(reference.kinetic.begin(), reference.kinetic.end()));
}

ReferenceErrors errors_against(const RunTrace& run, const RunTrace& reference) {
    ReferenceErrors errors;
    add_energy_errors(run, reference, errors);
    const std::vector<std::size_t> partner = partners(run, reference);
    add_impact_errors(run, reference, partner, errors);
    add_position_errors(run, reference, partner, errors);
    return errors;
}

}  // namespace ricochet
