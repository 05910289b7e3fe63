#pragma once

namespace terrane {

/// Rasters come and go by the hundred: what one leaves is kept for the next instead of being given
/// back to the system, which would have to clear it again, page by page. Of what is left at the end
/// of the heap, more than 2 GB still goes back.
void keep_freed_memory();

}  // namespace terrane
