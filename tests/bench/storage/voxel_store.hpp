// VoxelStore: what every way to keep the voxels of a chunk can do, so that one measurement and one test are
// templates over all of them: no virtual call stands in an inner loop. Chunks are cubes whose edge is a power of
// two, as trees and Morton codes want them. A store is made from runs and keeps nothing but what it needs to be
// read, walked and edited.
//   at(p)                 material of a voxel
//   set(p, m)             one voxel; nothing happens if it is of that material
//   paint(ball, m)        all voxels of a ball, in the way that suits the store
//   walk(f)               f(count, material) for stretches that make up the chunk, in the store's own best order
//   byte_size()           all that it keeps: itself and its blocks on the heap (heap_bytes.hpp)
#pragma once
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/bench/storage/ball.hpp"

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

/// A cube with an edge of 8, 16, 32, 64 or 128.
constexpr bool storable(Extent extent) {
  return extent.valid() && extent.x == extent.y && extent.y == extent.z &&
         std::has_single_bit(std::uint32_t{extent.x});
}

}  // namespace runstone::bench::storage
