#include "ricochet/dynamics/distribution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/normal_quantile.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/numeric_quantile.h"

namespace ricochet {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
/// Largest uniform number. Local: a constant of the random numbers, which have 53 bits.
constexpr double kLastUniform = 1.0 - 0x1p-53;
/// Largest ratio of the ends of a cell, if a distribution by mass is integrated. Local: a constant of the method; 1 /
/// r^3 is integrated to rounding in such a cell.
constexpr double kCellRatio = 1.25;

void require_sound(bool condition, const char* what) {
    if (!condition) throw InputError(what);
}

double lower_end(const Distribution& d) { return d.min.value_or(-kUnlimited); }
double upper_end(const Distribution& d) { return d.max.value_or(kUnlimited); }

void check_table(const Distribution& d) {
    double sum = 0.0;
    for (std::size_t k = 0; k < d.table.size(); ++k) {
        const TablePoint& point = d.table[k];
        require_sound(std::fabs(point.value) <= kLargestCoordinate, "every value of the table must be at most 1e75");
        require_sound(point.weight >= 0.0 && std::isfinite(point.weight), "every weight of the table must be >= 0");
        require_sound(k == 0 || d.table[k - 1].value < point.value,
                      "the values of the table must increase from point to point");
        if (point.value >= lower_end(d) && point.value <= upper_end(d)) sum += point.weight;
    }
    require_sound(std::isfinite(sum), "the weights of the table are too large");
    if (d.law == DistributionLaw::values) {
        require_sound(sum > 0.0, "the table has no value of weight above 0 from min to max");
    } else {
        require_sound(d.table.size() >= 2, "a density needs two points or more");
    }
}

void check_distribution(const Distribution& d) {
    using Law = DistributionLaw;
    require_sound(!std::isnan(lower_end(d)) && !std::isnan(upper_end(d)), "min and max must be numbers");
    require_sound(lower_end(d) < upper_end(d), "min must be below max");
    if (d.law == Law::values || d.law == Law::density) return check_table(d);
    if (d.law == Law::uniform) {
        require_sound(std::fabs(lower_end(d)) <= kLargestCoordinate && std::fabs(upper_end(d)) <= kLargestCoordinate,
                      "a uniform distribution needs min and max, each at most 1e75");
        return;
    }
    require_sound(std::fabs(d.center) <= kLargestCoordinate, "the mean, median or scale must be at most 1e75");
    require_sound(d.width > 0.0 && d.width <= kLargestCoordinate,
                  "the deviation or exponent must be > 0 and at most 1e75");
    if (d.law == Law::normal) return;
    require_sound(d.center > 0.0, "the mean, median or scale must be > 0");
    require_sound(upper_end(d) > 0.0, "max must be > 0");
    if (d.law == Law::log_normal) require_sound(d.width > 1.0, "the geometric deviation must be > 1");
}

// Standard normal distribution between two ends.
class NormalBetween {
public:
    // Between ends above 0, the mirrored distribution is drawn, because probabilities near 0 are more accurate.
    NormalBetween(double lower, double upper) : is_mirrored_(lower > 0.0) {
        if (is_mirrored_) std::tie(lower, upper) = std::pair(-upper, -lower);
        is_below_zero_ = upper <= 0.0;
        below_ = normal_cumulative(lower);
        above_ = is_below_zero_ ? 0.0 : normal_cumulative(-upper);
        inside_ = is_below_zero_ ? normal_cumulative(upper) - below_ : 1.0 - below_ - above_;
        require_sound(inside_ > 0.0, "no values lie between min and max");
    }
    [[nodiscard]] double operator()(double u) const {
        return is_mirrored_ ? -of_lower(1.0 - 0x1p-53 - u) : of_lower(u);
    }

private:
    [[nodiscard]] double of_lower(double u) const {
        if (is_below_zero_ || u < 0.5) return normal_quantile(below_ + (u + 0x1p-54) * inside_);
        return -normal_quantile(above_ + ((1.0 - u) - 0x1p-54) * inside_);
    }

