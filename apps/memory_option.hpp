#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "apps/memory/memory_cap.hpp"

namespace CLI {
class App;
}

namespace terrane {

/// What a command may take of memory, as it was typed.
struct MemoryOption {
  std::string memory, scratch;

  [[nodiscard]] bool is_given() const { return !memory.empty(); }
  /// Where the scratch file lies: in `folder` unless another is named.
  [[nodiscard]] const std::string& scratch_folder(const std::string& folder) const {
    return scratch.empty() ? folder : scratch;
  }
  /// The size that was given. Throws ConfigurationError if it is none, or no cap holds it, and
  /// where a scratch folder is named without one.
  [[nodiscard]] double bytes() const;
  /// A cap until its end, or none. `folder` takes the scratch file.
  [[nodiscard]] std::unique_ptr<MemoryCap> cap(const std::string& folder) const;
  /// What each of so many ranks takes of a run that takes so much by itself: the size that was
  /// given, or a share. Throws ConfigurationError where so little does not hold the run.
  [[nodiscard]] double bytes_of_rank(int ranks, double uncapped_bytes) const;
};

/// Adds --memory and --scratch. `what` is kept within so much: "the run".
void add_memory_options(CLI::App& command, MemoryOption& option, std::string_view what);

}  // namespace terrane
