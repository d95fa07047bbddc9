// The state that RdmScratch keeps between calls. Internal to rdm.
#pragma once
#include <array>
#include <bitset>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/mesh/rdm/layer_sweep.hpp"
#include "common/mesh/rdm/quad_buckets.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/rdm/row_runs.hpp"

namespace runstone::rdm {

/// The part that depends on the width of a row.
template <class Row>
struct RowScratch {
  Borders<Row> borders;
  SweepState<Row> sweep;
};

/// Quads of some layers that replace others, in one pass (opaque or transparent).
struct LayerPatch {
  struct Layer {
    std::size_t index = 0;        // in QuadLayers::first
    std::uint32_t quads_end = 0;  // in `quads`; they begin where those of the previous layer end
  };
  std::vector<Layer> layers;  // ascending
  std::vector<Quad> quads;
  std::vector<Quad> merged;  // scratch
};

}  // namespace runstone::rdm

namespace runstone {

struct RdmScratch::State {
  rdm::ChunkPalette palette;
  // The palette indices of the chunk's runs, in the type that the palette fits.
  std::vector<rdm::BytePaletteIndex> byte_indices;
  std::vector<rdm::PaletteIndex> full_indices;
  std::vector<Material> border_voxels;  // of a border layer, where transparent materials meet
  rdm::QuadBuckets opaque, transparent;
  std::array<rdm::LayerPatch, 2> patch;         // opaque and transparent
  std::array<rdm::RowRuns, kSideMax> row_runs;  // of one row in some layers of an axis
  std::bitset<kSideMax> row_known;              // the layers that row_runs holds
  rdm::RowRuns row_beyond;                      // of the same row in a neighbour
  std::uint32_t row_number = 0;
  std::array<std::array<Quad, kSideMax>, 2> strips;  // of the current row, by pass
  std::vector<Quad> adjacent;                        // quads above and below that row
  std::array<std::vector<Quad>, 2> layer;            // quads of the current layer, by pass
  // Each is made for the first chunk whose longest side needs it.
  std::unique_ptr<rdm::RowScratch<Row32>> rows_32;
  std::unique_ptr<rdm::RowScratch<Row64>> rows_64;
  std::unique_ptr<rdm::RowScratch<Row128>> rows_128;
  bool plain = false;
};

}  // namespace runstone
