#include "geo/kernels/plates/raster/raster_tectonics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/plates/raster/raster_start.hpp"
#include "raster_cycles.hpp"

namespace geo {

RasterTectonics::RasterTectonics(const RasterSettings& settings, std::uint64_t seed)
    : settings_(settings), seed_(seed) {
  const RasterWorld& world = settings_.world;
  if (world.columns < 16 || world.rows < 16) {
    throw ConfigurationError("raster plates: a world of " + std::to_string(world.columns) + " x " +
                             std::to_string(world.rows) + " cells; at least 16 x 16");
  }
  check_steps(settings_);
  constexpr std::int32_t kPays = 1'000'000;  // cells
  pays_ = world.size() >= kPays;
  rows_.resize(world.rows);
  std::vector<RasterCrust> crust = start_raster(world, settings_.sea_share, settings_.ocean_crust,
                                                settings_.continents_across, seed_);
  for (const RasterCrust& cell : crust) budget_.start += cell.height;
  divide(std::move(crust));
}

/// Cuts the crust of the world into new plates with new motion.
void RasterTectonics::divide(std::vector<RasterCrust> crust) {
  const RasterWorld& world = settings_.world;
  plates_.clear();
  owner_ = grow_raster_plates(world, settings_.plates, seed_, budget_.cycles);
  // Columns and rows that a plate has cells in; the widest gap round the torus is left out.
  const auto count = static_cast<std::size_t>(settings_.plates);
  std::vector<std::uint8_t> in_column(count * world.columns), in_row(count * world.rows);
  for (int y = 0; y < world.rows; ++y) {
    for (int x = 0; x < world.columns; ++x) {
      const std::size_t plate = owner_[static_cast<std::size_t>(y) * world.columns + x];
      in_column[plate * world.columns + x] = 1;
      in_row[plate * world.rows + y] = 1;
    }
  }
  const auto extent = [](std::span<const std::uint8_t> used) {
    const int n = static_cast<int>(used.size());
    int gap = 0, after = 0, run = 0;
    for (int k = 0; k < 2 * n; ++k) {
      run = used[k % n] != 0 ? 0 : run + 1;
      if (run > gap && run <= n) {
        gap = run;
        after = (k + 1) % n;
      }
    }
    return std::pair(after, n - gap);
  };
  const RandomStream random(seed_, "raster.motion");
  for (int p = 0; p < settings_.plates; ++p) {
    RasterPlate& plate = plates_.emplace_back(world);
    const auto [left, columns] = extent(
        std::span(in_column).subspan(p * static_cast<std::size_t>(world.columns), world.columns));
    const auto [top, rows] =
        extent(std::span(in_row).subspan(p * static_cast<std::size_t>(world.rows), world.rows));
    plate.open(left, top, columns, rows);
    plate.centre_x = left + 0.5 * columns;
    plate.centre_y = top + 0.5 * rows;
    const std::uint64_t draw = 8 * static_cast<std::uint64_t>(budget_.cycles);
    const double angle = 2.0 * std::numbers::pi * random.uniform(p, draw);
    const double spread = settings_.speed_spread;
    const double speed = settings_.speed * settings_.of(p, &RasterPlateSettings::speed, 1.0) *
                         random.uniform(p, draw + 1, 1.0 - spread, 1.0 + spread);
    plate.east = speed * std::cos(angle);
    plate.north = speed * std::sin(angle);
    plate.spin = settings_.spin * random.uniform(p, draw + 2, -1.0, 1.0);
    plate.curve = settings_.curve * random.uniform(p, draw + 3, -1.0, 1.0);
  }
  for (int y = 0; y < world.rows; ++y) {
    for (int x = 0; x < world.columns; ++x) {
      const std::size_t cell = static_cast<std::size_t>(y) * world.columns + x;
      RasterPlate& plate = plates_[owner_[cell]];
      plate.set(plate.claim(x, y), crust[cell]);
    }
  }
  for (RasterPlate& plate : plates_) plate.tighten();
  previous_ = owner_;
  ++budget_.cycles;
  cycle_ = {};
}

RasterCycle::Motion RasterTectonics::motion() const {
  return RasterCycle::motion_of(
      plates_, [](const RasterPlate& plate) { return std::hypot(plate.east, plate.north); });
}

bool RasterTectonics::advance() {
  if (over_) return false;
  if (cycle_.is_over(settings_.limits(), motion())) {
    over_ = budget_.cycles >= settings_.cycles;
    if (!over_) divide(gathered(map(), mass(), budget_.rounded));
    return !over_;
  }
  ++budget_.steps;
  cycle_.begin_step();
  move();
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1) if (pays_)
  for (int p = 0; p < static_cast<int>(plates_.size()); ++p) {
    errors.guard([&] {
      if (plates_[p].alive) plates_[p].find_continents(settings_.continent_steps);
    });
  }
  errors.rethrow();
  std::swap(owner_, previous_);
#pragma omp parallel for schedule(dynamic, 8) if (pays_)
  for (int row = 0; row < settings_.world.rows; ++row) errors.guard([&] { meet_along(row); });
  errors.rethrow();
  raise_arcs();
  slow_down();
  fill_gaps();
  return true;
}

