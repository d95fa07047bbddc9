// The state that RdmScratch keeps between calls. Internal to rdm.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/mesh/rdm/layer_sweep.hpp"
#include "common/mesh/rdm/part_seam.hpp"
#include "common/mesh/rdm/quad_buckets.hpp"
#include "common/mesh/rdm/quad_splice.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"

namespace runstone::rdm {

/// The part that depends on the width of a row.
template <class Row>
struct RowScratch {
  Borders<Row> borders;
  SweepState<Row> sweep;
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
  std::array<std::vector<rdm::PartSeam>, 2> seams;  // opaque and transparent
  rdm::QuadSplice splice;
  // Each is made for the first chunk whose longest side needs it.
  std::unique_ptr<rdm::RowScratch<Row32>> rows_32;
  std::unique_ptr<rdm::RowScratch<Row64>> rows_64;
  std::unique_ptr<rdm::RowScratch<Row128>> rows_128;
  bool plain = false;
};

}  // namespace runstone
