#pragma once

#include <filesystem>

#include "geo/io/netcdf/stage_file.hpp"

class vtkDataSet;
class vtkXMLWriter;

namespace geo::io {

/// Gives a data set the fields of a snapshot as cell data, with their units. VTK neither copies nor
/// frees them: the snapshot must outlive the data set.
void add_fields(vtkDataSet& data, const Snapshot& snapshot);
/// Says in a data set where it comes from.
void add_provenance(vtkDataSet& data, const Provenance& provenance);
/// Writes a data set as XML with appended raw data, deflated unless `compression` is 0: temporary
/// name, flush, rename. Throws IoError.
void write_whole(vtkXMLWriter& writer, vtkDataSet& data, const std::filesystem::path& path,
                 int compression);

}  // namespace geo::io
