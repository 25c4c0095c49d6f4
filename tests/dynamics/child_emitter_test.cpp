#include "ricochet/dynamics/child_emitter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

Emitter child_emitter(const ParentRule& rule, EmitterDescription description = {}) {
    description.name = "children";
    description.parent = rule;
    static const std::vector<AttributeDescription> columns = {{"heat", 1, {5, 0, 0}}, *looks_attribute("color")};
    return {std::move(description), 7, 3, {24.0, std::nullopt, columns}};
}

Particle parent_of(std::uint64_t lineage) {
    Particle parent;
    parent.position = {1, 2, 3};
    parent.velocity = {4, -5, 6};
    parent.mass = 0.7;
    parent.radius = 0.3;
    parent.birth_time = 0.25;
    parent.lifetime = 4.0;
    parent.origin.lineage = lineage;
    parent.attributes = {{77, 0, 0}, {0.1, 0.2, 0.3}};
    return parent;
}

TEST(ChildEmitter, BirthsDuringALifeDoNotDependOnTheTimeSteps) {
    EmitterDescription description;
    description.rate = {40.0, 30.0};
    const Emitter emitter = child_emitter({}, description);
    for (std::uint64_t lineage = 0; lineage < 50; ++lineage) {
        const Particle parent = parent_of(lineage);
        const std::vector<LifeBirth> whole = births_in_life(emitter, parent, 0.25, 4.25).first;
        for (const double step : {0.01, 1.0 / 24.0, 0.3}) {
            std::vector<LifeBirth> parts;
            for (double from = 0.25; from < 4.25; from = std::min(4.25, from + step)) {
                const auto some = births_in_life(emitter, parent, from, std::min(4.25, from + step)).first;
                parts.insert(parts.end(), some.begin(), some.end());
            }
            ASSERT_EQ(parts.size(), whole.size());
            for (std::size_t k = 0; k < parts.size(); ++k) {
                ASSERT_EQ(parts[k].time, whole[k].time);
                ASSERT_EQ(parts[k].ordinal, k);
            }
        }
    }
}

