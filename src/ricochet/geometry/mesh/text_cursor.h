/// \file
/// Private to the mesh readers: words and numbers of a text, line by line, with the line number for errors.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/mesh_source.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

/// Walks through a text once. Lines end with LF, CR LF or CR. Numbers are read without any locale.
///
/// What is asked for every character or word is inline and answers the common case (a printable character, one blank,
/// a lone LF) at once; everything else, comments and continuation lines too, is left to the `_slowly` functions, which
/// hold the whole rule.
class TextCursor {
public:
    /// How a format writes what is not data.
    struct Syntax {
        bool hash_comments = false;             ///< '#' starts a comment that ends with the line
        bool backslash_continues_line = false;  ///< a backslash at the end joins the next line
    };

    /// Starts at the first line, after a UTF-8 byte order mark if there is one.
    TextCursor(const MeshSource& source, Syntax syntax)
        : TextCursor(source, source.bytes.starts_with("\xef\xbb\xbf") ? 3 : 0, 1, syntax) {}
    /// Starts at a byte that begins the given line.
    TextCursor(const MeshSource& source, std::size_t first_byte, std::size_t first_line, Syntax syntax)
        : source_(source),
          at_(source.bytes.data() + first_byte),
          end_(source.bytes.data() + source.bytes.size()),
          line_(first_line),
          syntax_(syntax) {}

    /// True when nothing but blanks (and a comment) is left on the line.
    [[nodiscard]] bool at_line_end() {
        if (comes_next(' ')) ++at_;
        return !comes_plain() && at_line_end_slowly();
    }
    [[nodiscard]] bool at_text_end() const { return at_ == end_; }
    /// Next word of the line; empty at its end.
    [[nodiscard]] std::string_view word();
    /// Rest of the line without blanks at its ends, comments included.
    [[nodiscard]] std::string_view rest_of_line();
    /// Goes to the start of the next line.
    void next_line() {
        if (!comes_next('\n')) return next_line_slowly();
        ++at_;
        ++line_;
    }
    /// Goes to the next line that has a word; false when there is none.
    [[nodiscard]] bool next_filled_line();
    /// Number of the line the cursor is in; 1 for the first.
    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] const MeshSource& source() const { return source_; }
    [[nodiscard]] std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

    /// Next word of the line as a finite number; `what` names it in errors.
    [[nodiscard]] double number(const char* what);
    /// The same within the range of coordinates; tiny values become zero.
    [[nodiscard]] double coordinate(const char* what);
    [[nodiscard]] Vec3 point(const char* what);
    /// Next word of the line as an integer.
    [[nodiscard]] std::int64_t integer(const char* what);
    /// An integer that may be followed by other characters of the same word (OBJ corners).
    [[nodiscard]] std::int64_t integer_part(const char* what);
    /// Takes one character if it comes next, without skipping blanks.
    [[nodiscard]] bool take(char c);
    /// True if the character comes next, without skipping blanks.
    [[nodiscard]] bool comes_next(char c) const { return at_ != end_ && *at_ == c; }
    /// True at a blank, a line end or the text's end.
    [[nodiscard]] bool at_word_end() const { return !comes_plain() && at_word_end_slowly(); }

    /// Throws InputError with the file and the line.
    [[noreturn]] void fail(const std::string& what) const { source_.fail_at_line(line_, what); }

private:
    // A character that belongs to a word in every syntax.
    [[nodiscard]] bool comes_plain() const { return at_ != end_ && *at_ > ' ' && *at_ != '#' && *at_ != '\\'; }
    [[nodiscard]] bool at_line_end_slowly();
    [[nodiscard]] bool at_word_end_slowly() const;
    void next_line_slowly();
    void skip_blanks();
    [[nodiscard]] bool skip_continuation();
    [[nodiscard]] std::optional<std::int64_t> small_number();
    [[nodiscard]] std::string_view word_here() const;
    [[nodiscard]] double limit_value(const char* word_start, const char* what) const;

    const MeshSource& source_;
    const char* at_;
    const char* end_;
    std::size_t line_;
    Syntax syntax_;
};

/// Brings a coordinate into the range in which predicates are exact; nothing when it is too large or not finite.
[[nodiscard]] inline std::optional<double> accepted_coordinate(double value) {
    if (!(std::fabs(value) <= kLargestCoordinate)) return std::nullopt;
    return std::fabs(value) < kSmallestExactCoordinate ? 0.0 : value;
}

}  // namespace ricochet
