#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/formats/vox.hpp"
#include "common/formats/vox_look.hpp"
#include "common/materials/visibility_as_cube.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kVoxCellEdge = 128;
constexpr std::size_t kVoxBufferBytes = std::size_t{1} << 16;
constexpr std::size_t kVoxChunkHead = 12;
constexpr std::uint32_t kVoxNoNumber = 0xffff'ffff;

using VoxEntries = std::vector<std::pair<std::string, std::string>>;

void write_vox_text(ByteWriter& w, std::string_view text) {
  w.u32(static_cast<std::uint32_t>(text.size()));
  w.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void write_vox_entries(ByteWriter& w, const VoxEntries& entries) {
  w.u32(static_cast<std::uint32_t>(entries.size()));
  for (const auto& [key, value] : entries) {
    write_vox_text(w, key);
    write_vox_text(w, value);
  }
}

void write_vox_chunk(Bytes& out, std::string_view id, const Bytes& content) {
  ByteWriter w(out);
  w.bytes({reinterpret_cast<const std::uint8_t*>(id.data()), id.size()});
  w.u32(static_cast<std::uint32_t>(content.size()));
  w.u32(0);
  w.bytes(content);
}

std::string joined_numbers(const std::array<std::int64_t, 3>& numbers) {
  return std::to_string(numbers[0]) + " " + std::to_string(numbers[1]) + " " +
         std::to_string(numbers[2]);
}

/// Returns a share such as "0.35".
std::string vox_share(unsigned percent) {
  if (percent >= 100) return "1";
  const std::string digits = std::to_string(percent);
  return digits.size() == 1 ? "0.0" + digits : "0." + digits;
}

/// A box of the build that is a model, and the number of its voxels.
struct WrittenModel {
  VoxelBox box;
  std::uint64_t voxels = 0;
};

class VoxWriter {
 public:
  VoxWriter(const FileBuild& build, const FormatSink& sink) : build_(build), sink_(sink) {}

  Result<void> write() {
    if (auto done = choose_colours(); !done) return done;
    if (auto done = find_models(); !done) return done;
    const VoxelPos sides = build_.build->sides();
    // The scene has its middle at 0, and its lowest layer too.
    shift_ = {-(sides.x / 2), sides.z / 2, 0};
    const Bytes tail = tail_chunks();
    std::uint64_t bytes = tail.size();
    for (const WrittenModel& model : models_)
      bytes += 2 * kVoxChunkHead + 12 + 4 + 4 * model.voxels;
    RUNSTONE_ASSERT(bytes < 0x8000'0000U);
    Bytes head;
    ByteWriter w(head);
    w.bytes(ByteView(reinterpret_cast<const std::uint8_t*>("VOX "), 4));
    w.u32(150);
    w.bytes(ByteView(reinterpret_cast<const std::uint8_t*>("MAIN"), 4));
    w.u32(0);
    w.u32(static_cast<std::uint32_t>(bytes));
    if (auto done = give(head); !done) return done;
    for (const WrittenModel& model : models_) {
      if (auto done = write_model(model); !done) return done;
    }
    return give(tail);
  }

 private:
  Result<void> choose_colours();
  Result<void> find_models();
  Bytes tail_chunks() const;
  Result<void> write_model(const WrittenModel& model);
  /// Calls f(box, cells) for each part of a box.
  template <class F>
  void for_each_part(const VoxelBox& box, F&& f) const;

  Result<void> give(ByteView bytes) const {
    if (!sink_(bytes)) return fail(ErrorCode::io_failed, "vox: cannot be written");
    return {};
  }
  /// Returns what the middle of a model is shifted by, in the axes of the file.
  std::array<std::int64_t, 3> middle_of(const VoxelBox& box) const {
    const std::int64_t x = box.max.x - box.min.x, y = box.max.z - box.min.z,
                       z = box.max.y - box.min.y;
    return {box.min.x + x / 2 + shift_[0], -box.max.z + y / 2 + shift_[1],
            box.min.y + z / 2 + shift_[2]};
  }

  const FileBuild& build_;
  const FormatSink& sink_;
  std::array<std::int32_t, 3> shift_{};  // of the build in the scene, in the axes of the file
  std::vector<std::uint8_t> colours_;    // by cell number; 0: no voxel
  std::vector<std::size_t> entries_;     // of the palette of the build, by colour - 1
  std::vector<WrittenModel> models_;
};

Result<void> VoxWriter::choose_colours() {
  colours_.assign(build_.materials.size() + 1, 0);
  for (std::size_t i = 0; i < build_.materials.size(); ++i) {
    if (visibility_as_cube(build_.materials[i].row) == Visibility::empty) continue;
    if (entries_.size() == kVoxColours - 1)
      return fail(ErrorCode::limit_exceeded, "vox: build has more than 255 materials");
    entries_.push_back(i);
    colours_[i + 1] = static_cast<std::uint8_t>(entries_.size());
  }
  return {};
}

template <class F>
void VoxWriter::for_each_part(const VoxelBox& box, F&& f) const {
  for (std::int32_t z = box.min.z; z < box.max.z; z += kVoxCellEdge) {
    for (std::int32_t y = box.min.y; y < box.max.y; y += kVoxCellEdge) {
      for (std::int32_t x = box.min.x; x < box.max.x; x += kVoxCellEdge) {
        const VoxelBox part =
            intersect(box, {{x, y, z}, {x + kVoxCellEdge, y + kVoxCellEdge, z + kVoxCellEdge}});
        f(part, cells_in(*build_.build, part));
      }
    }
  }
}

Result<void> VoxWriter::find_models() {
  const VoxelPos sides = build_.build->sides();
  std::uint64_t voxels = 0;
  for (std::int32_t z = 0; z < sides.z; z += kVoxModelSideMax) {
    for (std::int32_t y = 0; y < sides.y; y += kVoxModelSideMax) {
      for (std::int32_t x = 0; x < sides.x; x += kVoxModelSideMax) {
        WrittenModel model{intersect(
            build_.build->box(),
            {{x, y, z}, {x + kVoxModelSideMax, y + kVoxModelSideMax, z + kVoxModelSideMax}})};
        for_each_part(model.box, [&](const VoxelBox&, const RunChunk& cells) {
          for (std::size_t i = 0; i < cells.runs.size(); ++i) {
            if (colours_[cells.runs.material(i)] != 0)
              model.voxels += cells.runs.end(i) - cells.runs.begin(i);
          }
        });
        if (model.voxels == 0) continue;
        voxels += model.voxels;
        if (voxels > kVoxWrittenMax)
          return fail(ErrorCode::limit_exceeded, "vox: build has more than 500,000,000 voxels");
        // A scene has two nodes, and two for each model. Our own reader takes no more, and other
        // programs take less.
        if (models_.size() == (kVoxNodesMax - 2) / 2)
          return fail(ErrorCode::limit_exceeded,
                      "vox: build has voxels in more than 32,767 boxes of 256 a side");
        models_.push_back(model);
      }
    }
  }
  if (models_.empty()) return fail(ErrorCode::bad_value, "vox: build has no voxel");
  return {};
}

Bytes VoxWriter::tail_chunks() const {
  Bytes out, content;
  ByteWriter w(content);
  const auto chunk = [&](std::string_view id) {
    write_vox_chunk(out, id, content);
    content.clear();
  };
  const auto transform = [&](std::uint32_t id, const VoxEntries& entries, std::uint32_t layer,
                             const VoxEntries& frame) {
    w.u32(id);
    write_vox_entries(w, entries);
    w.u32(id + 1);
    w.u32(kVoxNoNumber);
    w.u32(layer);
    w.u32(1);
    write_vox_entries(w, frame);
    chunk("nTRN");
  };
  const BuildInfo& info = build_.info;
  // The place in a world of the point 0 of the scene.
  const std::array<std::int64_t, 3> origin = {std::int64_t{info.origin.x} - shift_[0],
                                              std::int64_t{info.origin.y} - shift_[2],
                                              std::int64_t{info.origin.z} + shift_[1]};
  VoxEntries about = {{"_runstone_name", info.name}, {"_runstone_origin", joined_numbers(origin)}};
  if (!info.author.empty()) about.emplace_back("_runstone_author", info.author);
  if (info.created_us != 0)
    about.emplace_back("_runstone_created_us", std::to_string(info.created_us));
  transform(0, about, kVoxNoNumber, {});
  w.u32(1);
  write_vox_entries(w, {});
  w.u32(static_cast<std::uint32_t>(models_.size()));
  for (std::uint32_t i = 0; i < models_.size(); ++i) w.u32(2 + 2 * i);
  chunk("nGRP");
  for (std::uint32_t i = 0; i < models_.size(); ++i) {
    const std::string name = models_.size() == 1 ? info.name : info.name + " " + std::to_string(i);
    transform(2 + 2 * i, {{"_name", name}}, 0, {{"_t", joined_numbers(middle_of(models_[i].box))}});
    w.u32(3 + 2 * i);
    write_vox_entries(w, {});
    w.u32(1);
    w.u32(i);
    write_vox_entries(w, {});
    chunk("nSHP");
  }
  w.u32(0);
  write_vox_entries(w, {});
  w.u32(kVoxNoNumber);
  chunk("LAYR");
  for (std::size_t i = 0; i < kVoxColours; ++i) {
    const bool is_used = i < entries_.size();
    w.bytes(is_used ? build_.materials[entries_[i]].row.colour : MaterialColour{0, 0, 0, 255});
  }
  chunk("RGBA");
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const BuildMaterial& material = build_.materials[entries_[i]];
    const auto& look = material.row.look;
    VoxEntries entries;
    if (look && look->emission > 0) {
      entries = {{"_type", "_emit"}, {"_emit", vox_share(look->emission)}, {"_flux", "1"}};
    } else if (material.row.colour[3] != 255) {
      const std::string trans = vox_share(100U - material.row.colour[3] * 100U / 255U);
      entries = {{"_type", "_glass"}, {"_trans", trans}, {"_alpha", trans}, {"_rough", "0.1"}};
    } else {
      entries = {{"_type", "_diffuse"}};
    }
    entries.emplace_back("_runstone_name", material.row.name);
    if (!material.states.empty()) entries.emplace_back("_runstone_states", material.states);
    if (look) entries.emplace_back("_runstone_look", vox_look_text(*look));
    w.u32(static_cast<std::uint32_t>(i + 1));
    write_vox_entries(w, entries);
    chunk("MATL");
  }
  return out;
}

Result<void> VoxWriter::write_model(const WrittenModel& model) {
  Bytes buffer;
  ByteWriter w(buffer);
  const VoxelBox& box = model.box;
  w.bytes(ByteView(reinterpret_cast<const std::uint8_t*>("SIZE"), 4));
  w.u32(12);
  w.u32(0);
  w.u32(static_cast<std::uint32_t>(box.max.x - box.min.x));
  w.u32(static_cast<std::uint32_t>(box.max.z - box.min.z));
  w.u32(static_cast<std::uint32_t>(box.max.y - box.min.y));
  w.bytes(ByteView(reinterpret_cast<const std::uint8_t*>("XYZI"), 4));
  w.u32(static_cast<std::uint32_t>(4 + 4 * model.voxels));
  w.u32(0);
  w.u32(static_cast<std::uint32_t>(model.voxels));
  Result<void> result;
  for_each_part(box, [&](const VoxelBox& part, const RunChunk& cells) {
    if (!result) return;
    // Equal voxels give equal bytes, however the build keeps them.
    const RunChunk ordered_cells = reorder(cells, AxisOrder::xyz);
    for (std::size_t i = 0; i < ordered_cells.runs.size() && result; ++i) {
      const std::uint8_t colour = colours_[ordered_cells.runs.material(i)];
      if (colour == 0) continue;
      for (std::uint32_t at = ordered_cells.runs.begin(i); at < ordered_cells.runs.end(i); ++at) {
        const LocalPos local = pos_of(at, ordered_cells.extent, AxisOrder::xyz);
        w.u8(static_cast<std::uint8_t>(part.min.x + local.x - box.min.x));
        w.u8(static_cast<std::uint8_t>(box.max.z - 1 - (part.min.z + local.z)));
        w.u8(static_cast<std::uint8_t>(part.min.y + local.y - box.min.y));
        w.u8(colour);
        if (buffer.size() < kVoxBufferBytes) continue;
        result = give(buffer);
        buffer.clear();
        if (!result) break;
      }
    }
  });
  if (!result) return result;
  return give(buffer);
}

}  // namespace

Result<void> write_vox(const FileBuild& build, const FormatSink& sink) {
  RUNSTONE_ASSERT(build.build != nullptr &&
                  build.materials.size() == build.build->palette().size());
  return VoxWriter(build, sink).write();
}

}  // namespace runstone
