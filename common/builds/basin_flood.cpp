#include "common/builds/basin_flood.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
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

/// Voxels [first, last) of a line along x that the flood can fill or pass, all empty or none.
struct Stretch {
  std::uint8_t first, last;
  bool is_empty, is_reached;
};

/// The stretches of a chunk by line. Line y + edge * z has those from begins[line] to
/// begins[line + 1].
struct Lines {
  std::vector<std::uint32_t> begins;
  std::vector<Stretch> stretches;
};

/// A stretch that was reached.
struct Reached {
  ChunkCoord chunk;
  Lines* lines;
  std::int32_t y, z;  // in the chunk
  std::uint32_t stretch;
};

class BasinFiller {
 public:
  BasinFiller(const BasinFlood& flood, std::int32_t edge, const ChunkLookup& chunk_at)
      : flood_(flood), edge_(edge), chunk_at_(chunk_at) {}

  Result<FloodedBasin, BasinFault> run() {
    if (flood_.start.y > flood_.level) return failure(BasinFault::above_level);
    const ChunkCoord first = chunk_of(flood_.start, edge_);
    const LocalPos at = local_of(flood_.start, edge_);
    Lines* const lines = lines_of(first);
    if (lines == nullptr) return failure(BasinFault::missing_chunk);
    const int x = at.x;
    reach(first, lines, at.y, at.z, x, x + 1);
    if (waiting_.empty()) return failure(BasinFault::blocked);
    while (!waiting_.empty() && !fault_) {
      const Reached next = waiting_.back();
      waiting_.pop_back();
      spread(next);
    }
    if (fault_) return failure(*fault_);
    return build();
  }

 private:
  bool lets_pass(Material material) const {
    return material == kEmpty || (material < flood_.passes.size() && flood_.passes[material]);
  }

  /// Returns the lines of a chunk, or null if it is not known.
  Lines* lines_of(ChunkCoord at) {
    const auto known = chunks_.find(at);
    if (known != chunks_.end()) return &known->second;
    const std::shared_ptr<const RunChunk> chunk = chunk_at_(at);
    if (!chunk) return nullptr;
    RUNSTONE_ASSERT(chunk->extent == Extent::cube(static_cast<unsigned>(edge_)));
    Lines& out = chunks_[at];
    if (chunk->order == AxisOrder::xyz) {
      read(*chunk, out);
    } else {
      read(reorder(*chunk, AxisOrder::xyz), out);
    }
    return &out;
  }

