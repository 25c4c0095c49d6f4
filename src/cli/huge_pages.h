// Large arrays on large pages, for the whole program.
#pragma once

namespace ricochet::cli {

/// False where the program's memory comes from elsewhere: the system has no such advice, or a sanitizer serves it.
[[nodiscard]] bool requests_huge_pages();

}  // namespace ricochet::cli
