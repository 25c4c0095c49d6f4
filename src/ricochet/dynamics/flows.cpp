#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/dynamics/flows.h"

namespace ricochet {

namespace {

using detail::require_finite;
using detail::require_not_negative;
using detail::require_positive;
using detail::unit_direction;

class Wind final : public FlowField {
public:
    explicit Wind(const Vec3& velocity) : velocity_(velocity) {}
    [[nodiscard]] Vec3 velocity(const Vec3&, double) const override { return velocity_; }
    [[nodiscard]] bool is_steady() const override { return true; }
    [[nodiscard]] bool is_uniform() const override { return true; }

private:
    Vec3 velocity_;
};

class GustyWind final : public FlowField {
public:
    GustyWind(const Vec3& velocity, const Gust& gust) : velocity_(velocity), gust_(gust) {}
    [[nodiscard]] Vec3 velocity(const Vec3&, double time) const override {
        return velocity_ * (1.0 + gust_.amplitude * sine_of_turns(gust_.frequency * time + gust_.phase));
    }
    [[nodiscard]] bool is_steady() const override { return gust_.amplitude == 0.0 || gust_.frequency == 0.0; }
    [[nodiscard]] bool is_uniform() const override { return true; }

private:
    Vec3 velocity_;
    Gust gust_;
};

/// A steady flow whose velocity is a function of the position.
template <class Velocity>
class SteadyFlow final : public FlowField {
public:
    explicit SteadyFlow(Velocity velocity) : velocity_(std::move(velocity)) {}
    [[nodiscard]] Vec3 velocity(const Vec3& position, double) const override { return velocity_(position); }
    [[nodiscard]] bool is_steady() const override { return true; }

private:
    Velocity velocity_;
};

template <class Velocity>
FlowPointer steady_flow(Velocity velocity) {
    return std::make_shared<SteadyFlow<Velocity>>(std::move(velocity));
}

// Returns (1 - exp(-q)) / q, the profile of Lamb and Oseen. Near the axis the function uses a series, because 1 -
// exp(-q) would suffer from cancellation.
double lamb_oseen(double q) {
    // Local: below this value the series is exact to rounding.
    constexpr double kNearAxis = 1e-2;  // the first omitted term is q^6 / 5040
    if (q >= kNearAxis) return (1.0 - portable_exp(-q)) / q;
    return 1.0 - q / 2.0 * (1.0 - q / 3.0 * (1.0 - q / 4.0 * (1.0 - q / 5.0 * (1.0 - q / 6.0))));
}

class CallableFlow final : public FlowField {
public:
    CallableFlow(std::function<Vec3(const Vec3&, double)> velocity, bool is_steady)
        : velocity_(std::move(velocity)), steady_(is_steady) {}
    [[nodiscard]] Vec3 velocity(const Vec3& position, double time) const override { return velocity_(position, time); }
    [[nodiscard]] bool is_steady() const override { return steady_; }

private:
    std::function<Vec3(const Vec3&, double)> velocity_;
    bool steady_;
};

class FlowSum final : public FlowField {
public:
    explicit FlowSum(std::vector<FlowPointer> parts) : parts_(std::move(parts)) {}
    [[nodiscard]] Vec3 velocity(const Vec3& position, double time) const override {
        Vec3 sum;
        for (const FlowPointer& part : parts_) sum += part->velocity(position, time);
        return sum;
    }
    [[nodiscard]] bool is_steady() const override {
        return std::all_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->is_steady(); });
    }
    [[nodiscard]] bool is_uniform() const override {
        return std::all_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->is_uniform(); });
    }

private:
    std::vector<FlowPointer> parts_;
};

class ScaledFlow final : public FlowField {
public:
    ScaledFlow(FlowPointer flow, double factor) : flow_(std::move(flow)), factor_(factor) {}
    [[nodiscard]] Vec3 velocity(const Vec3& position, double time) const override {
        return flow_->velocity(position, time) * factor_;
    }
    [[nodiscard]] bool is_steady() const override { return flow_->is_steady(); }
    [[nodiscard]] bool is_uniform() const override { return flow_->is_uniform(); }

private:
    FlowPointer flow_;
    double factor_;
};

