// BuildInfo: what a build is and who made it. A build is a box of cells of any size with a name, such
// as a house or a town. Files (.rsb), records of the log and the library of a world hold it.
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The maximum side of a build, in voxels, in memory and in files. A volume then has at most 60 bits.
inline constexpr std::int32_t kBuildSideMax = 1 << 20;

inline constexpr std::size_t kBuildNameBytesMax = 64;
inline constexpr std::size_t kBuildAuthorBytesMax = 32;
inline constexpr std::size_t kBuildTagBytesMax = 32;
inline constexpr std::size_t kBuildTagsMax = 16;
/// The latest time of a build, in microseconds since 1970: 2^53.
inline constexpr TimeUs kBuildTimeMax = TimeUs{1} << 53;
/// The maximum size of the bytes of an info: sides, origin, time, texts with their lengths.
inline constexpr std::size_t kBuildInfoBytesMax = 3 * 3 + 3 * 5 + 8 + 1 + kBuildNameBytesMax + 1 +
                                                  kBuildAuthorBytesMax + 1 +
                                                  kBuildTagsMax * (1 + kBuildTagBytesMax);

struct BuildSides {
  std::uint32_t x = 1, y = 1, z = 1;  // voxels, 1 .. kBuildSideMax each
  friend auto operator<=>(const BuildSides&, const BuildSides&) = default;
  constexpr std::uint64_t volume() const { return std::uint64_t{x} * y * z; }
};

struct BuildInfo {
  std::string name;               // 1 .. kBuildNameBytesMax bytes, is_plain_name()
  std::string author;             // name of the player who made it, or empty; as `name`
  std::vector<std::string> tags;  // at most kBuildTagsMax, ascending, different; as `name`
  TimeUs created_us = 0;          // UTC, 0 .. kBuildTimeMax; 0: not known
  BuildSides sides;
  VoxelPos origin;  // of the lowest corner in the world from which the build was copied
  friend bool operator==(const BuildInfo&, const BuildInfo&) = default;
};

/// Fails with bad_value, limit_exceeded or not_canonical for the first field outside its range.
/// Cost: O(bytes).
Result<void> validate(const BuildInfo& info);

/// Appends the canonical bytes (docs/builds.md). Requires a valid info.
void write_build_info(ByteWriter& w, const BuildInfo& info);
/// Reads what write_build_info() wrote. A failure is found in the reader, also if a field is outside
/// its range. Memory is proportional to the bytes present.
BuildInfo read_build_info(ByteReader& r);

}  // namespace runstone
