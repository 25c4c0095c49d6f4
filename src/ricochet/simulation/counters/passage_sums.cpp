#include "ricochet/simulation/counters/passage_sums.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "ricochet/core/portable_math.h"

namespace ricochet {
namespace {

/// Kinetic energy of a passage, in J.
struct Energies {
    double translation = 0.0;
    double spin = 0.0;  // of a solid sphere
};

Energies energies_of(const Passage& passage) {
    const double inertia = 0.4 * passage.mass * passage.radius * passage.radius;
    return {0.5 * passage.mass * length_squared(passage.velocity), 0.5 * inertia * length_squared(passage.spin)};
}

/// Returns the angle between the velocity and the direction of a passage, in degrees, 0 to 90. Rounding can give a
/// velocity along the surface the wrong sign, so the sign is ignored. The angle of a particle at rest is 0.
double angle_of(const Passage& passage) {
    const double cosine = std::fabs(dot(passage.velocity, passage.direction));
    const double sine = length(cross(passage.velocity, passage.direction));
    return sine > 0.0 || cosine > 0.0 ? 360.0 * turns_of(sine, cosine) : 0.0;
}

double value_of(PassageQuantity quantity, const Passage& passage) {
    switch (quantity) {
        case PassageQuantity::speed:
            return length(passage.velocity);
        case PassageQuantity::angle:
            return angle_of(passage);
        case PassageQuantity::radius:
            return passage.radius;
        case PassageQuantity::spin:
            return length(passage.spin);
        case PassageQuantity::energy:
            break;
        case PassageQuantity::time:
            return passage.time;
    }
    const Energies energies = energies_of(passage);
    return energies.translation + energies.spin;
}

void add(PassageStatistics& statistics, const Passage& passage) {
    const bool is_first = statistics.speed.count == 0;
    const Energies energies = energies_of(passage);
    statistics.momentum += passage.mass * passage.velocity;
    statistics.kinetic_energy += energies.translation;
    statistics.spin_energy += energies.spin;
    statistics.speed.add(length(passage.velocity));
    statistics.angle.add(angle_of(passage));
    statistics.radius.add(passage.radius);
    statistics.spin.add(length(passage.spin));
    statistics.first_time = is_first ? passage.time : std::min(statistics.first_time, passage.time);
    statistics.last_time = is_first ? passage.time : std::max(statistics.last_time, passage.time);
}

void add(PassageHistogram& histogram, const Passage& passage) {
    const auto& [lower, upper] = histogram.description.range;
    const double value = value_of(histogram.description.quantity, passage);
    if (!(value >= lower && value < upper)) {
        ++(passage.is_forward ? histogram.forward_outside : histogram.backward_outside);
        return;
    }
    const std::uint32_t bins = histogram.description.bins;
    auto bin = std::min(static_cast<std::size_t>((value - lower) / (upper - lower) * bins), std::size_t{bins - 1});
    // The edges decide, because the quotient is rounded.
    if (value < histogram.edge(bin)) --bin;
    if (bin + 1 < bins && value >= histogram.edge(bin + 1)) ++bin;
    ++(passage.is_forward ? histogram.forward : histogram.backward)[bin];
}

bool is_sound(const PassageStatistics& s) {
    return is_finite(s.momentum) && std::isfinite(s.first_time) && std::isfinite(s.last_time) &&
           s.kinetic_energy >= 0.0 && s.spin_energy >= 0.0 && s.speed.is_sound() && s.angle.is_sound() &&
           s.radius.is_sound() && s.spin.is_sound();
}

void add_shape(StateHash& hash, const DiskCounter& disk) {
    hash.add(disk.center), hash.add(disk.normal), hash.add(disk.radius);
}

void add_shape(StateHash& hash, const PlaneCounter& plane) { hash.add(plane.center), hash.add(plane.normal); }

void add_shape(StateHash& hash, const RectangleCounter& rectangle) {
    hash.add(rectangle.center), hash.add(rectangle.normal), hash.add(rectangle.along);
    for (const double length : rectangle.size) hash.add(length);
}

void add_shape(StateHash& hash, const BoxCounter& box) { hash.add(box.center), hash.add(box.size); }

void add_shape(StateHash& hash, const MeshCounter& mesh) {
    for (const Vec3& vertex : mesh.mesh->vertices) hash.add(vertex);
    for (const Triangle& triangle : mesh.mesh->triangles) {
        for (const std::uint32_t corner : triangle) hash.add(std::uint64_t{corner});
    }
}

}  // namespace

CounterTotals empty_totals(const CounterDescription& counter, bool encloses) {
    CounterTotals totals;
    totals.name = counter.name;
    totals.encloses = encloses;
    for (const HistogramDescription& description : counter.histograms) {
        const std::vector<std::uint64_t> none(description.bins);
        totals.histograms.push_back({description, none, none});
    }
    return totals;
}

void add_passage(CounterTotals& totals, Visits& visits, const Passage& passage) {
    ++(passage.is_forward ? totals.forward : totals.backward);
    (passage.is_forward ? totals.forward_mass : totals.backward_mass) += passage.mass;
    add(passage.is_forward ? totals.forward_statistics : totals.backward_statistics, passage);
    for (PassageHistogram& histogram : totals.histograms) add(histogram, passage);
    if (passage.is_forward && visits.pass(passage.particle)) {
        totals.first_passage.add(passage.time - passage.birth_time);
    }
    if (!totals.encloses) return;
    if (passage.is_forward) {
        visits.enter(passage.particle, passage.time);
    } else if (const std::optional<double> entered = visits.leave(passage.particle)) {
        totals.residence.add(passage.time - *entered);
    }
}

bool is_sound(const CounterTotals& totals) {
    const auto is_mass = [](double mass) { return mass >= 0.0 && std::isfinite(mass); };
    return is_mass(totals.forward_mass) && is_mass(totals.backward_mass) && is_sound(totals.forward_statistics) &&
           is_sound(totals.backward_statistics) && totals.first_passage.is_sound() && totals.residence.is_sound();
}

void add_settings(StateHash& hash, const CounterDescription& counter) {
    hash.add(std::uint64_t{counter.shape.index()});
    std::visit([&](const auto& shape) { add_shape(hash, shape); }, counter.shape);
    for (const HistogramDescription& histogram : counter.histograms) {
        hash.add(std::uint64_t{static_cast<std::uint8_t>(histogram.quantity)});
        for (const double end : histogram.range) hash.add(end);
        hash.add(std::uint64_t{histogram.bins});
    }
}

}  // namespace ricochet
