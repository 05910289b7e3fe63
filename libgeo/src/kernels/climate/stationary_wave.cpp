#include "geo/kernels/climate/stationary_wave.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "kernels/numerics/thomas.hpp"

namespace geo {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;
constexpr double kRadians = kPi / 180.0;
constexpr double kSecondsPerDay = 86400.0;
constexpr Complex kI{0.0, 1.0};

/// What a wave meets at one latitude.
struct Parallel {
  double cosine, coriolis;
  Complex drag;         ///< e + i k U
  Complex wave_number;  ///< i k, k = m / (a cos lat)
  [[nodiscard]] Complex inertia() const { return drag * drag + coriolis * coriolis; }
};

/// The response of one zonal wave number.
class Wave {
 public:
  Wave(const WaveMode& model, int number, double radius_m, double rotation_rad_s,
       std::span<const double> latitude_deg, std::span<const double> zonal_wind_m_s)
      : model_(model), rows_(static_cast<int>(latitude_deg.size())) {
    const double damping = 1.0 / (model.momentum_damping_d * kSecondsPerDay);
    const double step = kPi / rows_;
    step_m_ = radius_m * step;
    const auto parallel = [&](double latitude, double wind) {
      const double cosine = std::max(std::cos(latitude), 1e-9);
      const Complex k = kI * (number / (radius_m * cosine));
      return Parallel{cosine, 2.0 * rotation_rad_s * std::sin(latitude),
                      damping + k * model.wind_share * wind, k};
    };
    for (int j = 0; j < rows_; ++j) {
      centre_.push_back(parallel(latitude_deg[j] * kRadians, zonal_wind_m_s[j]));
    }
    for (int j = 0; j + 1 < rows_; ++j) {
      face_.push_back(
          parallel(-0.5 * kPi + (j + 1) * step, 0.5 * (zonal_wind_m_s[j] + zonal_wind_m_s[j + 1])));
    }
    mirror_ = number % 2 == 0 ? 1.0 : -1.0;  // of P beyond a pole
  }

  /// The wind that carries the wave, as i k U.
  [[nodiscard]] Complex carried(int j) const { return centre_[j].drag - centre_[j].drag.real(); }

  /// Cooling of the geopotential as a wave passes: e_T + i k U.
  [[nodiscard]] Complex thermal(int j) const {
    const double damping = 1.0 / (model_.thermal_damping_d * kSecondsPerDay);
    return damping + carried(j);
  }

  /// Winds at the middle of a row.
  [[nodiscard]] std::pair<Complex, Complex> wind(int j, const std::vector<Complex>& values) const {
    const Parallel& at = centre_[j];
    const Complex north = j + 1 < rows_ ? values[j + 1] : mirror_ * values[j];
    const Complex south = j > 0 ? values[j - 1] : mirror_ * values[j];
    const Complex slope_east = at.wave_number * values[j],
                  slope_north = (north - south) / (2.0 * step_m_);
    return {-(at.drag * slope_east + at.coriolis * slope_north) / at.inertia(),
            (at.coriolis * slope_east - at.drag * slope_north) / at.inertia()};
  }

  /// Winds that a force, m s-2, makes at the middle of a row before pressure answers.
  [[nodiscard]] std::pair<Complex, Complex> pushed(int j, Complex east, Complex north) const {
    const Parallel& at = centre_[j];
    return {(at.drag * east + at.coriolis * north) / at.inertia(),
            (at.drag * north - at.coriolis * east) / at.inertia()};
  }

  /// Takes c^2 times the divergence of such winds from the forcing of the geopotential.
  void take_divergence(const std::vector<Complex>& east, const std::vector<Complex>& north,
                       std::vector<Complex>& forcing) const {
    const double speed2 = model_.speed_m_s * model_.speed_m_s;
    for (int j = 0; j < rows_; ++j) {
      forcing[j] -= speed2 * centre_[j].wave_number * pushed(j, east[j], north[j]).first;
    }
    for (int j = 0; j + 1 < rows_; ++j) {
      const Parallel& face = face_[j];
      const Complex along = 0.5 * (east[j] + east[j + 1]), across = 0.5 * (north[j] + north[j + 1]);
      const Complex flow = speed2 * face.cosine / step_m_ *
                           (face.drag * across - face.coriolis * along) / face.inertia();
      forcing[j] -= flow / centre_[j].cosine;
      forcing[j + 1] += flow / centre_[j + 1].cosine;
    }
  }

