// Importing a Luanti world: its map.sqlite is read block by block and becomes chunks of runs, through a sink,
// so that whoever keeps worlds decides where they go. Two passes: the first learns names and places
// (materials must be known before the first chunk), the second makes one chunk at a time. Memory does not
// grow with the voxels, only with the number of blocks (about 100 bytes each).
//   LuantiImportSink sink{materials, chunk, progress};
//   const auto report = import_luanti("worlds/valley", {.edge = 32}, sink);
// A damaged block is listed and left empty, never invented. Blocks: any thread; blocks on the disk.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

struct LuantiImportOptions {
  std::int32_t edge = 32;  // of the chunks to make: 16, 32, 64 or 128
  bool keep_all =
      false;  // plants, torches and the like become see-through cubes instead of nothing
};

struct LuantiImportSink {
  /// Called once, before the first chunk. Id 0 is air, then the names that occur, in ascending order of
  /// bytes.
  std::function<void(const MaterialTable&)> materials;
  /// Called for each chunk that is not all empty, in ascending (z, y, x), in its cheapest axis order.
  /// Returning false ends the import with an error.
  std::function<bool(const ChunkKey&, RunChunk&&)> chunk;
  /// Called now and then with the share of the work that is done; may be empty.
  std::function<void(std::uint64_t done, std::uint64_t total)> progress;
};

struct DamagedBlock {
  std::int64_t pos = 0;  // the row's key
  ChunkCoord block;      // what it stands for, in blocks of 16
  Error error;
};

struct LuantiImportReport {
  std::uint64_t blocks = 0;  // read well; damaged ones are not among them
  std::vector<DamagedBlock> damaged;
  std::uint64_t chunks = 0;  // handed to the sink
  std::uint64_t runs = 0;    // in them, together
  MaterialTable materials;
  std::vector<std::uint64_t>
      voxels;       // by material id; [0] counts the empty voxels of the chunks handed over
  VoxelBox bounds;  // smallest box around all blocks that were read well
  VoxelPos spawn;   // on top of the middle column of the bounds (bounds.max.y if it is empty)
};

struct ImportError {
  std::string file;
  std::string what;
  std::string message() const { return file + ": " + what; }
};

/// Imports `folder`/map.sqlite, which is opened read-only. Fails if it cannot be read as a Luanti map, holds
/// more names than a material table, or the sink says so.
Result<LuantiImportReport, ImportError> import_luanti(const std::string& folder,
                                                      const LuantiImportOptions& options,
                                                      const LuantiImportSink& sink);

}  // namespace runstone