void RasterTectonics::move() {
  std::vector<double> rounded(plates_.size(), 0.0);
  const auto move_plate = [&](int p) {
    RasterPlate& plate = plates_[p];
    if (!plate.alive) return;
    rounded[p] = tend(plate, p, settings_, budget_.steps);
    // With a spin, the path bends as the plate turns: motion about a pole.
    const double c = std::cos(plate.spin + plate.curve), s = std::sin(plate.spin + plate.curve);
    const double east = c * plate.east - s * plate.north;
    plate.north = s * plate.east + c * plate.north;
    plate.east = east;
    plate.x += plate.east;
    plate.y += plate.north;
    plate.angle += plate.spin;
    plate.settle();
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1) if (pays_)
  for (int p = 0; p < static_cast<int>(plates_.size()); ++p) errors.guard([&] { move_plate(p); });
  errors.rethrow();
  for (const double added : rounded) budget_.rounded += added;
}

/// Where magma of subducted crust rises: inland, along the motion of the lower plate as the upper
/// one sees it, with some scatter.
std::int32_t RasterTectonics::arc_place(const Subduction& event, int row,
                                        const RandomStream& random) const {
  const RasterPlate& below = plates_[event.below];
  const RasterPlate& above = plates_[event.above];
  const double reach = settings_.speed > 0.0 ? settings_.arc_cells / settings_.speed : 0.0;
  const auto offset =
      raster_arc_offset<2>({below.east, below.north}, {above.east, above.north}, reach);
  const auto words = random.words(budget_.steps, row * settings_.world.columns + event.column);
  const double sx = settings_.arc_scatter_cells * raster_scatter(words[0]);
  const double sy = settings_.arc_scatter_cells * raster_scatter(words[1]);
  return above.find(static_cast<int>(std::floor(event.column + offset[0] + sx)),
                    static_cast<int>(std::floor(row + offset[1] + sy)));
}

/// Takes subducted crust out of the budget and lets its magma rise; where the overriding plate has
/// no crust it stays below.
void RasterTectonics::raise_arcs() {
  const RandomStream random(seed_, "raster.arcs");
  const auto now = static_cast<std::int16_t>(budget_.steps);
  for (int y = 0; y < settings_.world.rows; ++y) {
    for (Subduction& event : rows_[y].subductions) {
      plates_[event.below].note(event.before, event.after);
      budget_.subducted += static_cast<double>(event.before) - event.after;
      if (event.melt > 0.0F) event.target = arc_place(event, y, random);
      plates_[event.above].expect(event.target);
    }
    for (const Subduction& event : rows_[y].subductions) {
      RasterPlate& above = plates_[event.above];
      if (event.target < 0 || !(above.crust(event.target).height > 0.0F)) continue;
      RasterCrust crust = above.crust(event.target);
      const float before = crust.height;
      crust.add({event.melt, now, 0});
      const float after = crust.height;
      if (after >= 1.0F) crust.folded = static_cast<std::uint16_t>(2 * budget_.steps);
      above.set(event.target, crust);
      above.note(before, after);
      budget_.melted += static_cast<double>(after) - before;
    }
    rows_[y].subductions.clear();
  }
}

/// Budget of folding: friction, and how far which continents overlap.
void RasterTectonics::slow_down() {
  std::vector<Overlap> overlaps;
  std::map<std::array<std::int32_t, 4>, std::size_t> number;
  std::size_t last = 0;
  bool met = false;
  std::vector<double> folded(plates_.size(), 0.0);
  for (Row& row : rows_) {
    for (const Fold& event : row.folds) {
      met = true;
      RasterPlate& from = plates_[event.from];
      RasterPlate& to = plates_[event.to];
      from.note(event.before, event.after);
      to.note(event.other_before, event.other_after);
      const double moved = static_cast<double>(event.before) - event.after;
      budget_.folded += moved;
      budget_.rounded += static_cast<double>(event.other_after) - event.other_before - moved;
      folded[event.from] += moved;
      folded[event.to] += moved;
      if (event.continent < 0 || event.other < 0) continue;
      Overlap key{event.from, event.to, event.continent, event.other, 0};
      const auto same = [&](const Overlap& o) {
        return o.a == key.a && o.b == key.b && o.continent_a == key.continent_a &&
               o.continent_b == key.continent_b;
      };
      if (last >= overlaps.size() || !same(overlaps[last])) {
        const auto [at, is_new] =
            number.try_emplace({key.a, key.b, key.continent_a, key.continent_b}, overlaps.size());
        last = at->second;
        if (is_new) overlaps.push_back(key);
      }
      ++overlaps[last].cells;
    }
    row.folds.clear();
  }
  for (std::size_t p = 0; p < plates_.size(); ++p) {
    RasterPlate& plate = plates_[p];
    const double left = raster_speed_left(std::hypot(plate.east, plate.north), folded[p],
                                          plate.mass, settings_.friction, settings_.speed);
    plate.east *= left;
    plate.north *= left;
  }
  cycle_.note(met);
  merge_continents(overlaps);
}

