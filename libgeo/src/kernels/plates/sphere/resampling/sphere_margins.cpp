#include <algorithm>
#include <cmath>
#include <optional>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/plates/sphere/sphere_boundaries.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

/// The haste with which a margin takes a share of what it takes with the least haste.
double haste_for(double share, double least) {
  constexpr int kParts = 32;
  const auto mean_kept = [](double haste) {
    double sum = 0.0;
    for (int k = 0; k < kParts; ++k) sum += stretched_share((k + 0.5) / kParts, haste);
    return sum / kParts;
  };
  const double wanted = share * mean_kept(least);
  double low = least, high = 16.0 * least;
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
    const auto link = [&](std::int32_t k) {
      for (std::int32_t m = 0; m < count; ++m) {
        if (owner[sample_[m]] != owner[sample_[k]]) continue;
        const Vector3 way = add(at(k), at(m), -1.0);
        const double s = 1.0 - dot(way, way) / reach2;
        if (s > 0.0) links[k].push_back({m, s * s});
      }
    };
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 64)
    for (std::int32_t k = 0; k < count; ++k) errors.guard([&] { link(k); });
    errors.rethrow();
    for (std::int32_t k = 0; k < count; ++k) {
      first_[k + 1] = first_[k] + static_cast<std::int32_t>(links[k].size());
      link_.insert(link_.end(), links[k].begin(), links[k].end());
    }
  }
  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(sample_.size()); }

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

/// The margins that grow in the gaps of one resampling, and the inland that they take their crust
/// from. Breaks are numbered; what is known of each is in vectors by that number.
class PassiveMargins {
 public:
  PassiveMargins(const SphereMesh& mesh, const SphereSettings& settings, SphereCrust& crust,
                 std::span<const std::int16_t> owner)
      : mesh_(mesh), s_(settings), crust_(crust), owner_(owner), number_(mesh.size(), -1) {}

