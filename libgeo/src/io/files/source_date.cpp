#include "geo/io/files/source_date.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <cstring>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

const char* given_text() { return std::getenv("SOURCE_DATE_EPOCH"); }

}  // namespace

bool time_is_given() { return given_text() != nullptr; }

std::time_t now_or_given() {
  const char* const text = given_text();
  if (text == nullptr) return std::time(nullptr);
  constexpr std::time_t kEndOfYear9999 = 253402300799;
  std::time_t time = 0;
  const char* const end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, time);
  if (error != std::errc() || stop != end || time < 0 || time > kEndOfYear9999) {
    throw ConfigurationError(fmt::format(
        "SOURCE_DATE_EPOCH = {}: must be seconds since 1970, up to {}", text, kEndOfYear9999));
  }
  return time;
}

}  // namespace geo::io
