/// \file
/// Keyed curves in scenes: the part of the table of keys that says what a curve is, and how one is read.
#pragma once

#include <string_view>

#include "ricochet/dynamics/keyed_curve.h"
#include "ricochet/io/detail/diagnostics.h"
#include "ricochet/io/detail/object_view.h"
#include "ricochet/io/detail/scene_keys.h"

namespace ricochet::detail {

/// {"interpolation": ..., "keys": [{"time": ..., "value": NUMBER}], "ends": ...}; the unit is that of the key that
/// holds the curve.
[[nodiscard]] const ObjectSpec& number_curve_spec();
/// The same with "value": [x, y, z].
[[nodiscard]] const ObjectSpec& vector_curve_spec();

/// A key whose value is a curve of numbers, or of vectors. Further members can be set on what is returned.
[[nodiscard]] KeySpec number_curve_key(std::string_view name, std::string_view description, std::string_view unit);
[[nodiscard]] KeySpec vector_curve_key(std::string_view name, std::string_view description, std::string_view unit);

/// The curve of an object of number_curve_spec(), each value within a range. What is wrong is reported with its path
/// ("emitters[0].rate.keys[1].time"), and a constant zero returned.
[[nodiscard]] KeyedCurve<double> number_curve_of(const ObjectView& view, Diagnostics& diagnostics,
                                                 const Range& range = {});
/// The curve of an object of vector_curve_spec(), in the same way.
[[nodiscard]] KeyedCurve<Vec3> vector_curve_of(const ObjectView& view, Diagnostics& diagnostics);

}  // namespace ricochet::detail
