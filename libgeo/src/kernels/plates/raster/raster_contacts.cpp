#include <algorithm>
#include <bit>
#include <cmath>

#include "geo/kernels/plates/raster/raster_tectonics.hpp"
#include "raster_blocks.hpp"

namespace geo {

/// Lays all plates on a row of the world, in their order, and settles who is on top.
void RasterTectonics::meet_along(int world_row) {
  const int columns = settings_.world.columns;
  const auto owner =
      std::span(owner_).subspan(static_cast<std::size_t>(world_row) * columns, columns);
  std::fill(owner.begin(), owner.end(), std::int16_t{-1});
  Row& events = rows_[world_row];
  int owned = 0;
  for (std::size_t p = 0; p < plates_.size(); ++p) {
    RasterPlate& plate = plates_[p];
    if (!plate.alive) continue;
    const int local = plate.local_row(world_row);
    if (local < 0) continue;
    const auto [begin, end] = plate.reach(local);
    if (begin >= end) continue;
    const RasterPlate::Block* blocks = plate.blocks(local);
    for (int block = begin / RasterPlate::kBlock; block * RasterPlate::kBlock < end; ++block) {
      std::uint32_t crust = blocks[block].crust;
      if (crust == 0) continue;
      const int first = block * RasterPlate::kBlock;
      const int column = settings_.world.column(plate.first_column() + first);
      if (crust == 0xFFFFU && column + RasterPlate::kBlock <= columns &&
          BlockOwners(&owner[column]).all_free()) {
        std::fill_n(&owner[column], RasterPlate::kBlock, static_cast<std::int16_t>(p));
        owned += RasterPlate::kBlock;
        continue;
      }
      for (; crust != 0; crust &= crust - 1) {
        const int k = std::countr_zero(crust);
        const int at = column + k < columns ? column + k : column + k - columns;
        if (owner[at] < 0) {
          owner[at] = static_cast<std::int16_t>(p);
          ++owned;
        } else {
          const std::int16_t other = owner[at];
          const Meeting meeting{at, plate.place(first + k, local),
                                plates_[other].find(at, world_row), static_cast<std::int16_t>(p),
                                other};
          plate.expect(meeting.place);
          plates_[other].expect(meeting.other_place);
          events.meetings.push_back(meeting);
        }
      }
    }
    for (const Meeting& meeting : events.meetings) meet(meeting, world_row, events);
    events.meetings.clear();
  }
  for (int column = 0; owned < columns && column < columns; ++column) {
    if (column + RasterPlate::kBlock <= columns && BlockOwners(&owner[column]).none_free()) {
      column += RasterPlate::kBlock - 1;
      continue;
    }
    if (owner[column] >= 0) continue;
    events.gaps.push_back(column);
    ++owned;
  }
}

/// A plate comes to a cell where another one is on top.
void RasterTectonics::meet(const Meeting& meeting, int world_row, Row& events) {
  const auto [column, place, other_place, plate, other] = meeting;
  std::int16_t& owner = owner_[static_cast<std::size_t>(world_row) * settings_.world.columns +
                               static_cast<std::size_t>(column)];
  const RasterCrust& crust = plates_[plate].crust(place);
  const RasterCrust& top = plates_[other].crust(other_place);
  switch (raster_meeting(top, crust)) {
    case RasterMeeting::second_sinks:
      subduct(plate, other, place, column, events);
      if (!(crust.height > 0.0F)) return;
      break;
    case RasterMeeting::first_sinks:
      subduct(other, plate, other_place, column, events);
      if (!(top.height > 0.0F)) {
        owner = plate;
        return;
      }
      break;
    case RasterMeeting::both_stay:
      break;
  }
  fold(plate, place, other, other_place, column, world_row, events);
}

void RasterTectonics::subduct(int below, int above, std::int32_t place, int column, Row& events) {
  RasterCrust crust = plates_[below].crust(place);
  const float before = crust.height;
  const auto [after, melt] = raster_sinking(before, settings_.ocean_crust, settings_.melting_ratio);
  crust.height = after;
  plates_[below].set(place, crust);
  events.subductions.push_back({column, static_cast<std::int16_t>(below),
                                static_cast<std::int16_t>(above), before, after, melt, -1});
}

void RasterTectonics::fold(int a, std::int32_t place_a, int b, std::int32_t place_b, int column,
                           int row, Row& events) {
  struct Side {
    int plate;
    std::int32_t place, continent, area;
  };
  const auto side = [&](int number, std::int32_t place) {
    const RasterPlate& plate = plates_[number];
    const std::int32_t continent =
        plate.continents().at(plate.local_column(column), plate.local_row(row));
    return Side{number, place, continent, continent < 0 ? 0 : plate.continents().area[continent]};
  };
  Side small = side(a, place_a), large = side(b, place_b);
  if (small.area > large.area) std::swap(small, large);
  RasterPlate& from = plates_[small.plate];
  RasterPlate& to = plates_[large.plate];
  RasterCrust source = from.crust(small.place), target = to.crust(large.place);
  const float before = source.height, other_before = target.height;
  raster_fold(
      source, target,
      settings_.of(small.plate, &RasterPlateSettings::folding_ratio, settings_.folding_ratio),
      budget_.steps);
  const float after = source.height, other_after = target.height;
  from.set(small.place, source);
  to.set(large.place, target);
  events.folds.push_back({column, static_cast<std::int16_t>(small.plate),
                          static_cast<std::int16_t>(large.plate), before, after, other_before,
                          other_after, small.continent, large.continent});
  owner_[static_cast<std::size_t>(row) * settings_.world.columns + column] =
      static_cast<std::int16_t>(large.plate);
}

RasterMap RasterTectonics::map() const {
  const RasterWorld& world = settings_.world;
  RasterMap map;
  map.crust.resize(world.size());
  map.plate = owner_;
#pragma omp parallel for schedule(dynamic, 8)
  for (int y = 0; y < world.rows; ++y) {
    const std::size_t first = static_cast<std::size_t>(y) * world.columns;
    for (const RasterPlate& plate : plates_) {
      const int local = plate.alive ? plate.local_row(y) : -1;
      if (local < 0) continue;
      const auto [begin, end] = plate.reach(local);
      for (int i = begin; i < end; ++i) {
        const RasterCrust crust = plate.crust(plate.place(i, local));
        if (!(crust.height > 0.0F)) continue;
        RasterCrust& all = map.crust[first + world.column(plate.first_column() + i)];
        all.add(crust);
      }
    }
  }
  return map;
}

}  // namespace geo
