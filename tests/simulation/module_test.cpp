// Tests of the list of modules: order of calls, plans of substeps, and deferred steps.
#include "ricochet/simulation/module.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {
namespace RICOCHET_FILE {

/// Writes its letter at each call, and ends substeps after a duration.
class LetterModule final : public Module {
public:
    LetterModule(char letter, double longest, bool defers, std::string& calls)
        : letter_(letter), longest_(longest), defers_(defers), calls_(calls) {}

    void begin_step(const TimeSpan& /*step*/) override { calls_ += letter_; }
    double plan(const ParticleRange& /*generation*/, const TimeSpan& rest) override {
        return std::min(rest.end, rest.begin + longest_);
    }
    [[nodiscard]] bool allows_deferred_steps() const override { return defers_; }

private:
    char letter_;
    double longest_;
    bool defers_;
    std::string& calls_;
};

TEST(ModuleList, CallsModulesInTheOrderOfTheirAddition) {
    std::string calls;
    ModuleList modules;
    for (const char letter : {'a', 'b', 'c'}) modules.add(std::make_unique<LetterModule>(letter, 1.0, true, calls));
    modules.each([](Module& module) { module.begin_step({0.0, 1.0}); });
    EXPECT_EQ(calls, "abc");
}

TEST(ModuleList, EndsASubstepWithTheShortestPlan) {
    std::string calls;
    ModuleList modules;
    EXPECT_EQ(modules.plan({}, {2.0, 3.0}).end, 3.0);
    modules.add(std::make_unique<LetterModule>('a', 0.5, true, calls));
    modules.add(std::make_unique<LetterModule>('b', 0.25, true, calls));
    modules.add(std::make_unique<LetterModule>('c', 0.75, true, calls));
    EXPECT_EQ(modules.plan({}, {2.0, 3.0}).begin, 2.0);
    EXPECT_EQ(modules.plan({}, {2.0, 3.0}).end, 2.25);
    EXPECT_EQ(modules.plan({}, {2.0, 2.125}).end, 2.125);
}

TEST(ModuleList, DefersStepsOnlyIfEachModuleAllowsIt) {
    std::string calls;
    ModuleList modules;
    EXPECT_TRUE(modules.allow_deferred_steps());
    modules.add(std::make_unique<LetterModule>('a', 1.0, true, calls));
    EXPECT_TRUE(modules.allow_deferred_steps());
    modules.add(std::make_unique<LetterModule>('b', 1.0, false, calls));
    EXPECT_FALSE(modules.allow_deferred_steps());
}

TEST(ModuleList, FindsAModuleByItsClass) {
    class Other final : public Module {};
    std::string calls;
    ModuleList modules;
    EXPECT_EQ(modules.find<LetterModule>(), nullptr);
    modules.add(std::make_unique<LetterModule>('a', 1.0, true, calls));
    ASSERT_NE(modules.find<LetterModule>(), nullptr);
    modules.find<LetterModule>()->begin_step({0.0, 1.0});
    EXPECT_EQ(calls, "a");
    EXPECT_EQ(modules.find<Other>(), nullptr);
}

TEST(ModuleList, AsksAllModulesForSpawnedParticles) {
    class Parent final : public Module {
    public:
        explicit Parent(bool has_children) : has_children_(has_children) {}
        bool spawn(const TimeSpan& /*step*/) override {
            ++calls;
            return has_children_;
        }
        int calls = 0;

    private:
        bool has_children_;
    };
    ModuleList modules;
    EXPECT_FALSE(modules.spawn({0.0, 1.0}));
    modules.add(std::make_unique<Parent>(true));
    auto childless = std::make_unique<Parent>(false);
    const Parent& last = *childless;
    modules.add(std::move(childless));
    EXPECT_TRUE(modules.spawn({0.0, 1.0}));
    EXPECT_EQ(last.calls, 1);
}

TEST(Module, DoesNothingByDefault) {
    class Idle final : public Module {};
    Idle idle;
    std::vector<BlockRecord> blocks(1);
    std::vector<ColliderLoad> loads(2);
    SimulationStatistics statistics;
    EXPECT_EQ(idle.plan({}, {0.0, 0.5}), 0.5);
    idle.after_substep({}, {0.0, 0.5}, blocks);
    idle.record({}, blocks, loads);
    idle.correct({}, {0.0, 0.5}, blocks);
    idle.end_step(statistics);
    EXPECT_EQ(blocks.size(), 1U);
    EXPECT_EQ(loads.size(), 2U);
    EXPECT_EQ(statistics.unsolved_steps, 0U);
    EXPECT_FALSE(idle.spawn({0.0, 0.5}));
    EXPECT_EQ(idle.fault_of(0), nullptr);
    EXPECT_EQ(idle.fault(0.0), nullptr);
    EXPECT_FALSE(idle.allows_deferred_steps());
}

/// Counts the moves that it reads.
class ReadingModule final : public Module {
public:
    explicit ReadingModule(const MoveParts& parts) : parts_(parts) {}

    [[nodiscard]] MoveParts needs() const override { return parts_; }
    void observe(const MoveReport& move, BlockRecord& block) override {
        ++moves;
        block.heat.push_back({move.index, move.end, 1.0});
    }

    int moves = 0;

private:
    MoveParts parts_;
};

TEST(ModuleList, ReportsMovesToModulesThatNeedParts) {
    ModuleList modules;
    std::vector<ReadingModule*> readers;
    for (const MoveParts& parts : {MoveParts{}, MoveParts{.segments = true}, MoveParts{.motions = true}}) {
        auto reader = std::make_unique<ReadingModule>(parts);
        readers.push_back(reader.get());
        modules.add(std::move(reader));
    }
    const MoveObservers& observers = modules.hooks().observers;
    EXPECT_FALSE(observers.needs().pieces);
    EXPECT_TRUE(observers.needs().segments);
    EXPECT_TRUE(observers.needs().motions);
    const Particles particles;
    const ForceInput moved{};
    MoveReport report{3, particles, moved};
    report.end = 0.5;
    BlockRecord block;
    observers.report(report, block);
    EXPECT_EQ(readers[0]->moves, 0);
    EXPECT_EQ(readers[1]->moves, 1);
    EXPECT_EQ(readers[2]->moves, 1);
    ASSERT_EQ(block.heat.size(), 2U);
    EXPECT_EQ(block.heat[0].particle, 3U);
    EXPECT_EQ(block.heat[0].time, 0.5);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
