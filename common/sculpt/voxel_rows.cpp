#include "common/sculpt/voxel_rows.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/assert.hpp"
#include "common/core/build_info.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// A stretch inside one chunk, in world coordinates.
struct ChunkStretch {
  std::int32_t y = 0, z = 0;
  RowStretch part;
};

using ChunkStretches = std::map<ChunkCoord, std::vector<ChunkStretch>>;

/// Returns the stretches by chunk, each list in index order.
ChunkStretches by_chunk(const VoxelRows& rows, std::int32_t edge) {
  ChunkStretches out;
  for (const VoxelRows::Place& place : rows.places()) {
    for (const RowStretch& part : *rows.row(place.y, place.z)) {
      for (std::int32_t low = part.low; low < part.high;) {
        const ChunkCoord chunk = chunk_of({low, place.y, place.z}, edge);
        const std::int32_t high = std::min(part.high, origin_of(chunk, edge).x + edge);
        out[chunk].push_back({place.y, place.z, {low, high}});
        low = high;
      }
    }
  }
  return out;
}

/// Returns the cells of a chunk inside a part of it: those of the stretches that are not empty, and
/// with `with_air` the empty ones as well. Returns nullopt if there are too many materials.
std::optional<RunChunk> cells_of_stretches(const RunChunk& chunk, VoxelPos origin,
                                           const VoxelBox& part,
                                           const std::vector<ChunkStretch>& stretches,
                                           BuildBuilder& out, bool with_air) {
  const auto edge = static_cast<std::uint32_t>(chunk.extent.x);
  const auto side = [](std::int32_t low, std::int32_t high) {
    return static_cast<std::uint8_t>(high - low);
  };
  const Extent extent{side(part.min.x, part.max.x), side(part.min.y, part.max.y),
                      side(part.min.z, part.max.z)};
  RunBuilder cells(extent, AxisOrder::xyz);
  for (const ChunkStretch& stretch : stretches) {
    const auto from = static_cast<std::uint32_t>(stretch.part.low - origin.x) +
                      edge * (static_cast<std::uint32_t>(stretch.y - origin.y) +
                              edge * static_cast<std::uint32_t>(stretch.z - origin.z));
    const auto count = static_cast<std::uint32_t>(stretch.part.high - stretch.part.low);
    const auto to = static_cast<std::uint32_t>(stretch.part.low - part.min.x) +
                    extent.x * (static_cast<std::uint32_t>(stretch.y - part.min.y) +
                                extent.y * static_cast<std::uint32_t>(stretch.z - part.min.z));
    cells.append_to(to, 0);
    std::uint32_t at = from;
    for (std::size_t run = find_run(chunk, from); at < from + count; ++run) {
      const std::uint32_t end = std::min(chunk.runs.end(run), from + count);
      const Material material = chunk.runs.material(run);
      std::uint16_t number = 0;
      if (material != kEmpty || with_air) {
        const auto found = out.number_of(material);
        if (!found) return std::nullopt;
        number = *found;
      }
      cells.append(end - at, number);
      at = end;
    }
  }
  cells.append_to(extent.volume(), 0);
  return cells.finish();
}

}  // namespace

void VoxelRows::add(std::int32_t y, std::int32_t z, RowStretch part) {
  auto& row = rows_[key_of(y, z)];
  // Consecutive stretches often meet, so most of them grow the last one of their row.
  if (!row.empty() && part.low <= row.back().high && row.back().low <= part.high) {
    row.back() = {std::min(row.back().low, part.low), std::max(row.back().high, part.high)};
  } else {
    row.push_back(part);
  }
  box_ = bounding_box(box_, {{part.low, y, z}, {part.high, y + 1, z + 1}});
}

void VoxelRows::join() {
  for (auto& [key, row] : rows_) join_stretches(row);
}

std::uint64_t VoxelRows::count() const {
  std::uint64_t out = 0;
  for (const auto& [key, row] : rows_) {
    for (const RowStretch& part : row) out += static_cast<std::uint64_t>(part.high - part.low);
  }
  return out;
}

