/// \file
/// Time of one evaluation of each force and flow, and of a typical sum.

#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"

namespace ricochet {
namespace {

using Forces = std::vector<std::unique_ptr<Force>>;

std::vector<ForceInput> states() {
    RandomSequence random(1, 0, 0);
    std::vector<ForceInput> result;
    while (result.size() < 1024) {
        result.push_back({3.0 * random.in_unit_ball(), 3.0 * random.in_unit_ball(), 1.0, 0.01, random.uniform()});
    }
    return result;
}

void evaluate(benchmark::State& state, Forces list) {
    const ForceField forces(std::move(list));
    const std::vector<ForceInput> inputs = states();
    std::size_t i = 0;
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(forces.acceleration(inputs[i++ % inputs.size()]));
}

template <class... Pointers>
Forces list_of(Pointers... forces) {
    Forces list;
    (list.push_back(std::move(forces)), ...);
    return list;
}

FlowPointer vortex(VortexProfile profile = VortexProfile::rankine) {
    return make_vortex({{}, {0, 0, 1}, 1.0, 0.2, profile});
}

FlowPointer turbulence(std::uint32_t octaves, double rate) {
    TurbulenceSettings settings;
    settings.octaves = octaves;
    settings.rate = rate;
    return make_turbulence(settings);
}

FlowPointer grid() {
    VectorGrid grid{{-3, -3, -3}, {0.2, 0.2, 0.2}, {31, 31, 31}, {}};
    grid.values.resize(31 * 31 * 31, Vec3(1, 2, 3));
    return make_grid_flow(std::move(grid));
}

Forces field(const FlowPointer& flow) { return list_of(make_field_force(flow, FieldMeaning::acceleration)); }

Forces six_forces() {
    return list_of(make_gravity({0, 0, -9.81}), make_linear_drag(0.1),
                   make_field_force(make_wind({1, 0, 0}), FieldMeaning::acceleration),
                   make_point_gravity({{{1, 0, 0}, 1.0, 0.1}}), make_swirl({}, {0, 0, 1}, 1.0, 0.2),
                   make_lorentz_force({1.0, {}, {0, 0, 1}}));
}

void add(const char* name, const std::function<Forces()>& make) {
    benchmark::RegisterBenchmark(name, [make](benchmark::State& state) { evaluate(state, make()); });
}

void add_forces() {
    add("gravity", [] { return list_of(make_gravity({0, 0, -9.81})); });
    add("linear_drag", [] { return list_of(make_linear_drag(0.1)); });
    add("linear_drag_in_wind", [] { return list_of(make_linear_drag(0.1, make_wind({1, 0, 0}))); });
    add("quadratic_drag", [] { return list_of(make_quadratic_drag(0.1)); });
    add("sphere_drag", [] { return list_of(make_sphere_drag(0.47, 1.2)); });
    add("stokes_drag", [] { return list_of(make_stokes_drag(1e-3)); });
    add("schiller_naumann_drag", [] { return list_of(make_schiller_naumann_drag(1.2, 1e-3)); });
    add("buoyancy", [] { return list_of(make_buoyancy(1.2, {0, 0, -9.81})); });
    add("point_gravity", [] { return list_of(make_point_gravity({{{1, 0, 0}, 1.0, 0.1}})); });
    add("radial", [] { return list_of(make_radial_force({{}, 1.0, -2.0, 0.1, 1.0})); });
    add("radial_broken_exponent", [] { return list_of(make_radial_force({{}, 1.0, -1.5, 0.1, 1.0})); });
    add("swirl", [] { return list_of(make_swirl({}, {0, 0, 1}, 1.0, 0.2)); });
    add("lorentz", [] { return list_of(make_lorentz_force({1.0, {1, 0, 0}, {0, 0, 1}})); });
    add("anchor", [] { return list_of(make_anchor({{}, 1.0, 0.5, 0.1})); });
    add("six_forces", six_forces);
}

void add_flows() {
    add("flow/uniform", [] { return field(make_wind({1, 0, 0})); });
    add("flow/gust", [] { return field(make_gusty_wind({1, 0, 0}, {0.5, 1.0, 0.0})); });
    add("flow/vortex", [] { return field(vortex()); });
    add("flow/lamb_oseen", [] { return field(vortex(VortexProfile::lamb_oseen)); });
    add("flow/source", [] { return field(make_source({}, 1.0, 0.1)); });
    add("flow/rotation", [] { return field(make_rotation({}, {0, 0, 1})); });
    add("flow/sphere", [] { return field(make_flow_past_sphere({}, 0.5, {1, 0, 0})); });
    add("flow/grid", [] { return field(grid()); });
    add("flow/turbulence_1_frozen", [] { return field(turbulence(1, 0.0)); });
    add("flow/turbulence_3_frozen", [] { return field(turbulence(3, 0.0)); });
    add("flow/turbulence_3_changing", [] { return field(turbulence(3, 1.0)); });
}

}  // namespace
}  // namespace ricochet

int main(int argc, char** argv) {
    ricochet::add_forces();
    ricochet::add_flows();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
