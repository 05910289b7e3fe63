#include "geo/kernels/plates/raster/raster_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "raster_cycles.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

void check(const RasterSettings& settings) {
  if (settings.world.columns < 16) {
    throw ConfigurationError("raster plates: a world of " + std::to_string(settings.world.columns) +
                             " cells round the equator; at least 16");
  }
  check_steps(settings);
}

}  // namespace

std::int32_t raster_samples(int columns) {
  constexpr double kMost = 16e6;  // that a lattice may have
  return static_cast<std::int32_t>(
      std::lround(std::min(kMost, static_cast<double>(columns) * columns / kPi)));
}

RasterSphere::RasterSphere(const SphereMesh& mesh, const RasterSettings& settings,
                           std::uint64_t seed)
    : pages_(mesh),
      settings_(settings),
      seed_(seed),
      cell_rad_(2.0 * kPi / settings.world.columns),
      page_(pages_.count()) {
  check(settings_);
  constexpr std::int32_t kPays = 50'000;  // samples
  pays_ = mesh.size() >= kPays;
  std::vector<RasterCrust> crust =
      start_raster_sphere(mesh.samples(), settings_.sea_share, settings_.ocean_crust,
                          settings_.continents_across, seed_);
  for (const RasterCrust& cell : crust) budget_.start += cell.height;
  divide(std::move(crust));
}

/// Cuts the crust of the world into new plates with new motion.
void RasterSphere::divide(std::vector<RasterCrust> crust) {
  const FibonacciSphere& samples = mesh().samples();
  plates_.assign(settings_.plates, RasterSpherePlate(pages_));
  owner_ = grow_raster_sphere_plates(samples, settings_.plates, seed_, budget_.cycles);
  std::vector<Vector3> middle(plates_.size(), Vector3{});
  for (std::int32_t i = 0; i < mesh().size(); ++i) {
    plates_[owner_[i]].set(i, crust[i]);
    middle[owner_[i]] = add(middle[owner_[i]], samples.position(i));
  }
  const RandomStream random(seed_, "raster.motion");
  for (int p = 0; p < settings_.plates; ++p) {
    RasterSpherePlate& plate = plates_[p];
    plate.tighten();
    // A plate all round the planet has no middle; any place will do.
    plate.centre = length(middle[p]) > 1e-6 ? normalised(middle[p]) : Vector3{0.0, 0.0, 1.0};
    const std::uint64_t draw = 8 * static_cast<std::uint64_t>(budget_.cycles);
    const double spread = settings_.speed_spread;
    const double speed = cell_rad_ * settings_.speed *
                         settings_.of(p, &RasterPlateSettings::speed, 1.0) *
                         random.uniform(p, draw + 1, 1.0 - spread, 1.0 + spread);
    // Any direction across the centre is the axis of a motion there.
    const Vector3 side =
        std::abs(plate.centre[2]) < 0.9 ? Vector3{0.0, 0.0, 1.0} : Vector3{1.0, 0.0, 0.0};
    const Vector3 axis = rotated(normalised(cross(plate.centre, side)),
                                 scaled(plate.centre, 2.0 * kPi * random.uniform(p, draw)));
    plate.rotation = add(scaled(axis, speed), plate.centre,
                         settings_.spin * random.uniform(p, draw + 2, -1.0, 1.0));
    plate.curve = settings_.curve * random.uniform(p, draw + 3, -1.0, 1.0);
  }
  turn_.assign(plates_.size(), Quaternion{}.matrix());
  for (Page& page : page_) page.watched.clear();
  previous_ = owner_;
  ++budget_.cycles;
  cycle_ = {};
}

RasterCycle::Motion RasterSphere::motion() const {
  return RasterCycle::motion_of(
      plates_, [&](const RasterSpherePlate& plate) { return plate.speed() / cell_rad_; });
}

bool RasterSphere::advance() {
  if (over_) return false;
  if (cycle_.is_over(settings_.limits(), motion())) {
    over_ = budget_.cycles >= settings_.cycles;
    if (!over_) divide(gathered(map(), mass(), budget_.resampled));
    return !over_;
  }
  ++budget_.steps;
  cycle_.begin_step();
  move();
  watch();
  meet();
  raise_arcs();
  slow_down();
  merge_continents();
  fill_gaps();
  return true;
}

void RasterSphere::move() {
  std::vector<double> rounded(plates_.size(), 0.0);
  const auto move_plate = [&](int p) {
    RasterSpherePlate& plate = plates_[p];
    if (!plate.alive) return;
    rounded[p] = tend(plate, p, settings_, budget_.steps);
    if (!plate.alive) return;
    plate.move();
    turn_[p] = plate.turn.matrix();
    plate.find_continents(settings_.continent_steps);
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1) if (pays_)
  for (int p = 0; p < static_cast<int>(plates_.size()); ++p) errors.guard([&] { move_plate(p); });
  errors.rethrow();
  for (const double added : rounded) budget_.rounded += added;
}

