#include "ricochet/io/checkpoint.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/binary_archive.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"

namespace ricochet {
namespace {

/// Begins every checkpoint; the last digit changes with the layout.
constexpr std::uint64_t kCheckpointFormat = 0x5249434f43484b33ULL;

template <class Archive>
void archive_series(Archive& a, std::vector<PvdEntry>& series) {
    auto count = static_cast<std::uint64_t>(series.size());
    a(count);
    if constexpr (Archive::kReads) {
        if (count > BinaryReader::kLongestList) throw InputError("a saved list is longer than any can be");
        series.resize(count);
    }
    for (PvdEntry& entry : series) {
        a(entry.time);
        a(entry.part);
        a(entry.file);
    }
}

template <class Archive>
void archive_checkpoint(Archive& a, Checkpoint& checkpoint) {
    a(checkpoint.wall_seconds);
    a(checkpoint.output_seconds);
    archive_series(a, checkpoint.frames);
    archive_series(a, checkpoint.contacts);
}

struct Close {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw InputError(fmt::format("{}: {}; run the scene without --resume to begin anew (this removes what is there)",
                                 file.string(), why));
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, const Simulation& simulation) {
    AtomicFile target(file);
    StateHash head;
    const ByteSink sink = [&](std::span<const std::byte> bytes) {
        head.add(bytes);
        target.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    BinaryWriter writer(sink);
    writer(kCheckpointFormat);
    writer(checkpoint.scene);
    Checkpoint copy = checkpoint;
    archive_checkpoint(writer, copy);
    writer(head.value());
    simulation.save(sink);  // with a checksum of its own
    target.commit();
}

Checkpoint read_checkpoint(const std::filesystem::path& file, std::uint64_t scene, Simulation& simulation) {
    const std::unique_ptr<std::FILE, Close> opened(std::fopen(file.c_str(), "rb"));
    if (!opened) {
        throw InputError(
            fmt::format("{}: there is no checkpoint to resume from: the run was finished, or killed before "
                        "its first checkpoint (output.checkpoint_every); run it without --resume",
                        file.string()));
    }
    StateHash head;
    const ByteSource source = [&](std::span<std::byte> bytes) {
        if (std::fread(bytes.data(), 1, bytes.size(), opened.get()) != bytes.size()) {
            throw InputError("the file ends too early");
        }
        head.add(bytes);
    };
    Checkpoint checkpoint;
    try {
        BinaryReader reader(source);
        std::uint64_t format = 0;
        reader(format);
        if (format != kCheckpointFormat) throw InputError("not a checkpoint that this version can read");
        reader(checkpoint.scene);
        if (checkpoint.scene != scene) throw InputError("the scene is not the one that was interrupted");
        archive_checkpoint(reader, checkpoint);
        const std::uint64_t expected = head.value();
        std::uint64_t found = 0;
        reader(found);
        if (found != expected) throw InputError("the file is damaged (its checksum is wrong)");
        simulation.restore(source);
    } catch (const InputError& error) {
        refuse(file, error.what());
    }
    return checkpoint;
}

}  // namespace ricochet
