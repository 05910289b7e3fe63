#include "frame_files.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "geo/core/error.hpp"

namespace geo::io {

void FrameFiles::write(BackgroundWriter& writer, Frame frame, Provenance provenance) {
  const auto folder = folder_ / "frames";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError(fmt::format("{}: {}", folder.string(), error.message()));
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->stage = "plates";
  snapshot->grid = frame.fields.shared_grid();
  for (const FieldSpec* spec : frame.fields.present()) {
    snapshot->fields.emplace_back(spec, frame.fields.values(*spec));
  }
  const double time_myr = frame.checkpoint.time_myr;
  snapshot->checkpoint = std::make_shared<const Checkpoint>(std::move(frame.checkpoint));
  provenance.title = fmt::format("terrane: plates after {:g} Myr", time_myr);
  const auto stem = folder / fmt::format("plates-{:07.2f}", time_myr);
  writer.submit([this, snapshot, provenance, stem, time_myr] {
    const std::filesystem::path netcdf = stem.string() + ".nc", vti = stem.string() + ".vti";
    write_netcdf(netcdf, *snapshot, provenance, static_cast<int>(settings_.compression));
    written_.push_back("frames/" + netcdf.filename().string());
    if (!settings_.vtk) return;
    write_vti(vti, *snapshot, provenance, static_cast<int>(settings_.vtk_compression));
    written_.push_back("frames/" + vti.filename().string());
    listed_.push_back(vti);
    times_.push_back(time_myr);
    write_pvd(folder_ / "plates.pvd", listed_, times_);
  });
}

std::vector<std::string> FrameFiles::take_written() {
  std::vector<std::string> written = std::exchange(written_, {});
  if (!listed_.empty() && !written.empty()) written.emplace_back("plates.pvd");
  return written;
}

}  // namespace geo::io
