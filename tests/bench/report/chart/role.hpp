// Role: the meaning of a series for the reader. It decides colour, hatching and shape, never the
// numbers.
#pragma once
#include <cstddef>
#include <string>

namespace runstone::bench::chart {

enum class Role {
  ours,      // the product: the strongest colour
  baseline,  // what the product is compared with
  // All others: a palette by index where lines and columns must be distinguished, otherwise one
  // quiet colour.
  other,
  // Printed figures: muted; hatched, dashed or hollow, so that no colour is needed.
  thesis
};

/// Returns the CSS class of a role: "c-ours", "c-baseline", "c-thesis", "c-rest".
std::string class_of(Role role);

/// Returns the CSS class for series that must be distinguished. `index` counts those of the same
/// role. Others are "c-other0" .. "c-other7" and start again. A second series of the product, and
/// those after it, are "c-ours2", another shade.
std::string class_of(Role role, std::size_t index);

}  // namespace runstone::bench::chart
