#include "common/formats/piece_joiner.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/assert.hpp"
#include "common/core/build_info.hpp"
#include "common/core/text.hpp"
#include "common/formats/block_assembler.hpp"
#include "common/materials/visibility_as_cube.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kJoinEdge = 64;
/// The runs of pieces that are laid over each other at once.
constexpr std::size_t kJoinBatchBytes = std::size_t{4} << 20;
/// The sections that a piece of kSideMax voxels a side meets at most.
constexpr std::size_t kMeetingsMax = 27;
/// The memory of a section besides its runs, in bytes.
constexpr std::size_t kJoinSectionBytes = sizeof(RunChunk) + 64;

VoxelBox box_at(VoxelPos origin, Extent extent) {
  return {origin, {origin.x + extent.x, origin.y + extent.y, origin.z + extent.z}};
}

Extent extent_of_box(const VoxelBox& box) {
  return {static_cast<std::uint8_t>(box.max.x - box.min.x),
          static_cast<std::uint8_t>(box.max.y - box.min.y),
          static_cast<std::uint8_t>(box.max.z - box.min.z)};
}

LocalPos local_in(const VoxelBox& box, VoxelPos at) {
  return {static_cast<std::uint8_t>(at.x - box.min.x), static_cast<std::uint8_t>(at.y - box.min.y),
          static_cast<std::uint8_t>(at.z - box.min.z)};
}

RunChunk cut_to(const VoxelBox& box, const RunChunk& voxels, const VoxelBox& part) {
  if (part == box) return voxels;
  return cut(voxels, local_in(box, part.min), extent_of_box(part));
}

/// A piece, or what is made of several, in a section: its voxels in AxisOrder::xyz, read line by line.
struct LaidPart {
  VoxelBox box;  // from the lowest corner of the section
  RunChunk voxels;
  std::size_t run = 0;
  std::uint32_t at = 0;

  /// Writes the materials of the next line that are not 0.
  void lay_line(std::span<Material> line) {
    const std::uint32_t begin = at;
    const std::uint32_t end = at + static_cast<std::uint32_t>(box.max.x - box.min.x);
    while (at < end) {
      const Run part = voxels.runs[run];
      const std::uint32_t stop = std::min(part.end, end);
      if (part.material != 0) {
        const std::size_t first = static_cast<std::size_t>(box.min.x) + (at - begin);
        std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(first), stop - at, part.material);
      }
      at = stop;
      if (at == part.end) ++run;
    }
  }
};

/// Lays the parts over each other, the last one on top.
RunChunk laid_over(Extent extent, std::vector<LaidPart>& parts) {
  RunBuilder out(extent, AxisOrder::xyz);
  std::array<Material, kJoinEdge> buffer{};
  const std::span<Material> line = std::span(buffer).first(extent.x);
  std::vector<LaidPart*> active;
  for (std::int32_t z = 0; z < extent.z; ++z) {
    active.clear();
    for (LaidPart& part : parts) {
      if (z >= part.box.min.z && z < part.box.max.z) active.push_back(&part);
    }
    for (std::int32_t y = 0; y < extent.y; ++y) {
      std::fill(line.begin(), line.end(), Material{0});
      for (LaidPart* part : active) {
        if (y >= part->box.min.y && y < part->box.max.y) part->lay_line(line);
      }
      for (std::size_t begin = 0; begin < line.size();) {
        std::size_t end = begin + 1;
        while (end < line.size() && line[end] == line[begin]) ++end;
        out.append(static_cast<std::uint32_t>(end - begin), line[begin]);
        begin = end;
      }
    }
  }
  return out.finish();
}

/// Returns text that a build may have as states.
std::string printable_states(std::string_view states) {
  if (is_printable_utf8(states)) return std::string(cut_utf8(states, kBuildStatesBytesMax));
  std::string out(states.substr(0, kBuildStatesBytesMax));
  for (char& c : out) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return out;
}

std::size_t run_bytes(const RunChunk& voxels) { return voxels.runs.byte_capacity(); }

Unexpected<Error> too_many_bytes() {
  return fail(ErrorCode::limit_exceeded, "build takes too much memory");
}

}  // namespace

