#include "thread_count.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <charconv>

#include "geo/core/error.hpp"
#include "log.hpp"

namespace terrane {
namespace {

int asked_of_environment() {
  const int asked = omp_get_max_threads(), processors = omp_get_num_procs();
  if (asked <= processors) return asked;
  log_warning(
      fmt::format("OMP_NUM_THREADS asks for {} threads, this machine has {} processor{}: "
                  "as many are used; --threads N sets another number",
                  asked, processors, processors == 1 ? "" : "s"));
  return processors;
}

int parse(const std::string& text) {
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

}  // namespace

int use_threads(const std::string& text) {
  const int threads = text.empty() ? asked_of_environment() : parse(text);
  omp_set_num_threads(threads);
  return threads;
}

}  // namespace terrane
