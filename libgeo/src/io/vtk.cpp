#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkShortArray.h>
#include <vtkSignedCharArray.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLImageDataWriter.h>

#include <sstream>
#include <string>

#include "geo/core/error.hpp"
#include "geo/io/atomic_file.hpp"
#include "geo/io/stage_file.hpp"

namespace geo::io {
namespace {

template <class T>
struct VtkArray;
template <>
struct VtkArray<float> {
  using type = vtkFloatArray;
};
template <>
struct VtkArray<double> {
  using type = vtkDoubleArray;
};
template <>
struct VtkArray<std::int8_t> {
  using type = vtkSignedCharArray;
};
template <>
struct VtkArray<std::int16_t> {
  using type = vtkShortArray;
};
template <>
struct VtkArray<std::int32_t> {
  using type = vtkIntArray;
};

/// A view of a field; VTK neither copies nor frees it.
vtkSmartPointer<vtkDataArray> view_of(const FieldSpec& spec, const Values& values) {
  vtkSmartPointer<vtkDataArray> view;
  std::visit(
      [&]<class T>(const std::vector<T>& array) {
        const auto typed = vtkSmartPointer<typename VtkArray<T>::type>::New();
        constexpr int kKeep = 1;
        // VTK has no read-only arrays; the writer does not change it.
        typed->SetArray(const_cast<T*>(array.data()), static_cast<vtkIdType>(array.size()), kKeep);
        view = typed;
      },
      values);
  view->SetName(std::string(spec.name).c_str());
  if (!spec.units.empty()) {
    view->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), std::string(spec.units).c_str());
  }
  return view;
}

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

void silence(vtkObject& object) {
  // With an observer VTK keeps its error text off stderr; the error code says it all.
  const vtkNew<vtkCallbackCommand> nothing;
  object.AddObserver("ErrorEvent", nothing);
  object.AddObserver("WarningEvent", nothing);
}

/// Where the file comes from, as a string array of the data set.
void add_text(vtkImageData& image, const char* name, const std::string& text) {
  const vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(text);
  image.GetFieldData()->AddArray(array);
}

}  // namespace

void write_vti(const std::filesystem::path& path, const Snapshot& snapshot,
               const Provenance& provenance) {
  const vtkNew<vtkImageData> image;
  set_geometry(*image, *snapshot.grid);
  for (const auto& [spec, values] : snapshot.fields) {
    image->GetCellData()->AddArray(view_of(*spec, *values));
  }
  add_text(*image, "title", provenance.title);
  add_text(*image, "source", "terrane " + provenance.version);
  add_text(*image, "seed", std::to_string(provenance.seed));

  AtomicFile whole(path);
  const vtkNew<vtkXMLImageDataWriter> writer;
  silence(*writer);
  silence(*writer->GetExecutive());
  writer->SetInputData(image);
  writer->SetFileName(whole.temporary().c_str());
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToNone();
  if (writer->Write() == 0 || writer->GetErrorCode() != vtkErrorCode::NoError) {
    whole.fail(vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()));
  }
  whole.commit();
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
