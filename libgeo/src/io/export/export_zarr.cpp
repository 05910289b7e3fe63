#include "export_source.hpp"
#include "zarr_store.hpp"

namespace geo::io {

void write_zarr(const std::filesystem::path& output, const ExportSource& source, bool all_fields) {
  Snapshot snapshot = source.snapshot;
  if (!all_fields) {
    std::erase_if(snapshot.fields, [&](const auto& held) { return held.first != source.field; });
  }
  const std::filesystem::path store =
      output.has_filename() ? output : output.parent_path();  // "elevation.zarr/"
  const Scratch netcdf(store, "nc");
  write_netcdf(netcdf.path(), snapshot, source.provenance);
  write_zarr_store(netcdf.path(), store);
}

}  // namespace geo::io
