/// \file
/// Files of a page, embedded in the program: three.js and the scripts of this repository.
#pragma once

#include <string_view>

namespace ricochet {

/// Returns the contents of an embedded file by name (`three.core.js`, `page.css`). Throws RunError for an unknown
/// name, which is a programming error.
[[nodiscard]] std::string_view page_file(std::string_view name);

}  // namespace ricochet
