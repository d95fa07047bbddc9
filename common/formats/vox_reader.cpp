#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "common/formats/inflate_source.hpp"
#include "common/formats/vox.hpp"
#include "common/formats/vox_file.hpp"
#include "common/formats/vox_look.hpp"
#include "common/formats/vox_scene.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kVoxPieceEdge = 128;

/// A part of a model: its lowest voxel and its runs, in the axes of the file. Materials are colours.
struct VoxPart {
  std::array<std::int32_t, 3> low{};
  RunChunk runs;
};

/// Sorts by the bits of the place, 8 and up. Voxels of one place keep their order.
void sort_by_place(std::vector<std::uint32_t>& voxels, std::vector<std::uint32_t>& scratch) {
  constexpr unsigned kBits = 11;
  scratch.resize(voxels.size());
  for (const unsigned shift : {8U, 8U + kBits}) {
    std::array<std::uint32_t, (1U << kBits) + 1> begin{};
    for (const std::uint32_t voxel : voxels) ++begin[(voxel >> shift & ((1U << kBits) - 1)) + 1];
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    for (const std::uint32_t voxel : voxels)
      scratch[begin[voxel >> shift & ((1U << kBits) - 1)]++] = voxel;
    voxels.swap(scratch);
  }
}

/// Makes runs of the models of a file, each when it is first needed.
class VoxModels {
 public:
  explicit VoxModels(const VoxFile& file) : file_(file), parts_(file.models.size()) {}

  /// Returns the parts of a model, none if it has no voxel.
  Result<const std::vector<VoxPart>*> parts(std::size_t number) {
    if (!parts_[number]) {
      auto made = file_.models[number].is_packed ? unpack(file_.models[number])
                                                 : sort(file_.models[number]);
      if (!made) return failure(made.error());
      parts_[number] = *std::move(made);
    }
    return &*parts_[number];
  }

 private:
  Result<std::vector<VoxPart>> sort(const VoxModel& model);
  static Result<std::vector<VoxPart>> unpack(const VoxModel& model);

  const VoxFile& file_;
  std::vector<std::optional<std::vector<VoxPart>>> parts_;
  std::vector<std::uint32_t> voxels_, scratch_;
};

Extent part_extent(const VoxModel& model, const std::array<std::int32_t, 3>& low) {
  const auto side = [](std::int32_t whole, std::int32_t first) {
    return static_cast<std::uint8_t>(std::min(whole - first, kVoxPieceEdge));
  };
  return {side(model.x, low[0]), side(model.y, low[1]), side(model.z, low[2])};
}

/// Calls f with the lowest voxel of each part of a model.
template <class F>
void for_each_part(const VoxModel& model, F&& f) {
  for (std::int32_t z = 0; z < model.z; z += kVoxPieceEdge) {
    for (std::int32_t y = 0; y < model.y; y += kVoxPieceEdge) {
      for (std::int32_t x = 0; x < model.x; x += kVoxPieceEdge) f({x, y, z});
    }
  }
}

Result<std::vector<VoxPart>> VoxModels::sort(const VoxModel& model) {
  bool is_empty_model = true;
  for (std::size_t i = 0; i < model.voxels.size(); i += 4) {
    const ByteView voxel = model.voxels.subspan(i, 4);
    if (voxel[0] >= model.x || voxel[1] >= model.y || voxel[2] >= model.z)
      return fail(ErrorCode::bad_value, "vox: a voxel lies outside its model", model.offset + i);
    is_empty_model = is_empty_model && voxel[3] == 0;
  }
  std::vector<VoxPart> out;
  if (is_empty_model) return out;
  for_each_part(model, [&](std::array<std::int32_t, 3> low) {
    const Extent extent = part_extent(model, low);
    voxels_.clear();
    for (std::size_t i = 0; i < model.voxels.size(); i += 4) {
      const ByteView voxel = model.voxels.subspan(i, 4);
      const auto x = static_cast<std::uint32_t>(voxel[0] - low[0]),
                 y = static_cast<std::uint32_t>(voxel[1] - low[1]),
                 z = static_cast<std::uint32_t>(voxel[2] - low[2]);
      // A coordinate below the part wraps to a large number, so it is outside, too.
      if (x < extent.x && y < extent.y && z < extent.z)
        voxels_.push_back((x + extent.x * (y + extent.y * z)) << 8 | voxel[3]);
    }
    sort_by_place(voxels_, scratch_);
    RunBuilder runs(extent, AxisOrder::xyz);
    for (std::size_t i = 0; i < voxels_.size(); ++i) {
      const std::uint32_t place = voxels_[i] >> 8;
      // Of several voxels in one place the last one counts.
      if (i + 1 < voxels_.size() && voxels_[i + 1] >> 8 == place) continue;
      runs.append_to(place, 0);
      runs.append(1, static_cast<Material>(voxels_[i] & 255));
    }
    runs.append_to(extent.volume(), 0);
    out.push_back({low, in_cheapest_order(runs.finish())});
  });
  return out;
}