Result<void> PieceJoiner::add(ForeignPiece&& piece) {
  RUNSTONE_ASSERT(validate_runs(piece.voxels).has_value());
  const auto sides = piece.voxels.extent.sides();
  const auto fits = [](std::int32_t at, std::int32_t side) {
    return at >= -kWorldLimit && at <= kWorldLimit - side;
  };
  if (!fits(piece.origin.x, sides[0]) || !fits(piece.origin.y, sides[1]) ||
      !fits(piece.origin.z, sides[2]))
    return fail(ErrorCode::bad_value, "voxels lie outside the world");
  const VoxelBox box = box_at(piece.origin, piece.voxels.extent);
  box_ = bounding_box(box_, box);

  std::vector<bool> occurs(piece.blocks.size() + 1);
  piece.voxels.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      RUNSTONE_ASSERT(runs.material(i) < occurs.size());
      occurs[runs.material(i)] = true;
    }
  });
  std::vector<Material> to(piece.blocks.size() + 1, 0);
  bool says_something = false;
  for (std::size_t i = 0; i < piece.blocks.size(); ++i) {
    if (!occurs[i + 1]) continue;
    says_something = true;
    const auto next = static_cast<std::uint16_t>(numbers_.size() + 1);
    const auto [known, is_new] = numbers_.try_emplace(std::move(piece.blocks[i]), next);
    if (is_new) {
      if (numbers_.size() > kBuildMaterialsMax)
        return fail(ErrorCode::limit_exceeded, "build has more than 65535 materials");
      bytes_ += sizeof(ForeignBlock) + known->first.name.size() + known->first.states.size() + 64;
    }
    to[i + 1] = known->second;
  }
  // A piece that says nothing counts for the box only.
  if (!says_something) return {};
  Piece kept{box, with_materials(piece.voxels, to)};
  kept.voxels.runs.shrink_to_fit();
  kept.bytes = sizeof(Piece) + kMeetingsMax * sizeof(Meeting) + run_bytes(kept.voxels);
  bytes_ += kept.bytes;
  if (bytes_ > bytes_max_ || pieces_.size() == UINT32_MAX) return too_many_bytes();
  pieces_.push_back(std::move(kept));
  return {};
}

