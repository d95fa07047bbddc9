// Hash of chunk keys for look-up tables of one process. Nothing may depend on the order of such a table.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/hash.hpp"

namespace runstone {

struct ChunkKeyHash {
  std::size_t operator()(const ChunkKey& key) const noexcept {
    const auto word = [](std::int32_t v) { return std::uint64_t{static_cast<std::uint32_t>(v)}; };
    const std::uint64_t xz = mix64(word(key.at.x) | word(key.at.z) << 32);
    return static_cast<std::size_t>(mix64(xz ^ (word(key.at.y) | std::uint64_t{key.lod} << 32)));
  }
};

}  // namespace runstone
