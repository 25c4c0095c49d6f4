#include "ricochet/io/detail/curve_keys.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/io/detail/key_ranges.h"

namespace ricochet::detail {
namespace {

KeySpec time_key() {
    return {.name = "time",
            .description = "When; later than the key before.",
            .unit = "s",
            .range = kCoordinate,
            .required = true};
}

const ObjectSpec& number_key_spec() {
    static const ObjectSpec spec{
        .title = "curve key",
        .description = "A number at a time.",
        .keys = {time_key(),
                 {.name = "value", .description = "The curve's value then.", .range = kCoordinate, .required = true}}};
    return spec;
}

const ObjectSpec& vector_key_spec() {
    static const ObjectSpec spec{.title = "vector curve key",
                                 .description = "A vector at a time.",
                                 .keys = {time_key(),
                                          {.name = "value",
                                           .type = ValueType::vector,
                                           .description = "The curve's value then.",
                                           .range = kCoordinate,
                                           .required = true}}};
    return spec;
}

std::vector<KeySpec> curve_keys(const ObjectSpec& key_spec) {
    return {
        {.name = "keys",
         .type = ValueType::list,
         .description = "The keys in the order of time, at least one, each `{\"time\": ..., \"value\": ...}`.",
         .required = true,
         .not_empty = true,
         .content = &key_spec},
        {.name = "interpolation",
         .type = ValueType::choice,
         .description = "What holds between two keys.",
         .fallback = "\"linear\"",
         .choices = {{"linear", "a straight line"},
                     {"slow_in_slow_out", "3 s^2 - 2 s^3 of the way, so that it is at rest at every key"},
                     {"spline", "a smooth cubic (Catmull-Rom, for uneven keys too)"}}},
        {.name = "ends",
         .type = ValueType::choice,
         .description = "What holds before the first and after the last key.",
         .fallback = "\"hold\"",
         .choices = {{"hold", "that key's value"},
                     {"repeat",
                      "the keys again and again, each round beginning with the value that the last one "
                      "ended with"}}},
    };
}

// What the table cannot say: later and later, and values within the holder's range.
bool are_good_keys(const std::vector<ObjectView>& keys, Diagnostics& diagnostics, const Range& range) {
    bool good = !keys.empty();
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const ObjectView& key = keys[k];
        good = good && key.has("time") && key.has("value");
        if (k > 0 && good && !(keys[k - 1].number("time") < key.number("time"))) {
            diagnostics.error(key.place_of("time"), key.path_of("time"),
                              fmt::format("found {} s, expected a time after the {} s of the key before",
                                          key.number("time"), keys[k - 1].number("time")));
            good = false;
        }
        if (const auto value = key.node("value").number(); value && !range.contains(*value)) {
            diagnostics.error(key.place_of("value"), key.path_of("value"),
                              fmt::format("found {}, expected a number {}", *value, range_words(range)));
            good = false;
        }
    }
    return good;
}

template <class Value, class Read>
KeyedCurve<Value> curve_of(const ObjectView& view, Diagnostics& diagnostics, const Range& range, const Read& read) {
    const std::vector<ObjectView> views = view.objects("keys");
    if (!are_good_keys(views, diagnostics, range)) return KeyedCurve<Value>{};
    std::vector<CurveKey<Value>> keys;
    for (const ObjectView& key : views) keys.push_back({key.number("time"), read(key)});
    try {
        return KeyedCurve<Value>(std::move(keys),
                                 interpolation_from_name(view.text("interpolation")).value_or(Interpolation::linear),
                                 view.text("ends") == "repeat" ? CurveEnds::repeat : CurveEnds::hold);
    } catch (const InputError& problem) {
        diagnostics.error(view.place(), view.path(), problem.what());
        return KeyedCurve<Value>{};
    }
}

KeySpec curve_key(std::string_view name, std::string_view description, std::string_view unit, const ObjectSpec& spec) {
    return {.name = name, .type = ValueType::object, .description = description, .unit = unit, .content = &spec};
}

}  // namespace

const ObjectSpec& number_curve_spec() {
    static const ObjectSpec spec{.title = "curve",
                                 .description = "A number keyed in time, in the unit of the key that holds the curve.",
                                 .keys = curve_keys(number_key_spec())};
    return spec;
}

const ObjectSpec& vector_curve_spec() {
    static const ObjectSpec spec{.title = "vector curve",
                                 .description = "A vector keyed in time: a curve whose values are [x, y, z].",
                                 .keys = curve_keys(vector_key_spec())};
    return spec;
}

KeySpec number_curve_key(std::string_view name, std::string_view description, std::string_view unit) {
    return curve_key(name, description, unit, number_curve_spec());
}

KeySpec vector_curve_key(std::string_view name, std::string_view description, std::string_view unit) {
    return curve_key(name, description, unit, vector_curve_spec());
}

KeyedCurve<double> number_curve_of(const ObjectView& view, Diagnostics& diagnostics, const Range& range) {
    return curve_of<double>(view, diagnostics, range, [](const ObjectView& key) { return key.number("value"); });
}

KeyedCurve<Vec3> vector_curve_of(const ObjectView& view, Diagnostics& diagnostics) {
    return curve_of<Vec3>(view, diagnostics, {}, [](const ObjectView& key) { return key.vector("value"); });
}

}  // namespace ricochet::detail
