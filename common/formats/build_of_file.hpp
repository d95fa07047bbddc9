// Builds of foreign files: joins the pieces that a reader gives to one FileBuild, and from there the
// clipboard, the library, an .rsb or a writer of another format take it.
#pragma once
#include <cstddef>
#include <string>

#include "common/builds/build.hpp"
#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

struct ForeignReading {
  bool keep_all = true;  // as that of Format::material_of
  // True: blocks whose shape fills less than half of its voxel are empty (visibility_as_cube()).
  bool only_cubes = false;
  std::size_t bytes_max = kBuildBytesMax;  // of the memory of the build and of its pieces
  std::string name = {};                   // of the build, if the file has none; see BuildInfo
  // For a height map: the bytes of a PNG with the colours of its columns (height_map.hpp), or none.
  // They must outlive the call. Programs set `colours_file` alone, the path of the PNG:
  // read_build_of_file() (common/build_files) reads the bytes from it.
  ByteView colours = {};
  std::string colours_file = {};
};

/// Reads a whole file as a build. The build is the smallest box around the pieces. Voxels of which the
/// file says nothing are untouched, and blocks of air are empty cells. Each pair of name and states is
/// a material of the build; a name becomes one that validate_material() accepts, and states that are
/// too long are cut. Where pieces overlap, the later one counts. Fails as Format::read does, with
/// limit_exceeded if the build has more materials or sides than a build may have or takes more memory
/// than allowed, and with bad_value if no cell is touched. Requires a format that reads files, and
/// that of height maps if there are colours. Cost:
/// O(runs + lines of the pieces).
Result<FileBuild> read_foreign_build(const Format& format, ByteView file,
                                     const ForeignReading& reading);

}  // namespace runstone
