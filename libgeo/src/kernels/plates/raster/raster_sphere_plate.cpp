#include "geo/kernels/plates/raster/raster_sphere_plate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace geo {

namespace {

FibonacciSphere middles_of(const SphereMesh& mesh) {
  constexpr std::int32_t kSamples = 16, kFewest = 32;  // of a page, of pages
  return FibonacciSphere(std::max(kFewest, mesh.size() / kSamples));
}

/// Cosine of half the least distance between neighbours.
double cos_inner(const SphereMesh& mesh) {
  double least = 1.0;
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    for (const std::int32_t j : mesh.neighbours(i)) {
      least =
          std::min(least, angle_between(mesh.samples().position(i), mesh.samples().position(j)));
    }
  }
  return std::cos(0.5 * least);
}

}  // namespace

LatticePages::LatticePages(const SphereMesh& mesh)
    : mesh_(&mesh),
      coarse_(middles_of(mesh)),
      coarse_mesh_(coarse_),
      cos_inner_(cos_inner(mesh)),
      cos_middle_(cos_inner(coarse_mesh_)),
      page_(mesh.size()),
      slot_(mesh.size()) {
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    page_[i] = coarse_.nearest(mesh.samples().position(i));
  }
  first_.assign(coarse_.size() + 1, 0);
  double reach = 0.0;
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    ++first_[page_[i] + 1];
    reach = std::max(reach, angle_between(coarse_.position(page_[i]), mesh.samples().position(i)));
  }
  reach += mesh.samples().spacing();
  list_pages_about(2.0 * reach);
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  order_.resize(mesh.size());
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    slot_[i] = static_cast<std::int16_t>(next[page_[i]] - first_[page_[i]]);
    order_[next[page_[i]]++] = i;
  }
}

/// For each middle those within a distance of any place to which it is the nearest.
void LatticePages::list_pages_about(double distance) {
  const double within = std::min(distance + coarse_.spacing(), std::numbers::pi);
  cos_about_ = distance < std::numbers::pi ? std::cos(distance) : -2.0;
  about_first_.assign(1, 0);
  std::vector<std::int32_t> near;
  for (std::int32_t middle = 0; middle < coarse_.size(); ++middle) {
    near.assign(1, middle);
    for (std::size_t k = 0; k < near.size(); ++k) {
      for (const std::int32_t next : coarse_mesh_.neighbours(near[k])) {
        if (std::find(near.begin(), near.end(), next) == near.end() &&
            angle_between(coarse_.position(next), coarse_.position(middle)) < within) {
          near.push_back(next);
        }
      }
    }
    about_.insert(about_.end(), near.begin(), near.end());
    about_first_.push_back(static_cast<std::int32_t>(about_.size()));
  }
}

std::int32_t LatticePages::nearest_in(const SphereMesh& mesh, double cos_inner, const Vector3& unit,
                                      std::int32_t from) {
  const FibonacciSphere& samples = mesh.samples();
  double best = dot(samples.position(from), unit);
  for (std::int32_t at = from; best < cos_inner; from = at) {
    for (const std::int32_t next : mesh.neighbours(from)) {
      const double near = dot(samples.position(next), unit);
      if (near > best) {
        best = near;
        at = next;
      }
    }
    if (at == from) return at;
    if (best >= cos_inner) return at;
  }
  return from;
}

void RasterSpherePlate::move() {
  if (curve != 0.0) {
    const Vector3 about = scaled(times(turn.matrix(), centre), curve);
    rotation = rotated(rotation, about);
  }
  turn = Quaternion::about(rotation).after(turn);
}

const RasterCrust& RasterSpherePlate::crust(std::int32_t sample) const {
  static const RasterCrust kNone;
  const Cell* cell = find(sample);
  return cell == nullptr ? kNone : cell->crust;
}

std::int32_t RasterSpherePlate::continent(std::int32_t sample) const {
  const Cell* cell = find(sample);
  return cell == nullptr ? -1 : cell->continent;
}

void RasterSpherePlate::set(std::int32_t sample, const RasterCrust& crust) {
  Cell* cell = find(sample);
  if (cell == nullptr) {
    const int page = pages_->page(sample);
    base_[page] = static_cast<std::int32_t>(cells_.size());
    cells_.resize(cells_.size() + pages_->samples(page).size());
    empty_[page] = static_cast<std::int32_t>(pages_->samples(page).size());
    open_.insert(std::lower_bound(open_.begin(), open_.end(), page), page);
    cell = find(sample);
  }
  mass += static_cast<double>(crust.height) - cell->crust.height;
  if ((crust.height >= 1.0F) != (cell->crust.height >= 1.0F)) land_changed_ = true;
  empty_[pages_->page(sample)] +=
      (crust.height > 0.0F ? 0 : 1) - (cell->crust.height > 0.0F ? 0 : 1);
  cell->crust = crust;
}

