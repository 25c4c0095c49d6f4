/// \file
/// The files that make a page: three.js and our own, as they stand in the repository, kept in the program.
#pragma once

#include <string_view>

namespace ricochet {

/// The contents of the file of that name (`three.core.js`, `page.css`). To ask for one that is not kept is a mistake of
/// the program: RunError.
[[nodiscard]] std::string_view page_file(std::string_view name);

}  // namespace ricochet
