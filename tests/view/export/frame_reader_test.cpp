// Frames in pieces are read like the frame of a single process, or refused in one line.
#include "view/export/frame_reader.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/io/frames.h"
#include "run/example_frames.h"
#include "run/run_folder.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;

/// Returns the particles whose index has the given remainder: the share of one of several processes.
Particles share_of(const Particles& all, std::size_t rest, std::size_t count) {
    Particles share = all;
    std::vector<std::uint8_t> keep(all.size());
    for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = (i * i + i / 3) % count == rest ? 1 : 0;
    share.compact(keep);
    return share;
}

/// Writes the frame of 100 particles in three pieces; the last piece may be empty. Returns the path of the index.
std::filesystem::path write_pieces(const TemporaryFolder& folder, std::size_t shares) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < 3; ++k) {
        names.push_back(piece_file_name(7, k));
        const Particles share = k < shares ? share_of(test::example_particles(100), k, shares) : Particles{};
        write_vtp(folder.path(names.back()), particle_frame(share, 1.0 / 3.0));
    }
    return folder.write(frame_index_name(7), pvtp_text(particle_frame(Particles{}, 1.0 / 3.0), names));
}

std::string refusal(const std::filesystem::path& index) {
    try {
        (void)read_frame(index);
    } catch (const InputError& error) {
        return error.what();
    }
    return "it was read";
}

TEST(FrameReader, PiecesAreJoinedInTheOrderOfIds) {
    const VtkPolyData whole = particle_frame(test::example_particles(100), 1.0 / 3.0);
    for (const std::size_t shares : {2U, 3U}) {
        const TemporaryFolder folder;
        const VtkPolyData read = read_frame(write_pieces(folder, shares));
        EXPECT_EQ(read.time, whole.time);
        EXPECT_TRUE(read.points == whole.points);
        ASSERT_EQ(read.point_arrays.size(), whole.point_arrays.size());
        for (std::size_t k = 0; k < read.point_arrays.size(); ++k) {
            EXPECT_EQ(read.point_arrays[k].name, whole.point_arrays[k].name);
            EXPECT_TRUE(read.point_arrays[k].values == whole.point_arrays[k].values) << read.point_arrays[k].name;
        }
    }
}

TEST(FrameReader, WholeFramesAreReadUnchanged) {
    const TemporaryFolder folder;
    const VtkPolyData whole = particle_frame(test::example_particles(5), 2.0);
    write_vtp(folder.path(frame_file_name(3)), whole);
    EXPECT_TRUE(read_frame(folder.path(frame_file_name(3))).points == whole.points);
}

TEST(FrameReader, PiecesThatDoNotFitTogetherAreRefused) {
    struct Damage {
        const char* message;
        std::function<void(const TemporaryFolder&)> apply;
    };
    const Particles all = test::example_particles(100);
    const auto piece = [](const TemporaryFolder& folder) { return folder.path(piece_file_name(7, 1)); };
    const std::vector<Damage> damages = {
        {"particles_000007_p1.vtp: not a regular file",
         [&](const TemporaryFolder& folder) { std::filesystem::remove(piece(folder)); }},
        {"is in two pieces",
         [&](const TemporaryFolder& folder) { write_vtp(piece(folder), particle_frame(all, 1.0 / 3.0)); }},
        {"another time", [&](const TemporaryFolder& folder) { write_vtp(piece(folder), particle_frame(all, 0.5)); }},
        {"other arrays",
         [&](const TemporaryFolder& folder) { write_vtp(piece(folder), particle_frame(all, 1.0 / 3.0, true)); }},
        {"lines or triangles in one of several pieces",
         [&](const TemporaryFolder& folder) {
             VtkPolyData frame = particle_frame(share_of(all, 1, 3), 1.0 / 3.0);
             frame.lines.push_back({0, 1});
             write_vtp(piece(folder), frame);
         }},
    };
    for (const Damage& damage : damages) {
        const TemporaryFolder folder;
        const std::filesystem::path index = write_pieces(folder, 3);
        damage.apply(folder);
        const std::string message = refusal(index);
        EXPECT_NE(message.find(damage.message), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

TEST(FrameReader, InvalidIndexIsRefused) {
    const TemporaryFolder folder;
    (void)write_pieces(folder, 3);
    const VtkPolyData none = particle_frame(Particles{}, 0.0);
    const std::string good = pvtp_text(none, {piece_file_name(7, 0)});
    const std::vector<std::string> bad = {
        "",
        "<VTKFile",
        good.substr(0, good.size() - 12),
        pvtp_text(none, {}),
        pvtp_text(none, {"../particles_000007_p0.vtp"}),
        pvtp_text(none, {"/etc/passwd"}),
        pvtp_text(none, {"particles_000007.pvtp"}),
        pvtp_text(none, {piece_file_name(7, 0), piece_file_name(7, 1), piece_file_name(7, 0)})};
    for (const std::string& text : bad) {
        const std::string message = refusal(folder.write("bad.pvtp", text));
        EXPECT_NE(message.find("bad.pvtp: "), std::string::npos) << text << ": " << message;
        EXPECT_NE(message.find("expected a .pvtp file as ricochet writes it"), std::string::npos) << message;
    }
    EXPECT_NE(refusal(folder.path("missing.pvtp")), "it was read");
    EXPECT_NE(refusal(folder.path("")), "it was read");
}

// The same empty piece could be named any number of times, and the reader would allocate memory for each.
TEST(FrameReader, PieceThatIsNamedRepeatedlyIsRefused) {
    const TemporaryFolder folder;
    (void)write_pieces(folder, 0);
    const std::vector<std::string> names(2000, piece_file_name(7, 2));
    const std::string message =
        refusal(folder.write("often.pvtp", pvtp_text(particle_frame(Particles{}, 1.0 / 3.0), names)));
    EXPECT_NE(message.find("particles_000007_p2.vtp is named twice"), std::string::npos) << message;
}

TEST(FrameReader, PieceThatIsALinkOutOfTheFolderIsRefused) {
    const TemporaryFolder folder;
    const TemporaryFolder elsewhere;
    const std::filesystem::path index = write_pieces(folder, 3);
    std::filesystem::rename(folder.path(piece_file_name(7, 1)), elsewhere.path("piece.vtp"));
    std::filesystem::create_symlink(elsewhere.path("piece.vtp"), folder.path(piece_file_name(7, 1)));
    EXPECT_NE(refusal(index).find("outside of the run's folder"), std::string::npos);
}

TEST(FrameReader, TruncatedOrChangedIndexNeverCrashes) {
    const TemporaryFolder folder;
    const std::string good = folder.read(write_pieces(folder, 3).filename().string());
    for (std::size_t k = 0; k < good.size(); k += 7) {
        (void)refusal(folder.write("bad.pvtp", good.substr(0, k)));
        std::string changed = good;
        changed[k] = static_cast<char>(changed[k] ^ 0x15);
        (void)refusal(folder.write("bad.pvtp", changed));
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
