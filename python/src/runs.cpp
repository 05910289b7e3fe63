#include <omp.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "configuration.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/run/island_session.hpp"
#include "geo/io/run/memory_run.hpp"
#include "geo/io/run/run_session.hpp"
#include "listener.hpp"
#include "module.hpp"

namespace terrane::python {
namespace {

using geo::io::StageInMemory;

/// As many threads as asked for while it lives; 0 leaves them.
class Threads {
 public:
  explicit Threads(int count) : before_(omp_get_max_threads()) {
    if (count < 0) throw geo::ConfigurationError("threads: must be a positive whole number");
    if (count > 0) omp_set_num_threads(count);
  }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() { omp_set_num_threads(before_); }

 private:
  int before_;
};

/// A planet of its own elevations, for stages that need nothing before them.
std::optional<geo::State> state_of(const std::shared_ptr<geo::Grid>& grid, const py::dict& fields) {
  if (!grid) return std::nullopt;
  geo::State state(grid);
  for (const auto& [key, value] : fields) {
    const auto name = key.cast<std::string>();
    const geo::FieldSpec* spec = geo::field::find(name);
    if (spec == nullptr) throw geo::ConfigurationError("unknown field " + name);
    const auto take = [&]<class T>(T) {
      const auto array = value.cast<Array<T>>();
      const auto values = values_on<T>(*grid, array, name.c_str());
      state.set(*spec, geo::Values(std::vector<T>(values.begin(), values.end())));
    };
    switch (spec->type) {
      case geo::Type::float32:
        take(float{});
        break;
      case geo::Type::float64:
        take(double{});
        break;
      case geo::Type::int8:
        take(std::int8_t{});
        break;
      case geo::Type::int16:
        take(std::int16_t{});
        break;
      case geo::Type::int32:
        take(std::int32_t{});
        break;
    }
  }
  return state;
}

std::vector<StageInMemory> run(Configuration& configuration, const std::string& from,
                               const std::string& to, const std::shared_ptr<geo::Grid>& grid,
                               const py::dict& fields, int threads, py::object tell) {
  const Threads limit(threads);
  Listener listener(std::move(tell));
  auto state = state_of(grid, fields);
  return listener.run([&] {
    return geo::io::run_in_memory(configuration.run(), from, to, listener.events(),
                                  std::move(state));
  });
}

void run_to_folder(Configuration& configuration, const std::string& folder, const std::string& from,
                   const std::string& to, bool resume, bool overwrite, bool allow_other_build,
                   int threads, py::object tell) {
  const Threads limit(threads);
  Listener listener(std::move(tell));
  geo::io::RunSession session(configuration.run(), configuration.stage_numbers(),
                              {.folder = folder,
                               .from = from,
                               .to = to,
                               .resume = resume,
                               .allow_other_build = allow_other_build,
                               .overwrite = overwrite,
                               .threads = omp_get_max_threads()});
  listener.run([&] {
    session.prepare();
    session.execute(listener.events());
  });
}

std::vector<geo::io::Snapshot> snapshots_of(const std::vector<const StageInMemory*>& stages) {
  std::vector<geo::io::Snapshot> snapshots;
  for (const StageInMemory* stage : stages) snapshots.push_back(stage->snapshot);
  return snapshots;
}

StageInMemory island(Configuration& configuration, const std::vector<const StageInMemory*>& planet,
                     int threads, py::object tell) {
  const Threads limit(threads);
  Listener listener(std::move(tell));
  const auto snapshots = snapshots_of(planet);
  return listener.run(
      [&] { return geo::io::island_in_memory(configuration.run(), snapshots, listener.events()); });
}

std::string island_to_folder(Configuration& configuration, const std::string& folder,
                             bool allow_other_build, int threads, py::object tell) {
  const Threads limit(threads);
  Listener listener(std::move(tell));
  geo::io::IslandSession session(configuration.pipeline, configuration.stage_numbers().back(),
                                 configuration.settings, configuration.planet,
                                 configuration.parameters(), folder);
  return listener.run([&] {
    session.prepare(allow_other_build);
    return session.execute(listener.events());
  });
}

py::dict arrays_of(const StageInMemory& stage) {
  py::dict arrays;
  for (const auto& [spec, values] : stage.snapshot.fields) {
    arrays[py::str(std::string(spec->name))] = view_of(values, *stage.snapshot.grid);
  }
  return arrays;
}

/// Columns by name; rows that are shorter than the table end in NaN.
py::dict columns_of(const geo::StepTable& steps) {
  py::dict columns;
  for (std::size_t k = 0; k < steps.columns.size(); ++k) {
    std::vector<double> values;
    for (const auto& row : steps.rows) {
      values.push_back(k < row.size() ? row[k] : std::numeric_limits<double>::quiet_NaN());
    }
    const auto rows = static_cast<py::ssize_t>(values.size());
    columns[py::str(steps.columns[k])] = array_of(std::move(values), {rows});
  }
  return columns;
}

}  // namespace

void add_runs(py::module_& module) {
  py::class_<StageInMemory>(module, "StageInMemory", "What one stage made.")
      .def_property_readonly("name", [](const StageInMemory& s) { return s.snapshot.stage; })
      .def_property_readonly("grid",
                             [](const StageInMemory& s) {
                               return std::const_pointer_cast<geo::Grid>(s.snapshot.grid);
                             })
      .def_property_readonly("arrays", &arrays_of)
      .def_property_readonly("steps", [](const StageInMemory& s) { return columns_of(s.steps); })
      .def_readonly("seconds", &StageInMemory::seconds)
      .def_readonly("budget", &StageInMemory::budget)
      .def_readonly("warnings", &StageInMemory::warnings);
  module.def("run", &run, py::arg("configuration"), py::arg("from_stage"), py::arg("to_stage"),
             py::arg("grid"), py::arg("fields"), py::arg("threads"), py::arg("tell"));
  module.def("run_to_folder", &run_to_folder, py::arg("configuration"), py::arg("folder"),
             py::arg("from_stage"), py::arg("to_stage"), py::arg("resume"), py::arg("overwrite"),
             py::arg("allow_other_build"), py::arg("threads"), py::arg("tell"));
  module.def("island", &island, py::arg("configuration"), py::arg("planet"), py::arg("threads"),
             py::arg("tell"));
  module.def("island_to_folder", &island_to_folder, py::arg("configuration"), py::arg("folder"),
             py::arg("allow_other_build"), py::arg("threads"), py::arg("tell"));
}

}  // namespace terrane::python