    bool is_mirrored_;
    bool is_below_zero_ = false;
    double below_ = 0.0;   // probability below the interval
    double above_ = 0.0;   // probability above the interval
    double inside_ = 1.0;  // probability in the interval
};

// Exponential distribution of mean 1 between two ends, 0 <= lower < upper.
class ExponentialBetween {
public:
    ExponentialBetween(double lower, double upper) : lower_(lower), inside_(1.0 - portable_exp(lower - upper)) {
        require_sound(std::isfinite(lower) && inside_ > 0.0, "no values lie between min and max");
    }
    [[nodiscard]] double operator()(double u) const { return lower_ - portable_log(1.0 - u * inside_); }

private:
    double lower_;
    double inside_;  // probability of the interval, given that the value is above its lower end
};

// Returns (x / scale)^exponent, 0 for x <= 0.
double scaled_power(double x, double scale, double exponent) {
    if (!(x > 0.0)) return 0.0;
    return std::isfinite(x) ? portable_pow(x / scale, exponent) : kUnlimited;
}

double log_of(double x) { return x > 0.0 ? (std::isfinite(x) ? portable_log(x) : kUnlimited) : -kUnlimited; }

// Values with probabilities in proportion to their weights.
Quantile quantile_of_values(const Distribution& d) {
    std::vector<double> values;
    std::vector<double> sums;
    double sum = 0.0;
    for (const TablePoint& point : d.table) {
        if (point.value < lower_end(d) || point.value > upper_end(d) || point.weight == 0.0) continue;
        const double scaled = point.value / d.table.back().value;
        sum += d.by == DistributionBasis::mass ? point.weight / (scaled * scaled * scaled) : point.weight;
        values.push_back(point.value);
        sums.push_back(sum);
    }
    require_sound(std::isfinite(sum), "the weights of the table differ too much");
    return [values, sums](double u) {
        const auto found = std::upper_bound(sums.begin(), sums.end() - 1, u * sums.back());
        return values[static_cast<std::size_t>(found - sums.begin())];
    };
}

double density_in_table(const std::vector<TablePoint>& table, double x) {
    if (x < table.front().value || x > table.back().value) return 0.0;
    const auto is_below = [](const TablePoint& point, double value) { return point.value < value; };
    const auto after = std::lower_bound(table.begin() + 1, table.end() - 1, x, is_below);
    const auto before = after - 1;
    return before->weight + (after->weight - before->weight) * ((x - before->value) / (after->value - before->value));
}

// Returns the part of a density from min to max.
std::vector<TablePoint> clipped(const Distribution& d) {
    const double lower = std::max(lower_end(d), d.table.front().value);
    const double upper = std::min(upper_end(d), d.table.back().value);
    require_sound(lower < upper, "min and max exclude all values of the table");
    std::vector<TablePoint> part{{lower, density_in_table(d.table, lower)}};
    for (const TablePoint& point : d.table) {
        if (point.value > lower && point.value < upper) part.push_back(point);
    }
    part.push_back({upper, density_in_table(d.table, upper)});
    return part;
}

// The cumulative distribution is a parabola in each piece, which is inverted in closed form.
Quantile quantile_of_density(const Distribution& d) {
    const std::vector<TablePoint> points = clipped(d);
    std::vector<double> sums{0.0};
    for (std::size_t k = 1; k < points.size(); ++k) {
        const double area = 0.5 * (points[k].weight + points[k - 1].weight) * (points[k].value - points[k - 1].value);
        sums.push_back(sums.back() + area);
    }
    require_sound(sums.back() > 0.0 && std::isfinite(sums.back()),
                  "the density has no finite area above 0 from min to max");
    return [points, sums](double u) {
        const double target = u * sums.back();
        const auto above = std::upper_bound(sums.begin() + 1, sums.end() - 1, target);
        const auto k = static_cast<std::size_t>(above - sums.begin());
        const double area = target - sums[k - 1];
        const double width = points[k].value - points[k - 1].value;
        const double first = points[k - 1].weight;
        const double slope = (points[k].weight - first) / width;
        const double root = std::sqrt(std::max(0.0, first * first + 2.0 * slope * area));
        const double step = area > 0.0 ? 2.0 * area / (first + root) : 0.0;
        return points[k - 1].value + std::min(step, width);
    };
}

// Returns the function without the limits of rounding at min and max.
Quantile unlimited_quantile(const Distribution& d) {
    const double lower = lower_end(d);
    const double upper = upper_end(d);
    const double center = d.center;
    const double width = d.width;
    switch (d.law) {
        case DistributionLaw::uniform:
            return [lower, upper](double u) { return lower + (upper - lower) * u; };
        case DistributionLaw::normal: {
            const NormalBetween normal((lower - center) / width, (upper - center) / width);
            return [=](double u) { return center + width * normal(u); };
        }
        case DistributionLaw::log_normal: {
            const double scale = portable_log(width);
            const double middle = portable_log(center);
            const NormalBetween normal((log_of(lower) - middle) / scale, (log_of(upper) - middle) / scale);
            return [=](double u) { return center * portable_exp(scale * normal(u)); };
        }
        case DistributionLaw::exponential: {
            const ExponentialBetween part(std::max(0.0, lower) / center, upper / center);
            return [=](double u) { return center * part(u); };
        }
        case DistributionLaw::rosin_rammler: {
            const ExponentialBetween part(scaled_power(lower, center, width), scaled_power(upper, center, width));
            return [=](double u) {
                const double power = part(u);
                return power > 0.0 ? center * portable_pow(power, 1.0 / width) : 0.0;
            };
        }
        case DistributionLaw::values:
            return quantile_of_values(d);
        case DistributionLaw::density:
            return quantile_of_density(d);
    }
    throw InputError("there is no such law of a distribution");
}

Quantile limited_quantile(const Distribution& d) {
    return [draw = unlimited_quantile(d), lower = lower_end(d), upper = upper_end(d)](double u) {
        return std::clamp(draw(u), lower, upper);
    };
}

// Returns the density, in any unit.
std::function<double(double)> density_of(const Distribution& d) {
    const double center = d.center;
    const double width = d.width;
    switch (d.law) {
        case DistributionLaw::normal:
            return [=](double x) { return portable_exp(-0.5 * ((x - center) / width) * ((x - center) / width)); };
        case DistributionLaw::exponential:
            return [=](double x) { return portable_exp(-x / center); };
        case DistributionLaw::rosin_rammler:
            return [=](double x) {
                const double power = scaled_power(x, center, width);
                return power / x * portable_exp(-power);
            };
        case DistributionLaw::density:
            return [table = d.table](double x) { return density_in_table(table, x); };
        default:
            return [](double) { return 1.0; };
    }
}

// Returns ends of cells in which a distribution by mass and by number is smooth. They are quantiles by mass, closer
// towards both ends, and the corners of a tabulated density, divided until their ratio is small.
std::vector<double> cells_of(const Distribution& d, const Quantile& by_mass) {
    std::vector<double> ends{by_mass(0.0), by_mass(kLastUniform)};
    if (d.min) ends.push_back(*d.min);
    for (double part = 0.5; part > 0x1p-53; part *= 0.5) {
        ends.push_back(by_mass(part));
        ends.push_back(by_mass(1.0 - part));
    }
    for (const TablePoint& point : d.table) {
        if (point.value > lower_end(d) && point.value < upper_end(d)) ends.push_back(point.value);
    }
    std::sort(ends.begin(), ends.end());
    std::vector<double> cells{ends.front()};
    for (const double end : ends) {
        if (!(end > cells.back())) continue;
        const double begin = cells.back();
        const int pieces = static_cast<int>(std::ceil(portable_log(end / begin) / portable_log(kCellRatio)));
        for (int k = 1; k < pieces; ++k) cells.push_back(begin * portable_pow(end / begin, double(k) / pieces));
        cells.push_back(end);
    }
    return cells;
}

// Returns the quantiles by number of a distribution by mass. The log-normal distribution by number is log-normal, too,
// with the median divided by exp(3 s^2), if s is the logarithm of the geometric deviation (Hatch and Choate 1929).
Quantile quantile_by_number(Distribution d) {
    if (d.law == DistributionLaw::log_normal) {
        const double scale = portable_log(d.width);
        d.center *= portable_exp(-3.0 * scale * scale);
        require_sound(d.center > 0.0, "the geometric deviation is too large for a distribution by mass");
        return limited_quantile(d);
    }
    const Quantile by_mass = limited_quantile(d);
    const double least = by_mass(0.0);
    require_sound(least > 0.0,
                  "a distribution by mass needs a min above 0, because the number of small particles has no limit");
    if (d.law == DistributionLaw::values) return by_mass;
    const double typical = by_mass(0.5);
    const NumericQuantile draw(
        [density = density_of(d), typical](double x) {
            const double part = x / typical;
            return density(x) / (part * part * part);
        },
        cells_of(d, by_mass));
    return [draw, lower = lower_end(d), upper = upper_end(d)](double u) { return std::clamp(draw(u), lower, upper); };
}

}  // namespace

double DrawnValue::least() const { return distribution ? quantile_of(*this)(0.0) : mean - spread; }

double DrawnValue::most() const { return distribution ? quantile_of(*this)(kLastUniform) : mean + spread; }

double DrawnValue::expected() const {
    if (!distribution) return mean;
    constexpr int kSamples = 512;
    const Quantile draw = quantile_of(*this);
    double sum = 0.0;
    for (int k = 0; k < kSamples; ++k) sum += draw((k + 0.5) / kSamples);
    return sum / kSamples;
}

Quantile quantile_of(const DrawnValue& value) {
    if (!value.distribution) {
        return [pair = MeanSpread(value)](double u) { return pair.mean + pair.spread * (2.0 * u - 1.0); };
    }
    check_distribution(*value.distribution);
    if (value.distribution->by == DistributionBasis::mass) return quantile_by_number(*value.distribution);
    return limited_quantile(*value.distribution);
}

}  // namespace ricochet
