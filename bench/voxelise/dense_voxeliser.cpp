#include "bench/voxelise/dense_voxeliser.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "common/runs/run_builder.hpp"
#include "common/voxelise/line_crossings.hpp"

namespace runstone::bench {
namespace {

constexpr std::int32_t kDenseSection = 64;

struct FreeBytes {
  void operator()(std::uint8_t* bytes) const { std::free(bytes); }
};

/// The grid. The system gives its pages, filled with zeros, when they are touched first.
struct ByteGrid {
  explicit ByteGrid(VoxelPos sides_)
      : sides(sides_),
        bytes(static_cast<std::uint8_t*>(
            std::calloc(static_cast<std::size_t>(sides.x) * static_cast<std::size_t>(sides.y),
                        static_cast<std::size_t>(sides.z)))) {}
  std::uint8_t* row(std::int32_t y, std::int32_t z) const {
    return bytes.get() + static_cast<std::size_t>(sides.x) *
                             (static_cast<std::size_t>(y) +
                              static_cast<std::size_t>(sides.y) * static_cast<std::size_t>(z));
  }
  VoxelPos sides;
  std::unique_ptr<std::uint8_t, FreeBytes> bytes;
};

/// Fills the row between each two marks. Returns the number of voxels that are set.
std::uint64_t fill_row(std::uint8_t* row, std::size_t count) {
  std::uint64_t set = 0;
  std::uint8_t* const end = row + count;
  for (std::uint8_t* at = row; at < end;) {
    auto* first =
        static_cast<std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)));
    if (first == nullptr) break;
    auto* last = static_cast<std::uint8_t*>(
        std::memchr(first + 1, 1, static_cast<std::size_t>(end - first - 1)));
    if (last == nullptr) last = end;
    std::memset(first, 1, static_cast<std::size_t>(last - first));
    set += static_cast<std::uint64_t>(last - first);
    if (last < end) *last = 0;
    at = last + 1;
  }
  return set;
}

/// Appends the runs of a piece of a row.
void append_row(RunBuilder& runs, const std::uint8_t* row, std::size_t count) {
  for (std::size_t at = 0; at < count;) {
    const std::uint8_t material = row[at];
    const auto* next =
        static_cast<const std::uint8_t*>(std::memchr(row + at, material == 0 ? 1 : 0, count - at));
    const std::size_t end = next == nullptr ? count : static_cast<std::size_t>(next - row);
    runs.append(static_cast<std::uint32_t>(end - at), material);
    at = end;
  }
}

}  // namespace

Result<Voxelised> dense_voxelise(const Model& model, const VoxeliseOptions& options,
                                 const VoxelPieceSink& sink) {
  if (auto valid = validate(model); !valid) return failure(valid.error());
  const auto placement = ModelPlacement::of(model, options.turn, options.scale);
  if (!placement) return failure(placement.error());
  const auto edges = mesh_edges(model, *placement);
  if (!edges) return failure(edges.error());
  Voxelised out;
  out.sides = placement->sides();
  out.colours = {{255, 255, 255}};
  out.closure = edges->closure;
  out.rule = SolidRule::parity;
  const VoxelPos s = out.sides;
  const ByteGrid grid(s);
  if (grid.bytes == nullptr) return fail(ErrorCode::limit_exceeded, "no memory for the grid");
  const LineRanges lines{{0, 0, 0}, {s.x - 1, s.y - 1, s.z - 1}};
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    for_each_crossing<true>(placement->triangle(model, i), 0, kVoxelUnit / 2, lines,
                            [&](const auto& line, const Crossing& crossing) {
                              const std::int32_t x = crossing.first_centre();
                              if (x < s.x) grid.row(line[1], line[2])[x] ^= 1;
                            });
  }
  const auto row_bytes = static_cast<std::size_t>(s.x);
  for (std::int32_t z = 0; z < s.z; ++z) {
    for (std::int32_t y = 0; y < s.y; ++y) out.voxels += fill_row(grid.row(y, z), row_bytes);
  }
  for (VoxelPos o; o.z < s.z; o.z += kDenseSection) {
    for (o.y = 0; o.y < s.y; o.y += kDenseSection) {
      for (o.x = 0; o.x < s.x; o.x += kDenseSection) {
        const Extent extent{static_cast<std::uint8_t>(std::min(kDenseSection, s.x - o.x)),
                            static_cast<std::uint8_t>(std::min(kDenseSection, s.y - o.y)),
                            static_cast<std::uint8_t>(std::min(kDenseSection, s.z - o.z))};
        RunBuilder runs(extent, AxisOrder::xyz);
        for (std::int32_t z = o.z; z < o.z + extent.z; ++z) {
          for (std::int32_t y = o.y; y < o.y + extent.y; ++y)
            append_row(runs, grid.row(y, z) + o.x, extent.x);
        }
        RunChunk voxels = runs.finish();
        if (is_empty(voxels)) continue;
        if (auto taken = sink({o, std::move(voxels)}); !taken) return failure(taken.error());
      }
    }
  }
  return out;
}

}  // namespace runstone::bench
