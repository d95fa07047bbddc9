// The target decodes foreign blocks in two ways: the bytes as a whole row (the zstd stream is
// hostile), and as the content of the stream (its fields are hostile, which random streams would
// hardly ever reach).
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/luanti_block.hpp"
#include "tests/support/formats/luanti_bytes.hpp"

using namespace runstone;

namespace {

void decode(ByteView row) {
  const auto block = decode_luanti_block(row);
  if (!block) return;
  RUNSTONE_ASSERT(validate(block->voxels).has_value());
  for (std::size_t i = 0; i < block->voxels.runs.size(); ++i) {
    RUNSTONE_ASSERT(block->voxels.runs.material(i) <= block->names.size());
  }
  MaterialTable table;
  for (const std::string& name : block->names) {
    MaterialInfo info = material_of_luanti_node(name, true);
    const bool known = table.find(info.name).has_value();
    RUNSTONE_ASSERT(table.add(std::move(info)).has_value() != known);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode({data, size});
  decode(test::luanti_row(Bytes(data, data + size)));
  return 0;
}
