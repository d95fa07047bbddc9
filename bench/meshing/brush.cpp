#include "bench/meshing/brush.hpp"

#include <fmt/format.h>

#include <memory>

#include "common/core/assert.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"

namespace runstone::bench {
namespace {

/// Returns a cube of `side` voxels without the voxels inside.
std::shared_ptr<const Clipboard> house(std::uint32_t side, Material material) {
  ClipboardBuilder builder(Extent::cube(static_cast<std::uint16_t>(side)));
  const auto is_edge = [side](std::uint32_t at) { return at == 0 || at + 1 == side; };
  for (std::uint32_t z = 0; z < side; ++z) {
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t x = 0; x < side; ++x)
        builder.append(1, is_edge(x) || is_edge(y) || is_edge(z) ? material : kEmpty);
    }
  }
  auto made = builder.finish();
  RUNSTONE_ASSERT(made.has_value());
  return *made;
}

}  // namespace

std::string Brush::name() const {
  switch (kind) {
    case BrushKind::sphere:
      return size == 0 ? "voxel" : fmt::format("sphere r {}", size);
    case BrushKind::box:
      return fmt::format("box {}", size);
    case BrushKind::stroke:
      return fmt::format("stroke {}", size);
    case BrushKind::paste:
      return fmt::format("paste {}", size);
  }
  return "";
}

std::vector<Brush> brushes() {
  std::vector<Brush> out;
  for (const unsigned radius : {0u, 1u, 2u, 3u, 5u, 8u, 12u})
    out.push_back({BrushKind::sphere, radius});
  for (const unsigned side : {2u, 6u, 16u}) out.push_back({BrushKind::box, side});
  for (const unsigned length : {8u, 24u}) out.push_back({BrushKind::stroke, length});
  out.push_back({BrushKind::paste, 9});
  return out;
}

EditDescriptor brush_edit(const Brush& brush, VoxelPos at, Material material) {
  const auto size = static_cast<std::int32_t>(brush.size);
  switch (brush.kind) {
    case BrushKind::sphere:
      if (brush.size == 0) return {SetVoxel{at}, {}, material};
      return {FillSphere{at, static_cast<std::uint16_t>(brush.size)}, {}, material};
    case BrushKind::box:
      return {FillBox{{at, {at.x + size, at.y + size, at.z + size}}}, {}, material};
    case BrushKind::stroke:
      return {FillStroke{{at, {at.x + size, at.y + size / 4, at.z + size / 2}}, 1}, {}, material};
    case BrushKind::paste:
      return {Paste{at, house(brush.size, material), {}}, {}, kEmpty};
  }
  return {};
}

}  // namespace runstone::bench
