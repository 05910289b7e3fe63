#include <algorithm>
#include <cmath>

#include "geo/kernels/sphere_boundaries.hpp"
#include "geo/kernels/sphere_tectonics.hpp"

namespace geo {
namespace {

constexpr double kOuter = 0.25;

/// Share of its first thickness that stretched crust keeps at a share of the margin's width; the
/// haste of 1 or more brings it sooner to the outer share.
double kept(double s, double haste) {
  return kOuter + (1.0 - kOuter) * std::pow(1.0 - s * s * (3.0 - 2.0 * s), haste);
}
/// The haste with which a margin takes a share of what it takes with haste 1.
double haste_for(double share) {
  constexpr int kParts = 32;
  const auto mean_kept = [](double haste) {
    double sum = 0.0;
    for (int k = 0; k < kParts; ++k) sum += kept((k + 0.5) / kParts, haste);
    return sum / kParts;
  };
  const double wanted = share * mean_kept(1.0);
  double low = 1.0, high = 16.0;
  for (int k = 0; k < 24; ++k) {
    const double haste = 0.5 * (low + high);
    (mean_kept(haste) > wanted ? low : high) = haste;
  }
  return low;
}
/// How much of the thinning at the break is left at a share of the way that crust flows from.
double tapered(double s) { return s < 1.0 ? 1.0 - s * s * (3.0 - 2.0 * s) : 0.0; }

/// Thinner crust is itself a margin, and does not break into another one.
constexpr double kWhole_m = 20000.0;
/// Height lost below water for each that a dry column loses.
constexpr double kWaterLoad = 1.45;
/// Rounds in which what each sample has from its nearest break is levelled with its neighbours.
constexpr int kLevellings = 4;

/// Means of the values of some samples and those neighbours that count, in rounds.
template <class Counts>
void level(const SphereMesh& mesh, std::span<const std::int32_t> samples, Counts&& counts,
           std::vector<double>& values) {
  for (int round = 0; round < kLevellings; ++round) {
    const std::vector<double> before = values;
    for (const std::int32_t i : samples) {
      double sum = before[i];
      int count = 1;
      for (const std::int32_t j : mesh.neighbours(i)) {
        if (!counts(i, j)) continue;
        sum += before[j];
        ++count;
      }
      values[i] = sum / count;
    }
  }
}

/// The samples along which continents have broken, and means along them: over the breaks of the
/// same plate within a length, so that what margins take from each is a smooth field on the sphere
/// and not each sample's own.
class Breaks {
 public:
  Breaks(const SphereMesh& mesh, std::span<const std::int16_t> owner,
         std::vector<std::int32_t> sample, double length_rad)
      : mesh_(mesh), sample_(std::move(sample)), first_(sample_.size() + 1, 0) {
    const double reach2 = std::pow(2.0 * std::sin(0.5 * std::min(length_rad, 3.1)), 2);
    const auto count = static_cast<std::int32_t>(sample_.size());
    std::vector<std::vector<Link>> links(count);
#pragma omp parallel for schedule(dynamic, 64)
    for (std::int32_t k = 0; k < count; ++k) {
      for (std::int32_t m = 0; m < count; ++m) {
        if (owner[sample_[m]] != owner[sample_[k]]) continue;
        const Vector3 way = add(at(k), at(m), -1.0);
        const double s = 1.0 - dot(way, way) / reach2;
        if (s > 0.0) links[k].push_back({m, s * s});
      }
    }
    for (std::int32_t k = 0; k < count; ++k) {
      first_[k + 1] = first_[k] + static_cast<std::int32_t>(links[k].size());
      link_.insert(link_.end(), links[k].begin(), links[k].end());
    }
  }
  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(sample_.size()); }
  [[nodiscard]] std::int32_t sample(std::int32_t k) const { return sample_[k]; }
  [[nodiscard]] const std::vector<std::int32_t>& samples() const { return sample_; }

  /// sum_m K(k, m) values_m: K is symmetric, so that sum_k w_k sums(v / sums(w))_k = sum_m v_m.
  [[nodiscard]] std::vector<double> sums(const std::vector<double>& values) const {
    std::vector<double> out(values.size(), 0.0);
    for (std::int32_t k = 0; k < size(); ++k) {
      for (std::int32_t l = first_[k]; l < first_[k + 1]; ++l) {
        out[k] += link_[l].weight * values[link_[l].other];
      }
    }
    return out;
  }
  [[nodiscard]] std::vector<double> means(const std::vector<double>& values) const {
    const std::vector<double> weight = sums(std::vector<double>(values.size(), 1.0));
    std::vector<double> out = sums(values);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] /= weight[k];
    return out;
  }

 private:
  struct Link {
    std::int32_t other;
    double weight;
  };
  [[nodiscard]] const Vector3& at(std::int32_t k) const {
    return mesh_.samples().position(sample_[k]);
  }

  const SphereMesh& mesh_;
  std::vector<std::int32_t> sample_, first_;
  std::vector<Link> link_;
};

}  // namespace

