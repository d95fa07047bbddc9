// level.dat of a Minecraft Java world: the place where players arrive.
#pragma once
#include <optional>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Returns the place where players arrive in the overworld: SpawnX, SpawnY and SpawnZ of Data, or
/// the `pos` of its `spawn`, which worlds since 1.21.9 have. Returns nullopt if the file says none,
/// or a place in another dimension or outside the world. The file may be gzip, zlib or not
/// compressed. Every byte is untrusted. Fails if it is no NBT, or damaged; the offset of the error
/// is a decompressed byte. Cost: O(decompressed bytes). Memory: that of NbtFileSource.
Result<std::optional<VoxelPos>> read_minecraft_spawn(ByteView level_dat);

}  // namespace runstone
