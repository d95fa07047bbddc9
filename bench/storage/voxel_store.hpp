// VoxelStore: the interface of every way to store the voxels of a chunk. One measurement and one
// test are templates over all of them, so that no virtual call stands in an inner loop. Chunks are
// cubes whose edge is a power of two, as trees and Morton codes require. A store is made from runs
// and keeps only what reading, walking and editing need.
//   at(p)                 returns the material of a voxel
//   set(p, m)             sets one voxel; does nothing if it has that material
//   paint(ball, m)        sets all voxels of a ball, in the way that suits the store
//   walk(f)               calls f(count, material) for stretches that tile the chunk, in the
//                         store's best order
//   byte_size()           returns all that it keeps: itself and its heap blocks (heap_bytes.hpp)
#pragma once
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "bench/storage/ball.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::bench::storage {

template <class S>
concept VoxelStore =
    std::copyable<S> && std::constructible_from<S, const RunChunk&> &&
    requires(S store, const S& kept, LocalPos at, Material material, const Ball& ball) {
      { kept.at(at) } -> std::same_as<Material>;
      { store.set(at, material) } -> std::same_as<void>;
      { store.paint(ball, material) } -> std::same_as<void>;
      kept.walk([](std::uint32_t, Material) {});
      { kept.byte_size() } -> std::same_as<std::size_t>;
    };

/// Returns true for a cube with an edge of 8, 16, 32, 64 or 128.
constexpr bool storable(Extent extent) {
  return extent.valid() && extent.x == extent.y && extent.y == extent.z &&
         std::has_single_bit(std::uint32_t{extent.x});
}

}  // namespace runstone::bench::storage
