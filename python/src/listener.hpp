#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>

#include "geo/core/error.hpp"
#include "geo/io/run/run_events.hpp"

namespace terrane::python {

/// Hands what a run tells on to a Python function `tell(kind, text, number)`, or to nobody (None).
/// Looks for signals as it goes: Ctrl-C, and any error that the function raises, stop the run.
/// To be made and used without Python's lock held.
class Listener {
 public:
  explicit Listener(pybind11::object tell) : tell_(std::move(tell)) {}

  [[nodiscard]] geo::io::RunEvents events();
  [[nodiscard]] const std::atomic<bool>* stop() const { return &stop_; }
  void tell(const char* kind, std::string_view text, double number);

  /// Runs `compute` without Python's lock. What was raised meanwhile is raised again here.
  template <class Function>
  auto run(const Function& compute) {
    try {
      const pybind11::gil_scoped_release unlocked;
      return compute();
    } catch (const geo::Interrupted&) {
      if (raised_) std::rethrow_exception(raised_);
      throw;
    }
  }

 private:
  pybind11::object tell_;
  std::atomic<bool> stop_ = false;
  std::exception_ptr raised_;
};

}  // namespace terrane::python
