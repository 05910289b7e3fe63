// The index of the search is fetched, which browsers forbid to pages opened from the disk: no search is
// better than one that finds nothing.
if (location.protocol === "file:")
  document.addEventListener("DOMContentLoaded", () =>
    document.querySelectorAll(".md-search, label[for='__search']").forEach((part) => part.remove()));
