/// \file
/// Saved lists of several processes, read as one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/core/error.h"

namespace ricochet {

/// Reads what a BinaryWriter of each of several processes has written of the same type: an archive like BinaryReader.
/// Lists are merged entry by entry, single values are the first one's. The first list that is read is that of the ids,
/// in ascending order and different from each other: all other lists go by it.
class MergingReader {
public:
    static constexpr bool kReads = true;

    /// parts: what each process has written; must outlive it.
    explicit MergingReader(const std::vector<std::vector<std::byte>>& parts) {
        for (const auto& part : parts) sources_.push_back({part, 0, 0});
    }

    template <class T>
    requires kIsFlat<T>
    void operator()(T& value) {
        if (selected_) return read(sources_[*selected_], value);
        for (std::size_t k = sources_.size(); k-- > 0;) read(sources_[k], value);
    }
    void operator()(bool& value) {
        std::uint8_t byte = 0;
        (*this)(byte);
        value = byte != 0;
    }
    /// The ids.
    void operator()(std::vector<std::uint64_t>& ids) {
        std::vector<std::pair<std::uint64_t, std::uint32_t>> all;
        for (std::uint32_t k = 0; k < sources_.size(); ++k) {
            std::vector<std::uint64_t> part;
            read_list(sources_[k], part);
            sources_[k].count = part.size();
            for (const std::uint64_t id : part) all.emplace_back(id, k);
        }
        std::sort(all.begin(), all.end());
        ids.clear();
        for (const auto& [id, source] : all) ids.push_back(id), order_.push_back(source);
    }
    /// A list beside that of the ids: as many entries for each of them.
    template <class T>
    requires kIsFlat<T>
    void operator()(std::vector<T>& values, std::size_t size) {
        const std::size_t width = order_.empty() ? 0 : size / order_.size();
        std::vector<std::vector<T>> parts(sources_.size());
        for (std::size_t k = 0; k < parts.size(); ++k) {
            read_list(sources_[k], parts[k]);
            if (parts[k].size() != sources_[k].count * width) complain();
        }
        interleave(parts, values, width);
    }
    /// The same where a process may have none: it has `absent` then.
    template <class T>
    void all_or_none(std::vector<T>& values, std::size_t size, const T& absent) {
        std::vector<std::vector<T>> parts(sources_.size());
        for (std::size_t k = 0; k < parts.size(); ++k) read_list(sources_[k], parts[k]);
        values.clear();
        if (std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.empty(); })) return;
        for (std::size_t k = 0; k < parts.size(); ++k) parts[k].resize(sources_[k].count, absent);
        interleave(parts, values, order_.empty() ? 0 : size / order_.size());
    }
    /// A list of entries that are not saved as they lie in memory: as many for each id.
    template <class T, class Visit>
    void entries(std::vector<T>& list, const Visit& visit, std::uint64_t expected) {
        std::uint64_t count = 0;
        for (Source& source : sources_) {
            std::uint64_t part = 0;
            read(source, part);
            count += part;
        }
        if (count != expected) complain();
        list.clear();
        const std::uint64_t width = order_.empty() ? 0 : expected / order_.size();
        for (const std::uint32_t source : order_) {
            selected_ = source;
            for (std::uint64_t k = 0; k < width; ++k) visit(list.emplace_back());
        }
        selected_.reset();
    }

private:
    struct Source {
        std::span<const std::byte> bytes;
        std::size_t at = 0;
        std::size_t count = 0;  ///< ids
    };

    [[noreturn]] static void complain() { throw RunError("what the ranks have sent does not fit together"); }

    template <class T>
    static void read(Source& source, T& value) {
        read_bytes(source, std::as_writable_bytes(std::span(&value, 1)));
    }
    template <class T>
    static void read_list(Source& source, std::vector<T>& values) {
        std::uint64_t count = 0;
        read(source, count);
        if (count > source.bytes.size()) complain();
        values.resize(count);
        read_bytes(source, std::as_writable_bytes(std::span(values)));
    }
    static void read_bytes(Source& source, std::span<std::byte> into) {
        if (into.size() > source.bytes.size() - source.at) complain();
        if (!into.empty()) std::memcpy(into.data(), source.bytes.data() + source.at, into.size());
        source.at += into.size();
    }
    template <class T>
    void interleave(const std::vector<std::vector<T>>& parts, std::vector<T>& values, std::size_t width) const {
        values.clear();
        values.reserve(order_.size() * width);
        std::vector<std::size_t> next(parts.size(), 0);
        for (const std::uint32_t source : order_) {
            const auto first = parts[source].begin() + static_cast<std::ptrdiff_t>(next[source]);
            values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(width));
            next[source] += width;
        }
    }

    std::vector<Source> sources_;
    std::vector<std::uint32_t> order_;  // whose each entry is
    std::optional<std::uint32_t> selected_;
};

/// As for BinaryReader.
template <class T, class Visit>
void archive_entries(MergingReader& a, std::vector<T>& entries, const Visit& visit, std::uint64_t expected) {
    a.entries(entries, visit, expected);
}

}  // namespace ricochet
