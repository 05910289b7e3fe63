#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "sample_sums.hpp"
#include "sphere_steps.hpp"

namespace geo {
namespace {

/// Share of the difference in excess that flows to each neighbour in a round: stable for up to
/// eight of them.
constexpr double kFlow = 0.125;
constexpr int kRounds = 200;
constexpr double kLevel_m = 1.0;

/// Continental crust that lies on top, by its plate, or -1.
std::vector<std::int16_t> land_on_top(const SphereTectonics& model) {
  const SphereCrust& crust = model.state.crust;
  const std::int32_t n = crust.size();
  std::vector<std::int16_t> land_of(n);
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < n; ++i) {
    const bool holds =
        crust.plate[i] >= 0 && crust.continental[i] != 0 && model.margins.hidden[i] == 0;
    land_of[i] = static_cast<std::int16_t>(holds ? crust.plate[i] : -1);
  }
  return land_of;
}

/// Thickens or thins crust in Airy balance, so that the sum of all gains is kept to rounding.
void give(SphereTectonics& model, std::span<const std::int32_t> samples,
          std::span<const double> gain_m) {
  SphereCrust& crust = model.state.crust;
  WholeGains gains;
  for (const std::int32_t i : samples) gains.put(crust.thickness_m[i], gain_m[i]);
  const auto count = std::ssize(samples);
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const std::int32_t i = samples[k];
    crust.elevation_m[i] =
        static_cast<float>(height_after(crust.elevation_m[i], gain_m[i], model.settings.rebound));
  }
  model.budget.lost_km3 += 1e-3 * model.sample_km2() * gains.left();
}

/// Diffusion of what lies above a thickness, over the land of each plate.
class LowerCrust {
 public:
  LowerCrust(const SphereTectonics& model, double above_m)
      : m_(model),
        above_m_(above_m),
        land_of_(land_on_top(model)),
        is_reached_(land_of_.size(), 0),
        gain_m_(land_of_.size(), 0.0),
        excess_m_(land_of_.size(), 0.0) {
    for (std::int32_t i = 0; i < model.state.crust.size(); ++i) {
      if (land_of_[i] >= 0 && model.state.crust.thickness_m[i] > above_m_) reach(i);
    }
    weigh_from(0);
  }
  [[nodiscard]] bool is_empty() const { return reached_.empty(); }
  [[nodiscard]] std::span<const std::int32_t> reached() const { return reached_; }
  [[nodiscard]] std::span<const double> gain_m() const { return gain_m_; }

  /// An explicit step of finite volumes: D times the time over a sample's area.
  void flow(double share) {
    const std::size_t sources = reached_.size();
    for (; spread_ < sources; ++spread_) {
      const std::int32_t i = reached_[spread_];
      for (const std::int32_t j : m_.mesh->neighbours(i)) {
        if (is_reached_[j] == 0 && land_of_[j] == land_of_[i]) reach(j);
      }
    }
    weigh_from(sources);
    change_m_.resize(reached_.size());
    const auto count = static_cast<std::int64_t>(reached_.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < count; ++k) {
      const std::int32_t i = reached_[k];
      const auto star = m_.mesh->neighbours(i);
      double sum_m = 0.0;
      for (std::size_t s = 0; s < star.size(); ++s) {
        const std::int32_t j = star[s];
        if (land_of_[j] != land_of_[i]) continue;
        sum_m += weight_[first_[k] + s] * (excess_m_[j] - excess_m_[i]);
      }
      change_m_[k] = share * sum_m;
    }
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < count; ++k) {
      gain_m_[reached_[k]] += change_m_[k];
      put_excess(reached_[k]);
    }
  }

 private:
  void reach(std::int32_t i) {
    is_reached_[i] = 1;
    reached_.push_back(i);
    first_.push_back(ways_);
    ways_ += m_.mesh->neighbours(i).size();
  }
  /// Those that are reached from one of them on.
  void weigh_from(std::size_t from) {
    weight_.resize(ways_);
    const auto count = static_cast<std::int64_t>(reached_.size());
#pragma omp parallel for schedule(static)
    for (auto k = static_cast<std::int64_t>(from); k < count; ++k) {
      const std::int32_t i = reached_[k];
      const auto star = m_.mesh->neighbours(i);
      for (std::size_t s = 0; s < star.size(); ++s) {
        const std::int32_t left = star[(s + 1) % star.size()],
                           right = star[(s + star.size() - 1) % star.size()];
        weight_[first_[k] + s] = 0.5 * (cotangent(i, star[s], left) + cotangent(i, star[s], right));
      }
      put_excess(i);
    }
  }
  /// Of the angle at a sample between two others. Halves of those that face an edge sum up to the
  /// length of the Voronoi cells' common side over the distance of their samples.
  [[nodiscard]] double cotangent(std::int32_t a, std::int32_t b, std::int32_t at) const {
    const FibonacciSphere& samples = m_.mesh->samples();
    const Vector3 to_a = add(samples.position(a), samples.position(at), -1.0),
                  to_b = add(samples.position(b), samples.position(at), -1.0);
    return dot(to_a, to_b) / length(cross(to_a, to_b));
  }
  void put_excess(std::int32_t i) {
    excess_m_[i] = std::max(0.0, m_.state.crust.thickness_m[i] + gain_m_[i] - above_m_);
  }

  const SphereTectonics& m_;
  double above_m_;
  std::vector<std::int16_t> land_of_;
  std::vector<std::uint8_t> is_reached_;
  std::vector<double> gain_m_, excess_m_, change_m_;
  std::size_t ways_ = 0, spread_ = 0;  // of all that are reached; those that have reached others
  std::vector<std::size_t> first_;     // of the weights of each that is reached
  std::vector<double> weight_;         // of each neighbour
  std::vector<std::int32_t> reached_;  // in the order in which it flows there
};

}  // namespace