// Interpolation between two samples along one axis.
struct Cell {
    std::size_t first = 0;
    std::size_t second = 0;
    double part = 0.0;  // weight of the second sample
    bool inside = true;
};

Cell cell_of(double x, double origin, double spacing, std::uint32_t count) {
    if (count == 1) return {};
    const double cell = (x - origin) / spacing;
    const double last = count - 1;
    const bool inside = cell >= 0.0 && cell <= last;
    if (!(cell > 0.0)) return {0, 0, 0.0, inside};  // this test also catches NaN
    if (cell >= last) return {count - std::size_t{1}, count - std::size_t{1}, 0.0, inside};
    const double below = std::floor(cell);
    const auto first = static_cast<std::size_t>(below);
    return {first, first + 1, cell - below, inside};
}

Vec3 between(const Vec3& a, const Vec3& b, double part) { return a + (b - a) * part; }

class GridFlow final : public FlowField {
public:
    GridFlow(VectorGrid grid, OutsideGrid outside) : grid_(std::move(grid)), outside_(outside) {}

    [[nodiscard]] Vec3 velocity(const Vec3& position, double) const override {
        const Cell x = cell_of(position.x, grid_.origin.x, grid_.spacing.x, grid_.counts[0]);
        const Cell y = cell_of(position.y, grid_.origin.y, grid_.spacing.y, grid_.counts[1]);
        const Cell z = cell_of(position.z, grid_.origin.z, grid_.spacing.z, grid_.counts[2]);
        if (outside_ == OutsideGrid::zero && !(x.inside && y.inside && z.inside)) return {};
        const Vec3 lower = between(row(x, y.first, z.first), row(x, y.second, z.first), y.part);
        const Vec3 upper = between(row(x, y.first, z.second), row(x, y.second, z.second), y.part);
        return between(lower, upper, z.part);
    }
    [[nodiscard]] bool is_steady() const override { return true; }

private:
    [[nodiscard]] Vec3 row(const Cell& x, std::size_t j, std::size_t k) const {
        const std::size_t start = grid_.counts[0] * (j + grid_.counts[1] * k);
        return between(grid_.values[start + x.first], grid_.values[start + x.second], x.part);
    }

    VectorGrid grid_;
    OutsideGrid outside_;
};

void check(const VectorGrid& grid) {
    detail::require_finite(grid.origin, "grid: the origin", "m");
    for (int axis = 0; axis < 3; ++axis) detail::require_positive(grid.spacing[axis], "grid: the spacing", "m");
    const auto& n = grid.counts;
    // The test uses a division, because the product of all counts may overflow.
    const bool fits = n[0] > 0 && n[1] > 0 && n[2] > 0 && grid.values.size() % n[0] == 0 &&
                      grid.values.size() / n[0] == std::uint64_t{n[1]} * n[2];
    if (!fits) {
        throw InputError(
            fmt::format("grid: found {} values for {} x {} x {} points", grid.values.size(), n[0], n[1], n[2]));
    }
    const auto bad = std::find_if_not(grid.values.begin(), grid.values.end(), is_finite);
    if (bad != grid.values.end()) {
        throw InputError(fmt::format("grid: the value of point {} is not finite", bad - grid.values.begin()));
    }
}

}  // namespace

FlowPointer make_wind(const Vec3& velocity) {
    require_finite(velocity, "wind: the velocity", "m/s");
    return std::make_shared<Wind>(velocity);
}

FlowPointer make_gusty_wind(const Vec3& velocity, const Gust& gust) {
    require_finite(velocity, "wind: the velocity", "m/s");
    require_not_negative(gust.amplitude, "wind: the gusts' amplitude", "");
    require_not_negative(gust.frequency, "wind: the gusts' frequency", "Hz");
    require_finite(gust.phase, "wind: the gusts' phase", "turns");
    return std::make_shared<GustyWind>(velocity, gust);
}