std::vector<PieceJoiner::Meeting> PieceJoiner::meetings(const BuildCuts& cuts) {
  std::vector<Meeting> out;
  // Every section but the first along an axis begins at a multiple of the edge.
  const auto place = [](std::int32_t at, std::int32_t low) {
    return static_cast<std::uint64_t>(floor_div(at, kJoinEdge) - floor_div(low, kJoinEdge));
  };
  const std::uint64_t count_x = cuts[0].size() - 1, count_y = cuts[1].size() - 1;
  for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
    const VoxelBox& box = pieces_[i].box;
    for (auto z = place(box.min.z, box_.min.z); z <= place(box.max.z - 1, box_.min.z); ++z) {
      for (auto y = place(box.min.y, box_.min.y); y <= place(box.max.y - 1, box_.min.y); ++y) {
        for (auto x = place(box.min.x, box_.min.x); x <= place(box.max.x - 1, box_.min.x); ++x) {
          out.push_back({x + count_x * (y + count_y * z), i});
          ++pieces_[i].sections_left;
        }
      }
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

RunChunk PieceJoiner::cells_of(const VoxelBox& section, std::span<const Meeting> meetings) {
  // A piece that fills the section with one material hides all pieces before it.
  std::size_t first = meetings.size() - 1;
  for (std::size_t i = meetings.size(); i-- > 0;) {
    const Piece& piece = pieces_[meetings[i].piece];
    if (piece.voxels.is_uniform() && intersect(piece.box, section) == section) {
      first = i;
      break;
    }
    first = i;
  }
  meetings = meetings.subspan(first);
  Piece& only = pieces_[meetings.front().piece];
  if (meetings.size() == 1 && only.box == section)
    return only.sections_left == 1 ? std::move(only.voxels) : only.voxels;
  if (meetings.size() == 1 && intersect(only.box, section) == section)
    return cut_to(only.box, only.voxels, section);

  const Extent extent = extent_of_box(section);
  std::vector<LaidPart> parts;
  std::size_t bytes = 0;
  for (const Meeting& meeting : meetings) {
    const Piece& piece = pieces_[meeting.piece];
    const VoxelBox part = intersect(piece.box, section);
    const VoxelPos low = section.min;
    LaidPart laid{{{part.min.x - low.x, part.min.y - low.y, part.min.z - low.z},
                   {part.max.x - low.x, part.max.y - low.y, part.max.z - low.z}},
                  reorder(cut_to(piece.box, piece.voxels, part), AxisOrder::xyz)};
    bytes += sizeof(LaidPart) + run_bytes(laid.voxels);
    parts.push_back(std::move(laid));
    if (bytes < kJoinBatchBytes) continue;
    LaidPart below{box_at({}, extent), laid_over(extent, parts)};
    bytes = sizeof(LaidPart) + run_bytes(below.voxels);
    parts.clear();
    parts.push_back(std::move(below));
  }
  return in_cheapest_order(laid_over(extent, parts));
}

void PieceJoiner::release(std::span<const Meeting> meetings) {
  for (const Meeting& meeting : meetings) {
    Piece& piece = pieces_[meeting.piece];
    if (--piece.sections_left != 0) continue;
    piece.voxels.runs = RunList();
    bytes_ -= piece.bytes;
  }
}

Result<FileBuild> PieceJoiner::join() {
  RUNSTONE_ASSERT(has_pieces());
  const std::array<std::int32_t, 3> min = {box_.min.x, box_.min.y, box_.min.z};
  const std::array<std::int32_t, 3> max = {box_.max.x, box_.max.y, box_.max.z};
  BuildCuts cuts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int32_t side = max[axis] - min[axis];
    if (side > kBuildSideMax)
      return fail(ErrorCode::limit_exceeded, "build is longer than 1,048,576 voxels");
    const std::int32_t offset = min[axis] - floor_div(min[axis], kJoinEdge) * kJoinEdge;
    cuts[axis] = grid_cuts(side, kJoinEdge, offset);
  }
  auto builder = BuildBuilder::of(cuts, bytes_max_);
  if (!builder) return failure(builder.error());

  // Materials ascend by name and states. Blocks that become equal are one.
  struct Named {
    MaterialRow row;
    std::vector<std::uint16_t> numbers;  // of the blocks
  };
  std::map<std::pair<std::string, std::string>, Named> named;
  for (const auto& [block, number] : numbers_) {
    MaterialRow row = row_of(format_.material_of(block, keep_all_));
    std::string states;
    const Visibility visibility = only_cubes_ ? visibility_as_cube(row) : row.visibility;
    if (visibility == Visibility::empty) {
      row = MaterialRow{"air", {0, 0, 0, 0}, Visibility::empty};
    } else {
      states = printable_states(block.states);
    }
    auto& same = named[{row.name, std::move(states)}];
    if (same.numbers.empty()) same.row = std::move(row);
    same.numbers.push_back(number);
  }
  std::vector<BuildMaterial> materials;                        // by cell number - 1
  std::vector<Material> cell_numbers(numbers_.size() + 1, 0);  // by number of a block
  Material next = kEmpty + 1;
  for (auto& [key, same] : named) {
    const Material material = same.row.visibility == Visibility::empty ? kEmpty : next++;
    const auto number = builder->number_of(material);
    RUNSTONE_ASSERT(number && *number == materials.size() + 1);
    materials.push_back({std::move(same.row), key.second});
    for (const std::uint16_t of_block : same.numbers) cell_numbers[of_block] = *number;
  }

  const std::vector<Meeting> all = meetings(builder->cuts());
  const std::uint64_t count_x = cuts[0].size() - 1, count_y = cuts[1].size() - 1;
  std::size_t built_bytes = 0;
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin + 1;
    while (end < all.size() && all[end].section == all[begin].section) ++end;
    const std::span<const Meeting> here = std::span(all).subspan(begin, end - begin);
    const std::uint64_t number = all[begin].section;
    const SectionPos at{static_cast<std::uint32_t>(number % count_x),
                        static_cast<std::uint32_t>(number / count_x % count_y),
                        static_cast<std::uint32_t>(number / count_x / count_y)};
    const VoxelBox section = {
        {min[0] + cuts[0][at.x], min[1] + cuts[1][at.y], min[2] + cuts[2][at.z]},
        {min[0] + cuts[0][at.x + 1U], min[1] + cuts[1][at.y + 1U], min[2] + cuts[2][at.z + 1U]}};
    RunChunk cells = with_materials(cells_of(section, here), cell_numbers);
    release(here);
    if (!cells.is_uniform()) built_bytes += kJoinSectionBytes + cells.runs.byte_size();
    if (built_bytes > bytes_max_ || bytes_ > bytes_max_ - built_bytes) return too_many_bytes();
    if (const auto put = builder->put(at, std::move(cells)); !put) return failure(put.error());
    begin = end;
  }
  pieces_.clear();
  numbers_.clear();
  auto made = builder->finish();
  if (!made) return failure(made.error());
  FileBuild out{{}, *std::move(made), {}};
  // Materials of which no cell is left have no number any more, and the others keep their order.
  std::map<Material, std::size_t> at;
  Material id = kEmpty + 1;
  for (std::size_t i = 0; i < materials.size(); ++i)
    at.emplace(materials[i].row.visibility == Visibility::empty ? kEmpty : id++, i);
  for (const Material material : out.build->palette())
    out.materials.push_back(std::move(materials[at.at(material)]));
  return out;
}

}  // namespace runstone
