/// \file
/// Hints for common typing errors in JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace ricochet::detail {

struct JsonHint {
    std::size_t position = 0;  ///< offset in the text, in bytes
    std::string text;
};

/// Returns a hint for a missing comma or colon, or for a superfluous comma. Returns nothing for other errors. position:
/// number of bytes that the parser had read when it stopped. message: error message of the parser.
[[nodiscard]] std::optional<JsonHint> json_hint(std::string_view text, std::size_t position, std::string_view message);

}  // namespace ricochet::detail