TEST(ChildEmitter, BirthsBeyondTheListedOnesAreCounted) {
    EmitterDescription description;
    description.rate = {40.0, 0.0};
    const Emitter few = child_emitter({}, description);
    const std::vector<LifeBirth> all = births_in_life(few, parent_of(1), 1.0, 2.0).first;
    ASSERT_EQ(all.size(), 40U);
    for (const std::size_t most : {0U, 1U, 39U, 40U, 41U}) {
        const LifeBirths births = births_in_life(few, parent_of(1), 1.0, 2.0, most);
        ASSERT_EQ(births.first.size(), std::min<std::size_t>(most, 40));
        EXPECT_EQ(births.more, 40 - births.first.size());
        for (std::size_t k = 0; k < births.first.size(); ++k) EXPECT_EQ(births.first[k].ordinal, all[k].ordinal);
    }
    // A list of all births would take sixteen gigabytes and a long time.
    description.rate = {1e12, 0.0};
    const LifeBirths many = births_in_life(child_emitter({}, description), parent_of(1), 0.25, 4.25, 3);
    EXPECT_EQ(many.first.size(), 3U);
    EXPECT_EQ(many.more, 1'000'000'000U - 3U);
}

TEST(ChildEmitter, EveryParentDrawsItsOwnRateAroundTheGivenMean) {
    EmitterDescription description;
    description.rate = {50.0, 20.0};
    const Emitter emitter = child_emitter({}, description);
    double sum = 0.0;
    const int parents = 2000;
    for (std::uint64_t lineage = 0; lineage < parents; ++lineage) {
        const auto count =
            static_cast<double>(births_in_life(emitter, parent_of(lineage * 977), 0.25, 4.25).first.size());
        EXPECT_GE(count, 4 * 30.0 - 1.0);
        EXPECT_LE(count, 4 * 70.0 + 1.0);
        sum += count;
    }
    // The distribution is uniform with half width 80 and standard deviation 46.2. The mean of 2000 parents has a
    // standard deviation of 1.03. The limit is five of them.
    EXPECT_NEAR(sum / parents, 200.0, 5.2);
}

TEST(ChildEmitter, ChildrenStartAtTheirParentWithPartOfItsVelocityAndItsAttributes) {
    ParentRule rule;
    rule.inherit_velocity = 0.5;
    const Particle child = make_child(child_emitter(rule), parent_of(9), 0, 1.5);
    EXPECT_EQ(child.position, (Vec3{1, 2, 3}));
    EXPECT_EQ(child.velocity, (Vec3{2, -2.5, 3}));
    EXPECT_EQ(child.birth_time, 1.5);
    EXPECT_EQ(child.origin.generation, 1U);
    EXPECT_EQ(child.origin.emitter, 3U);
    EXPECT_EQ(child.attributes[0].x, 77.0);
    EXPECT_EQ(child.attributes[1], (Vec3{0.1, 0.2, 0.3}));
}

TEST(ChildEmitter, ItsOwnColourIsMixedWithTheInheritedPart) {
    EmitterDescription description;
    description.attributes = {{"color", {1, 1, 1}, {}}};
    ParentRule rule;
    rule.inherit_color = 0.25;
    const Particle child = make_child(child_emitter(rule, description), parent_of(9), 0, 1.5);
    EXPECT_NEAR(child.attributes[1].x, 0.775, 1e-15);
    EXPECT_NEAR(child.attributes[1].z, 0.825, 1e-15);
}

TEST(ChildEmitter, ChildrenOfDifferentParentsAndOrdinalsDiffer) {
    EmitterDescription description;
    description.speed = {2.0, 1.0};
    const Emitter emitter = child_emitter({}, description);
    const Vec3 first = make_child(emitter, parent_of(1), 0, 0.0).velocity;
    EXPECT_EQ(first, make_child(emitter, parent_of(1), 0, 0.0).velocity);
    EXPECT_NE(first, make_child(emitter, parent_of(1), 1, 0.0).velocity);
    EXPECT_NE(first, make_child(emitter, parent_of(2), 0, 0.0).velocity);
}

TEST(ChildEmitter, FragmentsShareTheMassExactlyInAnyOrder) {
    EmitterDescription description;
    description.mass = {1.0, 0.9};
    description.speed = {3.0, 1.0};
    ParentRule rule;
    rule.on = BirthEvent::impact;
    rule.share = true;
    const Emitter emitter = child_emitter(rule, description);
    RandomSequence random(1, 2, 3);
    for (std::uint64_t k = 0; k < 500; ++k) {
        Particle parent = parent_of(k);
        parent.mass = 1e-6 + 1e3 * random.uniform();
        auto fragments = make_fragments(emitter, parent, 1 + static_cast<std::uint32_t>(k % 40), 0, 1.0);
        for (int order = 0; order < 3; ++order) {
            double sum = 0.0;
            for (const Particle& fragment : fragments) sum += fragment.mass;
            ASSERT_EQ(sum, parent.mass);
            std::rotate(fragments.begin(), fragments.begin() + static_cast<std::ptrdiff_t>(fragments.size() / 2),
                        fragments.end());
            std::sort(fragments.begin(), fragments.end(), [&](const Particle& a, const Particle& b) {
                return order == 0 ? a.mass < b.mass : a.mass > b.mass;
            });
        }
        Vec3 momentum;
        double volume = 0.0;
        double scale = 0.0;
        for (const Particle& fragment : fragments) {
            ASSERT_GT(fragment.mass, 0.0);
            momentum += fragment.mass * fragment.velocity;
            scale += fragment.mass * length(fragment.velocity);
            volume += std::pow(fragment.radius, 3.0);
        }
        ASSERT_LT(length(momentum - parent.mass * parent.velocity), 1e-14 * scale);
        ASSERT_NEAR(volume, std::pow(parent.radius, 3.0), 1e-14);
    }
}

TEST(ChildEmitter, FragmentsOfATinyMassAreNeverLighterThanTheSmallestMass) {
    EmitterDescription description;
    description.mass = {1.0, 0.999};
    description.speed = {2.0, 1.0};
    ParentRule sharing;
    sharing.on = BirthEvent::death;
    sharing.share = true;
    const Emitter emitter = child_emitter(sharing, description);
    for (const double units : {1.0, 1.5, 3.0, 10.0, 1234.5, 1e7, 1e17}) {
        Particle parent = parent_of(3);
        parent.mass = units * 1e-300;
        ASSERT_EQ(most_fragments(parent.mass), static_cast<std::uint32_t>(std::min(units, 1e9)));
        for (const std::uint32_t wanted : {1U, 2U, 9U, 40U}) {
            const std::uint32_t count = std::min(wanted, most_fragments(parent.mass));
            const std::vector<Particle> fragments = make_fragments(emitter, parent, count, 0, 1.0);
            ASSERT_EQ(fragments.size(), count);
            double sum = 0.0;
            Vec3 momentum;
            for (const Particle& fragment : fragments) {
                // Each fragment gets exactly the smallest mass, up to the rounding of its share.
                EXPECT_GE(fragment.mass, 1e-300 * (1.0 - 1e-14)) << units << " in " << count;
                EXPECT_TRUE(is_finite(fragment.velocity) && std::isfinite(fragment.radius));
                sum += fragment.mass;
                momentum += fragment.mass / parent.mass * fragment.velocity;
            }
            EXPECT_EQ(sum, parent.mass) << units << " in " << count;
            EXPECT_LT(length(momentum - parent.velocity), 1e-12) << units << " in " << count;
        }
    }
}

TEST(ChildEmitter, TheKineticEnergyGrowsByTheLaunchesRelativeToTheirCentreOfMass) {
    EmitterDescription description;
    description.speed = {3.0, 0.0};
    description.mass = {1.0, 0.5};
    ParentRule rule;
    rule.on = BirthEvent::death;
    rule.share = true;
    const Emitter emitter = child_emitter(rule, description);
    const Particle parent = parent_of(5);
    const auto fragments = make_fragments(emitter, parent, 200, 0, 1.0);
    double energy = 0.0;
    for (const Particle& fragment : fragments) energy += 0.5 * fragment.mass * length_squared(fragment.velocity);
    // The centre of mass of 200 launches at 3 m/s in random directions moves at about 3 / sqrt(200) m/s.
    const double own = energy - 0.5 * parent.mass * length_squared(parent.velocity);
    EXPECT_LE(own, 0.5 * parent.mass * 9.0 * (1.0 + 1e-12));
    EXPECT_GE(own, 0.5 * parent.mass * 9.0 * 0.95);
}

TEST(ChildEmitter, CountsAreDrawnAroundTheirMeanAndNeverNegative) {
    ParentRule rule;
    rule.on = BirthEvent::death;
    rule.count = {1.0, 3.0};
    const Emitter emitter = child_emitter(rule);
    double sum = 0.0;
    const int parents = 20000;
    for (std::uint64_t k = 0; k < parents; ++k) {
        const std::uint32_t count = children_of_event(emitter, parent_of(k), 0);
        ASSERT_LE(count, 4U);
        sum += count;
    }
    // The counts are uniform in -2..4, rounded, and cut off below 0. Their mean is (1 + 2 + 3 + 4 / 2) / 6 = 4 / 3, and
    // their standard deviation 1.37. The limit is five sigma.
    EXPECT_NEAR(sum / parents, 4.0 / 3.0, 5.0 * 1.37 / std::sqrt(parents));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
