#include "frame_files.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "geo/core/error.hpp"

namespace geo::io {

void FrameFiles::write(BackgroundWriter& writer, std::string_view stage, Frame frame,
                       Provenance provenance) {
  const auto folder = folder_ / "frames";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError(fmt::format("{}: {}", folder.string(), error.message()));
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->stage = stage;
  snapshot->grid = frame.fields.shared_grid();
  for (const FieldSpec* spec : frame.fields.present()) {
    snapshot->fields.emplace_back(spec, frame.fields.values(*spec));
  }
  const double time_myr = frame.checkpoint.time_myr;
  snapshot->checkpoint = std::make_shared<const Checkpoint>(std::move(frame.checkpoint));
  provenance.title = fmt::format("terrane: {} after {:g} Myr", stage, time_myr);
  const auto stem = folder / fmt::format("{}-{:07.2f}", stage, time_myr);
  const std::string collection = fmt::format("{}.pvd", stage);
  writer.submit([this, snapshot, provenance, stem, collection, time_myr] {
    const std::filesystem::path netcdf = stem.string() + ".nc", vti = stem.string() + ".vti";
    write_netcdf(netcdf, *snapshot, provenance, static_cast<int>(settings_.compression));
    written_.push_back("frames/" + netcdf.filename().string());
    if (!settings_.vtk) return;
    write_vti(vti, *snapshot, provenance, static_cast<int>(settings_.vtk_compression));
    written_.push_back("frames/" + vti.filename().string());
    listed_.push_back(vti);
    times_.push_back(time_myr);
    collection_ = collection;
    write_pvd(folder_ / collection, listed_, times_);
  });
}

std::vector<std::string> FrameFiles::take_written() {
  std::vector<std::string> written = std::exchange(written_, {});
  if (!listed_.empty() && !written.empty()) written.push_back(collection_);
  return written;
}

}  // namespace geo::io
