#include "geo/core/random.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geo {
namespace {

std::uint64_t hash_name(std::string_view name) {  // FNV-1a, 64 bits
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

double to_unit(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 21) ^ (low >> 11);
  return static_cast<double>(bits & ((1ULL << 53) - 1)) * 0x1.0p-53;
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
  // Seed and name are mixed by the generator itself, so that near seeds give unrelated keys.
  const std::uint64_t hash = hash_name(name);
  const philox4x32_ctr_t counter{{static_cast<std::uint32_t>(hash),
                                  static_cast<std::uint32_t>(hash >> 32), 0x7465'7272, 0x616e'65}};
  const philox4x32_key_t key{
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const auto mixed = philox4x32(counter, key);
  key_ = {mixed.v[0], mixed.v[1]};
}

std::array<std::uint32_t, 4> RandomStream::words(std::uint64_t index,
                                                 std::uint64_t sub_index) const {
  const philox4x32_ctr_t counter{
      {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32),
       static_cast<std::uint32_t>(sub_index), static_cast<std::uint32_t>(sub_index >> 32)}};
  const philox4x32_key_t key{{key_[0], key_[1]}};
  const auto out = philox4x32(counter, key);
  return {out.v[0], out.v[1], out.v[2], out.v[3]};
}

double RandomStream::uniform(std::uint64_t index, std::uint64_t sub_index) const {
  const auto word = words(index, sub_index);
  return to_unit(word[0], word[1]);
}

double RandomStream::normal(std::uint64_t index, std::uint64_t sub_index) const {
  const auto word = words(index, sub_index);
  const double u = 1.0 - to_unit(word[0], word[1]);  // (0, 1]
  const double v = to_unit(word[2], word[3]);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

std::array<double, 3> RandomStream::direction(std::uint64_t index) const {
  const auto word = words(index, ~std::uint64_t{0});
  const double z = 2.0 * to_unit(word[0], word[1]) - 1.0;
  const double angle = 2.0 * std::numbers::pi * to_unit(word[2], word[3]);
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace geo