  /// From the forcing of the geopotential to its response.
  void respond(std::vector<Complex>& values) const {
    const double speed2 = model_.speed_m_s * model_.speed_m_s;
    std::vector<Complex> lower(rows_, 0.0), own(rows_), upper(rows_, 0.0);
    for (int j = 0; j < rows_; ++j) {
      const Parallel& at = centre_[j];
      const Complex per_inertia = speed2 * at.wave_number / at.inertia();
      own[j] = thermal(j) - per_inertia * at.drag * at.wave_number;
      // u from dP/dy across the row.
      const Complex slope = -per_inertia * at.coriolis / (2.0 * step_m_);
      (j + 1 < rows_ ? upper[j] : own[j]) += (j + 1 < rows_ ? 1.0 : mirror_) * slope;
      (j > 0 ? lower[j] : own[j]) -= (j > 0 ? 1.0 : mirror_) * slope;
      // v through the faces: v = (-drag dP/dy + f i k P) / inertia.
      const double per_width = speed2 / (at.cosine * step_m_);
      if (j + 1 < rows_) {
        const auto [before, beyond] = through(face_[j]);
        own[j] += per_width * before;
        upper[j] += per_width * beyond;
      }
      if (j > 0) {
        const auto [before, beyond] = through(face_[j - 1]);
        lower[j] -= per_width * before;
        own[j] -= per_width * beyond;
      }
    }
    factor_tridiagonal<Complex>(lower, upper, own);
    solve_tridiagonal<Complex>(lower, upper, own, values);
  }

 private:
  /// Flow cos(lat) v through a face for 1 of P before it, and beyond it.
  [[nodiscard]] std::pair<Complex, Complex> through(const Parallel& face) const {
    const Complex scale = face.cosine / face.inertia();
    const Complex along = 0.5 * face.coriolis * face.wave_number;
    const Complex down = face.drag / step_m_;
    return {scale * (along + down), scale * (along - down)};
  }

  const WaveMode& model_;
  int rows_;
  double step_m_, mirror_;
  std::vector<Parallel> centre_, face_;
};

using Spectra = std::vector<std::vector<Complex>>;  ///< of each parallel

/// Parallels into zonal wave numbers and back.
class ParallelTransform {
 public:
  explicit ParallelTransform(const Grid& grid) : nx_(grid.nx()), ny_(grid.ny()), line_(nx_) {}

  [[nodiscard]] Spectra none() const { return Spectra(ny_, std::vector<Complex>(nx_, 0.0)); }

  [[nodiscard]] Spectra analyse(std::span<const float> values) {
    Spectra spectra(ny_);
    for (int j = 0; j < ny_; ++j) {
      const auto row = values.subspan(static_cast<std::size_t>(j) * nx_, nx_);
      std::copy(row.begin(), row.end(), line_.begin());
      fourier_.fwd(spectra[j], line_);
    }
    return spectra;
  }

  void synthesise(const Spectra& spectra, std::span<float> values) {
    for (int j = 0; j < ny_; ++j) {
      fourier_.inv(line_, spectra[j]);
      const std::size_t begin = static_cast<std::size_t>(j) * nx_;
      for (int i = 0; i < nx_; ++i) values[begin + i] = static_cast<float>(line_[i]);
    }
  }

 private:
  int nx_, ny_;
  Eigen::FFT<double> fourier_;
  std::vector<double> line_;
};

/// Winds and descent of the waves that have been added.
class Response {
 public:
  Response(const StationaryWave& model, double radius_m, double rotation_rad_s,
           std::span<const double> latitude_deg, std::span<const double> zonal_wind_m_s,
           const Spectra& calm)
      : model_(model),
        radius_m_(radius_m),
        rotation_rad_s_(rotation_rad_s),
        latitude_deg_(latitude_deg),
        zonal_wind_m_s_(zonal_wind_m_s),
        values_(calm.size()),
        east_(calm),
        north_(calm),
        descent_(calm) {}

  /// What heating and forces set up in one wave number: the internal mode.
  void add_internal(int number, const Spectra& heating_w_m2, const Spectra& force_east,
                    const Spectra& force_north) {
    const double speed2 = model_.internal.speed_m_s * model_.internal.speed_m_s;
    const Wave wave = wave_of(model_.internal, number);
    std::vector<Complex> pushed_east(rows()), pushed_north(rows());
    for (int j = 0; j < rows(); ++j) {
      const double share = smoothed(number, j);
      values_[j] = -model_.heating_m4_s3_w * share * heating_w_m2[j][number];
      pushed_east[j] = share * force_east[j][number];
      pushed_north[j] = share * force_north[j][number];
    }
    wave.take_divergence(pushed_east, pushed_north, values_);
    wave.respond(values_);
    for (int j = 0; j < rows(); ++j) {
      add_wind(number, j, wave.wind(j, values_));
      add_wind(number, j, wave.pushed(j, pushed_east[j], pushed_north[j]));
      descent_[j][number] = -wave.thermal(j) * values_[j] / speed2;
    }
  }

