#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "geo/core/random.hpp"
#include "geo/io/netcdf/stage_file.hpp"

namespace geo {

/// Values of every kind that a field may hold, NaN, negative zero and extremes among them.
inline Values sample_values(const FieldSpec& spec, Index size, std::uint64_t seed) {
  const RandomStream random(seed, spec.name);
  const auto fill = [&]<class T>(std::vector<T> values) -> Values {
    for (Index cell = 0; cell < size; ++cell) {
      const double u = random.uniform(cell);
      if constexpr (std::is_floating_point_v<T>) {
        values[cell] = static_cast<T>(9000.0 * (2.0 * u - 1.0));
      } else {
        values[cell] = static_cast<T>(spec.flags.empty() ? 100.0 * u : u * spec.flags.size());
      }
    }
    if constexpr (std::is_floating_point_v<T>) {
      using Limits = std::numeric_limits<T>;
      const T special[] = {Limits::quiet_NaN(), T{-0.0}, Limits::denorm_min(), Limits::max()};
      for (Index cell = 0; cell < 4; ++cell) values[3 + cell] = special[cell];
    } else {
      values[3] = static_cast<T>(spec.missing);
    }
    return values;
  };
  switch (spec.type) {
    case Type::float32:
      return fill(std::vector<float>(size));
    case Type::float64:
      return fill(std::vector<double>(size));
    case Type::int8:
      return fill(std::vector<std::int8_t>(size));
    case Type::int16:
      return fill(std::vector<std::int16_t>(size));
    case Type::int32:
      return fill(std::vector<std::int32_t>(size));
  }
  return {};
}

/// Every field of the vocabulary on a grid.
inline io::Snapshot sample_snapshot(Grid grid, std::uint64_t seed = 1) {
  io::Snapshot snapshot{"sample", std::make_shared<const Grid>(std::move(grid)), {}};
  for (const FieldSpec* spec : field::all()) {
    snapshot.fields.emplace_back(
        spec, std::make_shared<const Values>(sample_values(*spec, snapshot.grid->size(), seed)));
  }
  return snapshot;
}

inline io::Provenance sample_provenance() {
  return {"terrane: sample",
          "# résumé <&> \"quoted\"\nseed = 18446744073709551615\n",
          18446744073709551615ULL,
          "0.1.0",
          "2026-01-01T00:00:00Z: terrane run",
          "doi:10.0000/sample"};
}

inline bool same_bits(const Values& a, const Values& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&](const auto& array) {
        const auto& other = std::get<std::decay_t<decltype(array)>>(b);
        return array.size() == other.size() &&
               std::memcmp(array.data(), other.data(), array.size() * sizeof(array[0])) == 0;
      },
      a);
}

}  // namespace geo
