#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "fuzz/byte_choices.h"
#include "fuzz/checkpoint_scenes.h"
#include "fuzz/fuzz_targets.h"
#include "fuzz/memory_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"
#include "ricochet/io/scene.h"
#include "run/checkpoint.h"
#include "support/temporary_folder.h"

namespace ricochet::fuzz {
namespace {

constexpr std::size_t kStepsAfter = 1;
constexpr std::size_t kChecksums = 2 * sizeof(std::uint64_t);

struct Base {
    std::uint64_t fingerprint = 0;
    std::string body;             ///< checkpoint without its two checksums
    std::size_t state_begin = 0;  ///< start of the simulation's state, which has its own checksum
};

Base make_base(const CheckpointScene& base_scene) {
    SceneDescription scene = parse_scene(base_scene.text, "base.json");
    Base base;
    base.fingerprint = scene.fingerprint;
    Simulation simulation(std::move(scene.setup));
    simulation.advance(base_scene.steps);
    Checkpoint checkpoint;
    checkpoint.scene = scene.fingerprint;
    checkpoint.frames = {{0.0, 0, "particles_000000.vtp"}, {0.02, 0, "particles_000001.vtp"}};
    const test::TemporaryFolder folder;
    write_checkpoint(folder.path("base"), checkpoint, simulation);
    base.body = folder.read("base");
    std::size_t state_size = 0;
    simulation.save([&](std::span<const std::byte> bytes) { state_size += bytes.size(); });
    base.state_begin = base.body.size() - sizeof(std::uint64_t) - state_size;
    base.body.resize(base.body.size() - kChecksums);
    return base;
}

const Base& base_of(std::size_t scene) {
    static std::array<std::optional<Base>, kCheckpointScenes.size()> bases;
    if (!bases[scene]) bases[scene] = make_base(kCheckpointScenes[scene]);
    return *bases[scene];
}

std::string bytes_of(std::uint64_t value) {
    std::string bytes(sizeof(value), '\0');
    std::memcpy(bytes.data(), &value, sizeof(value));
    return bytes;
}

/// Returns one of the values that are likely to reveal errors at any position.
std::string striking_value(ByteChoices& choices) {
    return bytes_of(
        choices.one_of<std::uint64_t>({0, 1, 2, 0xFF, 0xFFFF, 0xFFFFFFFF, 1ULL << 32, 1ULL << 62, ~std::uint64_t{0},
                                       0x7FF0000000000000, 0x7FF8000000000000, 0x7FEFFFFFFFFFFFFF, 0xFFEFFFFFFFFFFFFF,
                                       0x0000000000000001, 0x8000000000000000, 0x4F80000000000000}));
}

/// Overwrites, removes or inserts some bytes of a non-empty body, or copies a word of it to another position.
void edit(ByteChoices& choices, std::string& body, std::size_t& state_begin) {
    const std::uint8_t choice = choices.byte();
    const std::size_t kind = choice % 5;
    const std::size_t at = choices.two_bytes() % body.size();
    std::string piece;
    if (choice == kCopyEdit) {
        piece = body.substr(choices.two_bytes() % body.size() / sizeof(std::uint64_t) * sizeof(std::uint64_t),
                            sizeof(std::uint64_t));
    } else if (kind == 0) {
        piece = striking_value(choices);
    } else if (kind < 4) {
        const std::size_t length = 1 + choices.index(16);
        for (std::size_t k = 0; k < length; ++k) piece += static_cast<char>(choices.byte());
    }
    const bool keeps_length = kind < 3 || choice == kCopyEdit;
    const std::size_t removed = keeps_length ? piece.size() : kind == 3 ? 0 : 1 + choices.index(64);
    body.replace(at, std::min(removed, body.size() - at), piece);
    if (at < state_begin) state_begin += piece.size() - removed;
}

std::string with_checksums(std::string body, std::size_t state_begin) {
    StateHash state;
    state.add(std::as_bytes(std::span(body).subspan(std::min(state_begin, body.size()))));
    body += bytes_of(state.value());
    StateHash whole;
    whole.add(std::as_bytes(std::span(body)));
    return body + bytes_of(whole.value());
}

void require_some_steps(Simulation& simulation) {
    try {
        simulation.advance(kStepsAfter);
    } catch (const DivergedError&) {
        return;  // springs may start with any speed
    }
    const Particles& particles = simulation.particles();
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const bool is_known = is_finite(particles.position[i]) && is_finite(particles.velocity[i]);
        require(is_known || particles.frozen[i] != 0, "a particle that moves is somewhere");
    }
    simulation.save([](std::span<const std::byte>) {});
}

}  // namespace

// The first byte selects the scene, and the others edit its checkpoint.
bool fuzz_checkpoint(std::string_view bytes) {
    static const ThreadLimit one_thread(1);
    ByteChoices choices(bytes);
    const std::size_t scene = choices.index(kCheckpointScenes.size());
    std::string body = base_of(scene).body;
    std::size_t state_begin = base_of(scene).state_begin;
    while (!choices.at_end() && !body.empty()) edit(choices, body, state_begin);
    const MemoryFile file(with_checksums(std::move(body), state_begin));
    Simulation simulation(parse_scene(kCheckpointScenes[scene].text, "base.json").setup);
    try {
        static_cast<void>(read_checkpoint(file.path(), base_of(scene).fingerprint, simulation));
    } catch (const InputError&) {
        return false;
    }
    require_some_steps(simulation);
    return true;
}

}  // namespace ricochet::fuzz
