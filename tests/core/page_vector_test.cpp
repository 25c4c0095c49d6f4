#include "ricochet/core/page_vector.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>

namespace ricochet {
namespace RICOCHET_FILE {

struct alignas(64) Line {
    std::uint64_t value[8];
};

std::uintptr_t place_of(const void* memory) { return reinterpret_cast<std::uintptr_t>(memory); }

TEST(PageVector, UsesSeparatePagesFromTheStatedSizeOn) {
    const PageVector<std::uint64_t> small(kLeastOwnPages / sizeof(std::uint64_t) - 1);
    EXPECT_TRUE(own_pages(small).empty());
    const PageVector<std::uint64_t> large(kLeastOwnPages / sizeof(std::uint64_t));
    EXPECT_EQ(own_pages(large).size(), kLeastOwnPages);
    EXPECT_EQ(place_of(large.data()) % static_cast<std::uintptr_t>(::getpagesize()), 0U);
    EXPECT_TRUE(own_pages(PageVector<std::uint64_t>()).empty());
}

TEST(PageVector, KeepsItsElementsWhileItGrowsIntoPagesAndIsCopied) {
    PageVector<std::uint32_t> list;
    for (std::uint32_t k = 0; k < 300'000; ++k) list.push_back(k);
    const PageVector<std::uint32_t> copy = list;
    list.clear();
    list.shrink_to_fit();
    std::uint64_t sum = std::accumulate(copy.begin(), copy.end(), std::uint64_t{0});
    EXPECT_EQ(sum, 300'000ULL * 299'999ULL / 2);
}

TEST(PageVector, AlignsSmallListsToo) {
    const PageVector<Line> lines(3);
    EXPECT_EQ(place_of(lines.data()) % alignof(Line), 0U);
}

TEST(PageVector, ThrowsIfMemoryRunsOut) {
    constexpr std::size_t kMost = std::numeric_limits<std::ptrdiff_t>::max();
    EXPECT_THROW(static_cast<void>(PageVector<std::uint8_t>(kMost)), std::bad_alloc);
}

TEST(PageVector, WorksAsBeforeOnceItsPagesAreReplaced) {
    PageVector<std::uint64_t> list(100'001);
    std::iota(list.begin(), list.end(), std::uint64_t{5});
    const auto pages = own_pages(list);
    const int file = ::memfd_create("pages", MFD_CLOEXEC);
    ASSERT_EQ(::write(file, pages.data(), pages.size()), static_cast<::ssize_t>(pages.size()));
    void* const place = const_cast<std::byte*>(pages.data());
    ASSERT_EQ(::mmap(place, pages.size(), PROT_READ, MAP_SHARED | MAP_FIXED, file, 0), place);
    (void)::close(file);
    for (std::uint64_t k = 0; k < list.size(); ++k) ASSERT_EQ(list[k], k + 5);
    list = {};
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
