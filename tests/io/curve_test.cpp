#include "ricochet/io/scene/context.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/io/scene/document.h"

namespace ricochet::detail {
namespace RICOCHET_FILE {

using Lines = std::vector<std::string>;

// A curve from a JSON text, and its errors.
struct Read {
    KeyedCurve<double> curve;
    Lines errors;
};

Read read(const std::string& text) {
    const JsonNode node = parse_json_value(text, {}).value();
    Diagnostics diagnostics("s.json", {});
    KeyedCurve<double> curve = number_curve_of(ObjectView(node, number_curve_spec(), "a.angle"), diagnostics);
    return {std::move(curve), diagnostics.errors()};
}

TEST(CurveKeys, KeysSetTheCurve) {
    const Read spline = read(R"({"interpolation": "spline", "ends": "repeat",
                                 "keys": [{"time": 0, "value": 1}, {"time": 2, "value": 3}]})");
    EXPECT_EQ(spline.errors, Lines{});
    EXPECT_EQ(spline.curve.interpolation(), Interpolation::spline);
    EXPECT_EQ(spline.curve.ends(), CurveEnds::repeat);
    EXPECT_EQ(spline.curve.value(2.0), 3.0);
    const Read plain = read(R"({"keys": [{"time": 1.5, "value": -2}]})");
    EXPECT_EQ(plain.curve.interpolation(), Interpolation::linear);
    EXPECT_EQ(plain.curve.ends(), CurveEnds::hold);
    EXPECT_EQ(plain.curve.value(0.0), -2.0);
}

TEST(CurveKeys, ReadsVectors) {
    const JsonNode node =
        parse_json_value(R"({"keys": [{"time": 0, "value": [0, 0, 0]}, {"time": 2, "value": [2, 4, 6]}]})", {}).value();
    Diagnostics diagnostics("s.json", {});
    const auto curve = vector_curve_of(ObjectView(node, vector_curve_spec(), "a"), diagnostics);
    EXPECT_FALSE(diagnostics.failed());
    EXPECT_EQ(curve.value(1.0), Vec3(1, 2, 3));
}

TEST(CurveKeys, ErrorsHaveThePathOfTheKey) {
    const Read backward = read(R"({"keys": [{"time": 1, "value": 1}, {"time": 1, "value": 3}]})");
    ASSERT_EQ(backward.errors.size(), 1U);
    EXPECT_NE(
        backward.errors[0].find("a.angle.keys[1].time: found 1 s, expected a time after the 1 s of the key before"),
        std::string::npos)
        << backward.errors[0];
    const Read lonely = read(R"({"ends": "repeat", "keys": [{"time": 1, "value": 1}]})");
    ASSERT_EQ(lonely.errors.size(), 1U);
    EXPECT_NE(lonely.errors[0].find("a.angle: a curve that repeats has one key"), std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::detail
