#include "bench/storage/store_case.hpp"

#include <algorithm>

#include "common/core/hash.hpp"

namespace runstone::bench::storage {
namespace {

constexpr std::size_t kReads = 4096;
constexpr std::size_t kEdits = 256;
constexpr std::size_t kBrushes = 8;

std::vector<Material> palette_of(const RunChunk& chunk) {
  std::vector<Material> out = {kEmpty};
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) out.push_back(chunk.runs.material(i));
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  const auto gap =
      std::adjacent_find(out.begin(), out.end(), [](Material a, Material b) { return b > a + 1; });
  const Material before_new = gap == out.end() ? out.back() : *gap;
  out.push_back(static_cast<Material>(before_new + 1));
  return out;
}

}  // namespace

StoreCase make_store_case(const RunChunk& chunk, std::uint64_t seed) {
  SplitMix64 rng(seed);
  const auto place = [&] {
    const auto along = [&](std::uint8_t side) {
      return static_cast<std::uint8_t>(rng.below(side));
    };
    const std::uint8_t x = along(chunk.extent.x), y = along(chunk.extent.y);
    return LocalPos{x, y, along(chunk.extent.z)};
  };
  const std::vector<Material> palette = palette_of(chunk);
  const auto material = [&] {
    return palette[rng.below(static_cast<std::uint32_t>(palette.size()))];
  };

  StoreCase out{chunk, {}, {}, {}, 0};
  for (std::size_t i = 0; i < kReads; ++i) out.reads.push_back(place());
  for (std::size_t i = 0; i < kEdits; ++i) {
    const LocalPos at = place();
    const Material before = material_at(chunk, at);
    Material now = material();
    while (now == before) now = material();
    out.edits.push_back({at, now, before});
  }
  for (std::size_t i = 0; i < kBrushes; ++i) {
    const Brush brush{Ball(place(), kBrushRadius), material()};
    brush.ball.for_each_row(chunk.extent, AxisOrder::xyz, [&](OrderedPos, std::uint32_t count) {
      out.brush_voxels += static_cast<double>(count) / kBrushes;
    });
    out.brushes.push_back(brush);
  }
  return out;
}

}  // namespace runstone::bench::storage
