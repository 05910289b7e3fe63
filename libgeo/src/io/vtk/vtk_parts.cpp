#include "vtk_parts.hpp"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkShortArray.h>
#include <vtkSignedCharArray.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkXMLWriter.h>
#include <vtkZLibDataCompressor.h>

#include <string>

#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"

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

void silence(vtkObject& object) {
  // With an observer VTK keeps its error text off stderr; the error code says it all.
  const vtkNew<vtkCallbackCommand> nothing;
  object.AddObserver("ErrorEvent", nothing);
  object.AddObserver("WarningEvent", nothing);
}

/// Where the file comes from, as a string array of the data set.
void add_text(vtkDataSet& data, const char* name, const std::string& text) {
  const vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(text);
  data.GetFieldData()->AddArray(array);
}

}  // namespace

void add_fields(vtkDataSet& data, const Snapshot& snapshot) {
  for (const auto& [spec, values] : snapshot.fields) {
    data.GetCellData()->AddArray(view_of(*spec, *values));
  }
}

void add_provenance(vtkDataSet& data, const Provenance& provenance) {
  add_text(data, "title", provenance.title);
  add_text(data, "source", "terrane " + provenance.version);
  add_text(data, "seed", std::to_string(provenance.seed));
}

void write_whole(vtkXMLWriter& writer, vtkDataSet& data, const std::filesystem::path& path,
                 int compression) {
  AtomicFile whole(path);
  silence(writer);
  silence(*writer.GetExecutive());
  writer.SetInputDataObject(&data);
  writer.SetFileName(whole.temporary().c_str());
  writer.SetDataModeToAppended();
  writer.EncodeAppendedDataOff();
  writer.SetHeaderTypeToUInt64();
  writer.SetCompressorTypeToNone();
  const vtkNew<vtkZLibDataCompressor> compressor;
  if (compression > 0) {
    compressor->SetCompressionLevel(compression);
    writer.SetCompressor(compressor);
  }
  if (writer.Write() == 0 || writer.GetErrorCode() != vtkErrorCode::NoError) {
    whole.fail(vtkErrorCode::GetStringFromErrorCode(writer.GetErrorCode()));
  }
  whole.commit();
}

}  // namespace geo::io