  /// What mountains set up in one wave number: the external mode.
  void add_mountains(int number, const Spectra& height_m) {
    constexpr double kGravity_m_s2 = 9.81;
    const Wave wave = wave_of(model_.external, number);
    for (int j = 0; j < rows(); ++j) {
      values_[j] = kGravity_m_s2 * model_.mountain_share * smoothed(number, j) * wave.carried(j) *
                   height_m[j][number];
    }
    wave.respond(values_);
    for (int j = 0; j < rows(); ++j) add_wind(number, j, wave.wind(j, values_));
  }

  /// Fields are real: negative wave numbers are conjugates.
  void mirror(int number) {
    for (auto* spectra : {&east_, &north_, &descent_}) {
      for (auto& spectrum : *spectra) {
        spectrum[spectrum.size() - number] = std::conj(spectrum[number]);
      }
    }
  }

  [[nodiscard]] const Spectra& east() const { return east_; }
  [[nodiscard]] const Spectra& north() const { return north_; }
  [[nodiscard]] const Spectra& descent() const { return descent_; }

 private:
  [[nodiscard]] int rows() const { return static_cast<int>(values_.size()); }
  [[nodiscard]] Wave wave_of(const WaveMode& mode, int number) const {
    return Wave(mode, number, radius_m_, rotation_rad_s_, latitude_deg_, zonal_wind_m_s_);
  }
  [[nodiscard]] double smoothed(int number, int j) const {
    const double scale =
        1000.0 * model_.smoothing_km * number / (radius_m_ * std::cos(latitude_deg_[j] * kRadians));
    return 1.0 / (1.0 + scale * scale);
  }
  void add_wind(int number, int j, const std::pair<Complex, Complex>& wind) {
    const auto& [along, across] = wind;
    east_[j][number] += along;
    north_[j][number] += across;
  }

  const StationaryWave& model_;
  double radius_m_, rotation_rad_s_;
  std::span<const double> latitude_deg_, zonal_wind_m_s_;
  std::vector<Complex> values_;  ///< forcing, then geopotential
  Spectra east_, north_, descent_;
};

}  // namespace

void stationary_wave(const Grid& grid, const StationaryWave& model, double rotation_rad_s,
                     std::span<const double> latitude_deg, std::span<const double> zonal_wind_m_s,
                     const WaveForcing& forcing, const WaveWinds& winds) {
  check_sizes("stationary_wave", grid.ny(),
              {{"latitude_deg", latitude_deg.size()}, {"zonal_wind_m_s", zonal_wind_m_s.size()}});
  check_sizes("stationary_wave", grid.size(),
              {{"heating_w_m2", forcing.heating_w_m2.size()},
               {"force_east", forcing.force_east.size()},
               {"force_north", forcing.force_north.size()},
               {"height_m", forcing.height_m.size()},
               {"east", winds.east.size()},
               {"north", winds.north.size()},
               {"descent_1_s", winds.descent_1_s.size()}});
  if (grid.topology() != Topology::sphere) throw Bug("stationary_wave: the grid is no sphere");
  ParallelTransform transform(grid);
  const Spectra heating = transform.analyse(forcing.heating_w_m2);
  const Spectra force_east = transform.analyse(forcing.force_east);
  const Spectra force_north = transform.analyse(forcing.force_north);
  const bool mountains = model.mountain_share > 0.0;
  const Spectra height = mountains ? transform.analyse(forcing.height_m) : Spectra();
  Response response(model, grid.figure().radius_m, rotation_rad_s, latitude_deg, zonal_wind_m_s,
                    transform.none());
  const int waves = std::min(model.waves, grid.nx() / 2 - 1);
  for (int number = 1; number <= waves; ++number) {
    response.add_internal(number, heating, force_east, force_north);
    if (mountains) response.add_mountains(number, height);
    response.mirror(number);
  }
  transform.synthesise(response.east(), winds.east);
  transform.synthesise(response.north(), winds.north);
  transform.synthesise(response.descent(), winds.descent_1_s);
}

}  // namespace geo
