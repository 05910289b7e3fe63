#include "side_by_side.hpp"

#include <exception>

namespace geo::io {

void do_side_by_side(const std::vector<std::function<void()>>& pieces) {
  std::vector<std::exception_ptr> failures(pieces.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    try {
      pieces[i]();
    } catch (...) {
      failures[i] = std::current_exception();
    }
  }
  for (const auto& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace geo::io
