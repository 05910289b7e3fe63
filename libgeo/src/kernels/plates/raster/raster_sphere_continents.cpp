// Continents on a sphere that overlap become one.
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "geo/kernels/plates/raster/raster_sphere.hpp"

namespace geo {

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

/// A plate's own samples where crust of another plate lies, and those next to them, page by page so
/// that each is near the one before.
std::vector<std::int32_t> RasterSphere::samples_under(int plate, int other,
                                                      const PlacedCrust& crust) const {
  std::vector<std::int32_t> samples;
  std::int32_t near = -1;
  for (const auto& [sample, cell] : crust) {
    const Vector3 at = times(turn_[other], mesh().samples().position(sample));
    const Vector3 own = back(turn_[plate], at);
    near = near < 0 ? mesh().samples().nearest(own) : pages_.nearest(own, near);
    samples.push_back(near);
    for (const std::int32_t beside : mesh().neighbours(near)) samples.push_back(beside);
  }
  const auto page_first = [&](std::int32_t a, std::int32_t b) {
    return std::pair(pages_.page(a), a) < std::pair(pages_.page(b), b);
  };
  std::sort(samples.begin(), samples.end(), page_first);
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  return samples;
}

/// Crust of another plate as a plate's own samples see it: that of the sample nearest to each.
RasterSphere::PlacedCrust RasterSphere::seen_by(int plate, int other,
                                                const PlacedCrust& crust) const {
  const std::map<std::int32_t, RasterCrust> source(crust.begin(), crust.end());
  const std::vector<std::int32_t> samples = samples_under(plate, other, crust);
  PlacedCrust seen;
  std::int32_t near = source.begin()->first;
  for (const std::int32_t sample : samples) {
    near = own_sample(other, times(turn_[plate], mesh().samples().position(sample)), near);
    if (const auto found = source.find(near); found != source.end()) {
      seen.emplace_back(sample, found->second);
    }
  }
  if (seen.empty()) {  // a cell or two between the samples
    const auto& [sample, cell] = crust.front();
    const Vector3 at = times(turn_[other], mesh().samples().position(sample));
    seen.emplace_back(own_sample(plate, at, samples.front()), cell);
  }
  return seen;
}

/// The smaller continent moves to the larger one's plate. Momentum goes with it.
///
/// The larger one's samples see the smaller one's nearest to them; what that adds or takes is made
/// up for in proportion.
void RasterSphere::merge(const Overlap& overlap) {
  const RasterSpherePlate& from = plates_[overlap.a];
  RasterSpherePlate& to = plates_[overlap.b];
  const PlacedCrust taken = plates_[overlap.a].take_continent(overlap.continent_a);
  if (taken.empty()) return;
  const auto mass_of = [](const PlacedCrust& crust) {
    double sum = 0.0;
    for (const auto& [sample, cell] : crust) sum += cell.height;
    return sum;
  };
  PlacedCrust seen = seen_by(overlap.b, overlap.a, taken);
  const double moved = mass_of(taken), sum = mass_of(seen);
  double arrived = 0.0;
  for (auto& [sample, crust] : seen) {
    crust.height = static_cast<float>(crust.height * moved / sum);
    RasterCrust target = to.crust(sample);
    const float before = target.height;
    target.add(crust);
    to.set(sample, target);
    arrived += static_cast<double>(target.height) - before;
  }
  budget_.rounded += arrived - moved;
  to.forget_continents();
  budget_.merged += moved;
  ++budget_.mergers;
  const double share = moved / to.mass;
  to.rotation = add(to.rotation, add(from.rotation, to.rotation, -1.0), share);
}

}  // namespace geo
