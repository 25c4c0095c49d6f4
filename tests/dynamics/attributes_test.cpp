#include "ricochet/dynamics/particles.h"

#include <gtest/gtest.h>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/emitter.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(AttributeTable, ValuesFollowTheirParticles) {
    Particles particles;
    particles.attributes = AttributeTable({{"temperature", 1, {300, 0, 0}}, {"wind", 3, {1, 2, 3}}});
    for (int k = 0; k < 4; ++k) {
        Particle particle;
        particle.id = static_cast<std::uint64_t>(k);
        if (k > 0) particle.attributes = {{100.0 * k, 0, 0}, k == 2 ? Vec3{7, 8, 9} : missing_attribute()};
        particles.append(particle);
    }
    particles.compact({1, 0, 1, 1});
    ASSERT_EQ(particles.size(), 3U);
    EXPECT_EQ(particles.attributes.value(0, 0).x, 300.0);
    EXPECT_EQ(particles.attributes.value(0, 1).x, 200.0);
    EXPECT_EQ(particles.attributes.value(0, 2).x, 300.0);
    EXPECT_EQ(particles.attributes.value(1, 0), (Vec3{1, 2, 3}));
    EXPECT_EQ(particles.attributes.value(1, 1), (Vec3{7, 8, 9}));
    EXPECT_EQ(particles.at(1).attributes[0].x, 200.0);
    EXPECT_EQ(particles.attributes.find("wind"), 1U);
    EXPECT_FALSE(particles.attributes.find("colour"));
}

TEST(AttributeTable, RefusesNamesThatAreTakenAndOddComponents) {
    const auto refused = [](std::vector<AttributeDescription> columns) {
        EXPECT_THROW(AttributeTable{std::move(columns)}, InputError);
    };
    refused({{"", 1, {}}});
    refused({{"mass", 1, {}}});
    refused({{"vx", 1, {}}});
    refused({{"a", 1, {}}, {"a", 3, {}}});
    refused({{"a", 2, {}}});
    refused({{"a", 1, missing_attribute()}});
    refused({{"color", 1, {}}});
    EXPECT_NO_THROW(AttributeTable({*looks_attribute("color"), *looks_attribute("opacity"), *looks_attribute("size")}));
}

TEST(LifeCurve, MultipliesTheInitialValueOfAParticle) {
    const KeyedCurve<Vec3> fade(std::vector<CurveKey<Vec3>>{{0.0, {1, 1, 1}}, {1.0, {0, 0.5, 0}}});
    const std::vector<LifeCurve> curves = {{"color", fade, true}, {"heat", fade, false}};
    EXPECT_EQ(shown_value(curves, "color", {1, 1, 0.5}, 2.0, 4.0), (Vec3{0.5, 0.75, 0.25}));
    EXPECT_EQ(shown_value(curves, "heat", {10, 0, 0}, 0.25, 4.0).x, 7.5);
    EXPECT_EQ(shown_value(curves, "mass", {10, 0, 0}, 0.25, 4.0).x, 10.0);
    EXPECT_EQ(shown_value(curves, "color", {1, 1, 1}, 2.0, std::numeric_limits<double>::infinity()), (Vec3{1, 1, 1}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
