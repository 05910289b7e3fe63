#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/climate/energy_balance.hpp"

namespace geo {

/// e^(2 pi i k t) in the middle of a month.
[[nodiscard]] std::complex<double> month_phase(int harmonic, int month);

/// Heat that the winds of the months carry. Its annual and zonal mean belongs to the equations of
/// every harmonic; what the months' own winds carry besides is known from the last temperatures.
class HeatAdvection {
 public:
  using Complex = std::complex<double>;
  HeatAdvection(const Grid& grid, double heat_j_m2_k, const HeatWinds& winds);

  /// Winds as the temperatures have them now, and from now on their mean. What they carry besides
  /// is held, in each cell, to a share of how fast the equations level a departure there
  /// (`stiffness_w_m2_k`), so that the iteration converges on any planet; on the Earth it is far
  /// from that.
  void average(const TemperatureCycle& temperature, std::vector<double> stiffness_w_m2_k);
  /// m s-1 per row.
  [[nodiscard]] std::span<const double> mean_wind_m_s() const { return mean_wind_m_s_; }
  /// Moves what is carried besides half-way to what the temperatures have now.
  void advance(const TemperatureCycle& temperature);
  /// W per cell, of a harmonic; nothing before the first `advance`.
  [[nodiscard]] std::span<const Complex> besides(int harmonic) const { return besides_[harmonic]; }

 private:
  /// One month's air.
  struct Month {
    std::vector<float> temperature_c, east, north, heat_w_m2;
  };
  [[nodiscard]] Month blow(const TemperatureCycle& temperature, int month) const;
  void carry(Month& month) const;
  void find_annual_mean(const TemperatureCycle& temperature);

  const Grid& grid_;
  double heat_j_m2_k_;
  const HeatWinds& winds_;
  std::vector<double> mean_wind_m_s_, annual_mean_c_;  ///< per row
  std::vector<double> stiffness_w_m2_k_;               ///< per cell
  std::array<std::vector<Complex>, TemperatureCycle::kHarmonics + 1> besides_;
};

}  // namespace geo