  /// Requires the order xyz.
  void read(const RunChunk& chunk, Lines& out) const {
    const auto edge = static_cast<std::uint32_t>(edge_);
    out.begins.reserve(std::size_t{edge} * edge + 1);
    out.begins.push_back(0);
    const auto end_lines = [&](std::uint32_t count) {
      while (out.begins.size() <= count)
        out.begins.push_back(static_cast<std::uint32_t>(out.stretches.size()));
    };
    chunk.runs.visit([&](const auto& runs) {
      std::uint32_t begin = 0;
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::uint32_t end = runs.end(i);
        if (lets_pass(runs.material(i))) {
          for (std::uint32_t at = begin; at < end;) {
            const std::uint32_t line = at / edge, x = at - line * edge;
            const std::uint32_t last = std::min(end - line * edge, edge);
            end_lines(line);
            out.stretches.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(last),
                                     runs.material(i) == kEmpty, false});
            at = line * edge + last;
          }
        }
        begin = end;
      }
    });
    end_lines(edge * edge);
  }

  /// Marks the stretches of a line as reached that share a place of [first, last) along x.
  void reach(ChunkCoord chunk, Lines* lines, std::int32_t y, std::int32_t z, int first, int last) {
    const auto line = static_cast<std::size_t>(y + edge_ * z);
    for (std::uint32_t i = lines->begins[line]; i < lines->begins[line + 1]; ++i) {
      Stretch& s = lines->stretches[i];
      if (s.last <= first) continue;
      if (s.first >= last) break;
      if (std::exchange(s.is_reached, true)) continue;
      voxels_ += static_cast<std::uint64_t>(s.last - s.first);
      if (voxels_ > flood_.voxels_max) fault_ = BasinFault::too_many_voxels;
      if (s.is_empty) {
        const VoxelPos origin = origin_of(chunk, edge_);
        const VoxelPos low{origin.x + s.first, origin.y + y, origin.z + z};
        box_ = bounding_box(box_, {low, {origin.x + s.last, low.y + 1, low.z + 1}});
      }
      waiting_.push_back({chunk, lines, y, z, i});
    }
  }

  /// Marks the stretches beside a stretch as reached.
  void spread(const Reached& from) {
    const Stretch s = from.lines->stretches[from.stretch];
    if (s.first != 0) {
      reach(from.chunk, from.lines, from.y, from.z, s.first - 1, s.first);
    } else {
      reach_beyond(from, Direction::neg_x, from.y, from.z, edge_ - 1, edge_);
    }
    if (s.last != edge_) {
      reach(from.chunk, from.lines, from.y, from.z, s.last, s.last + 1);
    } else {
      reach_beyond(from, Direction::pos_x, from.y, from.z, 0, 1);
    }
    for (const Direction d :
         {Direction::neg_y, Direction::pos_y, Direction::neg_z, Direction::pos_z}) {
      const std::int32_t step = is_positive(d) ? 1 : -1;
      const std::int32_t y = from.y + (axis_of(d) == Axis::y ? step : 0);
      const std::int32_t z = from.z + (axis_of(d) == Axis::z ? step : 0);
      if (origin_of(from.chunk, edge_).y + y > flood_.level) continue;
      if (y >= 0 && y < edge_ && z >= 0 && z < edge_) {
        reach(from.chunk, from.lines, y, z, s.first, s.last);
      } else {
        reach_beyond(from, d, (y + edge_) % edge_, (z + edge_) % edge_, s.first, s.last);
      }
    }
  }

  void reach_beyond(const Reached& from, Direction d, std::int32_t y, std::int32_t z, int first,
                    int last) {
    const ChunkCoord beyond = neighbour(from.chunk, d);
    Lines* const lines = lines_of(beyond);
    if (lines == nullptr) {
      fault_ = BasinFault::missing_chunk;
    } else {
      reach(beyond, lines, y, z, first, last);
    }
  }

  Result<FloodedBasin, BasinFault> build() const {
    if (box_.empty()) return failure(BasinFault::full);
    const ChunkCoord first = chunk_of(box_.min, edge_);
    const VoxelPos origin = origin_of(first, edge_);
    if (std::max({box_.max.x - box_.min.x, box_.max.y - box_.min.y, box_.max.z - box_.min.z}) >
        kBuildSideMax)
      return failure(BasinFault::too_many_voxels);
    auto out = BuildBuilder::of({grid_cuts(box_.max.x - box_.min.x, edge_, box_.min.x - origin.x),
                                 grid_cuts(box_.max.y - box_.min.y, edge_, box_.min.y - origin.y),
                                 grid_cuts(box_.max.z - box_.min.z, edge_, box_.min.z - origin.z)});
    if (!out) return failure(BasinFault::too_many_voxels);
    const std::uint16_t number = *out->number_of(flood_.material);
    for (const auto& [at, lines] : chunks_) {
      auto cells = cells_of(at, lines, number);
      if (!cells) continue;
      const SectionPos place{static_cast<std::uint32_t>(at.x - first.x),
                             static_cast<std::uint32_t>(at.y - first.y),
                             static_cast<std::uint32_t>(at.z - first.z)};
      if (!out->put(place, *std::move(cells))) return failure(BasinFault::too_many_voxels);
    }
    auto made = out->finish();
    if (!made) return failure(BasinFault::too_many_voxels);
    return FloodedBasin{*std::move(made), box_.min, voxels_};
  }

  /// Returns the reached empty voxels of a chunk, within the box, or nullopt if there are none.
  std::optional<RunChunk> cells_of(ChunkCoord at, const Lines& lines, std::uint16_t number) const {
    const VoxelBox part = intersect(box_, box_of(at, edge_));
    if (part.empty()) return std::nullopt;
    const auto side = [](std::int32_t low, std::int32_t high) {
      return static_cast<std::uint8_t>(high - low);
    };
    const VoxelPos origin = origin_of(at, edge_);
    RunBuilder out(
        {side(part.min.x, part.max.x), side(part.min.y, part.max.y), side(part.min.z, part.max.z)},
        AxisOrder::xyz);
    const auto width = static_cast<std::uint32_t>(part.max.x - part.min.x);
    const std::int32_t x0 = part.min.x - origin.x;
    std::uint32_t line_end = 0;
    bool has_cells = false;
    for (std::int32_t z = part.min.z - origin.z; z < part.max.z - origin.z; ++z) {
      for (std::int32_t y = part.min.y - origin.y; y < part.max.y - origin.y; ++y) {
        const auto line = static_cast<std::size_t>(y + edge_ * z);
        for (std::uint32_t i = lines.begins[line]; i < lines.begins[line + 1]; ++i) {
          const Stretch& s = lines.stretches[i];
          if (!s.is_empty || !s.is_reached) continue;
          // The box holds each reached empty stretch.
          out.append_to(line_end + static_cast<std::uint32_t>(s.first - x0), 0);
          out.append_to(line_end + static_cast<std::uint32_t>(s.last - x0), number);
          has_cells = true;
        }
        line_end += width;
        out.append_to(line_end, 0);
      }
    }
    if (!has_cells) return std::nullopt;
    return out.finish();
  }

  const BasinFlood& flood_;
  const std::int32_t edge_;
  const ChunkLookup& chunk_at_;
  std::map<ChunkCoord, Lines> chunks_;
  std::vector<Reached> waiting_;
  VoxelBox box_;  // of the empty voxels that were reached
  std::uint64_t voxels_ = 0;
  std::optional<BasinFault> fault_;
};

}  // namespace

Result<FloodedBasin, BasinFault> flood_basin(const BasinFlood& flood, std::int32_t edge,
                                             const ChunkLookup& chunk_at) {
  RUNSTONE_ASSERT(flood.material != kEmpty && edge > 0);
  return BasinFiller(flood, edge, chunk_at).run();
}

}  // namespace runstone
