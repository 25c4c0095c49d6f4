#include "run/piece_writer.h"

#include <array>
#include <cstring>
#include <span>
#include <utility>

#include "ricochet/io/vtk.h"
#include "run/run_folder.h"

namespace ricochet {
namespace {

/// Returns a frame with the same time and the same arrays, but without values.
VtkPolyData shape_of(const VtkPolyData& frame) {
    VtkPolyData shape;
    shape.time = frame.time;
    const auto copy = [](const std::vector<VtkArray>& from, std::vector<VtkArray>& to) {
        for (const VtkArray& array : from) {
            VtkArray& empty = to.emplace_back();
            empty.name = array.name;
            std::visit([&](const auto& values) { empty.values = std::decay_t<decltype(values)>(); }, array.values);
        }
    };
    copy(frame.point_arrays, shape.point_arrays);
    copy(frame.cell_arrays, shape.cell_arrays);
    return shape;
}

}  // namespace

PieceWriter::PieceWriter(std::filesystem::path folder, RunInfo info, std::shared_ptr<Ranks> ranks,
                         const std::optional<Checkpoint>& resumed)
    : folder_(std::move(folder)),
      info_(std::move(info)),
      ranks_(std::move(ranks)),
      rank_(ranks_ ? ranks_->rank() : 0),
      size_(ranks_ ? ranks_->size() : 1) {
    if (resumed && !resumed->parts.empty()) set_ = set_of_checkpoint_part(resumed->parts.front().file).value_or(0);
}

void PieceWriter::write(const Simulation& simulation) {
    const auto frame = std::make_shared<VtkPolyData>();
    fill_run_frame(*frame, info_, simulation);
    open_.emplace(PieceIndex{simulation.step_index(), shape_of(*frame)});
    for (std::size_t k = 0; k < size_; ++k) open_->files.push_back(piece_file_name(simulation.step_index(), k));
    thread_.submit([frame, file = folder_ / open_->files[rank_]] { (void)write_vtp(file, *frame); });
}

std::optional<PieceIndex> PieceWriter::complete() {
    if (!open_) return std::nullopt;
    thread_.drain();
    std::array<std::uint64_t, 1> nothing{0};
    if (ranks_) ranks_->sum(nothing);
    return std::exchange(open_, std::nullopt);
}

std::vector<CheckpointPart> PieceWriter::write_checkpoint_part(const Simulation& simulation) {
    set_ = 1 - set_;
    const std::uint64_t mine = ricochet::write_checkpoint_part(folder_ / checkpoint_part_name(set_, rank_), simulation);
    std::vector<CheckpointPart> parts;
    for (const std::vector<std::byte>& bytes : ranks_->gather(std::as_bytes(std::span(&mine, 1)))) {
        CheckpointPart& part = parts.emplace_back();
        part.file = checkpoint_part_name(set_, parts.size() - 1);
        std::memcpy(&part.checksum, bytes.data(), sizeof part.checksum);
    }
    return parts;
}

}  // namespace ricochet
