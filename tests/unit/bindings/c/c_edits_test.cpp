#include <array>
#include <catch2/catch.hpp>
#include <string>

#include "common/core/hash.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/unit/bindings/c/owned_handle.hpp"

namespace runstone::test {
namespace {

constexpr runstone_pos c_pos(const VoxelPos& at) { return {at.x, at.y, at.z}; }

runstone_brush c_brush(const EditDescriptor& edit) {
  return {sizeof(runstone_brush), static_cast<std::uint32_t>(edit.mask.kind), edit.mask.material,
          edit.material};
}

VoxelPos random_pos(SplitMix64& rng) {
  const auto along = [&rng] { return static_cast<std::int32_t>(rng.between(-40, 40)); };
  return {along(), along(), along()};
}

EditDescriptor random_edit(SplitMix64& rng) {
  EditDescriptor edit;
  const VoxelPos at = random_pos(rng);
  switch (rng.below(4)) {
    case 0:
      edit.shape = SetVoxel{at};
      break;
    case 1:
      edit.shape = FillBox{{at,
                            {at.x + 1 + static_cast<std::int32_t>(rng.below(30)), at.y + 5,
                             at.z + 1 + static_cast<std::int32_t>(rng.below(9))}}};
      break;
    case 2:
      edit.shape = FillSphere{at, static_cast<std::uint16_t>(rng.below(12))};
      break;
    default:
      edit.shape = FillStroke{{at, {at.x + 9, at.y - 3, at.z}, {at.x + 9, at.y + 20, at.z + 4}},
                              static_cast<std::uint16_t>(1 + rng.below(4))};
  }
  edit.mask.kind = static_cast<MaskKind>(rng.below(4));
  if (edit.mask.kind == MaskKind::only_material)
    edit.mask.material = static_cast<Material>(1 + rng.below(3));
  edit.material = static_cast<Material>(rng.below(4));
  return edit;
}

runstone_status add_edit(runstone_edits* to, const EditDescriptor& edit) {
  const runstone_brush brush = c_brush(edit);
  if (const auto* voxel = std::get_if<SetVoxel>(&edit.shape))
    return runstone_edits_add_voxel(to, c_pos(voxel->at), &brush);
  if (const auto* box = std::get_if<FillBox>(&edit.shape))
    return runstone_edits_add_box(to, {c_pos(box->box.min), c_pos(box->box.max)}, &brush);
  if (const auto* sphere = std::get_if<FillSphere>(&edit.shape))
    return runstone_edits_add_sphere(to, c_pos(sphere->centre), sphere->radius, &brush);
  const auto& stroke = *std::get_if<FillStroke>(&edit.shape);
  std::vector<runstone_pos> points;
  for (const VoxelPos& point : stroke.points) points.push_back(c_pos(point));
  return runstone_edits_add_stroke(to, points.data(), points.size(), stroke.radius, &brush);
}

bool has_layer(const runstone_changes& changes, std::size_t axis, std::size_t layer) {
  return (changes.layers[axis][layer / 8] >> layer % 8 & 1) != 0;
}

}  // namespace

TEST_CASE("edits through the C interface change what the library changes", "[c_interface]") {
  SplitMix64 rng{17};
  const auto edits = owned<runstone_edits>(runstone_edits_create);
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    const unsigned edge = rng.below(2) == 0 ? 16 : 32;
    RunChunk chunk = random_chunk(rng, Extent::cube(edge), random_order(rng), 4);
    const ChunkCoord at{static_cast<std::int32_t>(rng.between(-1, 1)), 0, -1};
    const auto handle = handle_of(chunk);
    std::vector<EditDescriptor> list;
    REQUIRE(runstone_edits_clear(edits.get()) == RUNSTONE_OK);
    for (unsigned i = 1 + rng.below(4); i > 0; --i) {
      list.push_back(random_edit(rng));
      REQUIRE(add_edit(edits.get(), list.back()) == RUNSTONE_OK);
    }
    Digest digest = digest_of(chunk);
    ApplyScratch scratch;
    const ApplyResult expected =
        apply_stack(chunk, digest, origin_of(at, static_cast<std::int32_t>(edge)), list, scratch);
    runstone_changes changes{};
    changes.struct_size = sizeof changes;
    REQUIRE(runstone_chunk_apply(handle.get(), {at.x, at.y, at.z}, edits.get(), &changes) ==
            RUNSTONE_OK);
    CHECK(same_runs(handle.get(), chunk));
    CHECK((changes.is_changed != 0) == expected.changed);
    CHECK(changes.voxels == expected.voxels_changed);
    bool same_layers = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t layer = 0; layer < kSideMax; ++layer)
        same_layers =
            same_layers && has_layer(changes, axis, layer) == expected.dirty.layer[axis][layer];
    }
    CHECK(same_layers);
    std::uint64_t sum[2] = {};
    REQUIRE(runstone_chunk_digest(handle.get(), sum) == RUNSTONE_OK);
    CHECK(Digest{{sum[0], sum[1]}} == digest_of(chunk));
  }
}

