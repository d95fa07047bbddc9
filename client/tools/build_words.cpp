#include "client/tools/build_words.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace runstone {

std::string words_of(const Error& error) {
  if (error.code != ErrorCode::limit_exceeded) return error.what;
  return std::string(error.what) + " (a build has at most " +
         std::to_string(kBuildBytesMax / (1024 * 1024)) + " MiB): select a smaller box";
}

std::string size_text(const Build& build) {
  const VoxelPos s = build.sides();
  char bytes[32];
  std::snprintf(bytes, sizeof(bytes), "%.1f MB", static_cast<double>(build.memory_bytes()) / 1e6);
  return std::to_string(s.x) + " x " + std::to_string(s.y) + " x " + std::to_string(s.z) +
         " voxels, " + bytes;
}

bool is_in_world(VoxelPos at, VoxelPos sides) {
  const auto fits = [](std::int32_t low, std::int32_t side) {
    return low >= -kWorldLimit && std::int64_t{low} + side <= kWorldLimit;
  };
  return fits(at.x, sides.x) && fits(at.y, sides.y) && fits(at.z, sides.z);
}

}  // namespace runstone