std::uint64_t VoxelRows::stretches() const {
  std::uint64_t out = 0;
  for (const auto& [key, row] : rows_) out += row.size();
  return out;
}

const std::vector<RowStretch>* VoxelRows::row(std::int32_t y, std::int32_t z) const {
  const auto found = rows_.find(key_of(y, z));
  return found == rows_.end() ? nullptr : &found->second;
}

std::vector<VoxelRows::Place> VoxelRows::places() const {
  std::vector<Place> out;
  out.reserve(rows_.size());
  for (const auto& [key, row] : rows_) {
    out.push_back({static_cast<std::int32_t>(static_cast<std::uint32_t>(key)),
                   static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> 32))});
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool VoxelRows::contains(VoxelPos voxel) const {
  const std::vector<RowStretch>* const found = row(voxel.y, voxel.z);
  if (found == nullptr) return false;
  const auto behind =
      std::upper_bound(found->begin(), found->end(), voxel.x,
                       [](std::int32_t x, const RowStretch& part) { return x < part.low; });
  return behind != found->begin() && voxel.x < std::prev(behind)->high;
}

VoxelRows rows_of_boxes(std::span<const VoxelBox> boxes) {
  VoxelRows out;
  for (const VoxelBox& box : boxes) {
    for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) out.add(y, z, {box.min.x, box.max.x});
    }
  }
  out.join();
  return out;
}

VoxelRows united(const VoxelRows& a, const VoxelRows& b) {
  VoxelRows out;
  for (const VoxelRows* const rows : {&a, &b}) {
    for (const auto& [z, y] : rows->places()) {
      for (const RowStretch& part : *rows->row(y, z)) out.add(y, z, part);
    }
  }
  out.join();
  return out;
}

VoxelRows without(const VoxelRows& a, const VoxelRows& b) {
  VoxelRows out;
  std::vector<RowStretch> row, scratch;
  for (const auto& [z, y] : a.places()) {
    row = *a.row(y, z);
    if (const auto* const taken = b.row(y, z)) subtract_stretches(*taken, row, scratch);
    for (const RowStretch& part : row) out.add(y, z, part);
  }
  return out;
}

VoxelRows common(const VoxelRows& a, const VoxelRows& b) {
  VoxelRows out;
  for (const auto& [z, y] : a.places()) {
    const auto* const other = b.row(y, z);
    if (other == nullptr) continue;
    for (const RowStretch& part : common_stretches(*a.row(y, z), *other)) out.add(y, z, part);
  }
  return out;
}

VoxelRows moved(const VoxelRows& rows, VoxelPos by) {
  VoxelRows out;
  for (const auto& [z, y] : rows.places()) {
    for (const RowStretch& part : *rows.row(y, z))
      out.add(y + by.y, z + by.z, {part.low + by.x, part.high + by.x});
  }
  return out;
}

namespace {

/// Combines a set with all its copies that are moved by 1 .. `steps` steps. The result of `done`
/// steps, combined with itself moved by at most `done` steps, gives the result of up to twice as
/// many steps.
VoxelRows combined_along(const VoxelRows& rows, Direction direction, std::int32_t steps,
                         VoxelRows (*combine)(const VoxelRows&, const VoxelRows&)) {
  VoxelRows out = rows;
  const std::int32_t sign = is_positive(direction) ? 1 : -1;
  for (std::int32_t done = 0; done < steps && !out.empty();) {
    const std::int32_t more = std::min(std::max(done, 1), steps - done);
    VoxelPos by;
    (axis_of(direction) == Axis::x   ? by.x
     : axis_of(direction) == Axis::y ? by.y
                                     : by.z) = sign * more;
    out = combine(out, moved(out, by));
    done += more;
  }
  return out;
}

}  // namespace

VoxelRows grown_to(const VoxelRows& rows, Direction direction, std::int32_t steps) {
  return combined_along(rows, direction, steps, united);
}

