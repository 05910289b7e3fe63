#include "globe_layers.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <vtkBase64Utilities.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <variant>

namespace geo::io {
namespace {

/// Deflated and in base64.
std::string packed(const std::vector<std::uint8_t>& bytes) {
  constexpr int kLevel = 6;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::vector<std::uint8_t> small(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  small.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), small.data(),
                                        small.size()));
  std::string text(small.size() / 3 * 4 + 8, '\0');
  const auto length = vtkBase64Utilities::Encode(small.data(), small.size(),
                                                 reinterpret_cast<unsigned char*>(text.data()));
  text.resize(length);
  return text;
}

/// Values as codes of 16 bits between the least and the most.
struct Codes {
  double offset = 0.0, scale = 1.0;
  std::vector<std::uint16_t> codes;
};

Codes coded(const std::vector<double>& values, bool whole_numbers, int levels) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  Codes out;
  if (low > high) low = high = 0.0;
  out.offset = low;
  out.scale = whole_numbers ? 1.0 : std::max((high - low) / levels, 1e-30);
  out.codes.reserve(values.size());
  for (const double value : values) {
    out.codes.push_back(std::isfinite(value)
                            ? static_cast<std::uint16_t>(std::lround((value - low) / out.scale))
                            : kNothing);
  }
  return out;
}

/// Differences along rows, low bytes before high ones, and which cells are shown where only some
/// are.
std::vector<std::uint8_t> bytes_of(const std::vector<std::uint16_t>& codes, int width,
                                   const std::vector<std::uint8_t>& shown) {
  const std::size_t count = codes.size();
  std::vector<std::uint8_t> bytes(2 * count);
  for (std::size_t at = 0; at < count; ++at) {
    const bool begins = at % static_cast<std::size_t>(width) == 0;
    const auto difference = static_cast<std::uint16_t>(codes[at] - (begins ? 0 : codes[at - 1]));
    bytes[at] = static_cast<std::uint8_t>(difference & 255U);
    bytes[count + at] = static_cast<std::uint8_t>(difference >> 8U);
  }
  bytes.insert(bytes.end(), shown.begin(), shown.end());
  return bytes;
}

}  // namespace

std::vector<double> shown_values(const State& state, const FieldSpec& spec,
                                 const Thinning& thinning) {
  return std::visit(
      [&]<class T>(const std::vector<T>& values) {
        const std::vector<T> cells = thinned(std::span<const T>(values), state.grid(), thinning);
        std::vector<double> out(cells.begin(), cells.end());
        if constexpr (std::is_integral_v<T>) {
          for (std::size_t k = 0; k < out.size(); ++k) {
            if (cells[k] == static_cast<T>(spec.missing)) {
              out[k] = std::numeric_limits<double>::quiet_NaN();
            }
          }
        }
        return out;
      },
      *state.values(spec));
}

std::string hex(Rgb colour) {
  const auto byte = [](float part) {
    return static_cast<int>(std::lround(255.0F * std::clamp(part, 0.0F, 1.0F)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.r), byte(colour.g), byte(colour.b));
}

void GlobeLayers::add_values(std::string_view name, const std::vector<double>& values,
                             bool whole_numbers, ordered_json entry,
                             const std::vector<std::uint8_t>& shown) {
  entry["name"] = name;
  index.push_back(
      described(fmt::format("globe-{}", name), values, whole_numbers, std::move(entry), shown));
}
ordered_json GlobeLayers::described(const std::string& id, const std::vector<double>& values,
                                    bool whole_numbers, ordered_json entry,
                                    const std::vector<std::uint8_t>& shown, int levels) {
  const Codes codes = coded(values, whole_numbers, levels);
  entry["id"] = id;
  entry["offset"] = codes.offset;
  entry["scale"] = codes.scale;
  entry["masked"] = !shown.empty();
  elements += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id,
                          packed(bytes_of(codes.codes, thinning_.nx, shown)));
  return entry;
}

}  // namespace geo::io
