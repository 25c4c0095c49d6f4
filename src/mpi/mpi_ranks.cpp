// The loadable library that contains all calls to MPI.
#include <mpi.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <thread>
#include <vector>

#include "mpi/common_memory.h"
#include "mpi/mpi_library.h"

namespace ricochet::mpi {
namespace {

/// Largest message, in bytes. Longer messages are split, because MPI stores counts as int.
constexpr std::size_t kPiece = std::size_t{1} << 30U;

/// Time for which a rank polls without sleeping. It is about the duration of a message if all ranks are ready.
constexpr std::chrono::microseconds kSpin{100};
/// Interval of later polls. The rank sleeps between polls, so that the awaited ranks can use the processor.
constexpr std::chrono::microseconds kPause{50};

/// Waits for a request. MPI's own wait functions are not used, because they occupy a whole processor. With more ranks
/// than processors, a waiting rank would take whole time slices from ranks that have work.
void wait_for(MPI_Request& request) {
    const auto begin = std::chrono::steady_clock::now();
    for (int is_done = 0;;) {
        MPI_Test(&request, &is_done, MPI_STATUS_IGNORE);
        if (is_done != 0) return;
        if (std::chrono::steady_clock::now() - begin > kSpin) std::this_thread::sleep_for(kPause);
    }
}

/// Ranks of this machine.
class MachineRanks final : public Neighbours {
public:
    MachineRanks() { MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &ranks_); }
    ~MachineRanks() override { MPI_Comm_free(&ranks_); }
    MachineRanks(const MachineRanks&) = delete;
    MachineRanks& operator=(const MachineRanks&) = delete;

    [[nodiscard]] bool is_first() const override {
        int rank = 0;
        MPI_Comm_rank(ranks_, &rank);
        return rank == 0;
    }
    [[nodiscard]] std::size_t size() const override {
        int size = 1;
        MPI_Comm_size(ranks_, &size);
        return static_cast<std::size_t>(size);
    }
    void tell(std::span<std::int64_t> values) const override {
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Ibcast(values.data(), static_cast<int>(values.size()), MPI_INT64_T, 0, ranks_, &request);
        wait_for(request);
    }
    [[nodiscard]] bool all(bool is_so) const override {
        int least = is_so ? 1 : 0;
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Iallreduce(MPI_IN_PLACE, &least, 1, MPI_INT, MPI_MIN, ranks_, &request);
        wait_for(request);
        return least != 0;
    }

private:
    MPI_Comm ranks_ = MPI_COMM_NULL;
};

class MpiRanks final : public Ranks {
public:
    MpiRanks(int rank, int size) : rank_(rank), size_(size) {}

    [[nodiscard]] std::size_t rank() const override { return static_cast<std::size_t>(rank_); }
    [[nodiscard]] std::size_t size() const override { return static_cast<std::size_t>(size_); }
    void sum(std::span<std::uint64_t> values) override { reduce(values, MPI_SUM); }
    void least(std::span<std::uint64_t> values) override { reduce(values, MPI_MIN); }

    [[nodiscard]] std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) override {
        const std::vector<std::uint64_t> sizes = sizes_of_all(bytes.size());
        if (rank_ != 0) {
            for_pieces(bytes.size(), [&](std::size_t first, int count) {
                MPI_Request request = MPI_REQUEST_NULL;
                MPI_Isend(bytes.data() + first, count, MPI_BYTE, 0, 0, MPI_COMM_WORLD, &request);
                wait_for(request);
            });
            return {};
        }
        std::vector<std::vector<std::byte>> all{{bytes.begin(), bytes.end()}};
        for (int from = 1; from < size_; ++from) {
            std::vector<std::byte>& part = all.emplace_back(sizes[static_cast<std::size_t>(from)]);
            for_pieces(part.size(), [&](std::size_t first, int count) {
                MPI_Request request = MPI_REQUEST_NULL;
                MPI_Irecv(part.data() + first, count, MPI_BYTE, from, 0, MPI_COMM_WORLD, &request);
                wait_for(request);
            });
        }
        return all;
    }

