#include "lab/bench/records.h"

#include <gtest/gtest.h>

#include <regex>
#include <string>

namespace ricochet::bench {
namespace RICOCHET_FILE {

TEST(BenchEnvironment, NamesTheMachineByItsProcessor) {
    EXPECT_EQ(machine_slug("Intel(R) Xeon(R) Platinum 8488C", 2), "xeon-platinum-8488c-2t");
    EXPECT_EQ(machine_slug("Intel(R) Core(TM) i7-8550U CPU @ 1.80GHz", 8), "i7-8550u-8t");
    EXPECT_EQ(machine_slug("AMD EPYC 7763 64-Core Processor", 128), "epyc-7763-64-128t");
    EXPECT_EQ(machine_slug("", 4), "unknown-4t");
    EXPECT_EQ(machine_slug("../../Processor", 4), "unknown-4t");
}

TEST(BenchEnvironment, HasAllFields) {
    const Environment here = this_environment("1.2.3");
    for (const Field& field : record_of(here)) {
        const auto* text = std::get_if<std::string>(&field.value);
        EXPECT_TRUE(text == nullptr || !text->empty()) << field.name;
    }
    EXPECT_EQ(here.ricochet, "1.2.3");
    EXPECT_GE(here.hardware_threads, 1);
    EXPECT_EQ(here.machine, machine_slug(here.cpu, here.hardware_threads));
    EXPECT_NE(here.build_flags.find("-ffp-contract=off"), std::string::npos) << here.build_flags;
    EXPECT_EQ(here.build_flags.find("-W"), std::string::npos) << here.build_flags;
    EXPECT_TRUE(std::regex_match(here.date, std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)"))) << here.date;
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
