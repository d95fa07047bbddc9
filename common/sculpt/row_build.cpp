#include "common/sculpt/row_build.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/assert.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// Exchanges y with an axis. The exchange is its own inverse.
template <class T>
std::array<T, 3> exchanged(std::array<T, 3> of, Axis axis) {
  std::swap(of[1], of[static_cast<std::size_t>(axis)]);
  return of;
}

AxisOrder order_of(Axis axis) {
  if (axis == Axis::x) return AxisOrder::yxz;
  if (axis == Axis::z) return AxisOrder::xzy;
  return AxisOrder::xyz;
}

}  // namespace

VoxelPos with_upright(VoxelPos sides, Axis axis) {
  const auto out = exchanged(std::array{sides.x, sides.y, sides.z}, axis);
  return {out[0], out[1], out[2]};
}

Result<BuildPtr> build_of_rows(VoxelPos upright, Axis axis, Material material,
                               const RowSource& rows) {
  RUNSTONE_ASSERT(upright.x > 0 && upright.y > 0 && upright.z > 0);
  const BuildCuts cuts = {grid_cuts(upright.x, kPasteBlockEdge),
                          grid_cuts(upright.y, kPasteBlockEdge),
                          grid_cuts(upright.z, kPasteBlockEdge)};
  auto builder = BuildBuilder::of(exchanged(cuts, axis));
  if (!builder) return failure(builder.error());
  const std::uint16_t number = *builder->number_of(material);
  std::vector<RowStretch> row;
  for (std::uint32_t sz = 0; sz + 1 < cuts[2].size(); ++sz) {
    for (std::uint32_t sy = 0; sy + 1 < cuts[1].size(); ++sy) {
      // The rows of a line of sections are made once for all of them.
      std::vector<std::optional<RunBuilder>> sections(cuts[0].size() - 1);
      const std::int32_t height = cuts[1][sy + 1] - cuts[1][sy],
                         depth = cuts[2][sz + 1] - cuts[2][sz];
      for (std::int32_t z = 0; z < depth; ++z) {
        for (std::int32_t y = 0; y < height; ++y) {
          row.clear();
          rows(cuts[1][sy] + y, cuts[2][sz] + z, row);
          for (const RowStretch& part : row) {
            for (auto sx = static_cast<std::size_t>(part.low / kPasteBlockEdge);
                 sx < sections.size() && cuts[0][sx] < part.high; ++sx) {
              const std::int32_t low = cuts[0][sx], high = cuts[0][sx + 1], side = high - low;
              const std::int32_t from = std::max(low, part.low), to = std::min(high, part.high);
              if (!sections[sx]) {
                const auto extent = exchanged(
                    std::array{static_cast<std::uint8_t>(side), static_cast<std::uint8_t>(height),
                               static_cast<std::uint8_t>(depth)},
                    axis);
                sections[sx].emplace(Extent{extent[0], extent[1], extent[2]}, order_of(axis));
              }
              const auto start = static_cast<std::uint32_t>(side * (y + height * z));
              sections[sx]->append_to(start + static_cast<std::uint32_t>(from - low), 0);
              sections[sx]->append(static_cast<std::uint32_t>(to - from), number);
            }
          }
        }
      }
      for (std::uint32_t sx = 0; sx < sections.size(); ++sx) {
        if (!sections[sx]) continue;
        const std::int32_t side = cuts[0][sx + 1] - cuts[0][sx];
        sections[sx]->append_to(static_cast<std::uint32_t>(side * height * depth), 0);
        const auto at = exchanged(std::array{sx, sy, sz}, axis);
        if (const auto put = builder->put({at[0], at[1], at[2]}, sections[sx]->finish()); !put)
          return failure(put.error());
      }
    }
  }
  return builder->finish();
}

}  // namespace runstone
