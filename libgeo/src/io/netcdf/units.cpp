#include "units.hpp"

#include <udunits2.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <mutex>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

struct Free {
  void operator()(ut_system* system) const { ut_free_system(system); }
  void operator()(ut_unit* unit) const { ut_free(unit); }
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using System = std::unique_ptr<ut_system, Free>;
using Unit = std::unique_ptr<ut_unit, Free>;
using Converter = std::unique_ptr<cv_converter, Free>;

System read_system() {
  ut_set_error_message_handler(ut_ignore);
  System system(ut_read_xml(nullptr));
  if (!system) throw IoError("cannot read the units database of UDUNITS (libudunits2-data)");
  return system;
}

Unit parse(const System& system, std::string text) {
  const auto blank = [](unsigned char letter) { return std::isspace(letter) != 0; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
  Unit unit(ut_parse(system.get(), text.c_str(), UT_UTF8));
  if (unit) return unit;
  // Old files shout their units.
  for (char& letter : text) letter = static_cast<char>(std::tolower(letter));
  return Unit(ut_parse(system.get(), text.c_str(), UT_UTF8));
}

}  // namespace

std::optional<double> conversion_factor(const std::string& units, const std::string& target) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  static const System system = read_system();
  const Unit from = parse(system, units), to = parse(system, target);
  if (!from || ut_are_convertible(from.get(), to.get()) == 0) return {};
  const Converter converter(ut_get_converter(from.get(), to.get()));
  const double factor = cv_convert_double(converter.get(), 1.0);
  const double offset = cv_convert_double(converter.get(), 0.0);
  // Reciprocals ("m-1" to "m") convert too, but measure something else.
  if (offset != 0.0 || cv_convert_double(converter.get(), 2.0) != 2.0 * factor) return {};
  return factor;
}

}  // namespace geo::io
