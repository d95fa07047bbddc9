// Role: what a series is to the reader. It decides colour, hatching and shape, never the numbers.
#pragma once
#include <cstddef>
#include <string>

namespace runstone::bench::chart {

enum class Role {
  ours,      // the product: the strongest colour
  baseline,  // what it is held against
  other,  // everyone else: a palette by index where lines and columns must be told apart, else one quiet colour
  thesis  // figures taken from print: muted; hatched, dashed or hollow, so that no colour is needed
};

/// The CSS class of a role: "c-ours", "c-baseline", "c-thesis", "c-rest".
std::string class_of(Role role);

/// The same for series that must be told apart; `index` counts those of the same role. Others are "c-other0" ..
/// "c-other7" and round again; a second one of ours is "c-ours2", another shade, and so are those after it.
std::string class_of(Role role, std::size_t index);

}  // namespace runstone::bench::chart
