// Refusal of invalid counters, and of saved states that belong to other counters.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/error.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::setup_of;

void expect_refusal(const std::function<void(std::vector<CounterDescription>&)>& spoil, const std::string& message) {
    SimulationSetup setup = setup_of(0.1, 1.0);
    setup.counters = {{"counter", DiskCounter{{0, 0, 0}, {0, 0, 1}, 1.0}},
                      {"second", DiskCounter{{0, 0, 1}, {0, 0, 1}, 1.0}}};
    spoil(setup.counters);
    try {
        const Simulation simulation(std::move(setup));
        ADD_FAILURE() << message;
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()), message);
    }
}

TEST(CounterValidation, InvalidCountersAreRefusedInOneLine) {
    using All = std::vector<CounterDescription>;
    expect_refusal([](All& all) { all[1].name.clear(); }, "counter 1: name: found none, expected a name");
    expect_refusal([](All& all) { all[1].name = "counter"; },
                   "counter \"counter\": name: found counter, expected a name that no other has");
    expect_refusal([](All& all) { std::get<DiskCounter>(all[1].shape).normal = {}; },
                   "counter \"second\": normal: found [0, 0, 0], expected a direction of finite length above 0");
    expect_refusal([](All& all) { std::get<DiskCounter>(all[1].shape).radius = 0.0; },
                   "counter \"second\": radius: found 0, expected a finite number above 0 (m)");
    expect_refusal([](All& all) { std::get<DiskCounter>(all[1].shape).radius = -1.0; },
                   "counter \"second\": radius: found -1, expected a finite number above 0 (m)");
}

TEST(CounterValidation, InvalidShapesAreRefusedInOneLine) {
    const auto expect_shape = [](const CounterShape& shape, const std::string& message) {
        expect_refusal([&](std::vector<CounterDescription>& all) { all[1].shape = shape; },
                       "counter \"second\": " + message);
    };
    expect_shape(PlaneCounter{{0, 0, 0}, {}}, "normal: found [0, 0, 0], expected a direction of finite length above 0");
    const RectangleCounter gate{{0, 0, 0}, {0, 0, 1}, {0, 0, -3}, {1, 1}};
    expect_shape(gate,
                 "along: found the direction of the normal, expected a direction that is not parallel to the "
                 "normal");
    expect_shape(RectangleCounter{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0}},
                 "size: found 0, expected a finite number above 0 (m)");
    expect_shape(BoxCounter{{0, 0, 0}, {1, -1, 1}}, "size: found -1, expected a finite number above 0 (m)");
    expect_shape(MeshCounter{}, "mesh: found a null pointer, expected a mesh");
    expect_shape(MeshCounter{std::make_shared<const TriangleMesh>()},
                 "mesh: found no triangles, expected at least one");
    const TriangleMesh broken{{{0, 0, 0}}, {{0, 0, 7}}};
    expect_shape(MeshCounter{std::make_shared<const TriangleMesh>(broken)},
                 "corner of a triangle: found 7, expected a number below 1, the number of vertices");
}

TEST(CounterValidation, InvalidHistogramsAreRefusedInOneLine) {
    const auto expect_histogram = [](const HistogramDescription& histogram, const std::string& message) {
        expect_refusal([&](std::vector<CounterDescription>& all) { all[1].histograms = {histogram}; },
                       "counter \"second\": " + message);
    };
    expect_histogram({PassageQuantity::speed, {2, 2}, 5},
                     "histogram range: found [2, 2], expected a lower end below the upper one");
    expect_histogram({PassageQuantity::speed, {0, 1}, 0}, "histogram bins: found 0, expected 1 to 100000");
    expect_histogram({static_cast<PassageQuantity>(9), {0, 1}, 1},
                     "histogram: found 9, expected one of the quantities");
}

TEST(CounterValidation, StateOfOtherSettingsIsRefused) {
    using Change = std::function<void(CounterDescription&)>;
    const auto simulation = [](const CounterShape& shape, const Change& change) {
        SimulationSetup setup = setup_of(0.1, 1.0);
        setup.counters = {{"counter", shape, {{PassageQuantity::speed, {0, 1}, 5}}}};
        change(setup.counters[0]);
        return Simulation(std::move(setup));
    };
    const auto expect_refused = [&](const CounterShape& shape, const Change& change) {
        std::vector<std::byte> bytes;
        simulation(shape, [](CounterDescription&) {}).save([&](std::span<const std::byte> part) {
            bytes.insert(bytes.end(), part.begin(), part.end());
        });
        Simulation other = simulation(shape, change);
        std::size_t at = 0;
        EXPECT_THROW(other.restore([&](std::span<std::byte> part) {
            if (bytes.size() - at < part.size()) throw InputError("the file ends too early");
            std::memcpy(part.data(), bytes.data() + at, part.size());
            at += part.size();
        }),
                     InputError);
    };
    const auto mesh = [](double height) {
        return MeshCounter{std::make_shared<const TriangleMesh>(testing::floor_mesh(1.0, 2, height))};
    };
    expect_refused(PlaneCounter{}, [](CounterDescription& c) { c.shape = PlaneCounter{{0, 0, 1}, {0, 0, 1}}; });
    expect_refused(PlaneCounter{}, [](CounterDescription& c) { c.shape = DiskCounter{}; });
    expect_refused(RectangleCounter{}, [](CounterDescription& c) { std::get<RectangleCounter>(c.shape).size[1] = 2; });
    expect_refused(RectangleCounter{}, [](CounterDescription& c) { std::get<RectangleCounter>(c.shape).along.y = 2; });
    expect_refused(BoxCounter{}, [](CounterDescription& c) { std::get<BoxCounter>(c.shape).size.y = 2; });
    expect_refused(mesh(0.0), [&](CounterDescription& c) { c.shape = mesh(0.1); });
    expect_refused(PlaneCounter{}, [](CounterDescription& c) { c.histograms[0].bins = 6; });
    expect_refused(PlaneCounter{}, [](CounterDescription& c) { c.histograms[0].range[1] = 2; });
    expect_refused(PlaneCounter{}, [](CounterDescription& c) { c.histograms[0].quantity = PassageQuantity::spin; });
    expect_refused(PlaneCounter{}, [](CounterDescription& c) { c.histograms.clear(); });
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
