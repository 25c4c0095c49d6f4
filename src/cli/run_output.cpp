#include "cli/run_output.h"

#include <chrono>
#include <vector>

#include "cli/run_messages.h"

namespace ricochet::cli {
namespace {

/// Timer that adds its own lifetime to the output time of the writer, if the writer exists.
class Spending {
public:
    explicit Spending(RunWriter* writer) : writer_(writer) {}
    ~Spending() {
        if (writer_ != nullptr) writer_->add_output_seconds(seconds_since(start_));
    }
    Spending(const Spending&) = delete;
    Spending& operator=(const Spending&) = delete;

private:
    RunWriter* writer_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

void RunOutput::add_step(Simulation& simulation) {
    simulation.show_whole(Shown::contacts, [&] { parts_.writer->add_step(simulation); });
}

// Writes a frame. Pieces are written in the background, so the index of a frame's pieces is written together with the
// next frame.
void RunOutput::write_frame(Simulation& simulation) {
    if (last_frame_ == simulation.step_index()) return;
    last_frame_ = simulation.step_index();
    if (parts_.pieces) {
        const Spending spending(parts_.writer);
        list_pieces();
        parts_.pieces->write(simulation);
    }
    simulation.show_whole(parts_.pieces ? Shown::counts : Shown::particles,
                          [&] { parts_.writer->write_frame(simulation); });
}

void RunOutput::complete_frame() {
    const Spending spending(parts_.writer);
    list_pieces();
}

void RunOutput::list_pieces() {
    if (!parts_.pieces) return;
    const std::optional<PieceIndex> index = parts_.pieces->complete();
    if (index && parts_.writer != nullptr) parts_.writer->list(*index);
}

void RunOutput::write_checkpoint(Simulation& simulation, double seconds) {
    complete_frame();
    const bool in_parts = parts_.pieces && parts_.ranks;
    std::vector<CheckpointPart> parts;
    if (in_parts) {
        const Spending spending(parts_.writer);
        parts = parts_.pieces->write_checkpoint_part(simulation);
    }
    simulation.show_whole(in_parts ? Shown::all_but_particles : Shown::all, [&] {
        parts_.writer->write_checkpoint(simulation, parts_.fingerprint, seconds, parts);
        // The parts of the older checkpoint are removed only now, because that checkpoint was valid until the new one
        // was complete.
        parts_.folder->remove_checkpoint_parts(names_of(parts));
    });
}

}  // namespace ricochet::cli
