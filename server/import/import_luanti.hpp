// Import of a Luanti world: its map, in map.sqlite or in a LevelDB as world.mt says, is read block
// by block and becomes chunks of runs. A sink takes the chunks and decides where they go. There are
// two passes: the first finds names and places, because materials must be known before the first
// chunk; the second makes one chunk at a time.
//   LuantiImportSink sink{materials, chunk, progress}; const auto report =
//   import_luanti("worlds/valley", {.edge = 32}, sink);
// A damaged block is listed and left empty.
// Memory: about 100 bytes for each block; it does not grow with the voxels. Threads: any. It blocks
// on the disk.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/formats/material_map.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"
#include "server/import/import_error.hpp"

namespace runstone {

struct LuantiImportOptions {
  std::int32_t edge = 32;  // of the chunks to make: 16, 32, 64 or 128
  /// Plants, torches and similar nodes become see-through cubes. Otherwise they are left out.
  bool keep_all = false;
  /// Chooses materials, if it is not null. It must outlive the import.
  const MaterialMap* map = nullptr;
  /// If it is true, the materials are those of material_of_luanti_cube(). The benchmarks use it, so
  /// that their figures stay comparable.
  bool only_cubes = false;
};

struct LuantiImportSink {
  /// The import calls it once, before the first chunk. Id 0 is air. The nodes that occur
  /// follow, ascending by the bytes of the name and then of the state.
  std::function<void(const MaterialTable&)> materials;
  /// The import calls it for each chunk that is not all empty, ascending by (z, y, x). The chunk is
  /// in its cheapest axis order. If it returns false, the import ends with an error.
  std::function<bool(const ChunkKey&, RunChunk&&)> chunk;
  /// The import calls it from time to time with the part of the work that is done. It may be empty.
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;
};

struct DamagedBlock {
  std::int64_t pos = 0;                 // the row's key
  ChunkCoord block;                     // its position, in blocks of 16
  std::optional<std::uint8_t> version;  // of its serialisation; nullopt if it has no bytes
  Error error;
};

struct LuantiImportReport {
  std::uint64_t blocks = 0;  // without damage
  std::vector<DamagedBlock> damaged;
  /// The blocks of rows whose position an earlier row has. The earlier row counts.
  std::vector<ChunkCoord> repeated;
  /// The world has a read-only map beside its own (`readonly_backend`). It is not imported.
  bool has_seed_map = false;
  std::uint64_t chunks = 0;  // that the sink got
  std::uint64_t runs = 0;    // in all of them
  MaterialTable materials;
  AppliedRows applied;  // of the map
  /// Number of voxels by material id, in the chunks that the sink got. [0] counts their empty
  /// voxels.
  std::vector<std::uint64_t> voxels;
  VoxelBox bounds;  // smallest box around all blocks without damage
  VoxelPos spawn;   // on top of the middle column of the bounds; y is bounds.max.y if that is empty
};

/// Imports the map of a world, which is opened for reading only. Fails if
///   - world.mt names another backend than sqlite3 and leveldb, or the folder holds no Luanti world;
///   - the map cannot be read as a Luanti map, or has no blocks;
///   - it has more names than a material table can hold;
///   - the sink returns false.
Result<LuantiImportReport, ImportError> import_luanti(const std::string& folder,
                                                      const LuantiImportOptions& options,
                                                      const LuantiImportSink& sink);

}  // namespace runstone
