#include "python/scene_forces.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::uint64_t of(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return forces_fingerprint(text, overrides);
}

TEST(ForcesFingerprint, FingerprintDependsOnTheForcesAndNotOnTheirSpelling) {
    const std::uint64_t gravity = of(R"({"forces": [{"type": "gravity", "acceleration": [0, 0, -9]}]})");
    EXPECT_EQ(of(R"({"simulation": {"duration": 7},
                     "forces": [{"acceleration": [0.0, 0, -9e0], "type": "gravity"}], "flows": {}})"),
              gravity);
    EXPECT_EQ(of("{}"), of(R"({"forces": [], "particle_forces": []})"));
}

TEST(ForcesFingerprint, FingerprintChangesWithAForceOrAFlow) {
    const std::string one = R"({"forces": [{"type": "gravity", "acceleration": [0, 0, -9]}]})";
    EXPECT_NE(of(one), of("{}"));
    EXPECT_NE(of(one), of(one, {"forces[0].acceleration=[0, 0, -8]"}));
    EXPECT_EQ(of(one), of(one, {"simulation.duration=3"}));
    EXPECT_NE(of(R"({"forces": [{"type": "gravity"}]})"), of(R"({"particle_forces": [{"type": "gravity"}]})"));
    EXPECT_NE(of(R"({"flows": {"wind": {"type": "uniform", "velocity": [1, 0, 0]}}})"),
              of(R"({"flows": {"wind": {"type": "uniform", "velocity": [2, 0, 0]}}})"));
}

TEST(ForcesFingerprint, InvalidJsonIsRefused) { EXPECT_THROW((void)of("{"), InputError); }

}  // namespace RICOCHET_FILE
}  // namespace ricochet
