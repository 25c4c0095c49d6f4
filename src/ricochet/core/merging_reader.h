/// \file
/// Reader that merges the saved lists of several processes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/core/error.h"

namespace ricochet {

/// Archive like BinaryReader that reads the output of one BinaryWriter per process. All processes have written an
/// object of the same type. Lists are merged entry by entry; single values are taken from the first process. The first
/// list must contain the ids, which ascend and are unique among all processes. This list determines the order of all
/// other lists.
class MergingReader {
public:
    static constexpr bool kReads = true;

    /// parts: the output of each process; must outlive the reader.
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
    /// Reads the ids.
    void operator()(std::vector<std::uint64_t>& ids) {
        std::vector<std::vector<std::uint64_t>> parts(sources_.size());
        for (std::size_t k = 0; k < parts.size(); ++k) {
            read_list(sources_[k], parts[k]);
            sources_[k].count = parts[k].size();
            size_ += parts[k].size();
        }
        find_runs(parts);
        interleave(parts, ids, 1);
    }
    /// Reads a list of `size` entries in all processes together, with the same number of entries for each id.
    template <class T>
    requires kIsFlat<T>
    void operator()(std::vector<T>& values, std::size_t size) {
        const std::size_t width = width_of(size);
        std::vector<std::span<const std::byte>> parts;
        for (Source& source : sources_) {
            std::uint64_t count = 0;
            read(source, count);
            if (count != source.count * width) throw_mismatch();
            parts.push_back(bytes_of(source, count * sizeof(T)));
        }
        values.resize(size_ * width);
        std::byte* to = std::as_writable_bytes(std::span(values)).data();
        for (const Run& run : runs_) {
            const std::size_t bytes = run.count * width * sizeof(T);
            if (bytes == 0) continue;
            std::memcpy(to, parts[run.source].data(), bytes);
            parts[run.source] = parts[run.source].subspan(bytes);
            to += bytes;
        }
    }
    /// Reads a list of the same form, which may be empty in some processes. The entries of these processes have the
    /// value `absent`.
    template <class T>
    void all_or_none(std::vector<T>& values, std::size_t size, const T& absent) {
        std::vector<std::vector<T>> parts(sources_.size());
        for (std::size_t k = 0; k < parts.size(); ++k) read_list(sources_[k], parts[k]);
        values.clear();
        if (std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.empty(); })) return;
        for (std::size_t k = 0; k < parts.size(); ++k) parts[k].resize(sources_[k].count, absent);
        interleave(parts, values, width_of(size));
    }
    /// Reads a list of entries that are not flat (kIsFlat), with the same number of entries for each id.
    template <class T, class Visit>
    void entries(std::vector<T>& list, const Visit& visit, std::uint64_t expected) {
        std::uint64_t count = 0;
        for (Source& source : sources_) {
            std::uint64_t part = 0;
            read(source, part);
            count += part;
        }
        if (count != expected) throw_mismatch();
        list.clear();
        const std::uint64_t width = width_of(expected);
        for (const Run& run : runs_) {
            selected_ = run.source;
            for (std::uint64_t k = 0; k < run.count * width; ++k) visit(list.emplace_back());
        }
        selected_.reset();
    }

private:
    struct Source {
        std::span<const std::byte> bytes;
        std::size_t at = 0;
        std::size_t count = 0;  ///< ids
    };
    /// Run of consecutive entries from one source.
    struct Run {
        std::uint32_t source = 0;
        std::size_t count = 0;
    };

    [[noreturn]] static void throw_mismatch() { throw RunError("the ranks have sent lists that do not fit together"); }

    template <class T>
    static void read(Source& source, T& value) {
        read_bytes(source, std::as_writable_bytes(std::span(&value, 1)));
    }
    template <class T>
    static void read_list(Source& source, std::vector<T>& values) {
        std::uint64_t count = 0;
        read(source, count);
        if (count > source.bytes.size()) throw_mismatch();
        values.resize(count);
        read_bytes(source, std::as_writable_bytes(std::span(values)));
    }
    static void read_bytes(Source& source, std::span<std::byte> into) {
        const std::span<const std::byte> from = bytes_of(source, into.size());
        if (!into.empty()) std::memcpy(into.data(), from.data(), into.size());
    }
    static std::span<const std::byte> bytes_of(Source& source, std::size_t size) {
        if (size > source.bytes.size() - source.at) throw_mismatch();
        const std::span<const std::byte> bytes = source.bytes.subspan(source.at, size);
        source.at += size;
        return bytes;
    }
    [[nodiscard]] std::uint64_t width_of(std::uint64_t entries) const { return size_ == 0 ? 0 : entries / size_; }
    /// Splits the ids into runs: the source with the least next id contributes all ids below the next ids of all other
    /// sources.
    void find_runs(const std::vector<std::vector<std::uint64_t>>& ids) {
        using Head = std::pair<std::uint64_t, std::uint32_t>;  // the next id of a source
        std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
        std::vector<std::size_t> next(ids.size(), 0);
        for (std::uint32_t k = 0; k < ids.size(); ++k) {
            if (!ids[k].empty()) heads.emplace(ids[k].front(), k);
        }
        while (!heads.empty()) {
            const std::uint32_t source = heads.top().second;
            heads.pop();
            const std::vector<std::uint64_t>& from = ids[source];
            const std::size_t first = next[source];
            std::size_t last = first + 1;
            while (last < from.size() && (heads.empty() || from[last] < heads.top().first)) ++last;
            runs_.push_back({source, last - first});
            next[source] = last;
            if (last < from.size()) heads.emplace(from[last], source);
        }
    }
    template <class T>
    void interleave(const std::vector<std::vector<T>>& parts, std::vector<T>& values, std::size_t width) const {
        values.clear();
        values.reserve(size_ * width);
        std::vector<std::size_t> next(parts.size(), 0);
        for (const Run& run : runs_) {
            const auto first = parts[run.source].begin() + static_cast<std::ptrdiff_t>(next[run.source]);
            values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(run.count * width));
            next[run.source] += run.count * width;
        }
    }

    std::vector<Source> sources_;
    std::vector<Run> runs_;  // in the order of ids
    std::size_t size_ = 0;   // number of ids in all sources
    std::optional<std::uint32_t> selected_;
};

/// Merges the list like MergingReader::entries().
template <class T, class Visit>
void archive_entries(MergingReader& a, std::vector<T>& entries, const Visit& visit, std::uint64_t expected) {
    a.entries(entries, visit, expected);
}

}  // namespace ricochet
