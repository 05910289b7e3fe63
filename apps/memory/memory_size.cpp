#include "memory_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

#include "geo/core/error.hpp"

namespace terrane {

double parse_memory_size(const std::string& text) {
  struct Unit {
    const char* name;
    double bytes;
  };
  constexpr std::array<Unit, 9> kUnits{{{"B", 1.0},
                                        {"kB", 1e3},
                                        {"MB", 1e6},
                                        {"GB", 1e9},
                                        {"TB", 1e12},
                                        {"KiB", 0x1p10},
                                        {"MiB", 0x1p20},
                                        {"GiB", 0x1p30},
                                        {"TiB", 0x1p40}}};
  const std::size_t digits = std::min(text.size(), text.find_first_not_of("0123456789."));
  double number = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + digits, number);
  const std::string unit = text.substr(digits);
  const auto known = std::find_if(kUnits.begin(), kUnits.end(),
                                  [&](const Unit& each) { return unit == each.name; });
  if (digits == 0 || error != std::errc() || stop != text.data() + digits ||
      known == kUnits.end()) {
    throw geo::ConfigurationError(
        fmt::format("--memory {}: must be a size such as 16GiB or 500MB", text));
  }
  const double bytes = number * known->bytes;
  constexpr double kMost_bytes = 0x1p50;
  if (bytes < kLeastMemory_bytes || bytes > kMost_bytes) {
    throw geo::ConfigurationError(fmt::format(
        "--memory {}: must be from {:.0f}MB, which the program takes on any grid, to 1024TiB", text,
        kLeastMemory_bytes / 1e6));
  }
  return bytes;
}

}  // namespace terrane