/// Passive margins: where a continent has broken, the nearest part of the gap is its own crust,
/// stretched. What it takes flows from inland, whose crust thins towards the break, so that the
/// volume of the continent stays; where that does not suffice, the margin thins sooner. All
/// that a margin takes from the crust beside it are means along the break.
void SphereTectonics::stretch_margins(std::span<const std::int32_t> gaps,
                                      std::span<const std::int32_t> nearest, SphereCrust& now,
                                      std::span<const std::int16_t> owner) {
  const SphereSettings& s = settings_;
  if (s.margin_km <= 0.0 || s.margin_thinning <= 0.0) return;
  std::vector<std::int32_t> number(mesh_->size(), -1), source, margin;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const std::int32_t edge = nearest[k];
    if (now.continental[edge] == 0 || distance_km(gaps[k], edge) > s.margin_km) continue;
    margin.push_back(static_cast<std::int32_t>(k));
    if (number[edge] >= 0) continue;
    number[edge] = static_cast<std::int32_t>(source.size());
    source.push_back(edge);
  }
  if (margin.empty()) return;
  const Breaks near(*mesh_, owner, source, s.margin_km / s.radius_km);
  const Breaks far(*mesh_, owner, source, s.margin_source_km / s.radius_km);
  const std::int32_t breaks = near.size();
  std::vector<double> thick_m(breaks), z_m(breaks);
  const auto read_breaks = [&] {
    for (std::int32_t e = 0; e < breaks; ++e) {
      thick_m[e] = now.thickness_m[source[e]];
      z_m[e] = now.elevation_m[source[e]];
    }
    thick_m = near.means(thick_m);
    z_m = near.means(z_m);
  };
  read_breaks();
  std::vector<std::uint8_t> is_whole(breaks);
  for (std::int32_t e = 0; e < breaks; ++e) is_whole[e] = thick_m[e] >= kWhole_m ? 1 : 0;
  std::erase_if(margin, [&](std::int32_t k) { return is_whole[number[nearest[k]]] == 0; });
  // The shore of samples is jagged; distances to it need not be.
  std::vector<double> off_shore(mesh_->size(), 0.0);
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    off_shore[gaps[k]] = std::min(1.0, distance_km(gaps[k], nearest[k]) / s.margin_km);
  }
  std::vector<std::int32_t> stretched;
  for (const std::int32_t k : margin) stretched.push_back(gaps[k]);
  level(
      *mesh_, stretched, [](std::int32_t, std::int32_t) { return true; }, off_shore);
  std::vector<double> haste(breaks, 1.0);
  const auto share_kept = [&](std::int32_t k) {
    return kept(off_shore[gaps[k]], haste[number[nearest[k]]]);
  };
  const auto wanted_m = [&] {
    std::vector<double> wanted(breaks, 0.0);
    for (const std::int32_t k : margin) {
      wanted[number[nearest[k]]] += thick_m[number[nearest[k]]] * share_kept(k);
    }
    return wanted;
  };

  // Inland, each sample by its nearest break.
  const auto inland = nearest_samples(*mesh_, source, s.margin_source_km / s.radius_km);
  std::vector<std::int32_t> giver;
  std::vector<double> thinning(mesh_->size(), 0.0), has_m(breaks, 0.0);
  for (std::int32_t i = 0; i < mesh_->size(); ++i) {
    if (inland[i] < 0 || owner[i] < 0 || now.continental[i] == 0 || now.thickness_m[i] < kWhole_m ||
        owner[i] != owner[source[inland[i]]]) {
      continue;
    }
    giver.push_back(i);
    thinning[i] = tapered(distance_km(i, source[inland[i]]) / s.margin_source_km);
    has_m[inland[i]] += thinning[i] * now.thickness_m[i];
  }
  const std::vector<double> wanted_around = far.sums(wanted_m()), has_around = far.sums(has_m);
  for (const std::int32_t i : giver) {
    const std::int32_t e = inland[i];
    if (thinning[i] <= 0.0) continue;
    thinning[i] *= std::min(s.margin_thinning, wanted_around[e] / has_around[e]);
  }
  level(
      *mesh_, giver,
      [&](std::int32_t i, std::int32_t j) {
        return inland[j] >= 0 && owner[j] == owner[i] && now.continental[j] != 0;
      },
      thinning);
  std::vector<double> given_m(breaks, 0.0);
  for (const std::int32_t i : giver) {
    const double lost_m = thinning[i] * now.thickness_m[i];
    const float thinner_m = now.thickness_m[i] - static_cast<float>(lost_m);
    given_m[inland[i]] += static_cast<double>(now.thickness_m[i]) - thinner_m;
    now.thickness_m[i] = thinner_m;
    now.elevation_m[i] -= static_cast<float>(lost_m / s.rebound);
  }

  // The margin goes on from the thinner crust, and thins so fast that it takes what the breaks
  // around were given.
  read_breaks();
  const auto share_met = [&] {
    const std::vector<double> wanted_there = far.sums(wanted_m());
    std::vector<double> share(breaks, 0.0);
    for (std::int32_t e = 0; e < breaks; ++e) {
      if (wanted_there[e] > 0.0) share[e] = given_m[e] / wanted_there[e];
    }
    return far.sums(share);
  };
  std::vector<double> met = share_met();
#pragma omp parallel for schedule(static)
  for (std::int32_t e = 0; e < breaks; ++e) haste[e] = haste_for(met[e]);
  met = share_met();
  for (const std::int32_t k : margin) {
    const std::int32_t i = gaps[k], edge = nearest[k], e = number[edge];
    const double margin_m = thick_m[e] * share_kept(k) * met[e];
    const double dry_m = z_m[e] - (thick_m[e] - margin_m) / s.rebound;
    now.continental[i] = 1;
    now.thickness_m[i] = static_cast<float>(margin_m);
    // Never deeper than the floor that would lie there.
    const double floor_m = s.floor_by_age ? now.elevation_m[i] : 500.0 * s.law.abyss_km;
    now.elevation_m[i] =
        static_cast<float>(std::max(floor_m, dry_m < 0.0 ? kWaterLoad * dry_m : dry_m));
    now.age_myr[i] = 0.0F;
    now.orogeny_age_myr[i] = now.orogeny_age_myr[edge];
    now.ridge[i] = {};
    budget_.stretched_km2 += sample_km2();
  }
}

}  // namespace geo
