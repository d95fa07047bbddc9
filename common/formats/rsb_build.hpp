// A Build as an .rsb, and back. In memory a build has ids of a world as materials; in a file it has
// the rows of a material table, whose names another world knows.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/build_info.hpp"
#include "common/core/material_row.hpp"
#include "common/formats/build_head.hpp"
#include "common/formats/rsb_block.hpp"

namespace runstone {

/// A build from a file. Its palette has no ids of a world.
struct FileBuild {
  BuildInfo info;
  BuildPtr build;
  std::vector<BuildMaterial> materials;  // by palette entry of the build
};

/// Writes a build. `materials` are those of its palette, by entry; one without a name gets one from its
/// number. Sets the sides of `info`. With `skips_empty`, empty cells are written as
/// untouched. Fails as RsbWriter does: if two materials have one name and the same states, a field
/// is outside its range, the sink fails, or no cell is touched. Cost: O(runs + lines of the
/// sections). Memory: that of one section and one block.
RsbResult<void> write_build(const Build& build, std::span<const BuildMaterial> materials,
                            BuildInfo info, bool skips_empty, const RsbSink& sink,
                            int zstd_level = 9);

/// Reads a build. Fails as RsbReader does, and with limit_exceeded if the build takes more than
/// `bytes_max` of memory. No byte is trusted.
RsbResult<FileBuild> read_build(RsbSource source, std::size_t bytes_max = kBuildBytesMax);

}  // namespace runstone
