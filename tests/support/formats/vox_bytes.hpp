// A writer of .vox files for tests, made from the published format. It shares no code with the reader.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"

namespace runstone::test {

using VoxPairs = std::vector<std::pair<std::string, std::string>>;
using VoxVoxel = std::array<std::uint8_t, 4>;  // x, y, z, colour

Bytes vox_chunk(std::string_view id, const Bytes& content);
/// Returns SIZE and XYZI.
Bytes vox_model(std::array<std::int32_t, 3> sides, const std::vector<VoxVoxel>& voxels);
Bytes vox_transform(std::int32_t id, std::int32_t child, const VoxPairs& frame,
                    const VoxPairs& attributes = {}, std::int32_t layer = -1);
Bytes vox_group(std::int32_t id, const std::vector<std::int32_t>& children);
Bytes vox_shape(std::int32_t id, std::int32_t model);
Bytes vox_pairs(const VoxPairs& pairs);
Bytes vox_numbered(std::string_view chunk_id, std::int32_t id, const VoxPairs& pairs,
                   const Bytes& behind = {});
/// Returns a file of chunks.
Bytes vox_file(const std::vector<Bytes>& chunks, std::uint32_t version = 150);

}  // namespace runstone::test