void RasterTectonics::merge_continents(std::span<const Overlap> overlaps) {
  for (const Overlap& overlap : overlaps) {
    const auto& small = plates_[overlap.a].continents();
    const auto& large = plates_[overlap.b].continents();
    // One of both may have gone to another plate within this step.
    const std::int32_t area = small.area[overlap.continent_a];
    if (area == 0 || large.area[overlap.continent_b] == 0) continue;
    const double relative =
        settings_.of(overlap.a, &RasterPlateSettings::overlap_relative, settings_.overlap_relative);
    if (static_cast<double>(overlap.cells) >= settings_.overlap_cells ||
        static_cast<double>(overlap.cells) >= relative * area) {
      merge(overlap);
    }
  }
}

/// The smaller continent moves to the larger one's plate. Momentum goes with it.
void RasterTectonics::merge(const Overlap& overlap) {
  const RasterWorld& world = settings_.world;
  RasterPlate& from = plates_[overlap.a];
  RasterPlate& to = plates_[overlap.b];
  RasterContinents& continents = from.continents();
  double moved = 0.0;
  const int rows = static_cast<int>(continents.row_begin.size()) - 1;
  for (int j = 0; j < rows; ++j) {
    const int y = world.row(continents.top + j + from.shift_y());
    for (int k = continents.row_begin[j]; k < continents.row_begin[j + 1]; ++k) {
      const RasterContinents::Run run = continents.runs[k];
      if (run.continent != overlap.continent_a) continue;
      for (int i = run.begin; i < run.end; ++i) {
        const int x = world.column(continents.left + i + from.shift_x());
        const std::int32_t place = from.find(x, y);
        if (place < 0 || !(from.crust(place).height > 0.0F)) continue;
        const std::int32_t at = to.claim(x, y);
        const RasterCrust source = from.crust(place);
        RasterCrust target = to.crust(at);
        const float before = target.height;
        target.add(source);
        to.set(at, target);
        from.set(place, {});
        to.note(before, target.height);
        moved += source.height;
        budget_.rounded += static_cast<double>(target.height) - before - source.height;
        std::int16_t& owner = owner_[static_cast<std::size_t>(y) * world.columns + x];
        if (owner == overlap.a) owner = overlap.b;
      }
    }
  }
  from.mass -= moved;
  from.forget_continents();
  to.forget_continents();
  continents.area[overlap.continent_a] = 0;
  budget_.merged += moved;
  ++budget_.mergers;
  if (moved <= 0.0 || to.mass <= 0.0) return;
  const double share = moved / to.mass;
  to.east += share * (from.east - to.east);
  to.north += share * (from.north - to.north);
}

void RasterTectonics::fill_gaps() {
  const RasterWorld& world = settings_.world;
  const auto floor = static_cast<float>(settings_.ocean_crust);
  for (int y = 0; y < world.rows; ++y) {
    for (const std::int32_t x : rows_[y].gaps) {
      const RasterPlate& plate =
          plates_[previous_[static_cast<std::size_t>(y) * world.columns + x]];
      if (plate.alive) plate.expect(plate.find(x, y));
    }
    for (const std::int32_t x : rows_[y].gaps) {
      const std::size_t cell = static_cast<std::size_t>(y) * world.columns + x;
      int plate = previous_[cell];
      for (int k = 0; !plates_[plate].alive; ++k) plate = k;
      const std::int32_t place = plates_[plate].claim(x, y);
      const float before = plates_[plate].crust(place).height;
      plates_[plate].set(place, {floor, static_cast<std::int16_t>(budget_.steps), 0});
      plates_[plate].note(before, floor);
      owner_[cell] = static_cast<std::int16_t>(plate);
      budget_.created += static_cast<double>(floor) - before;
    }
    rows_[y].gaps.clear();
  }
}

double RasterTectonics::mass() const {
  double sum = 0.0;
  for (const RasterPlate& plate : plates_) {
    for (int j = 0; j < plate.rows(); ++j) {
      for (const RasterCrust& crust : plate.row(j)) sum += crust.height;
    }
  }
  return sum;
}

double RasterTectonics::progress() const {
  return share_of_steps(settings_, budget_.cycles, cycle_);
}

}  // namespace geo
