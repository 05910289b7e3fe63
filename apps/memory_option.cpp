#include "memory_option.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>

#include "apps/log.hpp"
#include "geo/core/error.hpp"
#include "memory/memory_size.hpp"

namespace terrane {

double MemoryOption::bytes() const {
  if (memory.empty() && !scratch.empty()) {
    throw geo::ConfigurationError("--scratch needs --memory, whose scratch file lies there");
  }
  return memory.empty() ? 0.0 : parse_memory_size(memory);
}

std::unique_ptr<MemoryCap> MemoryOption::cap(const std::string& folder) const {
  const double most_bytes = bytes();
  return is_given() ? std::make_unique<MemoryCap>(most_bytes, scratch_folder(folder)) : nullptr;
}

double MemoryOption::bytes_of_rank(int ranks, double uncapped_bytes) const {
  if (!scratch.empty()) {
    throw geo::ConfigurationError(
        "--scratch: several ranks have no scratch file; they keep for each other what does not fit "
        "one");
  }
  const double share = cap_of_rank(uncapped_bytes, ranks);
  if (!is_given()) return share;
  const double most_bytes = bytes();
  if (most_bytes < share) {
    throw geo::ConfigurationError(
        fmt::format("--memory {}: {} ranks want about {} each for this run; must be as much, or "
                    "more ranks",
                    memory, ranks, shown_bytes(share)));
  }
  return most_bytes;
}

void add_memory_options(CLI::App& command, MemoryOption& option, std::string_view what) {
  command
      .add_option("--memory", option.memory,
                  fmt::format("Keep {} within so much memory, such as 16GiB or 500MB: what does "
                              "not fit waits in a scratch file; same bits",
                              what))
      ->type_name("SIZE");
  command
      .add_option("--scratch", option.scratch,
                  "With --memory: folder of the scratch file (default: that of the files)")
      ->type_name("DIR");
}

}  // namespace terrane
