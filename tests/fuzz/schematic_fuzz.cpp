// The target reads any bytes as a schematic. Bytes that begin like NBT are read as they are, so that
// fields are hostile; others are inflated first, so that streams are. Pieces are sound, the memory of a
// file without cells is bounded, and each block becomes a material that a table accepts.
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/schematic_names.hpp"
#include "common/formats/schematic_reader.hpp"

using namespace runstone;

namespace {

Result<void> check_schematic_piece(ForeignPiece&& piece) {
  RUNSTONE_ASSERT(validate_runs(piece.voxels).has_value());
  for (std::size_t i = 0; i < piece.voxels.runs.size(); ++i)
    RUNSTONE_ASSERT(piece.voxels.runs.material(i) <= piece.blocks.size());
  for (const ForeignBlock& block : piece.blocks) {
    const MaterialInfo info = material_of_schematic_block(block, true);
    RUNSTONE_ASSERT(validate_material(info.name, info.colour, info.visibility, info.body, info.look)
                        .has_value());
  }
  return {};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = read_schematic({data, size}, check_schematic_piece);
  if (!read) RUNSTONE_ASSERT(read.error().what[0] != '\0');
  return 0;
}
