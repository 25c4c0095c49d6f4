#include "view/page/packing.h"

#include <gtest/gtest.h>

#include "ricochet/core/random.h"
#include "view/page/page_reader.h"

namespace ricochet {
namespace RICOCHET_FILE {

// The examples of RFC 4648, section 10.
TEST(Packing, WritesBytesAsTextOfSixBitsEach) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64(std::string("\xff\xfe\xfd\x00", 4)), "//79AA==");
}

TEST(Packing, UnpackingRestoresPackedBytes) {
    RandomSequence random(5, 1, 0);
    for (const std::size_t size : {0U, 1U, 2U, 3U, 1000U, 70'000U}) {
        std::string bytes(size, '\0');
        for (char& byte : bytes) byte = static_cast<char>(static_cast<int>(4.0 * random.uniform()));
        const std::string packed = deflated(bytes);
        EXPECT_EQ(test::unpacked(base64(packed)), bytes) << size;
        EXPECT_LT(packed.size(), size / 3 + 100);
    }
}

TEST(Packing, SmallNumbersTakeFewBytes) {
    ByteWriter out;
    for (const std::uint64_t value : {0ULL, 127ULL, 128ULL, 1ULL << 53}) out.varint(value);
    out.signed_varint(-1);
    out.signed_varint(-64);
    out.signed_varint(64);
    EXPECT_EQ(out.bytes().size(), 1U + 1U + 2U + 8U + 1U + 1U + 2U);
    test::PageBytes in(out.bytes());
    for (const std::uint64_t value : {0ULL, 127ULL, 128ULL, 1ULL << 53}) EXPECT_EQ(in.varint(), value);
    EXPECT_EQ(in.signed_varint(), -1);
    EXPECT_EQ(in.signed_varint(), -64);
    EXPECT_EQ(in.signed_varint(), 64);
}

TEST(Packing, HtmlTextEscapesTheCharactersOfTags) { EXPECT_EQ(html_text("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;"); }

}  // namespace RICOCHET_FILE
}  // namespace ricochet
