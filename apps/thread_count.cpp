#include "thread_count.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <charconv>

#include "geo/core/error.hpp"

namespace terrane {

int thread_count(const std::string& text) {
  if (text.empty()) return omp_get_max_threads();
  constexpr int kMost = 1024;
  int threads = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, threads);
  if (error != std::errc() || stop != end || threads < 1 || threads > kMost) {
    throw geo::ConfigurationError(
        fmt::format("--threads {}: must be a whole number from 1 to {}", text, kMost));
  }
  return threads;
}

}  // namespace terrane
