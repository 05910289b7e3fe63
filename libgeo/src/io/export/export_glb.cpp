#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "export_source.hpp"
#include "geo/core/error.hpp"
#include "geo/core/vector3.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "grid_sampler.hpp"
#include "io/drawing/png_file.hpp"
#include "io/maps/map_field.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

// What a scene of one body may take: 2 million triangles, a texture that all devices hold.
constexpr int kMostColumns = 1024, kMostTexture = 4096;

/// A mesh of (columns + 1) by (rows + 1) corners, rows from the north.
struct Mesh {
  int columns, rows;
  std::vector<std::array<float, 3>> corners, normals;
  std::vector<std::array<float, 2>> texture;
  std::vector<std::uint32_t> triangles;

  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * (columns + 1) + column;
  }
};

Mesh mesh_over(const Grid& grid) {
  const double coarser = std::max(1.0, static_cast<double>(grid.nx()) / kMostColumns);
  Mesh mesh{std::max(2, static_cast<int>(grid.nx() / coarser)),
            std::max(2, static_cast<int>(grid.ny() / coarser)),
            {},
            {},
            {},
            {}};
  for (int j = 0; j <= mesh.rows; ++j) {
    for (int i = 0; i <= mesh.columns; ++i) {
      mesh.texture.push_back({static_cast<float>(i) / static_cast<float>(mesh.columns),
                              static_cast<float>(j) / static_cast<float>(mesh.rows)});
    }
  }
  for (int j = 0; j < mesh.rows; ++j) {
    for (int i = 0; i < mesh.columns; ++i) {
      const auto nw = static_cast<std::uint32_t>(mesh.at(i, j)), ne = nw + 1;
      const auto sw = static_cast<std::uint32_t>(mesh.at(i, j + 1)), se = sw + 1;
      for (const std::uint32_t corner : {nw, sw, se, nw, se, ne}) mesh.triangles.push_back(corner);
    }
  }
  return mesh;
}

/// Where a corner lies on the grid, from edge to edge.
GridPlace place_of(const Grid& grid, const Mesh& mesh, int i, int j) {
  // The last meridian of a planet is the first.
  const int column = grid.topology() != Topology::plane && i == mesh.columns ? 0 : i;
  return {static_cast<double>(column) * grid.nx() / mesh.columns - 0.5,
          grid.ny() - 0.5 - static_cast<double>(j) * grid.ny() / mesh.rows};
}

/// The planet's radius is 1, heights are times `exaggeration` of it.
void lay_on_globe(const Grid& grid, const GridSampler& heights, double exaggeration, Mesh& mesh) {
  for (int j = 0; j <= mesh.rows; ++j) {
    const double latitude = std::numbers::pi * (0.5 - static_cast<double>(j) / mesh.rows);
    // Exactly on the axis at the poles, so that the surface closes.
    const bool pole = j == 0 || j == mesh.rows;
    const double flat = pole ? 0.0 : std::cos(latitude),
                 up = pole ? (j == 0 ? 1.0 : -1.0) : std::sin(latitude);
    for (int i = 0; i <= mesh.columns; ++i) {
      const double turn = static_cast<double>(i % mesh.columns) / mesh.columns;
      const double longitude = 2.0 * std::numbers::pi * turn - std::numbers::pi;
      const double height_m = heights.at(place_of(grid, mesh, i, j));
      const double radius = 1.0 + exaggeration * height_m / grid.figure().radius_m;
      mesh.corners.push_back({static_cast<float>(radius * flat * std::sin(longitude)),
                              static_cast<float>(radius * up),
                              static_cast<float>(radius * flat * std::cos(longitude))});
    }
  }
}

/// In metres, x to the east, z to the south, y up.
void lay_flat(const Grid& grid, const GridSampler& heights, Mesh& mesh) {
  for (int j = 0; j <= mesh.rows; ++j) {
    for (int i = 0; i <= mesh.columns; ++i) {
      const double x = (static_cast<double>(i) / mesh.columns - 0.5) * grid.nx();
      const double z = (static_cast<double>(j) / mesh.rows - 0.5) * grid.ny();
      mesh.corners.push_back({static_cast<float>(x * grid.spacing_east_m(0)),
                              heights.at(place_of(grid, mesh, i, j)),
                              static_cast<float>(z * grid.step_north_m())});
    }
  }
}

