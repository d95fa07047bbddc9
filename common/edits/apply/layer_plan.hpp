// LayerPlan: the pieces that a stack of edits draws in each layer of a band of layers. Scratch of
// the layer painter. Internal to edits.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/runs/extent.hpp"

namespace runstone {

/// The piece of part `part` of the stack in one layer: rows in the lines [m_first, m_last). The
/// rows of a box are those of its shape. The rows of other shapes are in the plan from place `rows`
/// on, one for each line.
struct LayerPiece {
  std::uint32_t part = 0;
  std::uint32_t rows = 0;
  std::uint8_t m_first = 0, m_last = 0;
};

struct LayerPlan {
  /// The number of layers that are planned together. The rows of one part in them take 8 KB at
  /// most.
  static constexpr std::uint32_t kBand = 32;

  // The order is layer by layer, and in each layer from the bottom of the stack to its top.
  std::vector<LayerPiece> pieces;
  // The pieces of layer i of the band are [begin[i], end[i]).
  std::array<std::uint32_t, kBand> begin{};
  std::array<std::uint32_t, kBand> end{};
  // Voxels [first, last) of a line. The row is empty if last <= first.
  std::vector<std::uint8_t> row_first, row_last;
};

}  // namespace runstone
