// The sections of a Minecraft chunk as pieces: from packed values to runs, without a grid. Internal to
// the reader of regions.
#pragma once
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/minecraft_chunk.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {

class MinecraftPieces {
 public:
  MinecraftPieces() : of_number_(std::size_t{1} << 16) {}

  /// Gives the pieces of a chunk to the sink, as MinecraftChunkReader::read() describes. `plain` are
  /// the bytes that were scanned. Requires at least one section.
  Result<void> give(ByteView plain, const MinecraftChunk& chunk, VoxelPos origin,
                    const PieceSink& sink);

 private:
  Result<void> append_section(ByteView plain, const MinecraftSection& section, std::int64_t version,
                              RunBuilder& out);
  Result<void> read_palette(ByteView plain, const MinecraftSection& section);
  Result<void> append_states(NbtLongs longs, unsigned bits, bool crossing, RunBuilder& out);
  Result<void> append_numbers(const MinecraftSection& section, RunBuilder& out);
  Result<Material> material_of_entry(ByteView entry);
  Result<Material> material_of_number(std::uint16_t number);
  Result<Material> add(ForeignBlock block);
  Result<Material> air();
  void clear();

  // Of the present piece.
  std::vector<ForeignBlock> blocks_;
  std::size_t name_bytes_ = 0;
  std::unordered_map<std::string_view, Material>
      of_entry_;                        // by the bytes of an entry of a palette
  std::vector<Material> of_number_;     // by id * 16 + data; 0: not yet seen
  std::vector<std::uint16_t> numbers_;  // those that were seen
  Material air_ = kEmpty;
  // Of the present section: the material of each entry of the palette.
  std::vector<Material> palette_;
};

}  // namespace runstone
