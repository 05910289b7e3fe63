#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "support/text_of.hpp"

namespace geo::test {

/// Nothing if two files hold the same bytes, else what a person would look for first.
inline std::string difference_of(const std::filesystem::path& one,
                                 const std::filesystem::path& other) {
  const std::string a = text_of(one), b = text_of(other);
  if (a == b) return {};
  const std::size_t shared = std::min(a.size(), b.size());
  std::size_t first = shared, count = 0;
  for (std::size_t k = shared; k-- > 0;) {
    if (a[k] == b[k]) continue;
    first = k;
    ++count;
  }
  return fmt::format("{} and {} bytes; of the first {} differ {}, from byte {} on", a.size(),
                     b.size(), shared, count, first);
}

}  // namespace geo::test
