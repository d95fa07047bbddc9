// The target reads foreign chunks in three ways: the bytes as a whole region file, as a stream of each
// compression in an otherwise sound file, and as the content of a chunk, which random streams would
// hardly ever reach.
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/block_materials.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_region.hpp"
#include "tests/support/formats/minecraft_bytes.hpp"

using namespace runstone;

namespace {

void read_file(ByteView file) {
  std::vector<RegionFault> faults;
  const auto read = read_minecraft_region(
      file,
      [](ForeignPiece&& piece) -> Result<void> {
        RUNSTONE_ASSERT(validate_runs(piece.voxels).has_value());
        RUNSTONE_ASSERT(piece.origin.x >= -kWorldLimit && piece.origin.x < kWorldLimit);
        RUNSTONE_ASSERT(piece.origin.z >= -kWorldLimit && piece.origin.z < kWorldLimit);
        for (std::size_t i = 0; i < piece.voxels.runs.size(); ++i) {
          const Material material = piece.voxels.runs.material(i);
          RUNSTONE_ASSERT(material != kEmpty && material <= piece.blocks.size());
        }
        for (const ForeignBlock& block : piece.blocks) {
          const MaterialInfo info = material_of_minecraft_block(block, true);
          RUNSTONE_ASSERT(
              validate_material(info.name, info.colour, info.visibility, info.body, info.look)
                  .has_value());
          const auto back = block_of_minecraft_material(minecraft_material_name(block));
          RUNSTONE_ASSERT(!back || *back == with_default_states(block) || info.name == "air");
        }
        return {};
      },
      faults);
  if (!read) RUNSTONE_ASSERT(read.error().what[0] != '\0');
  for (const RegionFault& fault : faults) RUNSTONE_ASSERT(fault.error.what[0] != '\0');
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView bytes(data, size);
  read_file(bytes);
  const auto region = [&](std::uint8_t compression) {
    return test::mc_region({{0, compression, Bytes(data, data + size)}});
  };
  for (const std::uint8_t compression :
       {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4}})
    read_file(region(compression));
  return 0;
}
