/// \file
/// Errors, warnings and notes on a scene, which are collected, and helper functions for their texts.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/io/scene/document.h"

namespace ricochet::detail {

/// Return the path of a value in the document, for example "colliders[1].file". Keys are quoted unless they are plain.
[[nodiscard]] std::string path_of_key(const std::string& parent, std::string_view key);
[[nodiscard]] std::string path_of_item(const std::string& parent, std::size_t index);

/// Errors, warnings and notes with their source locations.
class Diagnostics {
public:
    /// file: name of the scene file as the user wrote it. overrides: the `--set` arguments.
    Diagnostics(std::string file, std::vector<std::string> overrides);

    /// Records an error. path: path of the value; empty if the error concerns no single value.
    void error(const SourceLocation& location, const std::string& path, std::string_view what);
    void warning(const SourceLocation& location, const std::string& path, std::string_view what);
    /// Records a correct operation that the scene did not request explicitly, for example a change of the up axis.
    void note(const SourceLocation& location, const std::string& path, std::string_view what);

    [[nodiscard]] bool failed() const { return !errors_.empty(); }
    /// Return one line per entry, in the order of source locations. After ten errors, or a hundred warnings or notes, a
    /// last line states the number of further entries.
    [[nodiscard]] std::vector<std::string> errors() const;
    [[nodiscard]] std::vector<std::string> warnings() const;
    [[nodiscard]] std::vector<std::string> notes() const;
    [[nodiscard]] const std::vector<std::string>& overrides() const { return overrides_; }

private:
    struct Entry {
        SourceLocation location;
        std::string line;
    };
    [[nodiscard]] Entry entry(const SourceLocation& location, const std::string& path, std::string_view what) const;
    [[nodiscard]] static std::vector<std::string> lines(std::vector<Entry> entries, std::size_t most);

    std::string file_;
    std::vector<std::string> overrides_;
    std::vector<Entry> errors_;
    std::vector<Entry> warnings_;
    std::vector<Entry> notes_;
};

/// Returns the smallest number of insertions, deletions, replacements, and swaps of neighbours that turn a into b
/// (optimal string alignment). Method: F. J. Damerau, "A technique for computer detection and correction of spelling
/// errors", CACM 7(3), 1964.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// Returns all candidates at the smallest edit distance from the word. The list is empty if this distance is too large.
/// Case, hyphens, underscores and blanks are ignored, so timeStep matches time_step.
[[nodiscard]] std::vector<std::string_view> nearest_names(std::string_view word,
                                                          const std::vector<std::string_view>& candidates);

/// Returns a suggestion such as `did you mean "a" or "b"?`. Empty if there are no names.
[[nodiscard]] std::string did_you_mean(const std::vector<std::string_view>& names);

/// Returns `"a", "b", "c"`.
[[nodiscard]] std::string quoted_list(const std::vector<std::string_view>& names);

}  // namespace ricochet::detail
