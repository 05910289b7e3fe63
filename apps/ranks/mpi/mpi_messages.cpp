// The module that `terrane` loads where MPI has started it.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <vector>

#include "apps/ranks/rank_messages.hpp"

namespace terrane {
namespace {

constexpr int kTag = 1;

class MpiMessages : public RankMessages {
 public:
  MpiMessages() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    requests_.fill(MPI_REQUEST_NULL);
  }
  ~MpiMessages() override {
    MPI_Waitall(kOnTheWay, requests_.data(), MPI_STATUSES_IGNORE);
    MPI_Finalize();
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int count() const override { return count_; }

  void expect(std::size_t bytes) override {
    constexpr std::size_t kRoom = std::size_t(16) << 20;
    most_ = std::clamp<std::size_t>(kRoom / bytes, 4, copies_.size());
    for (std::size_t k = 0; k < most_; ++k) copies_[k].reserve(bytes);
  }

  void send(int to, std::span<const std::byte> bytes) override {
    next_ = (next_ + 1) % most_;
    MPI_Wait(&requests_[next_], MPI_STATUS_IGNORE);
    std::vector<std::byte>& copy = copies_[next_];
    copy.assign(bytes.begin(), bytes.end());
    MPI_Isend(copy.data(), static_cast<int>(copy.size()), MPI_BYTE, to, kTag, MPI_COMM_WORLD,
              &requests_[next_]);
  }

  std::size_t receive(int from, std::span<std::byte> bytes) override {
    MPI_Status status;
    MPI_Recv(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, from, kTag, MPI_COMM_WORLD,
             &status);
    return length(status);
  }

  std::optional<Waiting> waiting() override {
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &is_there, &status);
    if (is_there == 0) return std::nullopt;
    return Waiting{status.MPI_SOURCE, length(status)};
  }

 private:
  static std::size_t length(const MPI_Status& status) {
    int bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    return static_cast<std::size_t>(bytes);
  }

  static constexpr int kOnTheWay = 64;
  int rank_ = 0, count_ = 1;
  std::size_t most_ = kOnTheWay, next_ = 0;  ///< messages on their way
  std::array<MPI_Request, kOnTheWay> requests_{};
  std::array<std::vector<std::byte>, kOnTheWay> copies_;
};

}  // namespace
}  // namespace terrane

extern "C" terrane::RankMessages* terrane_make_rank_messages() { return new terrane::MpiMessages; }
