#include "view/render/black_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "view/render/tone.h"

namespace ricochet {
namespace RICOCHET_FILE {

// Points of the Planckian locus: CIE standard illuminant A (2856 K by today's constants), and G. Wyszecki, W. S.
// Stiles, "Color Science", 1982, table 1(3.3.4). The fit to the matching functions has an error below 0.005.
TEST(BlackBody, HasTheColoursOfThePlanckianLocus) {
    struct Known {
        double kelvin, x, y;
    };
    for (const Known& known : {Known{2856, 0.4476, 0.4074}, Known{1500, 0.5857, 0.3931}, Known{4000, 0.3805, 0.3768},
                               Known{6500, 0.3135, 0.3237}, Known{10000, 0.2807, 0.2884}}) {
        const Vec3 xyz = black_body_xyz(known.kelvin);
        const double sum = xyz.x + xyz.y + xyz.z;
        EXPECT_NEAR(xyz.x / sum, known.x, 0.005) << known.kelvin;
        EXPECT_NEAR(xyz.y / sum, known.y, 0.005) << known.kelvin;
    }
}

// By Wien's law the luminance is proportional to exp(-c2 / (wavelength T)) for some visible wavelength.
TEST(BlackBody, BrightnessFollowsWiensLaw) {
    const BlackBody body(1500.0);
    EXPECT_NEAR(luminance(body.light(1500.0)), 1.0, 1e-12);
    for (const double kelvin : {800.0, 1000.0, 1300.0, 1800.0, 2500.0}) {
        const double exponent = std::log(luminance(body.light(kelvin)));
        const double wavelength = 1.438776877e-2 * (1.0 / 1500.0 - 1.0 / kelvin) / exponent;
        EXPECT_GT(wavelength, 560e-9) << kelvin;
        EXPECT_LT(wavelength, 660e-9) << kelvin;
    }
}

TEST(BlackBody, GlowIsRedThenYellowThenWhiteThenBlue) {
    const BlackBody body(3000.0);
    const Vec3 red = body.light(900.0);
    EXPECT_GT(red.x, 4.0 * red.y);
    EXPECT_EQ(red.z, 0.0);
    const Vec3 yellow = body.light(2800.0);
    EXPECT_GT(yellow.x, yellow.y);
    EXPECT_GT(yellow.y, 1.5 * yellow.z);
    const Vec3 blue = body.light(20000.0);
    EXPECT_GT(blue.z, blue.x);
}

TEST(BlackBody, InvalidTemperaturesGiveNoLight) {
    const BlackBody body(1500.0);
    for (const double kelvin : {0.0, -5.0, 1.0, std::nan(""), -std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(body.light(kelvin), Vec3{}) << kelvin;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
