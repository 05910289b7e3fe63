#include "sphere_trenches.hpp"

#include <algorithm>
#include <cmath>

#include "geo/kernels/plates/growth/convergent_margins.hpp"

namespace geo {
namespace {

constexpr double kReach_km = 450.0;  ///< the forebulge is over

/// Age of the floor that subducts at a boundary; none, 0, where it is a continent.
double age_of_slab_myr(const SphereTectonics& model, const SphereBoundary& at, bool overrides) {
  const SphereCrust& crust = model.state.crust;
  if (!overrides) return crust.continental[at.sample] != 0 ? 0.0 : crust.age_myr[at.sample];
  double sum_myr = 0.0;
  int floor = 0;
  for (const std::int32_t j : model.mesh->neighbours(at.sample)) {
    if (crust.plate[j] != at.other || crust.continental[j] != 0) continue;
    sum_myr += crust.age_myr[j];
    ++floor;
  }
  return floor > 0 ? sum_myr / floor : 0.0;
}

}  // namespace

SphereTrenches::SphereTrenches(const SphereTectonics& model,
                               std::span<const SphereBoundary> boundaries,
                               std::span<const std::uint8_t> overrides, double slab_m,
                               double radius_km) {
  if (!(slab_m > 0.0)) return;
  const SphereMesh& mesh = *model.mesh;
  const FibonacciSphere& samples = mesh.samples();
  std::vector<std::int32_t> sources, boundary;
  std::vector<float> depth_m;
  for (std::size_t k = 0; k < boundaries.size(); ++k) {
    const SphereBoundary& at = boundaries[k];
    if (at.type != BoundaryType::convergent) continue;
    const double share =
        trench_share(age_of_slab_myr(model, at, overrides[k] != 0), at.motion.closing);
    if (!(share > 0.0)) continue;
    sources.push_back(at.sample);
    boundary.push_back(static_cast<std::int32_t>(k));
    depth_m.push_back(static_cast<float>(slab_m * share));
  }
  const std::vector<std::int32_t> nearest = nearest_samples(mesh, sources, kReach_km / radius_km);
  across_km_.assign(mesh.size(), 0.0F);
  depth_m_.assign(mesh.size(), 0.0F);
  const double half = 0.5 * samples.spacing();
  const auto& plate = model.state.crust.plate;
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    if (nearest[i] < 0) continue;
    const SphereBoundary& at = boundaries[boundary[nearest[i]]];
    if (plate[i] != at.plate && plate[i] != at.other) continue;
    const bool own = plate[i] == at.plate;
    const bool above = own == (overrides[boundary[nearest[i]]] != 0);
    const double far = length(add(samples.position(at.sample), samples.position(i), -1.0));
    const double far_km = radius_km * std::max(0.0, far + (own ? half : -half));
    across_km_[i] = static_cast<float>(above ? far_km : -far_km);
    depth_m_[i] = depth_m[nearest[i]];
  }
}

double SphereTrenches::elevation_m(const SphereMesh::Place& place, double cell_km) const {
  if (depth_m_.empty()) return 0.0;
  double across_km = 0.0, depth_m = 0.0, weight = 0.0;
  for (int k = 0; k < 3; ++k) {
    const std::int32_t corner = place.corner[k];
    if (!(depth_m_[corner] > 0.0F)) continue;  // has no side
    across_km += place.weight[k] * across_km_[corner];
    depth_m += place.weight[k] * depth_m_[corner];
    weight += place.weight[k];
  }
  if (!(depth_m > 0.0)) return 0.0;
  across_km /= weight;
  constexpr int kParts = 4;
  double sum = 0.0;
  for (int part = 0; part < kParts; ++part) {
    sum += bent_plate(across_km + ((part + 0.5) / kParts - 0.5) * cell_km);
  }
  return depth_m * sum / kParts;
}

}  // namespace geo
