#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geo/io/maps/maps.hpp"

namespace geo::io {

struct MapPlan;

/// The maps of a planet or an island on one base. Each can be drawn by itself, at the same time as
/// others; none of it depends on how many are. The state must outlive it.
class MapSet {
 public:
  static MapSet of_planet(const State& state, const std::filesystem::path& folder,
                          const MapView& view, std::string_view note,
                          std::span<const EventMark> marks);
  /// Of an island, whose maps bear its name.
  static MapSet of_island(const State& state, const std::filesystem::path& folder,
                          const std::string& name, const MapView& view, std::string_view note);
  MapSet(MapSet&&) noexcept;
  ~MapSet();

  /// The pictures, drawn or not.
  [[nodiscard]] std::vector<MapFile> files() const;
  /// Prepares and draws all of them.
  void draw_all();
  /// Makes the folder and what all maps lie on.
  void prepare();
  /// A piece of work for each map of a prepared set, the longest first. They refer to the set.
  [[nodiscard]] std::vector<std::function<void()>> pieces() const;

 private:
  MapSet(const State& state, std::vector<MapPlan> plans, const std::filesystem::path& folder,
         const MapView& view, std::string_view note, std::span<const EventMark> marks);
  void draw(const MapPlan& plan) const;

  struct Base;
  const State* state_;
  std::vector<MapPlan> plans_;
  std::filesystem::path folder_;
  std::string note_;
  std::vector<EventMark> marks_;
  std::unique_ptr<Base> base_;
};

}  // namespace geo::io
