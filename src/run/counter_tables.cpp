#include "run/counter_tables.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "ricochet/core/atomic_file.h"
#include "run/csv_file.h"
#include "run/run_folder.h"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

CounterCounts counts_of(const CounterTotals& counter) {
    return {counter.forward, counter.backward, counter.forward_mass, counter.backward_mass};
}

/// Returns the rows of all histograms.
std::string histogram_rows(const Simulation& simulation) {
    std::string text;
    for (const CounterTotals& counter : simulation.counters()) {
        for (const PassageHistogram& histogram : counter.histograms) {
            for (std::size_t bin = 0; bin < histogram.forward.size(); ++bin) {
                fmt::format_to(std::back_inserter(text), "{},{},{:.17g},{:.17g},{},{}\n", csv_field(counter.name),
                               name_of(histogram.description.quantity), histogram.edge(bin), histogram.edge(bin + 1),
                               histogram.forward[bin], histogram.backward[bin]);
            }
        }
    }
    return text;
}

/// Returns the mean and the standard deviation, or null values without numbers.
Json json_of(const RunningMean& mean) {
    if (mean.count == 0) return {{"mean", nullptr}, {"deviation", nullptr}};
    return {{"mean", mean.mean}, {"deviation", mean.count > 1 ? Json(mean.deviation()) : Json(nullptr)}};
}

Json json_with_count(const RunningMean& mean) {
    Json json = {{"count", mean.count}};
    json.update(json_of(mean));
    return json;
}

Json json_of(const PassageStatistics& statistics) {
    const bool has_passed = statistics.speed.count > 0;
    const Vec3& momentum = statistics.momentum;
    return {{"momentum", Json::array({momentum.x, momentum.y, momentum.z})},
            {"kinetic_energy", statistics.kinetic_energy},
            {"spin_energy", statistics.spin_energy},
            {"speed", json_of(statistics.speed)},
            {"angle", json_of(statistics.angle)},
            {"radius", json_of(statistics.radius)},
            {"spin", json_of(statistics.spin)},
            {"first_time", has_passed ? Json(statistics.first_time) : Json(nullptr)},
            {"last_time", has_passed ? Json(statistics.last_time) : Json(nullptr)}};
}

Json json_of(const PassageHistogram& histogram) {
    return {{"quantity", name_of(histogram.description.quantity)},
            {"range", histogram.description.range},
            {"forward", histogram.forward},
            {"backward", histogram.backward},
            {"forward_outside", histogram.forward_outside},
            {"backward_outside", histogram.backward_outside}};
}

}  // namespace

void CounterTables::add(const Simulation& simulation) {
    const std::vector<CounterTotals>& counters = simulation.counters();
    rows_.counts.resize(counters.size());
    for (std::size_t k = 0; k < counters.size(); ++k) {
        const CounterCounts now = counts_of(counters[k]);
        const CounterCounts before = std::exchange(rows_.counts[k], now);
        fmt::format_to(std::back_inserter(rows_.text), "{:.17g},{},{},{},{:.17g},{:.17g}\n", simulation.time(),
                       csv_field(counters[k].name), now.forward - before.forward, now.backward - before.backward,
                       now.forward_mass - before.forward_mass, now.backward_mass - before.backward_mass);
    }
}

void CounterTables::write(const Simulation& simulation) const {
    if (simulation.counters().empty()) return;
    write_file(folder_ / kCounterTableFile, "time,name,forward,backward,forward_mass,backward_mass\n" + rows_.text);
    const std::string histograms = histogram_rows(simulation);
    if (histograms.empty()) return;
    write_file(folder_ / kHistogramTableFile, "name,quantity,lower,upper,forward,backward\n" + histograms);
}

std::string counter_json(const CounterTotals& counter) {
    Json json = {{"name", counter.name},
                 {"forward", counter.forward},
                 {"backward", counter.backward},
                 {"forward_mass", counter.forward_mass},
                 {"backward_mass", counter.backward_mass},
                 {"forward_statistics", json_of(counter.forward_statistics)},
                 {"backward_statistics", json_of(counter.backward_statistics)}};
    json["transmission"] = {{"particles", counter.particles},
                            {"passed", counter.first_passage.count},
                            {"probability", counter.transmission()},
                            {"standard_error", counter.transmission_error()}};
    json["first_passage"] = json_with_count(counter.first_passage);
    if (counter.encloses) json["residence"] = json_with_count(counter.residence);
    for (const PassageHistogram& histogram : counter.histograms) json["histograms"].push_back(json_of(histogram));
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace ricochet
