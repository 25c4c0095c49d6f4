// Tests of untrusted files with many kinds of damage. Each is read, or refused with one line. Memory and work are
// proportional to the size of the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/point_cache.h"
#include "ricochet/io/frames.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/scene/context.h"
#include "ricochet/io/vti_reader.h"
#include "run/checkpoint.h"
#include "run/run_folder.h"
#include "run/vtp_reader.h"
#include "support/allocation_guard.h"
#include "support/counts.h"
#include "support/temporary_folder.h"
#include "view/export/frame_reader.h"
#include "view/render/image.h"

namespace ricochet::fuzz {
namespace RICOCHET_FILE {

constexpr std::uint64_t kSeed = 20261128;
constexpr int kCases = 60;  // of each kind

/// Limits of memory, in bytes, and of calls of the allocator: for each byte of a file, and for every file.
constexpr std::size_t kMostMemoryPerByte = 2000;
constexpr std::size_t kMostMemory = 40'000'000;
constexpr std::uint64_t kMostCallsPerByte = 100;
constexpr std::uint64_t kMostCalls = 100'000;

std::string file_of(const std::string& name) {
    std::ifstream in(std::filesystem::path(RICOCHET_SOURCE_DIR) / "tests/fuzz/corpus" / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

template <class T>
std::string bytes_of(const T& value) {
    std::string bytes(sizeof(value), '\0');
    std::memcpy(bytes.data(), &value, sizeof(value));
    return bytes;
}

std::string point_cache() {
    std::string bytes("POINTCACHE2\0", 12);
    for (const std::int32_t value : {1, 2}) bytes += bytes_of(value);
    for (const float value : {1.0F, 0.5F}) bytes += bytes_of(value);
    bytes += bytes_of(std::int32_t{3});
    for (int k = 0; k < 18; ++k) bytes += bytes_of(0.5F * static_cast<float>(k));
    return bytes;
}

std::string picture() {
    Image image{8, 8, {}, {}};
    for (int k = 0; k < 64; ++k) {
        for (const int c : {3 * k, 255 - k, k * k % 256}) image.rgb.push_back(static_cast<std::uint8_t>(c));
        image.alpha.push_back(static_cast<std::uint8_t>(4 * k));
    }
    return png_bytes(image);
}

constexpr const char* kScene =
    R"({"ricochet": 1, "simulation": {"time_step": 0.02, "duration": 0.2},
        "particles": [{"position": [0, 0, 0.5]}]})";

std::string checkpoint() {
    SceneDescription scene = parse_scene(kScene, "s.json");
    Checkpoint whole;
    whole.scene = scene.fingerprint;
    Simulation simulation(std::move(scene.setup));
    simulation.advance(2);
    const test::TemporaryFolder folder;
    write_checkpoint(folder.path("c"), whole, simulation);
    return folder.read("c");
}

/// Path of a file, with its folder.
struct Place {
    const test::TemporaryFolder& folder;
    std::filesystem::path file;
};

void read_checkpoint_file(const Place& place) {
    SceneDescription scene = parse_scene(kScene, "s.json");
    Simulation simulation(std::move(scene.setup));
    static_cast<void>(read_checkpoint(place.file, scene.fingerprint, simulation));
}

void read_table(const std::string& bytes) {
    const detail::ParticleTable table = detail::parse_particle_table(bytes, "p.csv", {});
    ASSERT_LE(table.errors.size(), 16U);
    if (!table.errors.empty()) throw InputError(table.errors.front());
}

/// Kind of file: valid examples, and the function that reads them.
struct Kind {
    const char* name;
    const char* extension;
    std::vector<std::string> good;
    std::function<void(const Place& place, const std::string& bytes)> read;
};

/// Returns an index over two pieces in the same folder.
std::string piece_index(const test::TemporaryFolder& folder) {
    Particles particles;
    for (std::uint64_t k = 0; k < 3; ++k) {
        Particle particle;
        particle.id = k;
        particles.append(particle);
    }
    write_vtp(folder.path(piece_file_name(1, 0)), particle_frame(particles, 0.1));
    const VtkPolyData shape = particle_frame(Particles{}, 0.1);
    write_vtp(folder.path(piece_file_name(1, 1)), shape);
    return pvtp_text(shape, {piece_file_name(1, 0), piece_file_name(1, 1)});
}

std::vector<Kind> kinds(const test::TemporaryFolder& folder) {
    const auto mesh = [](const Place& place, const std::string&) { static_cast<void>(read_mesh(place.file)); };
    return {
        {"glTF", ".gltf", {file_of("gltf/features.gltf")}, mesh},
        {"GLB", ".glb", {file_of("gltf/cube.glb")}, mesh},
        {"PC2",
         ".pc2",
         {point_cache()},
         [](const Place& place, const std::string& bytes) { static_cast<void>(read_point_cache(place.file, bytes)); }},
        {"VTP",
         ".vtp",
         {file_of("vtp/particles.vtp"), file_of("vtp/box.vtp"), file_of("vtp/contacts.vtp")},
         [](const Place& place, const std::string&) { static_cast<void>(read_vtp(place.file)); }},
        {"VTI",
         ".vti",
         {file_of("vti/raw.vti"), file_of("vti/ascii.vti"), file_of("vti/appended_base64.vti")},
         [](const Place& place, const std::string&) { static_cast<void>(read_vti(place.file)); }},
        {"CSV",
         ".csv",
         {file_of("csv/plain.csv"), file_of("csv/state.csv")},
         [](const Place&, const std::string& bytes) { read_table(bytes); }},
        {"PNG",
         ".png",
         {picture()},
         [](const Place& place, const std::string&) { static_cast<void>(read_png(place.file)); }},
        {"pieces",
         ".pvtp",
         {piece_index(folder)},
         [](const Place& place, const std::string&) { static_cast<void>(read_frame(place.file)); }},
        {"checkpoint",
         ".bin",
         {checkpoint()},
         [](const Place& place, const std::string&) { read_checkpoint_file(place); }},
    };
}

class Damage {
public:
    Damage(std::uint32_t kind, std::uint64_t number) : random_(kSeed, kind, number) {}

    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(random_.uniform() * static_cast<double>(count));
    }
    /// Damages a non-empty file at one to three positions.
    std::string apply(std::string bytes) {
        for (std::size_t k = 1 + below(3); k > 0 && !bytes.empty(); --k) damage(bytes);
        return bytes;
    }

private:
    void damage(std::string& bytes) {
        const std::size_t at = below(bytes.size());
        switch (below(8)) {
            case 0:
                bytes.resize(at);
                break;
            case 1:
                bytes[at] = static_cast<char>(below(256));
                break;
            case 2:  // a number beyond all
                replace_number(bytes, at);
                break;
            case 3: {  // a size in binary
                constexpr std::array<std::uint32_t, 6> kSizes{0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000000};
                const std::string size = bytes_of(kSizes[below(kSizes.size())]);
                bytes.replace(at, std::min<std::size_t>(4, bytes.size() - at), size);
                break;
            }
            case 4:  // a part of it again, somewhere else
                bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(200)));
                break;
            case 5:
                bytes.erase(at, 1 + below(50));
                break;
            case 6:  // one part many times
                repeat(bytes, at);
                break;
            default:
                bytes.insert(at, 1 + below(20), static_cast<char>(below(256)));
        }
    }
    void replace_number(std::string& bytes, std::size_t at) {
        constexpr std::array kNumbers{"-1", "1e999", "99999999999999999999", "4294967295", "nan", "2147483648", "0"};
        const std::size_t digit = bytes.find_first_of("0123456789", at);
        if (digit == std::string::npos) return;
        const std::size_t end = std::min(bytes.size(), bytes.find_first_not_of("0123456789", digit));
        bytes.replace(digit, end - digit, kNumbers[below(kNumbers.size())]);
    }
    void repeat(std::string& bytes, std::size_t at) {
        const std::string part = bytes.substr(at, 1 + below(60));
        std::string many;
        for (int k = 0; k < 300; ++k) many += part;
        bytes.insert(at, many);
    }

    RandomSequence random_;
};