Vector3 vector_of(const std::array<float, 3>& corner) { return {corner[0], corner[1], corner[2]}; }

/// Normals of corners: sums of those of their triangles by area. On a globe those of the last
/// meridian are those of the first, and those of a pole the same all round.
void add_normals(bool globe, Mesh& mesh) {
  std::vector<Vector3> sums(mesh.corners.size(), Vector3{0.0, 0.0, 0.0});
  for (std::size_t k = 0; k < mesh.triangles.size(); k += 3) {
    const Vector3 a = vector_of(mesh.corners[mesh.triangles[k]]);
    const Vector3 b = vector_of(mesh.corners[mesh.triangles[k + 1]]);
    const Vector3 c = vector_of(mesh.corners[mesh.triangles[k + 2]]);
    const Vector3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]},
        v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const Vector3 normal{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                         u[0] * v[1] - u[1] * v[0]};
    for (int corner = 0; corner < 3; ++corner) {
      Vector3& sum = sums[mesh.triangles[k + corner]];
      for (int x = 0; x < 3; ++x) sum[x] += normal[x];
    }
  }
  if (globe) {
    for (int j = 0; j <= mesh.rows; ++j) {
      Vector3 &first = sums[mesh.at(0, j)], &last = sums[mesh.at(mesh.columns, j)];
      for (int x = 0; x < 3; ++x) first[x] += last[x];
      last = first;
    }
    for (int i = 0; i <= mesh.columns; ++i) {
      sums[mesh.at(i, 0)] = {0.0, 1.0, 0.0};
      sums[mesh.at(i, mesh.rows)] = {0.0, -1.0, 0.0};
    }
  }
  for (const Vector3& sum : sums) {
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    const double scale = length > 0.0 ? 1.0 / length : 0.0;
    mesh.normals.push_back({static_cast<float>(sum[0] * scale),
                            length > 0.0 ? static_cast<float>(sum[1] * scale) : 1.0F,
                            static_cast<float>(sum[2] * scale)});
  }
}