TEST_CASE("the C interface tells the bytes, bounds and chunks of an edit", "[c_interface]") {
  SplitMix64 rng{18};
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    const EditDescriptor edit = random_edit(rng);
    const auto edits = owned<runstone_edits>(runstone_edits_create);
    REQUIRE(add_edit(edits.get(), edit) == RUNSTONE_OK);
    const auto bytes = fetched<std::uint8_t>([&](auto* out, std::size_t room, std::size_t* n) {
      return runstone_edits_bytes(edits.get(), 0, out, room, n);
    });
    CHECK(bytes == encode(edit));
    REQUIRE(runstone_edits_add_bytes(edits.get(), bytes.data(), bytes.size()) == RUNSTONE_OK);
    runstone_box bounds{};
    REQUIRE(runstone_edits_bounds(edits.get(), 1, &bounds) == RUNSTONE_OK);
    const VoxelBox box = bounding_box(edit);
    CHECK(VoxelPos{bounds.min.x, bounds.min.y, bounds.min.z} == box.min);
    CHECK(VoxelPos{bounds.max.x, bounds.max.y, bounds.max.z} == box.max);
    const auto chunks = fetched<runstone_pos>([&](auto* out, std::size_t room, std::size_t* n) {
      return runstone_edits_touched_chunks(edits.get(), 1, 16, out, room, n);
    });
    std::vector<ChunkCoord> touched;
    for (const runstone_pos& chunk : chunks) touched.push_back({chunk.x, chunk.y, chunk.z});
    CHECK(touched == touched_chunks(edit, 16));
    for (std::size_t size = 0; size < bytes.size(); ++size)
      CHECK(runstone_edits_add_bytes(edits.get(), bytes.data(), size) != RUNSTONE_OK);
    std::size_t count = 0;
    CHECK(runstone_edits_count(edits.get(), &count) == RUNSTONE_OK);
    CHECK(count == 2);
  }
}

TEST_CASE("edits out of range are refused and not added", "[c_interface]") {
  const auto edits = owned<runstone_edits>(runstone_edits_create);
  runstone_brush brush{sizeof brush, RUNSTONE_MASK_EVERYTHING, 0, 1};
  CHECK(runstone_edits_add_voxel(edits.get(), {1 << 29, 0, 0}, &brush) == RUNSTONE_BAD_VALUE);
  CHECK(runstone_edits_add_box(edits.get(), {{0, 0, 0}, {0, 1, 1}}, &brush) != RUNSTONE_OK);
  CHECK(runstone_edits_add_box(edits.get(), {{0, 0, 0}, {4097, 1, 1}}, &brush) != RUNSTONE_OK);
  CHECK(runstone_edits_add_sphere(edits.get(), {0, 0, 0}, 513, &brush) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_edits_add_sphere(edits.get(), {0, 0, 0}, 65537, &brush) == RUNSTONE_BAD_ARGUMENT);
  const std::array<runstone_pos, 257> points{};
  CHECK(runstone_edits_add_stroke(edits.get(), points.data(), 257, 1, &brush) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_edits_add_stroke(edits.get(), points.data(), 2, 1, &brush) != RUNSTONE_OK);
  CHECK(runstone_edits_add_stroke(edits.get(), points.data(), 0, 1, &brush) != RUNSTONE_OK);
  brush.mask = 4;
  CHECK(runstone_edits_add_voxel(edits.get(), {0, 0, 0}, &brush) == RUNSTONE_BAD_ARGUMENT);
  brush = {sizeof brush - 1, 0, 0, 1};
  CHECK(runstone_edits_add_voxel(edits.get(), {0, 0, 0}, &brush) == RUNSTONE_BAD_ARGUMENT);
  std::size_t count = 1;
  CHECK(runstone_edits_count(edits.get(), &count) == RUNSTONE_OK);
  CHECK(count == 0);
  runstone_box bounds{};
  CHECK(runstone_edits_bounds(edits.get(), 0, &bounds) == RUNSTONE_BAD_ARGUMENT);
}

TEST_CASE("edits are applied to chunks of a world only", "[c_interface]") {
  const auto edits = owned<runstone_edits>(runstone_edits_create);
  const runstone_brush brush{sizeof brush, RUNSTONE_MASK_EVERYTHING, 0, 1};
  REQUIRE(runstone_edits_add_box(edits.get(), {{0, 0, 0}, {4096, 4096, 4096}}, &brush) ==
          RUNSTONE_OK);
  std::size_t count = 0;
  for (const std::uint32_t edge : {0U, 4U, 8U, 24U, 256U})
    CHECK(runstone_edits_touched_chunks(edits.get(), 0, edge, nullptr, 0, &count) ==
          RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_edits_touched_chunks(edits.get(), 0, 16, nullptr, 0, &count) ==
        RUNSTONE_LIMIT_EXCEEDED);
  CHECK(runstone_edits_touched_chunks(edits.get(), 0, 128, nullptr, 0, &count) == RUNSTONE_OK);
  CHECK(count == 32 * 32 * 32);

  const auto flat = handle_of(uniform_chunk({16, 8, 16}, 0));
  const auto small = handle_of(uniform_chunk(Extent::cube(8), 0));
  const auto cube = handle_of(uniform_chunk(Extent::cube(16), 0));
  CHECK(runstone_chunk_apply(flat.get(), {0, 0, 0}, edits.get(), nullptr) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_apply(small.get(), {0, 0, 0}, edits.get(), nullptr) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_apply(cube.get(), {1 << 25, 0, 0}, edits.get(), nullptr) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_chunk_apply(cube.get(), {0, 0, INT32_MIN}, edits.get(), nullptr) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(same_runs(cube.get(), uniform_chunk(Extent::cube(16), 0)));
  CHECK(runstone_chunk_apply(cube.get(), {0, 0, 0}, edits.get(), nullptr) == RUNSTONE_OK);
  CHECK(same_runs(cube.get(), uniform_chunk(Extent::cube(16), 1)));
}

}  // namespace runstone::test
