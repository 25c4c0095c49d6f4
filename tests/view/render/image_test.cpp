#include "view/render/image.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

#include <memory>

#include "ricochet/core/error.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

Image gradient(int width, int height) {
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (const int value : {x, y, x * y}) image.rgb.push_back(static_cast<std::uint8_t>(value));
        }
    }
    return image;
}

TEST(Png, DecodesToTheSamePixels) {
    const Image image = gradient(37, 21);
    const test::TemporaryFolder folder;
    write_png(folder.path("a.png"), image);
    int width = 0;
    int height = 0;
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load(folder.path("a.png").c_str(), &width, &height, &channels, 3), stbi_image_free);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(width, 37);
    EXPECT_EQ(height, 21);
    EXPECT_EQ(channels, 3);
    EXPECT_TRUE(std::equal(image.rgb.begin(), image.rgb.end(), pixels.get()));
}

TEST(Png, FailedWriteLeavesNoFiles) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(write_png(folder.path("none") / "a.png", gradient(2, 2)), RunError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path("")));
}

TEST(Image, PixelsAreCountedFromTheTopLeft) { EXPECT_EQ(gradient(5, 4).pixel(3, 2), (std::array<int, 3>{3, 2, 6})); }

TEST(Png, WrittenFilesAreReadBack) {
    const test::TemporaryFolder folder;
    Image image = gradient(5, 3);
    write_png(folder.path("opaque.png"), image);
    EXPECT_EQ(read_png(folder.path("opaque.png")).rgb, image.rgb);
    EXPECT_TRUE(read_png(folder.path("opaque.png")).alpha.empty());
    for (int i = 0; i < 15; ++i) image.alpha.push_back(static_cast<std::uint8_t>(17 * i));
    write_png(folder.path("clear.png"), image);
    const Image read = read_png(folder.path("clear.png"));
    EXPECT_EQ(read.rgb, image.rgb);
    EXPECT_EQ(read.alpha, image.alpha);
    EXPECT_EQ(read.width, 5);
    EXPECT_EQ(read.height, 3);
}

TEST(Png, RefusesOtherFilesAndDamagedOnes) {
    const test::TemporaryFolder folder;
    EXPECT_THROW((void)read_png(folder.path("missing.png")), InputError);
    EXPECT_THROW((void)read_png(folder.write("text.png", "no picture")), InputError);
    const std::string whole = png_bytes(gradient(40, 40));
    EXPECT_THROW((void)read_png(folder.write("cut.png", whole.substr(0, whole.size() / 2))), InputError);
    std::string huge = whole;
    huge[16] = '\x7f';  // the width
    EXPECT_THROW((void)read_png(folder.write("huge.png", huge)), InputError);
}

TEST(Png, RefusesChunksLongerThanTheFile) {
    const test::TemporaryFolder folder;
    const std::string whole = png_bytes(gradient(40, 40));
    const std::size_t data = whole.find("IDAT");
    ASSERT_NE(data, std::string::npos);
    for (const char* length : {"\xff\xff\xff\xff", "\x7f\xff\xff\xff", "\x40\x01\x01\x01", "\x80\x01\x01\x01"}) {
        std::string damaged = whole;
        damaged.replace(data - 4, 4, length, 4);
        EXPECT_THROW((void)read_png(folder.write("chunk.png", damaged)), InputError);
    }
}

// Reading a pipe would block, and a device may never end.
TEST(Png, RefusesEverythingButRegularFiles) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo(folder.path("pipe.png").c_str(), 0600), 0);
    for (const std::filesystem::path& file :
         {folder.path("pipe.png"), folder.path(""), std::filesystem::path("/dev/zero")}) {
        EXPECT_THROW((void)read_png(file), InputError) << file;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
