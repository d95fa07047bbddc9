// ChunkKeyHash: hashes chunk keys for tables in memory. No result may depend on the order of such a
// table.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/hash.hpp"

namespace runstone {

struct ChunkKeyHash {
  std::size_t operator()(const ChunkKey& key) const noexcept {
    const auto bits = [](std::int32_t v) { return std::uint64_t{static_cast<std::uint32_t>(v)}; };
    const std::uint64_t xz = mix64(bits(key.at.x) | bits(key.at.z) << 32);
    return static_cast<std::size_t>(mix64(xz ^ (bits(key.at.y) | std::uint64_t{key.lod} << 32)));
  }
};

}  // namespace runstone
