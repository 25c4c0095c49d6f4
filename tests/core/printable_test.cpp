#include "ricochet/core/printable.h"

#include <gtest/gtest.h>

#include <string>

namespace ricochet {
namespace RICOCHET_FILE {

using namespace std::string_view_literals;

TEST(Printable, LeavesTextAsItIs) {
    for (const std::string_view text :
         {""sv, "stone 3"sv, "gr\u00fcn \u00b5m \u65e5\u672c \U0001F30D"sv, "a\\n\"b\""sv}) {
        EXPECT_EQ(printable(text), text);
    }
}

TEST(Printable, EscapesCharactersThatTerminalsObey) {
    EXPECT_EQ(printable("a\x1b[31mred\n\r\t\x7f\0z"sv), "a\\x1b[31mred\\n\\r\\t\\x7f\\x00z");
    EXPECT_EQ(printable("\u009b31m"), "\\x9b31m");  // control characters of the C1 block
    EXPECT_EQ(printable("a\u202egpj.exe"), "a\\u202egpj.exe");
    EXPECT_EQ(printable("\u2066\u200f"), "\\u2066\\u200f");
}

TEST(Printable, EscapesBytesThatAreNoText) {
    EXPECT_EQ(printable("\xff\xc0\xaf\xe2\x82"sv), "\\xff\\xc0\\xaf\\xe2\\x82");
    EXPECT_EQ(printable("\x9b"sv), "\\x9b");
}

TEST(Printable, IsTruncatedToTheGivenLength) {
    EXPECT_EQ(printable("abcdef", 3), "abc...");
    EXPECT_EQ(printable("abc", 3), "abc");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
