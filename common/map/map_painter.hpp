// MapPainter: the picture of a map. It has shaded relief: slopes towards the west and the north are
// light, as if the sun stood there. Water and glass are tinted by the depth to the ground below
// them. Pure.
// Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/map/map_materials.hpp"
#include "common/map/map_tops.hpp"

namespace runstone {

class MapPainter {
 public:
  /// Heights and the widths of columns are in units of `unit` voxels, so slopes do not change.
  /// Depths are multiplied by `unit`. `materials` must outlive the object.
  explicit MapPainter(const MapMaterials& materials, std::int32_t unit = 1);

  /// Writes the pixels of the tops, +x right and +z down: sRGB, red is the lowest byte, alpha the
  /// highest. A column without a top is 0, which is transparent. The rows of `out` are `stride`
  /// pixels apart. `west` and `north` are the tops of the columns beyond x = 0 and z = 0, which
  /// give the slopes at the borders; an empty span: not known. Requires spans of tops.edge columns
  /// or empty ones, and room in `out`. Cost: O(columns).
  void paint(const MapTops& tops, std::span<const ColumnTop> west, std::span<const ColumnTop> north,
             std::span<std::uint32_t> out, std::size_t stride);

 private:
  // The pixels of a map have few different colours, so colours are remembered by what they depend
  // on: a table of kSlots entries, in which a new colour replaces another one.
  static constexpr std::size_t kSlots = std::size_t{1} << 10;
  static constexpr std::uint64_t kNoBits = ~std::uint64_t{0};
  struct Kept {
    std::uint64_t bits = kNoBits;
    std::uint32_t pixel = 0;
  };
  const MapMaterials& materials_;
  const std::int32_t unit_;
  std::vector<Kept> kept_;
};

/// Returns the pixels that a new MapPainter writes, without gaps.
std::vector<std::uint32_t> paint_map(const MapTops& tops, std::span<const ColumnTop> west,
                                     std::span<const ColumnTop> north,
                                     const MapMaterials& materials, std::int32_t unit = 1);

}  // namespace runstone
