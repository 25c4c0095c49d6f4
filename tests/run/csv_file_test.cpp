#include "run/csv_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;

std::string written(double value) {
    const TemporaryFolder folder;
    CsvFile file(folder.path("a.csv"), "x");
    file.add(value);
    file.end_row();
    file.commit();
    const std::string text = folder.read("a.csv");
    return text.substr(2, text.size() - 3);
}

TEST(CsvFile, NumbersReadBackAsTheSameDoubles) {
    EXPECT_EQ(written(0.0), "0.0");
    EXPECT_EQ(written(-0.0), "-0.0");
    EXPECT_EQ(written(5.0), "5.0");
    EXPECT_EQ(written(0.1), "0.1");
    EXPECT_EQ(written(1e300), "1e+300");
    EXPECT_EQ(written(-std::numeric_limits<double>::infinity()), "-inf");
    EXPECT_EQ(written(std::numeric_limits<double>::quiet_NaN()), "nan");
    RandomSequence random(3, 0, 0);
    for (int k = 0; k < test::scaled(300); ++k) {
        const double value = std::ldexp(random.uniform_around(0, 1), static_cast<int>(random.uniform_around(0, 1070)));
        const std::string text = written(value);
        double read = 0.0;
        (void)std::from_chars(text.data(), text.data() + text.size(), read);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(value)) << text;
    }
}

TEST(CsvFile, FieldsAreQuotedIfNecessary) {
    EXPECT_EQ(csv_field("plain name"), "plain name");
    EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
    EXPECT_EQ(csv_field("a \"b\""), "\"a \"\"b\"\"\"");
    EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
    const TemporaryFolder folder;
    CsvFile file(folder.path("a.csv"), "a,b,c,d,e");
    file.add(std::string_view("x,y"));
    file.skip(2);
    file.add(std::uint8_t{7});
    file.add(std::int64_t{-1});
    file.end_row();
    EXPECT_FALSE(std::filesystem::exists(folder.path("a.csv")));  // not before it is complete
    file.commit();
    EXPECT_EQ(folder.read("a.csv"), "a,b,c,d,e\n\"x,y\",,,7,-1\n");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
