#include "geo/kernels/plates/raster/raster_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

void check(const RasterSettings& settings) {
  if (settings.world.columns < 16) {
    throw ConfigurationError("raster plates: a world of " + std::to_string(settings.world.columns) +
                             " cells round the equator; at least 16");
  }
  constexpr std::int64_t kMostSteps = 32'000;  // as cells count them
  if (std::int64_t{settings.cycles} * settings.cycle_steps > kMostSteps) {
    throw ConfigurationError("raster plates: " + std::to_string(settings.cycles) + " cycles of " +
                             std::to_string(settings.cycle_steps) +
                             " steps; at most 32000 steps in all");
  }
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
    if (budget_.cycles >= settings_.cycles) {
      over_ = true;
      return false;
    }
    std::vector<RasterCrust> crust = map().crust;
    double all = 0.0;
    for (const RasterCrust& cell : crust) all += cell.height;
    budget_.resampled += all - mass();
    divide(std::move(crust));
    return true;
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
  constexpr int kTighten = 32;
  std::vector<double> rounded(plates_.size(), 0.0);
  const auto move_plate = [&](int p) {
    RasterSpherePlate& plate = plates_[p];
    if (!plate.alive) return;
    const auto period = static_cast<std::int64_t>(
        settings_.of(p, &RasterPlateSettings::erosion_steps, settings_.erosion_steps));
    if (period > 0 && budget_.steps % period == 0) {
      rounded[p] = plate.erode(settings_.erosion);
    }
    if (budget_.steps % kTighten == 0) plate.tighten();
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

/// Which plates may have crust in a page of the world; one alone that fills all of it is calm.
void RasterSphere::watch() {
  for (Page& page : page_) page.plates.clear();
  for (std::size_t p = 0; p < plates_.size(); ++p) {
    if (!plates_[p].alive) continue;
    for (const std::int32_t own : plates_[p].open_pages()) {
      const Vector3 middle = times(turn_[p], pages_.middles().position(own));
      const std::int32_t near = plates_[p].lies_over(own, middle);
      pages_.pages_about(middle, near, [&](std::int32_t page) {
        auto& plates = page_[page].plates;
        if (plates.empty() || plates.back() != static_cast<std::int16_t>(p)) {
          plates.push_back(static_cast<std::int16_t>(p));
        }
      });
    }
  }
}

bool RasterSphere::is_calm(std::int32_t page) const {
  if (page_[page].plates.size() != 1) return false;
  const std::int16_t plate = page_[page].plates.front();
  const Vector3 middle = back(turn_[plate], pages_.middles().position(page));
  bool is_full = true;
  pages_.pages_about(middle, pages_.middles().nearest(middle),
                     [&](std::int32_t own) { is_full = is_full && plates_[plate].is_full(own); });
  return is_full;
}

/// The plates' samples at those of a page of the world, sample by sample of each plate in turn.
void RasterSphere::find_seats(std::int32_t number) {
  Page& page = page_[number];
  const auto samples = pages_.samples(number);
  std::vector<std::int32_t> seats;
  for (const std::int16_t plate : page.plates) {
    // Where it was a step ago is near; without that, what the sample before saw.
    const auto before = std::find(page.watched.begin(), page.watched.end(), plate);
    const std::int32_t* last =
        before == page.watched.end()
            ? nullptr
            : &page.seats[static_cast<std::size_t>(before - page.watched.begin()) * samples.size()];
    std::int32_t near = -1;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Vector3 own = back(turn_[plate], mesh().samples().position(samples[k]));
      if (last != nullptr) near = last[k];
      near = near < 0 ? mesh().samples().nearest(own) : pages_.nearest(own, near);
      seats.push_back(near);
    }
  }
  page.watched = page.plates;
  page.seats = std::move(seats);
}

void RasterSphere::meet() {
  std::swap(owner_, previous_);
  std::vector<std::vector<Crowd>> crowds(pages_.count());
  std::vector<std::vector<std::int32_t>> gaps(pages_.count());
  const auto meet_in_page = [&](std::int32_t number) {
    const auto samples = pages_.samples(number);
    Page& page = page_[number];
    if (is_calm(number)) {
      page.watched.clear();
      for (const std::int32_t at : samples) owner_[at] = page.plates.front();
      return;
    }
    find_seats(number);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      Seat first{-1, -1};
      Crowd* crowd = nullptr;
      for (std::size_t p = 0; p < page.plates.size(); ++p) {
        const Seat seat{page.plates[p], page.seats[p * samples.size() + k]};
        if (!(plates_[seat.plate].crust(seat.sample).height > 0.0F)) continue;
        if (first.plate < 0) {
          first = seat;
          continue;
        }
        if (crowd == nullptr) crowd = &crowds[number].emplace_back(Crowd{samples[k], {first}});
        crowd->seats.push_back(seat);
      }
      owner_[samples[k]] = first.plate;
      if (first.plate < 0) gaps[number].push_back(samples[k]);
    }
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 8) if (pays_)
  for (std::int32_t number = 0; number < pages_.count(); ++number) {
    errors.guard([&] { meet_in_page(number); });
  }
  errors.rethrow();
  arcs_.clear();
  overlaps_.clear();
  gaps_.clear();
  folded_.assign(plates_.size(), 0.0);
  met_ = false;
  for (std::int32_t page = 0; page < pages_.count(); ++page) {
    gaps_.insert(gaps_.end(), gaps[page].begin(), gaps[page].end());
    for (const Crowd& crowd : crowds[page]) meet_at(crowd);
  }
}

