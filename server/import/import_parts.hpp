// ImportParts: what an import reads besides a Luanti map: a file with a build, or the region files of a
// Minecraft world. Each part is a build with its place in the new world, and is read when it is
// asked for, so that only one is in memory. Parts do not overlap. Threads: any, one at a time. It
// blocks on the disk.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/build_files/model_reading.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// The memory of the build of a part, at most.
inline constexpr std::size_t kPartBytesMax = std::size_t{2} << 30;

struct ImportPart {
  FileBuild build;
  VoxelPos at;  // of its lowest corner
};

/// The parts that an import left out because they are damaged, one line for each.
using ImportFaults = std::vector<std::string>;

class ImportParts {
 public:
  virtual ~ImportParts() = default;
  virtual std::size_t count() const = 0;
  /// Reads part `index`, which is nullopt if nothing is in it. Appends to `faults` what is damaged.
  /// Fails with one line if the part cannot be read at all.
  virtual Result<std::optional<ImportPart>, std::string> read(std::size_t index,
                                                              ImportFaults& faults) = 0;
  /// Returns the place where players arrive, if the source says one.
  virtual std::optional<VoxelPos> spawn() const { return std::nullopt; }
  /// Returns lines about what the source lacks although parts can be read.
  virtual std::vector<std::string> notices() const { return {}; }
};

/// Opens a file of any format (build_files.hpp), whose lowest corner comes to `at`. `colours`: the
/// PNG with the colours of a height map; empty: none. `model`: how a model becomes a build.
Result<std::unique_ptr<ImportParts>, std::string> open_file_parts(const std::string& file,
                                                                  VoxelPos at, bool keep_all,
                                                                  const std::string& colours,
                                                                  const ModelReading& model);
/// Opens a Minecraft Java world: a folder with a folder `region`, a folder of region files, or one
/// region file. Each region is a part. Voxels keep their places. Chunks that are damaged are left out.
/// In a folder with a folder `region`, players arrive where level.dat says; a notice tells why it
/// says no place.
/// Fails if there is no region file.
Result<std::unique_ptr<ImportParts>, std::string> open_minecraft_parts(const std::string& place,
                                                                       bool keep_all);

}  // namespace runstone
