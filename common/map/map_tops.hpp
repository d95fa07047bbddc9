// MapTops: a square of columns from above: for each column of voxels the voxel that shows, and the
// ground below it. It is made directly from the runs of chunks or tiles. Pure.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/map/map_materials.hpp"
#include "common/runs/column_tops.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// A chunk of a column, for find_map_tops().
struct StackedChunk {
  const RunChunk* voxels = nullptr;  // not null
  std::int32_t base_y = 0;           // of its lowest voxels
};

struct MapTops {
  MapTops() = default;
  explicit MapTops(std::int32_t edge_)
      : edge(edge_), surface(static_cast<std::size_t>(edge_) * static_cast<std::size_t>(edge_)) {}

  std::int32_t edge = 0;           // columns along a side
  std::vector<ColumnTop> surface;  // what shows; column (x, z) is x + edge * z
  /// The highest opaque voxel, at or below the surface. Empty: the surface is the ground
  /// everywhere, because nothing transparent is above it.
  std::vector<ColumnTop> ground;

  const ColumnTop& at(std::int32_t x, std::int32_t z) const {
    return surface[static_cast<std::size_t>(x + edge * z)];
  }
  /// Returns the surface of the columns of the greatest x, by z.
  std::vector<ColumnTop> last_x() const;
  /// Returns the surface of the columns of the greatest z, by x.
  std::span<const ColumnTop> last_z() const {
    return std::span(surface).last(static_cast<std::size_t>(edge));
  }
  std::span<const ColumnTop> ground_or_surface() const { return ground.empty() ? surface : ground; }
  std::size_t bytes() const { return (surface.size() + ground.size()) * sizeof(ColumnTop); }
};

/// The tops of a column of chunks that are visited one after the other, from the highest to the
/// lowest.
class MapTopsFinder {
 public:
  /// `materials` must outlive the object.
  MapTopsFinder(std::int32_t edge, const MapMaterials& materials);

  /// Returns true if each column has ground, so that no chunk below can change the tops.
  bool is_complete() const { return ground_open_ == 0; }
  /// Visits the next chunk. Requires a cube of the edge, below all chunks before it. Returns the
  /// runs and columns that were visited. Cost: as find_column_tops(), and
  /// twice that once a chunk had a transparent material.
  std::size_t visit(const StackedChunk& chunk);
  MapTops take() { return std::move(tops_); }

 private:
  const MapMaterials& materials_;
  MapTops tops_;
  // While no chunk had a transparent material, the surface is the ground, and tops_.ground is
  // empty.
  std::size_t surface_open_, ground_open_;
};

/// Returns the tops of these chunks. Requires chunks from the highest to the lowest, cubes of one
/// edge. Adds the runs and columns that were visited to `work`. Chunks below the ground are not
/// visited.
MapTops find_map_tops(std::span<const StackedChunk> chunks, std::int32_t edge,
                      const MapMaterials& materials, std::size_t& work);

}  // namespace runstone
