#include "side_by_side.hpp"

#include "geo/core/parallel_errors.hpp"

namespace geo::io {

void do_side_by_side(const std::vector<std::function<void()>>& pieces) {
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < pieces.size(); ++i) errors.guard(pieces[i]);
  errors.rethrow();
}

}  // namespace geo::io
