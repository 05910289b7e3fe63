#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geo/core/state.hpp"
#include "io/drawing/map_colours.hpp"
#include "io/maps/planet_months.hpp"

namespace geo::io {

using nlohmann::ordered_json;

/// Code of cells without a value; codes of others are less.
inline constexpr std::uint16_t kNothing = 65535;

/// Values of the page's cells as double, NaN where there is none.
[[nodiscard]] std::vector<double> shown_values(const State& state, const FieldSpec& spec,
                                               const Thinning& thinning);
/// "#rrggbb".
[[nodiscard]] std::string hex(Rgb colour);

/// The layers as they are gathered: their description and their elements.
class GlobeLayers {
 public:
  GlobeLayers(const State& state, const Thinning& thinning) : state_(state), thinning_(thinning) {}

  void add(const FieldSpec& spec, ordered_json entry, const std::vector<std::uint8_t>& shown = {}) {
    add_values(spec.name, shown_values(state_, spec, thinning_), spec.type != Type::float32,
               std::move(entry), shown);
  }
  void add_values(std::string_view name, const std::vector<double>& values, bool whole_numbers,
                  ordered_json entry, const std::vector<std::uint8_t>& shown = {});
  ordered_json described(const std::string& id, const std::vector<double>& values,
                         bool whole_numbers, ordered_json entry,
                         const std::vector<std::uint8_t>& shown = {}, int levels = kNothing - 1);

  ordered_json index = ordered_json::array();
  std::string elements;

 private:
  const State& state_;
  const Thinning& thinning_;
};

}  // namespace geo::io