VoxelRows shrunk_from(const VoxelRows& rows, Direction direction, std::int32_t steps) {
  return combined_along(rows, opposite(direction), steps, common);
}

VoxelRows grown(const VoxelRows& rows, std::int32_t steps) {
  VoxelRows along_y, out;
  for (const auto& [z, y] : rows.places()) {
    for (const RowStretch& part : *rows.row(y, z)) {
      for (std::int32_t i = -steps; i <= steps; ++i)
        along_y.add(y + i, z, {part.low - steps, part.high + steps});
    }
  }
  along_y.join();
  for (const auto& [z, y] : along_y.places()) {
    for (const RowStretch& part : *along_y.row(y, z)) {
      for (std::int32_t i = -steps; i <= steps; ++i) out.add(y, z + i, part);
    }
  }
  out.join();
  return out;
}

namespace {

/// Returns in each row what it has in common with the rows up to `steps` away along y or z.
VoxelRows common_rows(const VoxelRows& rows, std::int32_t steps, Axis axis) {
  VoxelRows out;
  for (const auto& [z, y] : rows.places()) {
    std::vector<RowStretch> common = *rows.row(y, z);
    for (std::int32_t i = -steps; i <= steps && !common.empty(); ++i) {
      const auto* const beside = axis == Axis::y ? rows.row(y + i, z) : rows.row(y, z + i);
      common = beside == nullptr ? std::vector<RowStretch>{} : common_stretches(common, *beside);
    }
    for (const RowStretch& part : common) out.add(y, z, part);
  }
  return out;
}

}  // namespace

VoxelRows shrunk(const VoxelRows& rows, std::int32_t steps) {
  VoxelRows narrow;
  for (const auto& [z, y] : rows.places()) {
    for (const RowStretch& part : *rows.row(y, z)) {
      if (part.low + steps < part.high - steps)
        narrow.add(y, z, {part.low + steps, part.high - steps});
    }
  }
  return common_rows(common_rows(narrow, steps, Axis::y), steps, Axis::z);
}

Result<PlacedBuild> build_of_voxels(const VoxelRows& rows, std::int32_t edge,
                                    const ChunkLookup& chunk_at, bool with_air) {
  if (rows.empty()) return fail(ErrorCode::bad_value, "no voxel is left");
  const VoxelBox box = rows.box();
  const VoxelPos sides{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
  if (std::max({sides.x, sides.y, sides.z}) > kBuildSideMax)
    return fail(ErrorCode::limit_exceeded, "build is longer than 1,048,576 voxels");
  const ChunkCoord first = chunk_of(box.min, edge);
  auto out = BuildBuilder::of(world_cuts(box, edge));
  if (!out) return failure(out.error());
  for (const auto& [at, stretches] : by_chunk(rows, edge)) {
    auto chunk = chunk_at(at);
    if (!chunk) return fail(ErrorCode::not_found, "a chunk of it is not loaded");
    RUNSTONE_ASSERT(chunk->extent == Extent::cube(static_cast<unsigned>(edge)));
    if (chunk->order != AxisOrder::xyz)
      chunk = std::make_shared<const RunChunk>(reorder(*chunk, AxisOrder::xyz));
    auto cells = cells_of_stretches(*chunk, origin_of(at, edge), intersect(box, box_of(at, edge)),
                                    stretches, *out, with_air);
    if (!cells) return fail(ErrorCode::limit_exceeded, "build has too many materials");
    const SectionPos place{static_cast<std::uint32_t>(at.x - first.x),
                           static_cast<std::uint32_t>(at.y - first.y),
                           static_cast<std::uint32_t>(at.z - first.z)};
    if (const auto put = out->put(place, *std::move(cells)); !put) return failure(put.error());
  }
  auto build = out->finish();
  if (!build) return failure(build.error());
  return PlacedBuild{box.min, *std::move(build)};
}

}  // namespace runstone
