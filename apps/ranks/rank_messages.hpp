#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace terrane {

/// Messages between the processes of one job. Not for several threads at once.
class RankMessages {
 public:
  RankMessages() = default;
  virtual ~RankMessages() = default;  ///< waits for all ranks
  RankMessages(const RankMessages&) = delete;
  RankMessages& operator=(const RankMessages&) = delete;

  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int count() const = 0;

  /// Room for messages of so many bytes is made now: none is asked for while one is sent.
  virtual void expect(std::size_t bytes) = 0;
  /// On its way when it returns; the caller's bytes may change. Messages to one rank arrive in
  /// order.
  virtual void send(int to, std::span<const std::byte> bytes) = 0;
  /// Waits for the next message of a rank and returns its length, `bytes.size()` at most.
  virtual std::size_t receive(int from, std::span<std::byte> bytes) = 0;
  /// A message that waits to be received; nothing where none does.
  struct Waiting {
    int from = 0;
    std::size_t bytes = 0;
  };
  virtual std::optional<Waiting> waiting() = 0;
};

/// What the module with MPI in it has, by this name: it alone is linked with MPI, so that a program
/// that no `mpirun` started loads none.
using MakeRankMessages = RankMessages* (*)();
inline constexpr const char* kMakeRankMessages = "terrane_make_rank_messages";

}  // namespace terrane
