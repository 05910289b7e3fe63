#include "listener.hpp"

#include <string>

namespace terrane::python {

namespace py = pybind11;

void Listener::tell(const char* kind, std::string_view text, double number) {
  if (stop_) return;
  const py::gil_scoped_acquire locked;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!tell_.is_none()) tell_(kind, std::string(text), number);
  } catch (py::error_already_set&) {
    raised_ = std::current_exception();
    stop_ = true;
  }
}

geo::io::RunEvents Listener::events() {
  geo::io::RunEvents events;
  events.stage_begins = [this](std::string_view stage, double cells) {
    tell("begin", stage, cells);
  };
  events.stage_ends = [this](std::string_view stage, double seconds) {
    tell("end", stage, seconds);
  };
  events.progress = [this](double fraction) { tell("progress", {}, fraction); };
  events.info = [this](std::string_view message) { tell("info", message, 0.0); };
  events.warning = [this](std::string_view message) { tell("warning", message, 0.0); };
  events.stop = &stop_;
  return events;
}

}  // namespace terrane::python