/// The field in its map's colours as a PNG file, rows from the north.
std::vector<unsigned char> texture_of(const ExportSource& source, const fs::path& beside) {
  const Grid& grid = source.grid();
  const auto values = as_floats(*source.field, shared_values(source, *source.field));
  const GridSampler sampler(grid, *values);
  std::vector<float> some;
  const std::size_t stride = std::max<std::size_t>(1, values->size() / 200000);
  for (std::size_t i = 0; i < values->size(); i += stride) some.push_back((*values)[i]);
  const auto tint = tints_of(*source.field, some);
  const bool mixed = kind_of(*source.field) == FieldKind::relief ||
                     kind_of(*source.field) == FieldKind::continuous;
  const double coarser = std::max(1.0, static_cast<double>(grid.nx()) / kMostTexture);
  const int width = static_cast<int>(grid.nx() / coarser);
  const int height = std::max(1, static_cast<int>(grid.ny() / coarser));
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(width) * height);
#pragma omp parallel for schedule(static)
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const GridPlace place{(x + 0.5) * grid.nx() / width - 0.5,
                            grid.ny() - 0.5 - (y + 0.5) * grid.ny() / height};
      const Rgb colour = tint(mixed ? sampler.at(place) : (*values)[sampler.nearest(place)]);
      const auto byte = [](float part) {
        return static_cast<std::uint32_t>(std::lround(std::clamp(part, 0.0F, 1.0F) * 255.0F));
      };
      pixels[static_cast<std::size_t>(y) * width + x] =
          byte(colour.r) << 16U | byte(colour.g) << 8U | byte(colour.b);
    }
  }
  // The picture goes through a file, as all pictures do.
  const AtomicFile file(beside.string() + ".png");
  write_png(file.temporary(),
            {reinterpret_cast<const std::uint8_t*>(pixels.data()), width, height, 4 * width});
  std::ifstream stream(file.temporary(), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Puts an array into the one buffer and returns its view.
template <class T>
int add_view(tinygltf::Model& model, const std::vector<T>& values, int target) {
  auto& data = model.buffers[0].data;
  constexpr std::size_t kAlignment = 4;
  data.resize((data.size() + kAlignment - 1) / kAlignment * kAlignment);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = values.size() * sizeof(T);
  view.target = target;
  const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
  data.insert(data.end(), bytes, bytes + view.byteLength);
  model.bufferViews.push_back(view);
  return static_cast<int>(model.bufferViews.size()) - 1;
}

int add_accessor(tinygltf::Model& model, int view, int component, int type, std::size_t count) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

template <std::size_t N>
int add_vectors(tinygltf::Model& model, const std::vector<std::array<float, N>>& vectors) {
  const int accessor = add_accessor(
      model, add_view(model, vectors, TINYGLTF_TARGET_ARRAY_BUFFER), TINYGLTF_COMPONENT_TYPE_FLOAT,
      N == 3 ? TINYGLTF_TYPE_VEC3 : TINYGLTF_TYPE_VEC2, vectors.size());
  std::vector<double> least(N, std::numeric_limits<double>::infinity());
  std::vector<double> most(N, -std::numeric_limits<double>::infinity());
  for (const auto& vector : vectors) {
    for (std::size_t k = 0; k < N; ++k) {
      least[k] = std::min<double>(least[k], vector[k]);
      most[k] = std::max<double>(most[k], vector[k]);
    }
  }
  model.accessors[accessor].minValues = least;
  model.accessors[accessor].maxValues = most;
  return accessor;
}

tinygltf::Model model_of(const ExportSource& source, const Mesh& mesh,
                         const std::vector<unsigned char>& picture, bool globe) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "terrane " + source.provenance.version;
  model.buffers.resize(1);
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = 0;
  primitive.attributes["POSITION"] = add_vectors(model, mesh.corners);
  primitive.attributes["NORMAL"] = add_vectors(model, mesh.normals);
  primitive.attributes["TEXCOORD_0"] = add_vectors(model, mesh.texture);
  primitive.indices = add_accessor(
      model, add_view(model, mesh.triangles, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER),
      TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, mesh.triangles.size());
  tinygltf::Image image;
  image.bufferView = add_view(model, picture, 0);
  image.mimeType = "image/png";
  model.images.push_back(image);
  tinygltf::Sampler sampler;
  sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
  sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
  sampler.wrapS = globe ? TINYGLTF_TEXTURE_WRAP_REPEAT : TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  model.samplers.push_back(sampler);
  tinygltf::Texture texture;
  texture.sampler = 0;
  texture.source = 0;
  model.textures.push_back(texture);
  tinygltf::Material material;
  material.name = std::string(source.field->name);
  material.pbrMetallicRoughness.baseColorTexture.index = 0;
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.pbrMetallicRoughness.roughnessFactor = 1.0;
  model.materials.push_back(material);
  tinygltf::Mesh body;
  body.name = globe ? "planet" : "island";
  body.primitives.push_back(primitive);
  model.meshes.push_back(body);
  tinygltf::Node node;
  node.mesh = 0;
  node.name = body.name;
  model.nodes.push_back(node);
  tinygltf::Scene scene;
  scene.nodes.push_back(0);
  model.scenes.push_back(scene);
  model.defaultScene = 0;
  return model;
}

}  // namespace

void write_glb(const fs::path& output, const ExportSource& source, double exaggeration) {
  const Grid& grid = source.grid();
  const bool globe = grid.topology() == Topology::sphere;
  if (!globe && grid.is_latitude_longitude()) {
    throw ConfigurationError(
        "--format glb: takes a planet or an island, not a window of latitudes and longitudes");
  }
  Mesh mesh = mesh_over(grid);
  // Without an elevation, and where it has gaps, the surface is flat.
  std::vector<float> elevation_m(grid.size());
  if (source.has(field::elevation)) {
    elevation_m = std::get<std::vector<float>>(source.of(field::elevation));
    for (float& height : elevation_m) height = std::isnan(height) ? 0.0F : height;
  }
  const GridSampler sampler(grid, elevation_m);
  globe ? lay_on_globe(grid, sampler, exaggeration, mesh) : lay_flat(grid, sampler, mesh);
  add_normals(globe, mesh);
  tinygltf::Model model = model_of(source, mesh, texture_of(source, output), globe);
  AtomicFile file(output);
  std::ofstream stream(file.temporary(), std::ios::binary);
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, stream, false, true)) file.fail("tinygltf refused");
  stream.flush();
  if (!stream) file.fail("write failed");
  stream.close();
  file.commit();
}

}  // namespace geo::io
