#pragma once

#include <functional>
#include <vector>

namespace geo::io {

/// Does pieces of work at the same time, each whole on one thread, begun in the order given: the
/// longest first. All are done even where one fails; then what the first of them threw is thrown.
void do_side_by_side(const std::vector<std::function<void()>>& pieces);

}  // namespace geo::io
