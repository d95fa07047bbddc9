// The target reads foreign chunks in three ways: the bytes as a whole region file, as the stream of a
// chunk in an otherwise sound file, and as the content of a chunk, which random streams would hardly
// ever reach. The first byte chooses the way.
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_region.hpp"
#include "tests/support/formats/minecraft_bytes.hpp"

using namespace runstone;

namespace {

constexpr std::size_t kCheckedBlocks = 3;

Result<void> check_piece(ForeignPiece&& piece) {
  RUNSTONE_ASSERT(validate_runs(piece.voxels).has_value());
  RUNSTONE_ASSERT(piece.origin.x >= -kWorldLimit && piece.origin.x < kWorldLimit);
  RUNSTONE_ASSERT(piece.origin.z >= -kWorldLimit && piece.origin.z < kWorldLimit);
  for (std::size_t i = 0; i < piece.voxels.runs.size(); ++i) {
    const Material material = piece.voxels.runs.material(i);
    RUNSTONE_ASSERT(material != kEmpty && material <= piece.blocks.size());
  }
  // The facts of a block take much longer than reading it.
  if (piece.blocks.size() > kCheckedBlocks) piece.blocks.resize(kCheckedBlocks);
  for (const ForeignBlock& block : piece.blocks) {
    const MaterialInfo info = material_of_minecraft_block(block, true);
    RUNSTONE_ASSERT(validate_material(info.name, info.colour, info.visibility, info.body, info.look)
                        .has_value());
    const auto back = block_of_minecraft_material(minecraft_material_name(block));
    RUNSTONE_ASSERT(!back || *back == with_default_states(block) || info.name == "air");
  }
  return {};
}

void read_chunk(std::uint8_t compression, Bytes packed) {
  static MinecraftChunkReader reader;
  const Bytes file = test::mc_region({{0, compression, std::move(packed)}});
  const auto region = open_minecraft_region(file);
  RUNSTONE_ASSERT(region.has_value());
  const auto read = reader.read(*region, 0, nullptr, check_piece);
  if (!read) RUNSTONE_ASSERT(read.error().what[0] != '\0');
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const ByteView rest(data + 1, size - 1);
  if (data[0] == 0) {
    std::vector<RegionFault> faults;
    const auto read = read_minecraft_region(rest, check_piece, faults);
    if (!read) RUNSTONE_ASSERT(read.error().what[0] != '\0');
    for (const RegionFault& fault : faults) RUNSTONE_ASSERT(fault.error.what[0] != '\0');
  } else {
    read_chunk(data[0], Bytes(rest.begin(), rest.end()));
  }
  return 0;
}
