// Import of builds as the base of a new world: ImportParts become chunks of runs. There are two passes:
// the first finds the materials and the bounds, because materials must be known before the first chunk;
// the second makes the chunks. Memory: one part. It blocks on the disk.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"
#include "server/import/import_parts.hpp"

namespace runstone {

struct BuildsSurvey {
  MaterialTable materials;  // id 0 is air; the others ascend by name
  VoxelBox bounds;          // around all parts
  // The place that the source says, raised until two voxels there are empty. If the source says
  // none, or one outside the bounds along x and z, the top of the part in the middle.
  VoxelPos spawn;
};

struct BuildsReport {
  std::uint64_t parts = 0;   // that hold something
  std::uint64_t chunks = 0;  // that are not all empty
  std::uint64_t runs = 0;    // in them
  std::uint64_t voxels = 0;  // that are not empty
  ImportFaults faults;
};

/// Is called for each chunk that is not all empty, in its cheapest axis order. Returns false to stop.
using ImportedChunk = std::function<bool(const ChunkKey&, RunChunk&&)>;
/// Takes the share of the work that is done.
using ImportProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// The first pass. Fails with one line if a part cannot be read, if there are more materials than a
/// table can hold, or if nothing is in any part.
Result<BuildsSurvey, std::string> survey_builds(ImportParts& parts, const ImportProgress& progress);
/// The second pass, with the materials of the first. Fails with one line if a part cannot be read, has
/// a material that the first pass did not see, or the callback returns false.
Result<BuildsReport, std::string> import_builds(ImportParts& parts, const MaterialTable& materials,
                                                std::int32_t edge, const ImportedChunk& chunk,
                                                const ImportProgress& progress);

}  // namespace runstone
