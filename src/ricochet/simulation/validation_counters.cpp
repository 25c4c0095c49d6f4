#include <fmt/format.h>

#include <variant>

#include "ricochet/simulation/validation.h"

namespace ricochet {
namespace {

void validate(const DiskCounter& disk, const Subject& subject) {
    subject.require(disk.center, kCoordinate, "center", "m");
    subject.require_direction(disk.normal, "normal");
    subject.require(disk.radius, kLength, "radius", "m");
}

void validate(const PlaneCounter& plane, const Subject& subject) {
    subject.require(plane.center, kCoordinate, "center", "m");
    subject.require_direction(plane.normal, "normal");
}

void validate(const RectangleCounter& rectangle, const Subject& subject) {
    subject.require(rectangle.center, kCoordinate, "center", "m");
    subject.require_direction(rectangle.normal, "normal");
    subject.require_direction(rectangle.along, "along");
    if (!has_two_sides(rectangle)) {
        subject.refuse("along", "the direction of the normal", "a direction that is not parallel to the normal");
    }
    for (const double length : rectangle.size) subject.require(length, kLength, "size", "m");
}

void validate(const BoxCounter& box, const Subject& subject) {
    subject.require(box.center, kCoordinate, "center", "m");
    for (int axis = 0; axis < 3; ++axis) subject.require(box.size[axis], kLength, "size", "m");
}

void validate(const MeshCounter& counter, const Subject& subject) {
    if (!counter.mesh) subject.refuse("mesh", "a null pointer", "a mesh");
    for (const Vec3& vertex : counter.mesh->vertices) subject.require(vertex, kCoordinate, "vertex", "m");
    for (const Triangle& triangle : counter.mesh->triangles) {
        for (const std::uint32_t vertex : triangle) {
            subject.require_index(vertex, counter.mesh->vertices.size(), "corner of a triangle", "vertices");
        }
    }
    if (counter.mesh->triangles.empty()) subject.refuse("mesh", "no triangles", "at least one");
}

void validate(const HistogramDescription& histogram, const Subject& subject) {
    if (histogram.quantity > PassageQuantity::time) {
        subject.refuse("histogram", static_cast<int>(histogram.quantity), "one of the quantities");
    }
    const auto& [lower, upper] = histogram.range;
    for (const double end : histogram.range) subject.require(end, kCoordinate, "histogram range", "");
    if (!(lower < upper)) {
        subject.refuse("histogram range", fmt::format("[{}, {}]", lower, upper), "a lower end below the upper one");
    }
    subject.require_in(histogram.bins, 1.0, kMostHistogramBins, "histogram bins",
                       fmt::format("1 to {}", kMostHistogramBins));
}

}  // namespace

void validate_counters(std::span<const CounterDescription> counters) {
    for (std::size_t k = 0; k < counters.size(); ++k) {
        const CounterDescription& counter = counters[k];
        const Subject subject("counter", k, counter.name);
        // The summary and messages use the name.
        if (counter.name.empty()) subject.refuse("name", "none", "a name");
        std::visit([&](const auto& shape) { validate(shape, subject); }, counter.shape);
        for (const HistogramDescription& histogram : counter.histograms) validate(histogram, subject);
    }
}

}  // namespace ricochet
