// The target decodes foreign blocks in two ways: the bytes as a whole row (the zstd stream is
// hostile), and as the content of the stream (its fields are hostile, which random streams would
// hardly ever reach).
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/block_materials.hpp"
#include "common/formats/luanti_block.hpp"
#include "tests/support/formats/luanti_bytes.hpp"

using namespace runstone;

namespace {

void decode(ByteView row) {
  const auto read = read_luanti_block(row, [](ForeignPiece&& piece) -> Result<void> {
    RUNSTONE_ASSERT(validate(piece.voxels).has_value());
    for (std::size_t i = 0; i < piece.voxels.runs.size(); ++i) {
      RUNSTONE_ASSERT(piece.voxels.runs.material(i) <= piece.blocks.size());
    }
    BlockMaterials materials(formats().front(), true);
    materials.note(piece);
    const auto table = materials.make_table();
    RUNSTONE_ASSERT(table.has_value());
    const RunChunk voxels = materials.resolve(piece);
    RUNSTONE_ASSERT(validate(voxels).has_value());
    for (std::size_t i = 0; i < voxels.runs.size(); ++i) {
      RUNSTONE_ASSERT(table->knows(voxels.runs.material(i)));
    }
    return {};
  });
  if (!read) RUNSTONE_ASSERT(read.error().what[0] != '\0');
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode({data, size});
  decode(test::luanti_row(Bytes(data, data + size)));
  return 0;
}
