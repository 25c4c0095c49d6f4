/// \file
/// What is wrong with a scene, collected so that one run shows all of it, and the words that messages are made of.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/io/scene/document.h"

namespace ricochet::detail {

/// Where in the document a value is, as text: "colliders[1].file". Keys that are not plain words are quoted.
[[nodiscard]] std::string path_of_key(const std::string& parent, std::string_view key);
[[nodiscard]] std::string path_of_item(const std::string& parent, std::size_t index);

/// Errors, warnings and notes with their source locations.
class Diagnostics {
public:
    /// file: the scene file's name as the user wrote it. overrides: the `--set` arguments.
    Diagnostics(std::string file, std::vector<std::string> overrides);

    /// path: empty where no single value is meant.
    void error(const SourceLocation& location, const std::string& path, std::string_view what);
    void warning(const SourceLocation& location, const std::string& path, std::string_view what);
    /// What is done without being asked for in so many words, and is as it should be.
    void note(const SourceLocation& location, const std::string& path, std::string_view what);

    [[nodiscard]] bool failed() const { return !errors_.empty(); }
    /// One line each, in the order of their source locations; behind ten errors, or a hundred others, their count.
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

/// Insertions, deletions, replacements and swaps of neighbours that turn a into b (optimal string alignment).
/// Method: F. J. Damerau, "A technique for computer detection and correction of spelling errors", CACM 7(3), 1964.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidates nearest to the word, all those at the same distance; none when even the nearest is far. Case,
/// hyphens, underscores and blanks count nothing, so that timeStep is next to time_step.
[[nodiscard]] std::vector<std::string_view> nearest_names(std::string_view word,
                                                          const std::vector<std::string_view>& candidates);

/// `did you mean "a" or "b"?`; empty without names.
[[nodiscard]] std::string did_you_mean(const std::vector<std::string_view>& names);

/// `"a", "b", "c"`
[[nodiscard]] std::string quoted_list(const std::vector<std::string_view>& names);

}  // namespace ricochet::detail