    [[nodiscard]] std::vector<std::vector<std::byte>> gather_to_all(std::span<const std::byte> bytes) override {
        const std::vector<std::uint64_t> sizes = sizes_of_all(bytes.size());
        std::vector<std::vector<std::byte>> all;
        for (int from = 0; from < size_; ++from) {
            std::vector<std::byte>& part = all.emplace_back(sizes[static_cast<std::size_t>(from)]);
            if (from == rank_) std::copy(bytes.begin(), bytes.end(), part.begin());
            for_pieces(part.size(), [&](std::size_t first, int count) {
                MPI_Request request = MPI_REQUEST_NULL;
                MPI_Ibcast(part.data() + first, count, MPI_BYTE, from, MPI_COMM_WORLD, &request);
                wait_for(request);
            });
        }
        return all;
    }

    [[nodiscard]] std::vector<std::vector<std::byte>> exchange(
        const std::vector<std::vector<std::byte>>& to_each) override {
        std::vector<std::uint64_t> sent;
        for (const std::vector<std::byte>& part : to_each) sent.push_back(part.size());
        std::vector<std::uint64_t> sizes(size());
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Ialltoall(sent.data(), 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, &request);
        wait_for(request);
        std::vector<std::vector<std::byte>> received(size());
        std::vector<MPI_Request> requests;
        for (int rank = 0; rank < size_; ++rank) {
            const auto k = static_cast<std::size_t>(rank);
            received[k].resize(sizes[k]);
            for_pieces(received[k].size(), [&](std::size_t first, int count) {
                MPI_Irecv(received[k].data() + first, count, MPI_BYTE, rank, 0, MPI_COMM_WORLD,
                          &requests.emplace_back());
            });
            for_pieces(to_each[k].size(), [&](std::size_t first, int count) {
                MPI_Isend(to_each[k].data() + first, count, MPI_BYTE, rank, 0, MPI_COMM_WORLD,
                          &requests.emplace_back());
            });
        }
        for (MPI_Request& open : requests) wait_for(open);
        return received;
    }

    [[nodiscard]] std::uint64_t have_in_common(std::span<const std::span<const std::byte>> pages) override {
        return mpi::have_in_common(pages, MachineRanks());
    }

private:
    static void reduce(std::span<std::uint64_t> values, MPI_Op how) {
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_UINT64_T, how, MPI_COMM_WORLD,
                       &request);
        wait_for(request);
    }
    [[nodiscard]] std::vector<std::uint64_t> sizes_of_all(std::size_t mine) const {
        const std::uint64_t own = mine;
        std::vector<std::uint64_t> sizes(size());
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Iallgather(&own, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, &request);
        wait_for(request);
        return sizes;
    }
    template <class Visit>
    static void for_pieces(std::size_t size, const Visit& visit) {
        for (std::size_t first = 0; first < size; first += kPiece) {
            visit(first, static_cast<int>(std::min(kPiece, size - first)));
        }
    }

    int rank_;
    int size_;
};

class LoadedMpi final : public MpiLibrary {
public:
    [[nodiscard]] std::shared_ptr<Ranks> join() override {
        // MPI does not need to yield the processor, because wait_for() sleeps.
        (void)::setenv("OMPI_MCA_mpi_yield_when_idle", "0", 0);
        int provided = 0;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
        int rank = 0;
        int size = 1;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        MPI_Comm_size(MPI_COMM_WORLD, &size);
        return std::make_shared<MpiRanks>(rank, size);
    }

    // If mpirun binds ranks to separate processors, they share no processor. Unbound ranks share all processors of the
    // machine.
    [[nodiscard]] std::size_t ranks_on_these_processors() override {
        MPI_Comm here = MPI_COMM_NULL;
        int count = 1;
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
        MPI_Comm_size(here, &count);
        cpu_set_t own;
        CPU_ZERO(&own);
        (void)::sched_getaffinity(0, sizeof own, &own);
        std::vector<cpu_set_t> all(static_cast<std::size_t>(count));
        MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, here);
        MPI_Comm_free(&here);
        const auto sharing = std::count_if(all.begin(), all.end(), [&own](const cpu_set_t& other) {
            cpu_set_t common;
            CPU_AND(&common, &own, &other);
            return CPU_COUNT(&common) > 0;
        });
        return static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, sharing));
    }

    void finalize() override { MPI_Finalize(); }
    void abort(int exit_code) override { MPI_Abort(MPI_COMM_WORLD, exit_code); }
};

}  // namespace
}  // namespace ricochet::mpi

// The type is MpiLibraryFunction, and the name kMpiLibraryFunction.
extern "C" ricochet::mpi::MpiLibrary* ricochet_mpi_library() {
    static ricochet::mpi::LoadedMpi mpi;
    return &mpi;
}