/// Lets magma of subducted crust rise; where the overriding plate has no crust it stays below.
void RasterSphere::raise_arcs() {
  const RandomStream random(seed_, "raster.arcs");
  const auto now = static_cast<std::int16_t>(budget_.steps);
  const double reach = settings_.speed > 0.0 ? settings_.arc_cells / settings_.speed : 0.0;
  const double scatter = cell_rad_ * settings_.arc_scatter_cells;
  for (const Arc& arc : arcs_) {
    const Vector3& place = mesh().samples().position(arc.at);
    const Vector3 offset = raster_arc_offset(cross(plates_[arc.below].rotation, place),
                                             cross(plates_[arc.above].rotation, place), reach);
    const auto words = random.words(budget_.steps, arc.at);
    const Vector3 aside =
        std::abs(place[2]) < 0.9 ? Vector3{0.0, 0.0, 1.0} : Vector3{1.0, 0.0, 0.0};
    const Vector3 x = normalised(cross(aside, place)), y = cross(place, x);
    const Vector3 target =
        normalised(add(add(add(place, offset), x, scatter * raster_scatter(words[0])), y,
                       scatter * raster_scatter(words[1])));
    RasterSpherePlate& above = plates_[arc.above];
    const std::int32_t sample = own_sample(arc.above, target, arc.from);
    RasterCrust crust = above.crust(sample);
    if (!(crust.height > 0.0F)) continue;
    const float before = crust.height;
    crust.add({arc.melt, now, 0});
    if (crust.height >= 1.0F) crust.folded = static_cast<std::uint16_t>(2 * budget_.steps);
    above.set(sample, crust);
    budget_.melted += static_cast<double>(crust.height) - before;
  }
}

void RasterSphere::slow_down() {
  for (std::size_t p = 0; p < plates_.size(); ++p) {
    RasterSpherePlate& plate = plates_[p];
    if (!plate.alive || folded_[p] == 0.0) continue;
    plate.rotation =
        scaled(plate.rotation, raster_speed_left(plate.speed() / cell_rad_, folded_[p], plate.mass,
                                                 settings_.friction, settings_.speed));
  }
  cycle_.note(met_);
}

/// New floor where no plate is, on the plate that was there before.
void RasterSphere::fill_gaps() {
  // What has gone down all at once, or moved to another plate, is a gap as well.
  const auto is_gap = [&](std::int32_t at) { return owner_[at] < 0; };
  const RasterCrust floor{static_cast<float>(settings_.ocean_crust),
                          static_cast<std::int16_t>(budget_.steps), 0};
  const auto give = [&](int plate, std::int32_t sample) {
    const double before = plates_[plate].mass;
    plates_[plate].set(sample, floor);
    budget_.created += plates_[plate].mass - before;
  };
  std::vector<std::pair<std::int32_t, std::int16_t>> filled;
  for (const std::int32_t at : gaps_) {
    int plate = previous_[at];
    for (int k = 0; !plates_[plate].alive; ++k) plate = k;
    const std::int32_t sample =
        mesh().samples().nearest(back(turn_[plate], mesh().samples().position(at)));
    if (!(plates_[plate].crust(sample).height > 0.0F)) give(plate, sample);
    // Cells that no sample of the world sees now, within the gap.
    for (const std::int32_t beside : mesh().neighbours(sample)) {
      if (plates_[plate].crust(beside).height > 0.0F) continue;
      const std::int32_t seat =
          pages_.nearest(times(turn_[plate], mesh().samples().position(beside)), at);
      if (is_gap(seat)) give(plate, beside);
    }
    filled.emplace_back(at, static_cast<std::int16_t>(plate));
  }
  for (const auto& [at, plate] : filled) owner_[at] = plate;
}

RasterMap RasterSphere::map() const {
  RasterMap map;
  map.crust.resize(mesh().size());
  map.plate = owner_;
#pragma omp parallel for schedule(dynamic, 8)
  for (int page = 0; page < pages_.count(); ++page) {
    for (std::size_t p = 0; p < plates_.size(); ++p) {
      if (!plates_[p].alive) continue;
      std::int32_t near = -1;
      for (const std::int32_t at : pages_.samples(page)) {
        const Vector3 own = back(turn_[p], mesh().samples().position(at));
        near = near < 0 ? mesh().samples().nearest(own) : pages_.nearest(own, near);
        const RasterCrust& crust = plates_[p].crust(near);
        if (crust.height > 0.0F) map.crust[at].add(crust);
      }
    }
  }
  // Where all that was there has just gone down or moved on there is new floor, as in a gap.
  for (RasterCrust& crust : map.crust) {
    if (crust.height > 0.0F) continue;
    crust = {static_cast<float>(settings_.ocean_crust), static_cast<std::int16_t>(budget_.steps),
             0};
  }
  return map;
}

double RasterSphere::mass() const {
  double sum = 0.0;
  for (const RasterSpherePlate& plate : plates_) {
    for (const std::int32_t page : plate.open_pages()) {
      for (const RasterSpherePlate::Cell& cell : plate.cells(page)) sum += cell.crust.height;
    }
  }
  return sum;
}

double RasterSphere::progress() const { return share_of_steps(settings_, budget_.cycles, cycle_); }

}  // namespace geo
