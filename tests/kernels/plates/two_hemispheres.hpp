#pragma once

#include <cstdint>
#include <vector>

#include "geo/core/vector3.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"

namespace geo::test {

/// Two hemispheres that part or close at longitudes 0 and 180.
struct TwoHemispheres {
  CubedSphere mesh{64};
  std::vector<std::int16_t> plate;
  std::vector<Vector3> rotation{{0, 0, 0.004}, {0, 0, -0.004}};
  TwoHemispheres() : plate(mesh.size()) {
    for (std::int32_t cell = 0; cell < mesh.size(); ++cell) {
      plate[cell] = mesh.position(cell)[1] > 0.0 ? 0 : 1;
    }
  }
};

}  // namespace geo::test
