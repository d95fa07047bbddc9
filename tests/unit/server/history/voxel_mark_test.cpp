// The record that set a voxel last, in logs that are written by hand and at random.
#include "server/history/voxel_mark.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <span>

#include "server/history/base_chunk.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test::voxel_mark_test {
namespace {

/// A flat world with a log.
struct MarkedWorld {
  MarkedWorld() {
    WorldMeta meta = sample_meta();
    meta.generator.name = "flat";
    store = *create_world(folder.path(), meta);
    generator = *make_generator(meta.generator, meta.materials);
    REQUIRE(store->raise_epoch().has_value());
  }
  void add(const EditDescriptor& edit, AuthorId author = 1) {
    EditRecord record;
    record.version = {1, records.size() + 1};
    record.op = {author, 7, records.size() + 1};
    record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(records.size());
    record.edit = edit;
    records.push_back(record);
  }
  void write() { REQUIRE(store->append_history({}, records).has_value()); }
  /// Returns the sequence of the mark, or 0 if there is none.
  Sequence mark(VoxelPos at) {
    const auto found = read_voxel_mark(*store, *generator, at);
    REQUIRE(found.has_value());
    if (found->marks.empty()) return 0;
    REQUIRE(found->marks.size() == 1);
    const LogMark& mark = found->marks[0];
    const EditRecord& record = records.at(mark.seq - 1);
    CHECK(mark == LogMark{record.version.seq, record.time_us, record.op.author, record.cause,
                          kind_of(record.edit)});
    return mark.seq;
  }

  TempFolder folder;
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;
  std::vector<EditRecord> records;
};

}  // namespace

TEST_CASE("the mark of a voxel is that of the record that set it last", "[history]") {
  MarkedWorld world;
  world.add({FillBox{{{0, 5, 0}, {4, 6, 4}}}, {}, 1});
  world.add({SetVoxel{{1, 5, 1}}, {}, 2}, 2);
  world.add({SetVoxel{{1, 5, 1}}, {MaskKind::only_empty, kEmpty}, 1}, 3);  // changes nothing
  world.add({FillSphere{{2, 5, 2}, 0}, {MaskKind::only_solid, kEmpty}, 3});
  world.add({SetVoxel{{9, 5, 9}}, {}, 1});
  world.write();
  CHECK(world.mark({1, 5, 1}) == 2);
  CHECK(world.mark({2, 5, 2}) == 4);
  CHECK(world.mark({0, 5, 0}) == 1);
  CHECK(world.mark({9, 5, 9}) == 5);
  CHECK(world.mark({9, 6, 9}) == 0);
  CHECK(world.mark({0, -3, 0}) == 0);  // as the generator made it
}

TEST_CASE("a masked record counts if it changes what the generator made", "[history]") {
  MarkedWorld world;
  const VoxelPos deep{3, -9, 3}, high{3, 40, 3};
  for (const VoxelPos at : {deep, high}) {
    world.add({SetVoxel{at}, {MaskKind::only_solid, kEmpty}, kEmpty});
    world.add({SetVoxel{at}, {MaskKind::only_solid, kEmpty}, 2});
  }
  world.write();
  CHECK(world.mark(deep) == 1);
  CHECK(world.mark(high) == 0);
}

TEST_CASE("the cost of a mark is bounded, wherever its record is", "[history]") {
  MarkedWorld world;
  const VoxelPos busy{1, 5, 1}, quiet{200, 5, 200};
  world.add({SetVoxel{quiet}, {}, 2});
  world.add({SetVoxel{busy}, {}, 2});
  const EditDescriptor in_vain{SetVoxel{busy}, {MaskKind::only_empty, kEmpty}, 1};
  SECTION("it is behind many records in vain") {
    while (world.records.size() < 6'000) world.add(in_vain);
    world.write();
    CHECK(world.mark(busy) == 2);
  }
  SECTION("it is behind too many of them") {
    while (world.records.size() < 20'000) world.add(in_vain);
    world.write();
    CHECK(world.mark(busy) == 0);
    const auto found = read_voxel_mark(*world.store, *world.generator, busy);
    REQUIRE(found.has_value());
    CHECK(found->cost >= kVoxelMarkCostMax);
    CHECK(found->cost < kVoxelMarkCostMax + kVoxelMarkCostMax / 8);
  }
  CHECK(world.mark(quiet) == 1);
  CHECK(read_voxel_mark(*world.store, *world.generator, quiet)->cost < 10);
}

TEST_CASE("the mark of each voxel is that of a plain walk over the log", "[history][property]") {
  MarkedWorld world;
  SplitMix64 rng(11);
  const Extent extent = Extent::cube(kSampleEdge);
  for (int i = 0; i < 60; ++i) world.add(random_edit_near(rng, {}, extent));
  world.write();
  DenseChunk voxels =
      DenseChunk::of(generated_chunk(*world.generator, {0, {0, 0, 0}}, kSampleEdge).voxels);
  std::map<VoxelPos, Sequence> expected;
  for (const EditRecord& record : world.records) {
    const DenseChunk before = voxels;
    oracle_apply(voxels, {}, std::span(&record.edit, 1));
    const bool is_masked = record.edit.mask.kind != MaskKind::everything;
    for (std::int32_t x = 0; x < kSampleEdge; ++x) {
      for (std::int32_t y = 0; y < kSampleEdge; ++y) {
        for (std::int32_t z = 0; z < kSampleEdge; ++z) {
          const bool is_set = !is_masked && oracle_covers(record.edit, {x, y, z});
          if (is_set || voxels.at(x, y, z) != before.at(x, y, z))
            expected[{x, y, z}] = record.version.seq;
        }
      }
    }
  }
  for (int i = 0; i < 300; ++i) {
    const auto side = [&] { return static_cast<std::int32_t>(rng.below(kSampleEdge)); };
    const VoxelPos at{side(), side(), side()};
    CAPTURE(at.x, at.y, at.z);
    REQUIRE(world.mark(at) == (expected.contains(at) ? expected[at] : 0));
  }
}

}  // namespace runstone::test::voxel_mark_test