/// Returns true if the file was read. Fails if the refusal is more than one plain line, or if the reader uses too much
/// memory or work.
bool read_or_refuse(const Kind& kind, const Place& place, const std::string& bytes) {
    constexpr auto kNever = std::numeric_limits<std::uint64_t>::max();
    std::string refusal;
    const test::AllocationGuard memory;
    const test::AllocationFault calls(kNever, test::AllocationFault::Later::succeed);
    try {
        kind.read(place, bytes);
    } catch (const InputError& error) {
        refusal = error.what();
        EXPECT_FALSE(refusal.empty());
    }
    EXPECT_LT(memory.peak_bytes(), kMostMemory + kMostMemoryPerByte * bytes.size());
    EXPECT_LT(calls.calls(), kMostCalls + kMostCallsPerByte * bytes.size());
    const bool is_plain = std::all_of(refusal.begin(), refusal.end(),
                                      [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F; });
    EXPECT_TRUE(is_plain) << refusal;
    return refusal.empty();
}

TEST(MalformedFiles, AreReadOrRefusedWithOneLine) {
    const test::TemporaryFolder folder;
    std::uint32_t number = 0;
    for (const Kind& kind : kinds(folder)) {
        SCOPED_TRACE(kind.name);
        const Place place{folder, folder.path(std::string("file") + kind.extension)};
        int read = 0;
        const int cases = test::scaled(kCases * test::case_factor(50));
        for (int k = 0; k < cases; ++k) {
            SCOPED_TRACE("seed " + std::to_string(kSeed) + ", kind " + std::to_string(number) + ", case " +
                         std::to_string(k));
            Damage damage(number, static_cast<std::uint64_t>(k));
            const std::string bytes = damage.apply(kind.good[damage.below(kind.good.size())]);
            (void)folder.write(place.file.filename().string(), bytes);
            read += read_or_refuse(kind, place, bytes) ? 1 : 0;
        }
        constexpr int kEnough = 20;  // a smaller number may all be read
        EXPECT_TRUE(cases < kEnough || read < cases) << read;
        for (const std::string& good : kind.good) {
            (void)folder.write(place.file.filename().string(), good);
            EXPECT_TRUE(read_or_refuse(kind, place, good));
        }
        ++number;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::fuzz
