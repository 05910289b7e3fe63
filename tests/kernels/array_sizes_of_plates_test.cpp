// Kernels of plates, life and exemplars refuse arrays that do not fit, each one value too short.
#include <gtest/gtest.h>

#include "geo/kernels/exemplars/exemplar.hpp"
#include "geo/kernels/exemplars/exemplar_detail.hpp"
#include "geo/kernels/life/whittaker.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/noise/oriented_noise.hpp"
#include "geo/kernels/plates/growth/continents.hpp"
#include "geo/kernels/plates/growth/convergent_margins.hpp"
#include "geo/kernels/plates/growth/crust_age.hpp"
#include "geo/kernels/plates/growth/plate_pieces.hpp"
#include "geo/kernels/plates/plate_boundaries.hpp"
#include "geo/kernels/plates/plate_motion.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"
#include "geo/kernels/water/surface_rivers.hpp"
#include "kernels/refused_arrays.hpp"

namespace geo {
namespace {

using namespace refused_arrays;

TEST(ArraySizes, OfPlatesAndLifeAreChecked) {
  const Grid& grid = planet();
  expect_refused("convergent_margins", 7, [&](Lengths& n) {
    const std::vector<std::int16_t> plate(n(cells()));
    const std::vector<std::int8_t> type(n(cells()));
    const Floats strength(n(cells())), continent(n(cells())), age(n(cells())), east(n(cells())),
        north(n(cells()));
    convergent_margins(grid, plate, type, strength, continent, age, east, north);
  });
  expect_refused("deformation_sources", 2, [&](Lengths& n) {
    const std::vector<std::int8_t> type(n(cells()));
    deformation_sources(grid, type, Floats(n(cells())), 1, 100.0);
  });
  expect_refused("distance_to_marked_km", 1,
                 [&](Lengths& n) { distance_to_marked_km(grid, Bytes(n(cells()))); });
  expect_refused("orientation_of", 2, [&](Lengths& n) {
    const Floats east(n(cells()));
    static_cast<void>(orientation_of(grid, east, Floats(n(cells())), 0.1));
  });
  expect_refused("level_lines", 1,
                 [&](Lengths& n) { static_cast<void>(level_lines(grid, Floats(n(cells())))); });
  expect_refused("add_oriented_noise", 3, [&](Lengths& n) {
    const Orientation crests{Floats(n(cells()), 1.0F), Floats(n(cells()))};
    Floats values(n(cells()));
    add_oriented_noise(grid, grid, crests, {}, 1.0, 1, "noise", values);
  });
  expect_refused("ridge_direction", 1,
                 [&](Lengths& n) { static_cast<void>(ridge_direction(grid, Floats(n(cells())))); });
  expect_refused("smooth_biomes", 2, [&](Lengths& n) {
    std::vector<std::int8_t> biome(n(cells())), scratch(n(cells()));
    smooth_biomes(grid, 1e6, biome, scratch);
  });
}

TEST(ArraySizes, OfMeshesAreChecked) {
  const CubedSphere mesh(4);
  const auto places = static_cast<std::size_t>(mesh.size());
  const std::vector<Vector3> still(1);
  expect_refused("find_boundaries", 1, [&](Lengths& n) {
    const std::vector<std::int16_t> plate(n(places));
    find_boundaries(mesh, plate, still, 5.0, 100.0, 6371.0);
  });
  expect_refused("crust_budget", 1, [&](Lengths& n) {
    const std::vector<std::int16_t> plate(n(places));
    static_cast<void>(crust_budget(mesh, plate, {}, still, 6371.0));
  });
  expect_refused("ocean_age_myr", 1, [&](Lengths& n) {
    const std::vector<std::int16_t> plate(n(places));
    ocean_age_myr(mesh, plate, {}, still, 180.0, 6371.0);
  });
  expect_refused("continental_plates", 1, [&](Lengths& n) {
    const std::vector<std::int16_t> plate(n(places));
    static_cast<void>(continental_plates(mesh, plate, std::vector<Plate>(1), 0.4));
  });
  expect_refused("connect_plates", 1, [&](Lengths& n) {
    std::vector<std::int16_t> plate(n(places));
    connect_plates(mesh, plate);
  });
  expect_refused("net_rotation", 2, [&](Lengths& n) {
    const std::vector<std::int16_t> plate(places);
    const std::vector<Vector3> unit(n(places));
    const Doubles area_sr(n(places));
    static_cast<void>(net_rotation(plate, unit, area_sr, still));
  });
  expect_refused("Noise::fbm", 1, [&](Lengths& n) {
    const std::vector<Vector3> positions(places);
    Floats out(n(places));
    Noise(1, "noise").fbm(positions, 1.0, 3, 0.5, out);
  });
  expect_refused("route_rivers", 1, [&](Lengths& n) {
    SurfaceGraph graph;
    graph.first.assign(places + 1, 0);
    graph.is_there.assign(places, 0);
    graph.is_open.assign(places, 0);
    static_cast<void>(route_rivers(graph, Floats(n(places))));
  });
}

TEST(ArraySizes, OfExemplarsAreChecked) {
  const Grid fine = Grid::equal_area(8, 8, 1000.0, Centre{0.0, 0.0});
  const ExemplarLibrary library = grow_exemplars();
  const ExemplarBand band;
  const auto guide_of = [](Lengths& n, std::vector<Floats>& fields,
                           std::vector<std::int8_t>& type) {
    for (int k = 0; k < 4; ++k) fields.emplace_back(n(cells()));
    type.resize(n(cells()));
    return TerrainGuide{fields[0], type, fields[1], fields[2], fields[3]};
  };
  expect_refused("exemplar_detail", 6, [&](Lengths& n) {
    std::vector<Floats> fields;
    std::vector<std::int8_t> type;
    const TerrainGuide guide = guide_of(n, fields, type);
    Floats detail(n(fine.size()));
    exemplar_detail(planet(), guide, fine, library, band, 1, detail);
  });
  expect_refused("exemplar_detail_on_sphere", 7, [&](Lengths& n) {
    std::vector<Floats> fields;
    std::vector<std::int8_t> type;
    const TerrainGuide guide = guide_of(n, fields, type);
    const Bytes wanted(n(cells()));
    Floats detail(n(cells()));
    exemplar_detail_on_sphere(planet(), wanted, planet(), guide, library, band, 1, detail);
  });
}

}  // namespace
}  // namespace geo
