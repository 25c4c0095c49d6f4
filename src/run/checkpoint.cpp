#include "run/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/binary_archive.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "run/run_folder.h"

namespace ricochet {
namespace {

/// Format number at the start of every checkpoint. Its last byte is the version of the layout. The file ends with its
/// checksum.
constexpr std::uint64_t kCheckpointFormat = 0x5249434f43484b39ULL;
/// Format number at the start of every checkpoint part. The part also ends with its checksum.
constexpr std::uint64_t kPartFormat = 0x5249434f50415230ULL;
constexpr std::uint64_t kAnyLayout = ~std::uint64_t{0xFF};

template <class Archive>
void archive_series(Archive& a, std::vector<PvdEntry>& series) {
    archive_entries(a, series, [&](PvdEntry& entry) { a(entry.time), a(entry.part), a(entry.file); });
}

template <class Archive>
void archive_checkpoint(Archive& a, Checkpoint& checkpoint) {
    a(checkpoint.wall_seconds);
    a(checkpoint.output_seconds);
    archive_series(a, checkpoint.frames);
    archive_series(a, checkpoint.contacts);
    archive_series(a, checkpoint.moving);
    LoadRows& loads = checkpoint.loads;
    a(loads.colliders), a(loads.bodies), a(loads.since);
    archive_entries(a, checkpoint.parts, [&](CheckpointPart& part) { a(part.file), a(part.checksum); });
    archive_entries(a, loads.totals, [&](ColliderTotals& t) { a(t.hits), a(t.impulse), a(t.moment), a(t.work); });
    a(checkpoint.counters.text);
    archive_entries(a, checkpoint.counters.counts,
                    [&](CounterCounts& c) { a(c.forward), a(c.backward), a(c.forward_mass), a(c.backward_mass); });
}

/// Throws InputError if a series refers to anything but a file of a run. Reason: a resumed run writes the entries into
/// its own series files.
void require_sound_series(const Checkpoint& checkpoint) {
    const auto require = [](const std::vector<PvdEntry>& series, const auto& is_file) {
        const auto is_sound = [&](const PvdEntry& entry) { return std::isfinite(entry.time) && is_file(entry.file); };
        if (!std::all_of(series.begin(), series.end(), is_sound)) {
            throw InputError("the file is damaged: it lists files that are none of a run");
        }
    };
    require(checkpoint.frames, [](const std::string& name) {
        return step_of_frame_file(name).has_value() || step_of_frame_index(name).has_value();
    });
    require(checkpoint.contacts, [](const std::string& name) { return step_of_contact_file(name).has_value(); });
    require(checkpoint.moving, [](const std::string& name) { return step_of_moving_file(name).has_value(); });
}

struct Close {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

using OpenFile = std::unique_ptr<std::FILE, Close>;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw InputError(fmt::format("{}: {}; run the scene without --resume to begin anew (this removes what is there)",
                                 file.string(), why));
}

[[noreturn]] void fail_to_read(const std::filesystem::path& file) {
    throw RunError(fmt::format("{}: cannot be read ({})", file.string(), std::strerror(errno)));
}

OpenFile open_checkpoint(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    // A pipe is refused, because reading it would block.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        refuse(file, "found no regular file, expected a checkpoint");
    }
    OpenFile opened(std::fopen(file.c_str(), "rb"));
    if (opened) return opened;
    if (errno != ENOENT) fail_to_read(file);
    throw InputError(
        fmt::format("{}: there is no checkpoint to resume from: the run was finished in fewer steps than "
                    "output.every, or killed before its first checkpoint (output.checkpoint_every); run it without "
                    "--resume",
                    file.string()));
}

/// Reads like fread(), but throws RunError if reading fails. A read error must not count as the end of the file,
/// because the checkpoint may be intact.
std::size_t read_bytes(std::span<std::byte> bytes, std::FILE* file, const std::filesystem::path& name) {
    const std::size_t count = std::fread(bytes.data(), 1, bytes.size(), file);
    if (std::ferror(file) != 0) fail_to_read(name);
    return count;
}

/// Checks the format number and the checksum before any content is used. Returns the checksum.
std::uint64_t require_whole_file(std::FILE* file, const std::filesystem::path& name, std::uint64_t expected) {
    std::uint64_t format = 0;
    if (read_bytes(std::as_writable_bytes(std::span(&format, 1)), file, name) != sizeof(format)) {
        throw InputError("the file is damaged: it is too short");
    }
    if (format != expected) {
        const bool is_of_another_version = (format & kAnyLayout) == (expected & kAnyLayout);
        throw InputError(is_of_another_version ? "a checkpoint of another version of ricochet, which can resume it"
                                               : "not a checkpoint");
    }
    StateHash checksum;
    checksum.add(std::as_bytes(std::span(&format, 1)));
    // The last eight bytes read so far can be the stored checksum. They are added to the computed checksum only after
    // more bytes follow.
    std::vector<std::byte> piece(sizeof(std::uint64_t) + (std::size_t{1} << 16));
    std::size_t kept = 0;
    while (const std::size_t got = read_bytes(std::span(piece).subspan(kept), file, name)) {
        const std::size_t count = kept + got;
        kept = std::min(count, sizeof(std::uint64_t));
        checksum.add(std::span(piece).first(count - kept));
        std::memmove(piece.data(), piece.data() + (count - kept), kept);
    }
    std::uint64_t found = 0;
    std::memcpy(&found, piece.data(), kept);
    if (kept != sizeof(found) || found != checksum.value()) {
        throw InputError("the file is damaged or cut short (its checksum is wrong)");
    }
    std::rewind(file);
    return found;
}

/// Writes a file that ends with the checksum of the data from `write`. Returns the checksum.
std::uint64_t write_checked_file(const std::filesystem::path& file, const std::function<void(const ByteSink&)>& write) {
    AtomicFile target(file);
    StateHash checksum;
    const ByteSink sink = [&](std::span<const std::byte> bytes) {
        checksum.add(bytes);
        target.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    write(sink);
    const std::uint64_t whole = checksum.value();
    BinaryWriter writer(sink);
    writer(whole);
    target.commit();
    return whole;
}

ByteSource source_of(const OpenFile& opened, const std::filesystem::path& file) {
    return [&](std::span<std::byte> bytes) {
        if (read_bytes(bytes, opened.get(), file) != bytes.size()) throw InputError("the file ends too early");
    };
}

void read_part(const std::filesystem::path& folder, const CheckpointPart& part, Simulation& simulation) {
    const auto refuse_part = [&](const std::string& why) {
        throw InputError(fmt::format("its part {} {}", part.file, why));
    };
    // The name comes from a file that can be damaged. It must be the name of a checkpoint part in the checkpoint's
    // folder.
    if (!set_of_checkpoint_part(part.file)) refuse_part("is no part of a checkpoint");
    const std::filesystem::path file = folder / part.file;
    require_own_file(file);
    const OpenFile opened(std::fopen(file.c_str(), "rb"));
    if (!opened && errno != ENOENT) fail_to_read(file);
    if (!opened) refuse_part("is missing");
    try {
        if (require_whole_file(opened.get(), file, kPartFormat) != part.checksum) {
            throw InputError("it is of another checkpoint");
        }
        const ByteSource source = source_of(opened, file);
        BinaryReader reader(source);
        std::uint64_t format = 0;
        reader(format);
        simulation.restore_particles(source);
    } catch (const InputError& error) {
        refuse_part(fmt::format("cannot be used: {}", error.what()));
    }
}

}  // namespace

std::vector<std::string> names_of(const std::vector<CheckpointPart>& parts) {
    std::vector<std::string> names;
    for (const CheckpointPart& part : parts) names.push_back(part.file);
    return names;
}

std::uint64_t write_checkpoint_part(const std::filesystem::path& file, const Simulation& simulation) {
    return write_checked_file(file, [&](const ByteSink& sink) {
        BinaryWriter writer(sink);
        writer(kPartFormat);
        simulation.save_particles(sink);
    });
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, const Simulation& simulation) {
    (void)write_checked_file(file, [&](const ByteSink& sink) {
        BinaryWriter writer(sink);
        writer(kCheckpointFormat);
        writer(checkpoint.scene);
        Checkpoint copy = checkpoint;
        archive_checkpoint(writer, copy);
        simulation.save(sink);
    });
}

Checkpoint read_checkpoint(const std::filesystem::path& file, std::uint64_t scene, Simulation& simulation) {
    const OpenFile opened = open_checkpoint(file);
    const ByteSource source = source_of(opened, file);
    Checkpoint checkpoint;
    try {
        (void)require_whole_file(opened.get(), file, kCheckpointFormat);
        BinaryReader reader(source);
        std::uint64_t format = 0;
        reader(format);
        reader(checkpoint.scene);
        if (checkpoint.scene != scene) {
            throw InputError(
                "the scene, or a file that it reads, is not the one that was interrupted: undo the change to resume");
        }
        archive_checkpoint(reader, checkpoint);
        require_sound_series(checkpoint);
        simulation.restore(source);
        for (const CheckpointPart& part : checkpoint.parts) read_part(file.parent_path(), part, simulation);
    } catch (const InputError& error) {
        refuse(file, error.what());
    }
    return checkpoint;
}

}  // namespace ricochet
