/// \file
/// Distributions of the values that are drawn for each particle, such as speed, radius, mass and lifetime. One uniform
/// number gives one value, by the inverse of the cumulative distribution.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace ricochet {

/// Uniform distribution over [mean - spread, mean + spread).
struct MeanSpread {
    double mean = 0.0;
    double spread = 0.0;  ///< >= 0
};

/// Law of a distribution. `center` and `width` are members of Distribution.
enum class DistributionLaw {
    uniform,        ///< between `min` and `max`, which must both be given
    normal,         ///< mean `center`, standard deviation `width`
    log_normal,     ///< median `center` > 0, geometric standard deviation `width` > 1
    exponential,    ///< mean `center` > 0
    rosin_rammler,  ///< 1 - exp(-(x / center)^width) of the values are below x; both > 0
    values,         ///< the values of the table, in proportion to their weights
    density,        ///< density through the points of the table, linear between them
};

/// Measure whose share a distribution of radii gives.
enum class DistributionBasis {
    number,  ///< shares of the number of particles
    mass,    ///< shares of the mass: numbers are then in proportion to share / radius^3
};

/// Point of a tabulated distribution.
struct TablePoint {
    double value = 0.0;
    double weight = 0.0;  ///< >= 0, relative to the other points
};

/// Distribution of a drawn value, in the unit of the value. Sources: P. Rosin, E. Rammler, "The laws governing the
/// fineness of powdered coal", Journal of the Institute of Fuel 7, 1933; T. Hatch, S. P. Choate, "Statistical
/// description of the size properties of non-uniform particulate substances", Journal of the Franklin Institute
/// 207(3), 1929 (log-normal distributions by mass and by number).
struct Distribution {
    DistributionLaw law = DistributionLaw::uniform;
    double center = 0.0;
    double width = 1.0;
    std::optional<double> min{};      ///< smaller values are not drawn; the others keep their proportions
    std::optional<double> max{};      ///< the same for larger values
    std::vector<TablePoint> table{};  ///< for `values` and `density`: ascending values
    DistributionBasis by = DistributionBasis::number;
};

/// Value that is drawn for each particle: from `distribution` if it is given, otherwise uniformly around the mean.
struct DrawnValue : MeanSpread {
    DrawnValue(double mean_value = 0.0, double spread_value = 0.0) : MeanSpread{mean_value, spread_value} {}
    DrawnValue(const MeanSpread& pair) : MeanSpread(pair) {}
    DrawnValue(Distribution given) : distribution(std::move(given)) {}

    std::optional<Distribution> distribution = std::nullopt;

    /// Returns a lower and an upper bound of all values that can be drawn. Throw InputError like quantile_of().
    [[nodiscard]] double least() const;
    [[nodiscard]] double most() const;
    /// Returns the expected value, for a distribution with an error of about 1 % of its width.
    [[nodiscard]] double expected() const;
};

/// Function that returns the value for a uniform number u in [0, 1) and never decreases.
using Quantile = std::function<double(double u)>;

/// Returns the function that draws the value. Distributions by mass without a closed form are integrated numerically.
/// Their cumulative distribution has an error below 1e-12. Throws InputError if the distribution is out of range.
[[nodiscard]] Quantile quantile_of(const DrawnValue& value);

}  // namespace ricochet
