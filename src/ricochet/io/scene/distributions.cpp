// Distributions of drawn values in scenes.
#include <fmt/format.h>

#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

// Keys of one law. The law itself follows from the type.
struct LawKeys {
    double center = 0.0;
    double width = 1.0;
    std::optional<double> min{};
    std::optional<double> max{};
    std::vector<TablePoint> table{};
    bool is_linear = false;
};

using Keys = Fields<LawKeys>;

constexpr Range kAboveOne{.lower = 1.0, .lower_open = true};

Keys limit_fields() {
    return {{"min", &LawKeys::min, kCoordinate, "", "Smaller values are not drawn. The others keep their proportions.",
             Without{"no limit"}},
            {"max", &LawKeys::max, kCoordinate, "", "Larger values are not drawn. The others keep their proportions.",
             Without{"no limit"}}};
}

Keys end_fields() {
    return {{"min", &LawKeys::min, kCoordinate, "", "Smallest value.", kRequired},
            {"max", &LawKeys::max, kCoordinate, "", "Largest value, above `min`.", kRequired}};
}

Keys normal_fields() {
    return {{"mean", &LawKeys::center, kCoordinate, "", "Mean, without the limits.", kRequired},
            {"deviation", &LawKeys::width, kLength, "", "Standard deviation, without the limits.", kRequired}};
}

const ObjectSpec& table_point_spec() {
    static const ObjectSpec spec = object<TablePoint>(
        "table point", "A value and its weight.",
        {{"value", &TablePoint::value, kCoordinate, "", "Value, above that of the point before.", kRequired},
         {"weight", &TablePoint::weight, kNotNegative, "", "Weight relative to the other points.", kRequired}});
    return spec;
}

Keys table_fields() {
    return {{"points", &LawKeys::table, "Values with their weights, in ascending order.", &table_point_spec(),
             kRequired, kNotEmpty},
            {"linear", &LawKeys::is_linear,
             "true: the weights are a density, linear between the points. false: only the values of the points are "
             "drawn."}};
}

std::vector<Variant> laws() {
    return {
        variant<LawKeys>("uniform", "Every value between two ends has the same density.", end_fields()),
        variant<LawKeys>("normal", "The normal distribution.", joined({normal_fields(), limit_fields()})),
        variant<LawKeys>("truncated_normal", "The normal distribution between two ends, which must be given.",
                         joined({normal_fields(), end_fields()})),
        variant<LawKeys>(
            "log_normal", "The logarithm of the value has a normal distribution.",
            joined({Keys{{"median", &LawKeys::center, kLength, "", "Median, without the limits.", kRequired},
                         {"geometric_deviation", &LawKeys::width, kAboveOne, "",
                          "Geometric standard deviation: exp of the standard deviation of the logarithm.", kRequired}},
                    limit_fields()})),
        variant<LawKeys>("exponential", "Density in proportion to exp(-value / mean), from 0.",
                         joined({Keys{{"mean", &LawKeys::center, kLength, "", "Mean, without the limits.", kRequired}},
                                 limit_fields()})),
        variant<LawKeys>("rosin_rammler",
                         "The fraction exp(-(value / scale)^exponent) lies above a value (Rosin, Rammler, Weibull).",
                         joined({Keys{{"scale", &LawKeys::center, kLength, "",
                                       "Value that 36.8 % exceed, without the limits.", kRequired},
                                      {"exponent", &LawKeys::width, positive_up_to(1000.0), "",
                                       "Exponent. Larger exponents give a narrower distribution.", kRequired}},
                                 limit_fields()})),
        variant<LawKeys>("table", "Values with weights.", joined({table_fields(), limit_fields()}))};
}

DistributionLaw law_of(std::string_view type, const LawKeys& keys) {
    if (type == "uniform") return DistributionLaw::uniform;
    if (type == "log_normal") return DistributionLaw::log_normal;
    if (type == "exponential") return DistributionLaw::exponential;
    if (type == "rosin_rammler") return DistributionLaw::rosin_rammler;
    if (type == "table") return keys.is_linear ? DistributionLaw::density : DistributionLaw::values;
    return DistributionLaw::normal;
}

}  // namespace

const ObjectSpec& distribution_spec() {
    using By = DistributionBasis;
    static const ObjectSpec spec = object<Distribution>(
        "distribution", "A distribution from which a value is drawn, in the unit of the value.",
        {{"by", &Distribution::by, "Measure whose shares the distribution gives. Only for `particle_radius`.",
          Choices{choice(By::number, "number", "the number of particles"),
                  choice(By::mass, "mass", "their mass, so that numbers are in proportion to share / radius^3")}}},
        laws());
    return spec;
}

void Format<DrawnValue>::read(const JsonNode& node, const KeySpec& key, DrawnValue& value) {
    MeanSpread pair = value;
    Format<MeanSpread>::read(node, key, pair);
    value = {pair.mean, pair.spread};
    if (node.object() == nullptr) return;
    const ObjectView view(node, *key.content, "");
    if (view.type().empty()) return;  // the type was refused
    const auto keys = view.read<LawKeys>();
    Distribution drawn = view.read<Distribution>();
    drawn.law = law_of(view.type(), keys);
    drawn.center = keys.center;
    drawn.width = keys.width;
    drawn.min = keys.min;
    drawn.max = keys.max;
    drawn.table = keys.table;
    value = drawn;
}

std::string Format<DrawnValue>::text(const KeySpec& key, const DrawnValue& value) {
    return Format<MeanSpread>::text(key, value);
}

bool check_drawn(const SceneContext& context, const ObjectView& view, std::string_view key, const DrawnValue& value,
                 const Range& range) {
    if (!value.distribution) return true;
    const ObjectView object = view.object(key);
    if (!object.is_complete()) return false;  // reported already
    if (value.distribution->by == DistributionBasis::mass && key != "particle_radius") {
        context.error(object, "by", "only radii have a distribution by mass, leave it out");
        return false;
    }
    try {
        const double least = value.least();
        const double most = value.most();
        if (range.contains(least) && range.contains(most)) return true;
        const bool is_low = !range.contains(least);
        context.error(view, key,
                      fmt::format("found values {} to {:.3g}, expected {}: set its \"{}\"", is_low ? "down" : "up",
                                  is_low ? least : most, range_words(range), is_low ? "min" : "max"));
    } catch (const InputError& problem) {
        context.error(view, key, problem.what());
    }
    return false;
}

}  // namespace ricochet::detail