void RasterSpherePlate::tighten() {
  std::vector<Cell> kept;
  std::vector<std::int32_t> open;
  double sum = 0.0;
  for (const std::int32_t page : open_) {
    const auto held = std::as_const(*this).cells(page);
    double here = 0.0;
    for (const Cell& cell : held) here += cell.crust.height;
    if (!(here > 0.0)) {
      base_[page] = -1;
      continue;
    }
    sum += here;
    open.push_back(page);
    const auto base = static_cast<std::int32_t>(kept.size());
    kept.insert(kept.end(), held.begin(), held.end());
    base_[page] = base;
  }
  cells_ = std::move(kept);
  open_ = std::move(open);
  mass = sum;
  alive = !open_.empty();
}

double RasterSpherePlate::erode(double strength) {
  // Six neighbours in place of four, and a hexagonal cell of the same area as a square one.
  const auto share = static_cast<float>(0.25 * strength / std::sqrt(3.0));
  std::vector<std::pair<std::int32_t, float>> change;
  for (const std::int32_t page : open_) {
    const auto samples = pages_->samples(page);
    const auto held = std::as_const(*this).cells(page);
    for (std::size_t k = 0; k < held.size(); ++k) {
      const float height = held[k].crust.height;
      if (!(height > 1.0F)) continue;
      std::int32_t below[16];
      float flux[16], all = 0.0F;
      int count = 0;
      for (const std::int32_t next : pages_->mesh().neighbours(samples[k])) {
        const float other = crust(next).height;
        if (!(other > 0.0F) || other >= height || count == 16) continue;
        below[count] = next;
        flux[count] = share * (height - other);
        all += flux[count++];
      }
      if (count == 0) continue;
      const float scale = std::min(1.0F, (height - 1.0F) / all);
      for (int n = 0; n < count; ++n) change.emplace_back(below[n], scale * flux[n]);
      change.emplace_back(samples[k], -scale * all);
    }
  }
  double rounded = 0.0;
  for (const auto& [sample, amount] : change) {
    float& height = find(sample)->crust.height;
    const float before = height;
    height = std::max(0.0F, height + amount);
    const double added = static_cast<double>(height) - before;
    mass += added;
    rounded += added;
  }
  land_changed_ = true;
  return rounded;
}

void RasterSpherePlate::find_continents(int steps) {
  ++continents_age_;
  if (continents_known_ && (!land_changed_ || continents_age_ < steps)) return;
  continents_known_ = true;
  land_changed_ = false;
  continents_age_ = 0;
  area_.clear();
  for (Cell& cell : cells_) cell.continent = -1;
  std::vector<std::int32_t> front;
  for (const std::int32_t page : open_) {
    for (const std::int32_t start : pages_->samples(page)) {
      Cell* first = find(start);
      if (!(first->crust.height >= 1.0F) || first->continent >= 0) continue;
      const auto number = static_cast<std::int32_t>(area_.size());
      area_.push_back(0);
      first->continent = number;
      front.assign(1, start);
      while (!front.empty()) {
        const std::int32_t at = front.back();
        front.pop_back();
        ++area_[number];
        for (const std::int32_t next : pages_->mesh().neighbours(at)) {
          Cell* cell = find(next);
          if (cell == nullptr || !(cell->crust.height >= 1.0F) || cell->continent >= 0) continue;
          cell->continent = number;
          front.push_back(next);
        }
      }
    }
  }
}

std::vector<std::pair<std::int32_t, RasterCrust>> RasterSpherePlate::take_continent(
    std::int32_t continent) {
  std::vector<std::pair<std::int32_t, RasterCrust>> taken;
  for (const std::int32_t page : open_) {
    const auto samples = pages_->samples(page);
    const auto held = cells(page);
    for (std::size_t k = 0; k < held.size(); ++k) {
      if (held[k].continent != continent) continue;
      held[k].continent = -1;
      if (!(held[k].crust.height > 0.0F)) continue;
      taken.emplace_back(samples[k], held[k].crust);
      mass -= held[k].crust.height;
      held[k].crust = {};
      ++empty_[page];
    }
  }
  area_[continent] = 0;
  continents_known_ = false;
  return taken;
}

}  // namespace geo
