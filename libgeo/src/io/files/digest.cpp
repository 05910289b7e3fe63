#include "geo/io/files/digest.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <new>

#include "geo/core/error.hpp"
#include "io/netcdf/stage_names.hpp"

namespace geo::io {
namespace {

std::string text_of(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string digest_of(const void* data, std::size_t bytes) {
  return text_of(XXH3_128bits(data, bytes));
}

struct FreeHash {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

/// Figures of one row.
struct RowSummary {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  std::int64_t cells = 0;
};

template <class T>
RowSummary summarise_row(const T* row, int nx, double missing) {
  RowSummary summary;
  for (int i = 0; i < nx; ++i) {
    const double value = row[i];
    if (std::isnan(value) || value == missing) continue;
    summary.min = std::min(summary.min, value);
    summary.max = std::max(summary.max, value);
    summary.sum += value;
    ++summary.cells;
  }
  return summary;
}

template <class T>
std::vector<RowSummary> summarise_rows(const std::vector<T>& values, const FieldSpec& spec,
                                       const Grid& grid) {
  const double missing =
      std::is_floating_point_v<T> ? std::numeric_limits<double>::quiet_NaN() : spec.missing;
  std::vector<RowSummary> rows(grid.ny());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    rows[j] =
        summarise_row(values.data() + static_cast<std::size_t>(j) * grid.nx(), grid.nx(), missing);
  }
  return rows;
}

}  // namespace

std::string digest_of(std::string_view text) { return digest_of(text.data(), text.size()); }

std::string digest_of(const Values& values) {
  return std::visit(
      [](const auto& array) { return digest_of(array.data(), array.size() * sizeof(array[0])); },
      values);
}

std::string digest_of_file(const std::filesystem::path& path) {
  const std::unique_ptr<XXH3_state_t, FreeHash> hash(XXH3_createState());
  if (!hash) throw std::bad_alloc();
  XXH3_128bits_reset(hash.get());
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> block(std::size_t(1) << 20);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) ||
         stream.gcount() > 0) {
    XXH3_128bits_update(hash.get(), block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) throw IoError(fmt::format("{}: could not be read", path.string()));
  return text_of(XXH3_128bits_digest(hash.get()));
}

std::string digest_of(const Checkpoint& checkpoint) {
  std::string text = fmt::format("{:a}", checkpoint.time_myr);
  for (const auto& [name, values] : checkpoint.arrays) {
    text += fmt::format(" {} {} {}", name, values.index(), digest_of(values));
  }
  return digest_of(std::string_view(text));
}

FieldRecord summarise(const FieldSpec& spec, const Values& values, const Grid& grid) {
  const auto rows =
      std::visit([&](const auto& array) { return summarise_rows(array, spec, grid); }, values);
  RowSummary all;
  double area_m2 = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    all.min = std::min(all.min, rows[j].min);
    all.max = std::max(all.max, rows[j].max);
    all.sum += rows[j].sum * grid.area_m2(j);
    all.cells += rows[j].cells;
    area_m2 += static_cast<double>(rows[j].cells) * grid.area_m2(j);
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const bool any = all.cells > 0;
  return {std::string(spec.name), std::string(spec.units),
          any ? all.min : kNone,  any ? all.sum / area_m2 : kNone,
          any ? all.max : kNone,  grid.size() - all.cells,
          digest_of(values)};
}

}  // namespace geo::io
