#include "server/world/veil/shown_chunks.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr Material kOre = 6;
constexpr ChunkKey kHere{0, {0, 0, 0}}, kEast{0, {1, 0, 0}};

struct VeilBench {
  static EditLimits limits() {
    EditLimits out;
    out.chunk_edge = kEdge;
    out.material_count = 8;
    return out;
  }
  /// Loads stone with one ore in it.
  void load(const ChunkKey& key, LocalPos ore) {
    RunChunk ground = uniform_chunk(Extent::cube(kEdge), kStone);
    fill(ground, index_of(ore, ground.extent, ground.order), 1, kOre);
    const Digest digest = digest_of(ground);
    REQUIRE(authority.chunks().begin_load(key));
    REQUIRE(authority.chunks().loaded(key, {std::move(ground), {}, digest}).has_value());
  }
  Version newest() const { return {authority.epoch(), authority.head()}; }
  std::vector<ShownEdit> order(const std::vector<EditDescriptor>& edits) {
    for (const EditDescriptor& edit : edits)
      REQUIRE(authority.enqueue({{1, 1, ++seq}, Cause::player, 0, edit}).has_value());
    return shown.apply(*authority.commit({0, 0}));
  }
  Material at(const ChunkKey& key, LocalPos local) {
    return material_at(shown.find(key)->voxels, local);
  }

  Authority authority{limits(), {3, 0, 0}};
  ShownChunks shown{authority.chunks(), kEdge, mesh_materials()};
  ClientSequence seq = 0;
};

EditDescriptor dig(VoxelPos at) { return {SetVoxel{at}, {}, kEmpty}; }

}  // namespace

TEST_CASE("a shown chunk is made once, and only beside a true chunk in memory", "[world][veil]") {
  VeilBench bench;
  CHECK(bench.shown.make(kHere, bench.newest()) == nullptr);
  CHECK(bench.shown.count() == 0);
  bench.load(kHere, {8, 8, 8});
  const ChunkPtr made = bench.shown.make(kHere, bench.newest());
  REQUIRE(made != nullptr);
  CHECK(made->voxels.is_uniform());
  CHECK(made->voxels.order == kVeilOrder);
  CHECK(bench.shown.make(kHere, bench.newest()) == made);
  CHECK(bench.shown.find(kHere) == made);
  CHECK(bench.shown.count() == 1);
  CHECK(bench.shown.bytes() > 0);
  bench.shown.drop(kHere);
  bench.shown.drop(kHere);
  CHECK(bench.shown.find(kHere) == nullptr);
  CHECK(bench.shown.count() == 0);
  CHECK(bench.shown.bytes() == 0);
}

TEST_CASE("the version of a shown chunk never falls when it is made again", "[world][veil]") {
  VeilBench bench;
  bench.load(kHere, {15, 8, 8});
  bench.load(kEast, {8, 8, 8});
  // A world without records has the base as the version of everything.
  CHECK(bench.shown.make(kHere, bench.newest())->version == Version{});
  bench.shown.make(kEast, bench.newest());
  // The edit of the neighbour uncovers the ore at the border. The true chunk keeps its version.
  const auto edits = bench.order({dig({16, 8, 8})});
  REQUIRE(edits.size() == 1);
  CHECK(edits[0].form == ShownForm::descriptor);
  REQUIRE(edits[0].patches.size() == 1);
  CHECK(edits[0].patches[0].key == kHere);
  CHECK(edits[0].patches[0].before == Version{});
  CHECK(edits[0].patches[0].after == Version{3, 1});
  CHECK(bench.at(kHere, {15, 8, 8}) == kOre);
  CHECK(bench.authority.chunks().version(kHere) == Version{});
  CHECK(bench.shown.find(kHere)->version == Version{3, 1});
  bench.shown.drop(kHere);
  CHECK(bench.shown.make(kHere, bench.newest())->version == Version{3, 1});
}

TEST_CASE("edits of one commit are sent or hidden one by one", "[world][veil]") {
  VeilBench bench;
  bench.load(kHere, {8, 8, 8});
  bench.shown.make(kHere, bench.newest());
  // The second edit lies beside the first one, which has opened the rock. The third is in closed
  // rock, and the last one uncovers the ore by a mask that finds it.
  const EditDescriptor mask{
      FillBox{{{7, 7, 7}, {10, 10, 10}}}, {MaskKind::only_material, kOre}, kEmpty};
  const auto edits =
      bench.order({dig({3, 3, 3}), dig({3, 3, 4}), {SetVoxel{{12, 12, 12}}, {}, kDirt}, mask});
  REQUIRE(edits.size() == 4);
  CHECK(edits[0].form == ShownForm::descriptor);
  CHECK(edits[0].previous == std::vector<Sequence>{0});
  CHECK(edits[1].form == ShownForm::descriptor);
  CHECK(edits[1].previous == std::vector<Sequence>{1});
  CHECK(edits[2].form == ShownForm::hidden);
  CHECK(edits[3].form == ShownForm::result);
  CHECK(edits[3].previous.empty());
  REQUIRE(edits[3].patches.size() == 1);
  CHECK(edits[3].patches[0].before == Version{3, 2});
  CHECK(bench.shown.find(kHere)->version == Version{3, 4});
  CHECK(bench.at(kHere, {8, 8, 8}) == kEmpty);
  CHECK(bench.at(kHere, {12, 12, 12}) == kStone);
}

TEST_CASE("a chunk that arrives uncovers its neighbour at the newest version", "[world][veil]") {
  VeilBench bench;
  bench.load(kHere, {15, 8, 8});
  bench.shown.make(kHere, bench.newest());
  CHECK(bench.at(kHere, {15, 8, 8}) == kStone);  // the missing neighbour is closed
  CHECK(bench.shown.uncover_beside(kEast, bench.newest()).empty());
  bench.order({dig({1, 1, 1}), dig({16, 8, 8})});  // the second one waits for its chunk
  CHECK(bench.at(kHere, {15, 8, 8}) == kStone);
  bench.load(kEast, {8, 8, 8});
  const auto patches = bench.shown.uncover_beside(kEast, bench.newest());
  REQUIRE(patches.size() == 1);
  CHECK(patches[0].key == kHere);
  CHECK(patches[0].before == Version{3, 1});
  CHECK(patches[0].after == Version{3, 2});
  CHECK(bench.at(kHere, {15, 8, 8}) == kOre);
  CHECK(bench.shown.uncover_beside(kEast, bench.newest()).empty());
}

TEST_CASE("new materials keep shown chunks, and shapes drop them", "[world][veil]") {
  VeilBench bench;
  bench.load(kHere, {8, 8, 8});
  bench.shown.make(kHere, bench.newest());
  MaterialTable table = mesh_materials();
  REQUIRE(table.add({"ore", {90, 90, 90, 255}, Visibility::opaque, std::nullopt}));
  CHECK_FALSE(bench.shown.set_materials(table));
  CHECK(bench.shown.has(kHere));
  const Shape slab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  REQUIRE(table.give_shapes(std::vector<GivenShape>{{kDirt, slab}}));
  CHECK(bench.shown.set_materials(table));
  CHECK_FALSE(bench.shown.has(kHere));
  CHECK(bench.shown.count() == 0);
}

}  // namespace runstone::test
