// Where plates on a sphere meet, and who subducts or collides there.
#include <algorithm>
#include <utility>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/plates/raster/raster_sphere.hpp"

namespace geo {

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

}  // namespace geo
