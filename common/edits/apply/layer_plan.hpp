// LayerPlan: what a stack of edits draws in each layer of a band of layers. Scratch of the layer painter. Internal to
// edits.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/runs/extent.hpp"

namespace runstone {

/// What part number `part` of the stack has in one layer: rows in the lines [m_first, m_last). A box's are those of
/// its shape; those of others stand in the plan from place `rows` on, one for each line.
struct LayerPiece {
  std::uint32_t part = 0;
  std::uint32_t rows = 0;
  std::uint8_t m_first = 0, m_last = 0;
};

struct LayerPlan {
  /// Layers planned at once: the rows of a part are found together, and take 8 KB at most.
  static constexpr std::uint32_t kBand = 32;

  std::vector<LayerPiece>
      pieces;  // layer by layer, in each from the bottom of the stack to its top
  std::array<std::uint32_t, kBand> begin{};  // those of the band's layer i are [begin[i], end[i])
  std::array<std::uint32_t, kBand> end{};
  std::vector<std::uint8_t> row_first,
      row_last;  // voxels [first, last) of a line; none if last <= first
};

}  // namespace runstone
