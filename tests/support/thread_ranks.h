/// \file
/// Ranks that are threads of the test. They replace MPI processes, so that tests need no MPI.
#pragma once

#include <algorithm>
#include <barrier>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "ricochet/core/ranks.h"

namespace ricochet::testing {

/// Data shared by the threads.
struct ThreadRanksBoard {
    explicit ThreadRanksBoard(std::size_t size)
        : barrier(static_cast<std::ptrdiff_t>(size)), values(size), bytes(size), exchanged(size) {}
    std::barrier<> barrier;
    std::vector<std::vector<std::uint64_t>> values;
    std::vector<std::vector<std::byte>> bytes;
    std::vector<std::vector<std::vector<std::byte>>> exchanged;  // indexed by sender and receiver
};

class ThreadRanks final : public Ranks {
public:
    ThreadRanks(std::shared_ptr<ThreadRanksBoard> board, std::size_t rank) : board_(std::move(board)), rank_(rank) {}

    [[nodiscard]] std::size_t rank() const override { return rank_; }
    [[nodiscard]] std::size_t size() const override { return board_->values.size(); }
    void sum(std::span<std::uint64_t> values) override {
        combine(values, [](std::uint64_t a, std::uint64_t b) { return a + b; });
    }
    void least(std::span<std::uint64_t> values) override {
        combine(values, [](std::uint64_t a, std::uint64_t b) { return std::min(a, b); });
    }
    [[nodiscard]] std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) override {
        auto all = gather_to_all(bytes);
        if (rank_ != 0) all.clear();
        return all;
    }
    [[nodiscard]] std::vector<std::vector<std::byte>> gather_to_all(std::span<const std::byte> bytes) override {
        board_->bytes[rank_].assign(bytes.begin(), bytes.end());
        board_->barrier.arrive_and_wait();
        auto all = board_->bytes;
        board_->barrier.arrive_and_wait();
        return all;
    }

    [[nodiscard]] std::vector<std::vector<std::byte>> exchange(
        const std::vector<std::vector<std::byte>>& to_each) override {
        board_->exchanged[rank_] = to_each;
        board_->barrier.arrive_and_wait();
        std::vector<std::vector<std::byte>> received;
        for (const auto& from : board_->exchanged) received.push_back(from[rank_]);
        board_->barrier.arrive_and_wait();
        return received;
    }

private:
    template <class Combine>
    void combine(std::span<std::uint64_t> values, const Combine& how) {
        board_->values[rank_].assign(values.begin(), values.end());
        board_->barrier.arrive_and_wait();
        for (std::size_t rank = 0; rank < size(); ++rank) {
            for (std::size_t k = 0; k < values.size(); ++k) {
                values[k] = rank == 0 ? board_->values[0][k] : how(values[k], board_->values[rank][k]);
            }
        }
        board_->barrier.arrive_and_wait();
    }

    std::shared_ptr<ThreadRanksBoard> board_;
    std::size_t rank_;
};

/// Runs `work` on `count` ranks at the same time. Rethrows the exception of the lowest rank that threw. Either all
/// ranks must throw, or none.
inline void on_ranks(std::size_t count, const std::function<void(const std::shared_ptr<Ranks>&)>& work) {
    const auto board = std::make_shared<ThreadRanksBoard>(count);
    std::vector<std::exception_ptr> errors(count);
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < count; ++rank) {
        threads.emplace_back([&, rank] {
            try {
                work(std::make_shared<ThreadRanks>(board, rank));
            } catch (...) {
                errors[rank] = std::current_exception();
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& error : errors) {
        if (error) std::rethrow_exception(error);
    }
}

}  // namespace ricochet::testing
