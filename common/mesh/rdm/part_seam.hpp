// PartSeam: the quads of one layer that the sweep of a part replaces. Internal to rdm.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/rdm/sweep_input.hpp"

namespace runstone::rdm {

/// The quads from `begin` on, to the end of the layer, are replaced. Those from `behind` on end
/// behind the part, and keep their ends.
struct PartSeam {
  Direction direction{};
  Side side{};
  std::uint8_t layer = 0;
  std::uint32_t begin = 0, behind = 0;  // in QuadLayers::quads
};

}  // namespace runstone::rdm