/// The lower crust of thick roots is hot and flows towards thinner crust beside them [clark2000]:
/// dh/dt = div(D grad max(h - h_c, 0)), D = rho_c g (1 - rho_c/rho_m) c^3 / 12 mu of a channel of
/// thickness c and viscosity mu. Belts widen, and their flanks slope.
void flow_lower_crust(SphereTectonics& model) {
  const SphereSettings& s = model.settings;
  if (s.crustal_flow_km2_myr <= 0.0) return;
  LowerCrust crust(model, 1e3 * s.crustal_flow_above_km);
  if (crust.is_empty()) return;
  constexpr double kStable = 0.15;
  const double whole = s.crustal_flow_km2_myr * s.law.step_myr / model.sample_km2();
  const int parts = static_cast<int>(std::ceil(whole / kStable));
  for (int part = 0; part < parts; ++part) crust.flow(whole / parts);
  give(model, crust.reached(), crust.gain_m());
}

/// Hot crust at the foot of thick roots flows towards thinner crust beside them, so that belts grow
/// into plateaus instead of growing thicker: what is above `thickest_km` diffuses over the
/// continent, dh/dt = div(D grad max(h - h_c, 0)), so fast that a step sees its end. What finds no
/// room, because the land is too small, sinks into the mantle and is lost.
void spread_roots(SphereTectonics& model) {
  if (model.settings.thickest_km <= 0.0) return;
  SphereCrust& crust = model.state.crust;
  const std::int32_t n = crust.size();
  const double most_m = 1e3 * model.settings.thickest_km;
  std::vector<std::int32_t> reached;  // by what flows, in the order in which it comes
  const std::vector<std::int16_t> land_of = land_on_top(model);
  std::vector<std::uint8_t> is_reached(n);
  for (std::int32_t i = 0; i < n; ++i) {
    is_reached[i] = land_of[i] >= 0 && crust.thickness_m[i] > most_m ? 1 : 0;
    if (is_reached[i] != 0) reached.push_back(i);
  }
  if (reached.empty()) return;
  std::vector<double> gain_m(n, 0.0), change_m(n, 0.0), excess_m(n, 0.0);
  const auto put_excess = [&](std::int32_t i) {
    excess_m[i] = std::max(0.0, crust.thickness_m[i] + gain_m[i] - most_m);
  };
  for (const std::int32_t i : reached) put_excess(i);
  for (int round = 0; round < kRounds; ++round) {
    double largest_m = 0.0;
    const std::size_t sources = reached.size();
    for (std::size_t k = 0; k < sources; ++k) {
      const std::int32_t i = reached[k];
      const double from_m = excess_m[i];
      largest_m = std::max(largest_m, from_m);
      if (from_m <= 0.0) continue;
      for (const std::int32_t j : model.mesh->neighbours(i)) {
        if (land_of[j] != land_of[i]) continue;
        const double flow_m = kFlow * std::max(0.0, from_m - excess_m[j]);
        change_m[i] -= flow_m;
        change_m[j] += flow_m;
        if (is_reached[j] != 0) continue;
        is_reached[j] = 1;
        reached.push_back(j);
      }
    }
    if (largest_m < kLevel_m) break;
    for (const std::int32_t i : reached) {
      gain_m[i] += change_m[i];
      change_m[i] = 0.0;
      put_excess(i);
    }
  }
  for (const std::int32_t i : reached) {
    gain_m[i] -= excess_m[i];
    model.budget.lost_km3 += 1e-3 * model.sample_km2() * excess_m[i];
  }
  give(model, reached, gain_m);
}

}  // namespace geo