Result<std::vector<VoxPart>> VoxModels::unpack(const VoxModel& model) {
  std::vector<VoxPart> out;
  std::vector<RunBuilder> runs;
  for_each_part(model, [&](std::array<std::int32_t, 3> low) {
    const Extent extent = part_extent(model, low);
    out.push_back({low, {extent, AxisOrder::xyz, RunList()}});
    runs.emplace_back(extent, AxisOrder::xyz);
  });
  InflateSource source(model.voxels, DeflateForm::zlib);
  const std::int32_t wide = (model.x + kVoxPieceEdge - 1) / kVoxPieceEdge;
  const std::int32_t deep = (model.y + kVoxPieceEdge - 1) / kVoxPieceEdge;
  std::array<std::uint8_t, kVoxModelSideMax> row{};
  for (std::int32_t z = 0; z < model.z; ++z) {
    for (std::int32_t y = 0; y < model.y; ++y) {
      if (!source.read(std::span(row).first(static_cast<std::size_t>(model.x)))) {
        const std::size_t at = model.offset + source.offset();
        if (!source.is_damaged())
          return fail(ErrorCode::truncated, "vox: packed voxels end early", at);
        return fail(ErrorCode::bad_value, "vox: packed voxels are no zlib stream, or a damaged one",
                    at);
      }
      for (std::int32_t x = 0; x < model.x; ++x) {
        const std::int32_t part =
            x / kVoxPieceEdge + wide * (y / kVoxPieceEdge + deep * (z / kVoxPieceEdge));
        runs[static_cast<std::size_t>(part)].append(1, row[static_cast<std::size_t>(x)]);
      }
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].runs = in_cheapest_order(runs[i].finish());
  const bool has_voxels =
      std::any_of(out.begin(), out.end(), [](const VoxPart& part) { return !is_empty(part.runs); });
  if (!has_voxels) out.clear();
  return out;
}

/// Returns the runs of a part, turned. Axis i of the result is axis from[i] of the part, reversed if its
/// bit in `mirrored` is set.
RunChunk turned(const RunChunk& part, const std::array<std::uint8_t, 3>& from,
                std::uint8_t mirrored) {
  RunChunk out = mirrored == 0 ? part : cut(part, {0, 0, 0}, part.extent, mirrored);
  const auto sides = part.extent.sides();
  out.extent = {sides[from[0]], sides[from[1]], sides[from[2]]};
  std::array<Axis, 3> axes = axes_of(part.order);
  for (Axis& axis : axes) {
    for (std::uint8_t i = 0; i < 3; ++i) {
      if (from[i] != static_cast<std::uint8_t>(axis)) continue;
      axis = static_cast<Axis>(i);
      break;
    }
  }
  out.order = *std::find_if(kAxisOrders.begin(), kAxisOrders.end(),
                            [&](AxisOrder order) { return axes_of(order) == axes; });
  return out;
}

/// Gives the parts of a placed model to the sink.
Result<void> give_model(const VoxModel& model, const std::vector<VoxPart>& parts,
                        const VoxPlace& place, const std::vector<ForeignBlock>& blocks,
                        const PieceSink& sink) {
  // The axes of the world: x, z up, and y backwards. A half-open range a .. b becomes -b .. -a.
  const VoxPlace up{{{0, 2, 1}, {1, 1, -1}}, {}};
  const auto in_world = composed(up, place);
  RUNSTONE_ASSERT(in_world);
  const std::array<std::int32_t, 3> pivot = {model.x / 2, model.y / 2, model.z / 2};
  for (const VoxPart& part : parts) {
    const auto sides = part.runs.extent.sides();
    std::array<std::int64_t, 3> origin{};
    std::uint8_t mirrored = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t from = in_world->turn.from[i];
      const std::int64_t low = std::int64_t{part.low[from]} - pivot[from];
      const bool is_mirrored = in_world->turn.sign[i] < 0;
      if (is_mirrored) mirrored |= static_cast<std::uint8_t>(1U << from);
      origin[i] = in_world->shift[i] + (is_mirrored ? -(low + sides[from]) : low);
      if (origin[i] < -kWorldLimit || origin[i] > kWorldLimit - kVoxPieceEdge)
        return fail(ErrorCode::bad_value, "vox: the scene reaches out of the world", model.offset);
    }
    ForeignPiece piece{{static_cast<std::int32_t>(origin[0]), static_cast<std::int32_t>(origin[1]),
                        static_cast<std::int32_t>(origin[2])},
                       turned(part.runs, in_world->turn.from, mirrored),
                       blocks};
    if (auto taken = sink(std::move(piece)); !taken) return taken;
  }
  return {};
}

}  // namespace

Result<ForeignInfo> read_vox(ByteView bytes, const PieceSink& sink) {
  const auto file = read_vox_file(bytes);
  if (!file) return failure(file.error());
  const auto placed = placed_models(*file);
  if (!placed) return failure(placed.error());
  const std::vector<ForeignBlock> blocks = vox_blocks(*file);
  VoxModels models(*file);
  std::uint64_t voxels = 0;
  for (const PlacedVoxModel& one : *placed) {
    const VoxModel& model = file->models[one.model];
    voxels += model.is_packed
                  ? static_cast<std::uint64_t>(model.x) * static_cast<std::uint64_t>(model.y) *
                        static_cast<std::uint64_t>(model.z)
                  : model.voxels.size() / 4;
    if (voxels > kVoxPlacedMax)
      return fail(ErrorCode::limit_exceeded, "vox: the scene places more than 2^31 voxels",
                  model.offset);
    const auto parts = models.parts(one.model);
    if (!parts) return failure(parts.error());
    if (auto given = give_model(model, **parts, one.place, blocks, sink); !given)
      return failure(given.error());
  }
  return ForeignInfo{std::string(file->name), std::string(file->author), file->created_us,
                     file->origin};
}

}  // namespace runstone