FlowPointer make_vortex(const VortexSettings& settings) {
    require_finite(settings.point, "vortex: the point on the axis", "m");
    require_finite(settings.circulation, "vortex: the circulation", "m^2/s");
    require_positive(settings.core_radius, "vortex: the core radius", "m");
    if (settings.profile != VortexProfile::rankine && settings.profile != VortexProfile::lamb_oseen) {
        throw InputError("vortex: there is no such profile");
    }
    const Vec3 axis = unit_direction(settings.axis, "vortex: the axis");
    const double strength = settings.circulation / (2.0 * std::numbers::pi);
    const double core_squared = settings.core_radius * settings.core_radius;
    // In both profiles the angular velocity depends only on the squared distance from the axis.
    if (settings.profile == VortexProfile::rankine) {
        return steady_flow([point = settings.point, axis, strength, core_squared](const Vec3& position) {
            const Vec3 around = cross(axis, position - point);
            return around * (strength / std::max(length_squared(around), core_squared));
        });
    }
    return steady_flow([point = settings.point, axis, strength, core_squared](const Vec3& position) {
        const Vec3 around = cross(axis, position - point);
        return around * (strength / core_squared * lamb_oseen(length_squared(around) / core_squared));
    });
}

FlowPointer make_source(const Vec3& center, double strength, double core_radius) {
    require_finite(center, "source: the centre", "m");
    require_finite(strength, "source: the strength", "m^3/s");
    require_positive(core_radius, "source: the core radius", "m");
    const double per_angle = strength / (4.0 * std::numbers::pi);
    return steady_flow([center, per_angle, core_squared = core_radius * core_radius](const Vec3& position) {
        const Vec3 d = position - center;
        const double square = length_squared(d) + core_squared;
        return d * (per_angle / (square * std::sqrt(square)));
    });
}

FlowPointer make_rotation(const Vec3& point, const Vec3& angular_velocity) {
    require_finite(point, "rotation: the point on the axis", "m");
    require_finite(angular_velocity, "rotation: the angular velocity", "rad/s");
    return steady_flow(
        [point, angular_velocity](const Vec3& position) { return cross(angular_velocity, position - point); });
}

FlowPointer make_shear(const Vec3& point, const Vec3& rate, const Vec3& gradient) {
    require_finite(point, "shear: the point at rest", "m");
    require_finite(rate, "shear: the rate", "1/s");
    const Vec3 along = unit_direction(gradient, "shear: the gradient");
    return steady_flow([point, rate, along](const Vec3& position) { return rate * dot(position - point, along); });
}

FlowPointer make_flow_past_sphere(const Vec3& center, double radius, const Vec3& velocity) {
    require_finite(center, "flow past a sphere: the centre", "m");
    require_positive(radius, "flow past a sphere: the radius", "m");
    require_finite(velocity, "flow past a sphere: the velocity", "m/s");
    return steady_flow([center, radius, velocity](const Vec3& position) {
        const Vec3 d = (position - center) / radius;
        const double square = length_squared(d);
        if (square < 1.0) return Vec3{};
        const double half_cube = 0.5 / (square * std::sqrt(square));
        return velocity * (1.0 + half_cube) - d * (3.0 * half_cube * dot(velocity, d) / square);
    });
}

FlowPointer make_flow(std::function<Vec3(const Vec3&, double)> velocity, bool is_steady) {
    if (!velocity) throw InputError("flow: an empty function cannot be called");
    return std::make_shared<CallableFlow>(std::move(velocity), is_steady);
}

FlowPointer make_flow_sum(std::vector<FlowPointer> parts) {
    if (std::find(parts.begin(), parts.end(), nullptr) != parts.end()) {
        throw InputError("sum of flows: found a null pointer, expected flows");
    }
    return std::make_shared<FlowSum>(std::move(parts));
}

FlowPointer make_scaled_flow(FlowPointer flow, double factor) {
    if (!flow) throw InputError("scaled flow: found a null pointer, expected a flow");
    require_finite(factor, "scaled flow: the factor", "");
    return std::make_shared<ScaledFlow>(std::move(flow), factor);
}

FlowPointer make_grid_flow(VectorGrid grid, OutsideGrid outside) {
    check(grid);
    if (outside != OutsideGrid::clamp && outside != OutsideGrid::zero) {
        throw InputError("grid: expected clamp or zero outside of it");
    }
    return std::make_shared<GridFlow>(std::move(grid), outside);
}

}  // namespace ricochet
