#include "lab/bench/cases.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "ricochet/core/error.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

TEST(BenchSuites, HaveUniqueNames) {
    const std::vector<std::string> names = suite_names();
    const std::set<std::string> different(names.begin(), names.end());
    EXPECT_EQ(different.size(), names.size());
    EXPECT_EQ(different, (std::set<std::string>{"gas", "settle", "hail", "rain", "pinball", "wedge", "size", "count",
                                                "threads", "radius", "response", "moving", "pairs", "load", "quick"}));
    for (const std::string& name : names) EXPECT_NO_THROW(require_suite(name));
}

TEST(BenchSuites, UnknownSuitesAreRefusedWithTheNamesOfAll) {
    try {
        require_suite("juggle");
        FAIL();
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("--suite juggle"), std::string::npos) << message;
        for (const std::string& name : suite_names()) EXPECT_NE(message.find(name), std::string::npos) << message;
    }
}

TEST(BenchSuites, UseAllThreadsExceptThatTheThreadSuiteDoublesThem) {
    EXPECT_EQ(default_threads("gas", 8), (std::vector<int>{0}));
    EXPECT_EQ(default_threads("threads", 1), (std::vector<int>{1}));
    EXPECT_EQ(default_threads("threads", 2), (std::vector<int>{1, 2}));
    EXPECT_EQ(default_threads("threads", 8), (std::vector<int>{1, 2, 4, 8}));
    EXPECT_EQ(default_threads("threads", 12), (std::vector<int>{1, 2, 4, 8, 12}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