/// Lays plates on a place of the world in their order and settles who is on top.
void RasterSphere::meet_at(const Crowd& crowd) {
  const auto height = [&](const Seat& seat) {
    return plates_[seat.plate].crust(seat.sample).height;
  };
  const Seat* top = nullptr;
  for (const Seat& comer : crowd.seats) {
    if (!(height(comer) > 0.0F)) continue;  // it has gone down at the next place
    if (top == nullptr || !(height(*top) > 0.0F)) {
      top = &comer;
      continue;
    }
    const auto& on_top = plates_[top->plate].crust(top->sample);
    switch (raster_meeting(on_top, plates_[comer.plate].crust(comer.sample))) {
      case RasterMeeting::second_sinks:
        sink(comer, *top, crowd.at);
        if (!(height(comer) > 0.0F)) continue;
        break;
      case RasterMeeting::first_sinks:
        sink(*top, comer, crowd.at);
        if (!(height(*top) > 0.0F)) {
          top = &comer;
          continue;
        }
        break;
      case RasterMeeting::both_stay:
        break;
    }
    const auto area = [&](const Seat& seat) {
      const RasterSpherePlate& plate = plates_[seat.plate];
      return plate.continent_area(plate.continent(seat.sample));
    };
    const bool comer_is_larger = area(*top) <= area(comer);
    comer_is_larger ? fold(*top, comer) : fold(comer, *top);
    if (comer_is_larger) top = &comer;
  }
  if (top != nullptr) owner_[crowd.at] = top->plate;
}

void RasterSphere::sink(const Seat& below, const Seat& above, std::int32_t at) {
  RasterCrust crust = plates_[below.plate].crust(below.sample);
  const auto [after, melt] =
      raster_sinking(crust.height, settings_.ocean_crust, settings_.melting_ratio);
  budget_.subducted += static_cast<double>(crust.height) - after;
  crust.height = after;
  plates_[below.plate].set(below.sample, crust);
  if (melt > 0.0F) arcs_.push_back({at, below.plate, above.plate, above.sample, melt});
}

/// The smaller continent, `a`, gives crust to the larger one.
void RasterSphere::fold(const Seat& a, const Seat& b) {
  met_ = true;
  RasterSpherePlate& from = plates_[a.plate];
  RasterSpherePlate& to = plates_[b.plate];
  RasterCrust smaller = from.crust(a.sample), larger = to.crust(b.sample);
  const float before = smaller.height, other_before = larger.height;
  raster_fold(smaller, larger,
              settings_.of(a.plate, &RasterPlateSettings::folding_ratio, settings_.folding_ratio),
              budget_.steps);
  from.set(a.sample, smaller);
  to.set(b.sample, larger);
  const double moved = static_cast<double>(before) - smaller.height;
  budget_.folded += moved;
  budget_.rounded += static_cast<double>(larger.height) - other_before - moved;
  folded_[a.plate] += moved;
  folded_[b.plate] += moved;
  const std::int32_t own = from.continent(a.sample), other = to.continent(b.sample);
  if (own >= 0 && other >= 0) overlaps_.push_back({a.plate, b.plate, own, other, 1});
}

