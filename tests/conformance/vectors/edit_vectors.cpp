#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/conformance/vectors/vector_values.hpp"

namespace runstone::conformance {
namespace {

struct NamedEdit {
  std::string name;
  EditDescriptor edit;
  std::int32_t edge = 16;
};

/// Layers lie flat, so ground has few runs.
constexpr AxisOrder kGroundOrder = AxisOrder::zxy;

std::shared_ptr<const Clipboard> small_clipboard() {
  ClipboardBuilder cells({3, 2, 5}, AxisOrder::xyz);
  cells.append(4, Material{7});
  cells.append(2, std::nullopt);
  cells.append(9, kEmpty);
  cells.append(1, Material{9});
  cells.append(6, std::nullopt);
  cells.append(8, Material{7});
  return *cells.finish();
}

std::vector<NamedEdit> edits_of_vectors() {
  constexpr Mask kAll{};
  std::vector<NamedEdit> out = {
      {"set a voxel", {SetVoxel{{1, 2, 3}}, kAll, 300}},
      {"set a voxel at negative coordinates", {SetVoxel{{-1, -2, -17}}, kAll, 65'535}},
      {"remove a voxel", {SetVoxel{{5, 0, 5}}, kAll, kEmpty}, 32},
      {"fill a box in one chunk", {FillBox{{{2, 1, 3}, {9, 12, 16}}}, kAll, 5}},
      {"fill a box over eight chunks", {FillBox{{{-3, -2, -1}, {4, 3, 2}}}, kAll, 5}},
      {"fill a box where it is empty",
       {FillBox{{{0, 0, 0}, {16, 8, 16}}}, {MaskKind::only_empty, kEmpty}, 6}},
      {"fill a box where it is solid",
       {FillBox{{{0, 0, 0}, {20, 8, 16}}}, {MaskKind::only_solid, kEmpty}, kEmpty}},
      {"replace a material in a box",
       {FillBox{{{0, -16, 0}, {16, 16, 16}}}, {MaskKind::only_material, 1}, 2}},
      {"a box that changes nothing",
       {FillBox{{{0, 12, 0}, {16, 16, 16}}}, {MaskKind::only_solid, kEmpty}, 8}},
      {"a sphere of radius 0", {FillSphere{{5, 6, 7}, 0}, kAll, 127}},
      {"a sphere over the corner of eight chunks", {FillSphere{{0, 0, 0}, 5}, kAll, 11}},
      {"a sphere that misses chunks of its box", {FillSphere{{8, 8, 8}, 9}, kAll, 11}},
      {"a stroke",
       {FillStroke{{{2, 3, 2}, {13, 6, 11}, {13, 2, 20}}, 2}, {MaskKind::only_empty, kEmpty}, 12}},
      {"a stroke that passes chunks closely",
       {FillStroke{{{-6, 9, 14}, {22, 1, 17}}, 1}, kAll, 12}},
      {"a sphere in chunks of edge 32", {FillSphere{{28, 3, 20}, 6}, kAll, 3}, 32}};
  for (const int turns : {0, 1}) {
    const Paste paste{{-2, 1, 12}, small_clipboard(), Orientation{}.rotated_about_y(turns)};
    out.push_back({"paste, " + std::to_string(turns) + " quarter turns", {paste, kAll, kEmpty}});
  }
  const Paste mirrored{{14, -1, 3}, small_clipboard(), Orientation{}.mirrored(Axis::x)};
  out.push_back({"paste, mirrored along x, where it is empty",
                 {mirrored, {MaskKind::only_empty, kEmpty}, kEmpty}});
  return out;
}

Json entry_of(const NamedEdit& named) {
  Json chunks = Json::array();
  ApplyScratch scratch;
  for (const ChunkCoord at : touched_chunks(named.edit, named.edge)) {
    RunChunk chunk = ground_chunk(at, static_cast<unsigned>(named.edge), kGroundOrder);
    Digest digest = digest_of(chunk);
    Json entry = {{"key", json_of(at)}};
    const ApplyResult result =
        apply_stack(chunk, digest, origin_of(at, named.edge), {&named.edit, 1}, scratch);
    // The vector is of the voxels, so it does not rely on the digest that was updated.
    RUNSTONE_ASSERT(digest == digest_of(chunk));
    entry["after"] = raw_hex(chunk);
    entry["digest"] = json_of(digest);
    entry["voxels_changed"] = result.voxels_changed;
    chunks.push_back(std::move(entry));
  }
  const VoxelBox box = bounding_box(named.edit);
  return {{"name", named.name},
          {"edge", named.edge},
          {"descriptor", to_hex(encode(named.edit))},
          {"box", {json_of(box.min), json_of(box.max)}},
          {"chunks", std::move(chunks)}};
}

Json refused_edits() {
  struct Hostile {
    const char* name;
    Bytes bytes;
  };
  const std::vector<Hostile> hostile = {
      {"no bytes", {}},
      {"no kind 0", {0x00, 0x00, 0x01, 0x00, 0x00, 0x00}},
      {"no kind 5", {0x05, 0x00, 0x01, 0x00, 0x00, 0x00}},
      {"no kind 255", {0xff, 0x00, 0x01, 0x00, 0x00, 0x00}},
      {"a voxel, cut", {0x01, 0x00, 0xac, 0x02, 0x02, 0x03}},
      {"a voxel, a byte too many", {0x01, 0x00, 0xac, 0x02, 0x02, 0x03, 0x06, 0x00}},
      {"no mask 4", {0x01, 0x04, 0x01, 0x00, 0x00, 0x00}},
      {"a mask of a material, cut", {0x01, 0x03}},
      {"a material above 65,535", {0x01, 0x00, 0x80, 0x80, 0x04, 0x00, 0x00, 0x00}},
      {"a number that is not written in the shortest way",
       {0x01, 0x00, 0x81, 0x00, 0x00, 0x00, 0x00}},
      {"a voxel beyond the world", {0x01, 0x00, 0x01, 0x80, 0x80, 0x80, 0x80, 0x04, 0x00, 0x00}},
      {"a box with a side of 4,097", {0x02, 0x00, 0x01, 0x00, 0x00, 0x00, 0x80, 0x20, 0x00, 0x00}},
      {"a sphere of radius 513", {0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x81, 0x04}},
      {"a stroke of radius 0", {0x04, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00}},
      {"a stroke with a point twice",
       {0x04, 0x00, 0x01, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}},
      {"a paste with an orientation of 48",
       {0x06, 0x00, 0x00, 0x00, 0x00, 0x00, 0x30, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01, 0x01}},
  };
  Json out = Json::array();
  for (const auto& [name, bytes] : hostile) {
    const auto decoded = decode_descriptor(bytes);
    RUNSTONE_ASSERT(!decoded.has_value());
    out.push_back(refusal_of(name, bytes, decoded));
  }
  return out;
}

}  // namespace

Json edit_vectors() {
  Json edits = Json::array();
  std::map<std::pair<std::int32_t, ChunkCoord>, std::string> ground;
  for (const NamedEdit& named : edits_of_vectors()) {
    edits.push_back(entry_of(named));
    for (const ChunkCoord at : touched_chunks(named.edit, named.edge)) {
      const auto edge = static_cast<unsigned>(named.edge);
      ground[{named.edge, at}] = raw_hex(ground_chunk(at, edge, kGroundOrder));
    }
  }
  Json before = Json::array();
  for (const auto& [place, raw] : ground)
    before.push_back({{"edge", place.first}, {"key", json_of(place.second)}, {"raw", raw}});
  return {{"format", "runstone edit vectors 1"},
          {"ground", std::move(before)},
          {"edits", std::move(edits)},
          {"refused", refused_edits()}};
}

}  // namespace runstone::conformance
