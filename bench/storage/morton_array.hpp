// MortonArray: one material a voxel, in the order of Morton codes. Source: thesis 3.3.4.
#pragma once
#include <vector>

#include "bench/storage/heap_bytes.hpp"
#include "bench/storage/morton_code.hpp"
#include "bench/storage/row_pieces.hpp"
#include "bench/storage/voxel_store.hpp"
#include "common/core/assert.hpp"
#include "common/runs/dense.hpp"

namespace runstone::bench::storage {

/// Returns the voxels of a storable chunk by Morton code. Counts a dense expansion. Cost:
/// O(volume).
inline std::vector<Material> in_morton_order(const RunChunk& chunk) {
  RUNSTONE_ASSERT(storable(chunk.extent));
  count_dense_expansion();
  std::vector<Material> out(chunk.volume());
  const std::uint32_t fastest = kMortonAxis[static_cast<std::size_t>(axes_of(chunk.order)[0])];
  for_each_row_piece(chunk, [&](OrderedPos first, std::uint32_t count, Material material) {
    std::uint32_t code = MortonByTable::code(from_ordered(first, chunk.order));
    for (; count > 0; --count, code = morton_next(code, fastest)) out[code] = material;
  });
  return out;
}

/// Code is MortonByTable or MortonByPdep.
template <class Code>
class MortonArray {
 public:
  explicit MortonArray(const RunChunk& chunk)
      : extent_(chunk.extent), voxels_(in_morton_order(chunk)) {}

  Material at(LocalPos at) const { return voxels_[Code::code(at)]; }
  void set(LocalPos at, Material material) { voxels_[Code::code(at)] = material; }
  void paint(const Ball& ball, Material material) {
    ball.for_each_row(extent_, AxisOrder::xyz, [&](OrderedPos first, std::uint32_t count) {
      std::uint32_t code = Code::code(from_ordered(first, AxisOrder::xyz));
      for (; count > 0; --count, code = morton_next(code, kMortonAxis[0])) voxels_[code] = material;
    });
  }
  template <class F>
  void walk(F&& stretch) const {
    for (const Material material : voxels_) stretch(1u, material);
  }
  std::size_t byte_size() const {
    return sizeof *this + heap_bytes(voxels_.capacity() * sizeof(Material));
  }

 private:
  Extent extent_;
  std::vector<Material> voxels_;
};
static_assert(VoxelStore<MortonArray<MortonByTable>> && VoxelStore<MortonArray<MortonByPdep>>);

}  // namespace runstone::bench::storage
