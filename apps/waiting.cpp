#include "waiting.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <string_view>

namespace terrane {

void wait_without_spinning(int argc, char** argv) {
  // libgomp's word; 300 000 without it, which is milliseconds.
  constexpr const char* kLooks = "GOMP_SPINCOUNT";
  constexpr const char* kTimes = "300";
  constexpr std::array<std::string_view, 5> kComputing{"run", "calibrate", "island", "maps",
                                                       "score"};
  if (argc < 2 || std::find(kComputing.begin(), kComputing.end(), argv[1]) == kComputing.end()) {
    return;
  }
  if (std::getenv(kLooks) != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  // By its own name, so that it is listed under that.
  std::array<char, PATH_MAX> path{};
  if (::readlink("/proc/self/exe", path.data(), path.size() - 1) <= 0) return;
  if (::setenv(kLooks, kTimes, 1) != 0) return;
  ::execv(path.data(), argv);
  // Replaced or removed since it was started: then it goes on as it is.
}

}  // namespace terrane
