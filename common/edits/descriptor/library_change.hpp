// LibraryChange: a change of the library of builds of a world, as a record of the log holds it. It
// has no voxels and touches no chunk. The cells of a build are in the store, beside the log
// (docs/builds.md). The number of a build in the library is the sequence of the record that added
// it. docs/edit-log.md specifies the bytes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <variant>

#include "common/core/build_info.hpp"
#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Adds a build.
struct AddBuild {
  BuildInfo info;
  std::uint64_t touched = 1;      // cells, 1 .. volume
  std::uint64_t file_bytes = 1;   // of its .rsb, 1 .. kLibraryFileBytesMax
  std::uint64_t file_digest = 0;  // XXH3-64 (seed 0) of the bytes of the .rsb
  // Names the bytes in the store. Drawn by the server, never 0 and never used twice in a world.
  std::uint64_t content = 1;
  friend bool operator==(const AddBuild&, const AddBuild&) = default;
};

/// Removes a build. A number that no build has changes nothing.
struct RemoveBuild {
  Sequence number = 1;  // 1 .. kSequenceMax
  friend bool operator==(const RemoveBuild&, const RemoveBuild&) = default;
};

using LibraryChange = std::variant<AddBuild, RemoveBuild>;

/// The maximum size of a build in a library, whatever the settings of a server allow: 1 GiB.
inline constexpr std::uint64_t kLibraryFileBytesMax = std::uint64_t{1} << 30;
/// The maximum size of the bytes of a change: the tag, the info, and four numbers.
inline constexpr std::size_t kLibraryChangeBytesMax = 1 + kBuildInfoBytesMax + 10 + 10 + 8 + 8;

/// Fails with bad_value, limit_exceeded or not_canonical for the first field outside its range.
/// Cost: O(bytes).
Result<void> validate(const LibraryChange& change);

/// Appends the canonical bytes. Requires validate().
void write_library_change(ByteWriter& w, const LibraryChange& change);
/// Reads what write_library_change() wrote. A failure is found in the reader. The result is not
/// validated, apart from the info of a build.
LibraryChange read_library_change(ByteReader& r);

}  // namespace runstone