/// Lets the magma of what went down rise; where the upper plate has no crust it stays below.
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

void RasterSphere::merge_continents() {
  // Counted for each pair of continents, in the order in which they first met.
  std::map<std::array<std::int32_t, 4>, std::size_t> number;
  std::vector<Overlap> pairs;
  for (const Overlap& one : overlaps_) {
    const auto [at, is_new] =
        number.try_emplace({one.a, one.b, one.continent_a, one.continent_b}, pairs.size());
    if (is_new) {
      pairs.push_back(one);
    } else {
      ++pairs[at->second].cells;
    }
  }
  for (const Overlap& pair : pairs) {
    // One of both may have gone to another plate within this step.
    const std::int32_t area = plates_[pair.a].continent_area(pair.continent_a);
    if (area == 0 || plates_[pair.b].continent_area(pair.continent_b) == 0) continue;
    const double relative =
        settings_.of(pair.a, &RasterPlateSettings::overlap_relative, settings_.overlap_relative);
    if (static_cast<double>(pair.cells) >= settings_.overlap_cells ||
        static_cast<double>(pair.cells) >= relative * area) {
      merge(pair);
    }
  }
}

/// The smaller continent moves to the larger one's plate. Momentum goes with it.
///
/// The larger one's samples see the smaller one's nearest to them; what that adds or takes is made
/// up for in proportion.
void RasterSphere::merge(const Overlap& overlap) {
  RasterSpherePlate& from = plates_[overlap.a];
  RasterSpherePlate& to = plates_[overlap.b];
  const auto taken = from.take_continent(overlap.continent_a);
  std::map<std::int32_t, RasterCrust> source;
  std::vector<std::int32_t> places;
  double moved = 0.0;
  std::int32_t near = -1;
  for (const auto& [sample, crust] : taken) {
    moved += crust.height;
    source.emplace(sample, crust);
    const Vector3 at = times(turn_[overlap.a], mesh().samples().position(sample));
    const Vector3 own = back(turn_[overlap.b], at);
    near = near < 0 ? mesh().samples().nearest(own) : pages_.nearest(own, near);
    places.push_back(near);
    for (const std::int32_t beside : mesh().neighbours(near)) places.push_back(beside);
  }
  if (source.empty()) return;
  const auto page_first = [&](std::int32_t a, std::int32_t b) {
    return std::pair(pages_.page(a), a) < std::pair(pages_.page(b), b);
  };
  std::sort(places.begin(), places.end(), page_first);  // so that each is near the one before
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<std::pair<std::int32_t, RasterCrust>> seen;
  double sum = 0.0;
  near = source.begin()->first;
  for (const std::int32_t place : places) {
    near = own_sample(overlap.a, times(turn_[overlap.b], mesh().samples().position(place)), near);
    const auto found = source.find(near);
    if (found == source.end()) continue;
    seen.emplace_back(place, found->second);
    sum += found->second.height;
  }
  if (seen.empty()) {  // a cell or two between the samples
    const Vector3 at = times(turn_[overlap.a], mesh().samples().position(taken.front().first));
    seen.emplace_back(own_sample(overlap.b, at, places.front()), taken.front().second);
    sum = taken.front().second.height;
  }
  double arrived = 0.0;
  for (auto& [place, crust] : seen) {
    crust.height = static_cast<float>(crust.height * moved / sum);
    RasterCrust target = to.crust(place);
    const float before = target.height;
    target.add(crust);
    to.set(place, target);
    arrived += static_cast<double>(target.height) - before;
  }
  budget_.rounded += arrived - moved;
  to.forget_continents();
  budget_.merged += moved;
  ++budget_.mergers;
  const double share = moved / to.mass;
  to.rotation = add(to.rotation, add(from.rotation, to.rotation, -1.0), share);
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

double RasterSphere::progress() const {
  const double cycle = static_cast<double>(cycle_.steps()) / std::max(1, settings_.cycle_steps);
  return std::min(1.0, (budget_.cycles - 1 + cycle) / settings_.cycles);
}

}  // namespace geo