  /// Margins of gaps whose nearest sample is a whole continent's: their samples.
  void find(std::span<const std::int32_t> gaps, std::span<const std::int32_t> nearest) {
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      const std::int32_t edge = nearest[k];
      if (crust_.continental[edge] == 0 || distance_km(gaps[k], edge) > s_.margin_km) continue;
      margin_.push_back({gaps[k], edge});
      if (number_[edge] >= 0) continue;
      number_[edge] = static_cast<std::int32_t>(edge_.size());
      edge_.push_back(edge);
    }
    near_.emplace(mesh_, owner_, edge_, s_.margin_km / s_.radius_km);
    far_.emplace(mesh_, owner_, edge_, s_.margin_source_km / s_.radius_km);
    haste_.assign(edge_.size(), s_.margin_necking);
    read_breaks();
    std::erase_if(margin_, [&](const Place& at) { return thick_m_[number_[at.edge]] < kWhole_m; });
    measure_off_shore(gaps, nearest);
  }
  [[nodiscard]] bool empty() const { return margin_.empty(); }

  /// Thins the inland towards the breaks by what the margins want, at most by the share that it may
  /// give.
  void thin_inland() {
    const auto inland = nearest_samples(mesh_, edge_, s_.margin_source_km / s_.radius_km);
    const std::vector<std::int32_t> giver = givers(inland);
    std::vector<double> thinning(mesh_.size(), 0.0), has_m(edge_.size(), 0.0);
    for (const std::int32_t i : giver) {
      thinning[i] = tapered(distance_km(i, edge_[inland[i]]) / s_.margin_source_km);
      has_m[inland[i]] += thinning[i] * crust_.thickness_m[i];
    }
    const std::vector<double> wanted_around = far_->sums(wanted_m()),
                              has_around = far_->sums(has_m);
    for (const std::int32_t i : giver) {
      const std::int32_t e = inland[i];
      if (thinning[i] <= 0.0) continue;
      thinning[i] *= std::min(s_.margin_thinning, wanted_around[e] / has_around[e]);
    }
    level(
        mesh_, giver,
        [&](std::int32_t i, std::int32_t j) {
          return inland[j] >= 0 && owner_[j] == owner_[i] && crust_.continental[j] != 0;
        },
        thinning);
    given_m_.assign(edge_.size(), 0.0);
    for (const std::int32_t i : giver) {
      const double lost_m = thinning[i] * crust_.thickness_m[i];
      const float thinner_m = crust_.thickness_m[i] - static_cast<float>(lost_m);
      given_m_[inland[i]] += static_cast<double>(crust_.thickness_m[i]) - thinner_m;
      crust_.thickness_m[i] = thinner_m;
      crust_.elevation_m[i] =
          static_cast<float>(height_after(crust_.elevation_m[i], -lost_m, s_.rebound));
    }
  }

  /// Lays the margins down: they go on from the thinner inland, and thin so fast that they take
  /// what the breaks around were given. Returns the number of samples.
  std::size_t lay() {
    read_breaks();
    std::vector<double> met = share_met();
#pragma omp parallel for schedule(static)
    for (std::size_t e = 0; e < haste_.size(); ++e) {
      haste_[e] = haste_for(met[e], s_.margin_necking);
    }
    met = share_met();
    for (const Place& at : margin_) {
      const std::int32_t e = number_[at.edge];
      const double margin_m = thick_m_[e] * share_kept(at) * met[e];
      const double margin_top_m = height_after(high_m_[e], margin_m - thick_m_[e], s_.rebound);
      // Never deeper than the floor that would lie there.
      const double floor_m =
          s_.floor_by_age ? crust_.elevation_m[at.sample] : 500.0 * s_.law.abyss_km;
      crust_.continental[at.sample] = 1;
      crust_.thickness_m[at.sample] = static_cast<float>(margin_m);
      crust_.elevation_m[at.sample] = static_cast<float>(std::max(floor_m, margin_top_m));
      crust_.age_myr[at.sample] = 0.0F;
      crust_.orogeny_age_myr[at.sample] = crust_.orogeny_age_myr[at.edge];
      crust_.ridge[at.sample] = {};
    }
    return margin_.size();
  }

 private:
  struct Place {
    std::int32_t sample, edge;  // in the gap, and where the continent has broken
  };
  [[nodiscard]] double distance_km(std::int32_t a, std::int32_t b) const {
    return s_.radius_km * angle_between(mesh_.samples().position(a), mesh_.samples().position(b));
  }
  /// Thickness and height at the breaks, means along them.
  void read_breaks() {
    thick_m_.resize(edge_.size());
    high_m_.resize(edge_.size());
    for (std::size_t e = 0; e < edge_.size(); ++e) {
      thick_m_[e] = crust_.thickness_m[edge_[e]];
      high_m_[e] = crust_.elevation_m[edge_[e]];
    }
    thick_m_ = near_->means(thick_m_);
    high_m_ = near_->means(high_m_);
  }
  /// Shares of the margin's width. The shore of samples is jagged; distances to it need not be.
  void measure_off_shore(std::span<const std::int32_t> gaps,
                         std::span<const std::int32_t> nearest) {
    off_shore_.assign(mesh_.size(), 0.0);
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      off_shore_[gaps[k]] = std::min(1.0, distance_km(gaps[k], nearest[k]) / s_.margin_km);
    }
    std::vector<std::int32_t> stretched;
    for (const Place& at : margin_) stretched.push_back(at.sample);
    level(
        mesh_, stretched, [](std::int32_t, std::int32_t) { return true; }, off_shore_);
  }
  [[nodiscard]] double share_kept(const Place& at) const {
    return stretched_share(off_shore_[at.sample], haste_[number_[at.edge]]);
  }
  [[nodiscard]] std::vector<double> wanted_m() const {
    std::vector<double> wanted(edge_.size(), 0.0);
    for (const Place& at : margin_) {
      wanted[number_[at.edge]] += thick_m_[number_[at.edge]] * share_kept(at);
    }
    return wanted;
  }
  /// What breaks around were given over what their margins want.
  [[nodiscard]] std::vector<double> share_met() const {
    const std::vector<double> wanted_there = far_->sums(wanted_m());
    std::vector<double> share(edge_.size(), 0.0);
    for (std::size_t e = 0; e < edge_.size(); ++e) {
      if (wanted_there[e] > 0.0) share[e] = given_m_[e] / wanted_there[e];
    }
    return far_->sums(share);
  }
  /// Whole crust of the plates that have broken, by the nearest break of each sample.
  [[nodiscard]] std::vector<std::int32_t> givers(std::span<const std::int32_t> inland) const {
    std::vector<std::int32_t> giver;
    for (std::int32_t i = 0; i < mesh_.size(); ++i) {
      if (inland[i] < 0 || owner_[i] < 0 || owner_[i] != owner_[edge_[inland[i]]]) continue;
      if (crust_.continental[i] == 0 || crust_.thickness_m[i] < kWhole_m) continue;
      giver.push_back(i);
    }
    return giver;
  }

  const SphereMesh& mesh_;
  const SphereSettings& s_;
  SphereCrust& crust_;
  std::span<const std::int16_t> owner_;
  std::vector<std::int32_t> number_, edge_;  // of the break at a sample, and the other way round
  std::vector<Place> margin_;
  std::optional<Breaks> near_, far_;
  std::vector<double> thick_m_, high_m_, haste_, given_m_;  // of each break
  std::vector<double> off_shore_;                           // of each sample
};

}  // namespace

/// Passive margins: where a continent has broken, the nearest part of the gap is its own crust,
/// stretched. What it takes flows from inland, whose crust thins towards the break, so that the
/// volume of the continent stays; where that does not suffice, the margin thins sooner. All
/// that a margin takes from the crust beside it are means along the break.
void stretch_margins(SphereTectonics& model, std::span<const std::int32_t> gaps,
                     std::span<const std::int32_t> nearest, SphereCrust& now,
                     std::span<const std::int16_t> owner) {
  if (model.settings.margin_km <= 0.0 || model.settings.margin_thinning <= 0.0) return;
  PassiveMargins margins(*model.mesh, model.settings, now, owner);
  margins.find(gaps, nearest);
  if (margins.empty()) return;
  margins.thin_inland();
  model.budget.stretched_km2 += model.sample_km2() * static_cast<double>(margins.lay());
}

}  // namespace geo
