#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLImageDataWriter.h>

#include <sstream>
#include <string>

#include "geo/io/files/atomic_file.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "vtk_parts.hpp"

namespace geo::io {
namespace {

/// Cells of a grid as image cells: degrees where rows are parallels, else metres.
void set_geometry(vtkImageData& image, const Grid& grid) {
  image.SetDimensions(grid.nx() + 1, grid.ny() + 1, 1);
  if (grid.is_latitude_longitude()) {
    const Window& w = grid.window();
    image.SetOrigin(w.west_deg, w.south_deg, 0.0);
    image.SetSpacing((w.east_deg - w.west_deg) / grid.nx(), (w.north_deg - w.south_deg) / grid.ny(),
                     1.0);
  } else {
    const double dx = grid.spacing_east_m(0), dy = grid.step_north_m();
    image.SetOrigin(-0.5 * grid.nx() * dx, -0.5 * grid.ny() * dy, 0.0);
    image.SetSpacing(dx, dy, 1.0);
  }
}

void add_numbers(vtkImageData& image, const char* name, std::initializer_list<double> numbers) {
  const vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (const double number : numbers) array->InsertNextValue(number);
  image.GetFieldData()->AddArray(array);
}

/// What lays an image on its planet: the radius, and of an island's map the centre.
void add_place(vtkImageData& image, const Grid& grid) {
  if (!grid.is_geographic()) return;
  add_numbers(image, "planet_radius_m", {grid.figure().radius_m});
  if (grid.is_projected() && grid.centre()) {
    add_numbers(image, "projection_centre_deg",
                {grid.centre()->latitude_deg, grid.centre()->longitude_deg});
  }
}

}  // namespace

void write_vti(const std::filesystem::path& path, const Snapshot& snapshot,
               const Provenance& provenance, int compression) {
  const vtkNew<vtkImageData> image;
  set_geometry(*image, *snapshot.grid);
  add_fields(*image, snapshot);
  add_provenance(*image, provenance);
  add_place(*image, *snapshot.grid);
  const vtkNew<vtkXMLImageDataWriter> writer;
  write_whole(*writer, *image, path, compression);
}

void write_pvd(const std::filesystem::path& path, const std::vector<std::filesystem::path>& files,
               const std::vector<double>& times) {
  const vtkNew<vtkXMLDataElement> root;
  root->SetName("VTKFile");
  root->SetAttribute("type", "Collection");
  root->SetAttribute("version", "0.1");
  const vtkNew<vtkXMLDataElement> collection;
  collection->SetName("Collection");
  root->AddNestedElement(collection);
  const auto folder = std::filesystem::absolute(path).parent_path();
  for (std::size_t step = 0; step < files.size(); ++step) {
    const vtkNew<vtkXMLDataElement> entry;
    entry->SetName("DataSet");
    if (times.empty()) {
      entry->SetIntAttribute("timestep", static_cast<int>(step));
    } else {
      entry->SetDoubleAttribute("timestep", times[step]);
    }
    entry->SetIntAttribute("part", 0);
    const auto relative = std::filesystem::absolute(files[step]).lexically_relative(folder);
    entry->SetAttribute("file", relative.generic_string().c_str());
    collection->AddNestedElement(entry);
  }
  std::ostringstream text;
  text << "<?xml version=\"1.0\"?>\n";
  root->PrintXML(text, vtkIndent());
  write_text_file(path, text.str());
}

}  // namespace geo::io
