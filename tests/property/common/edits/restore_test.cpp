#include "common/edits/restore/restore.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/edits/apply/edit_changes.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

/// Keeps, for every voxel, all materials that were written to it, and their writers.
class HistoryOracle {
 public:
  HistoryOracle(DenseChunk start, VoxelPos origin)
      : start_(std::move(start)), origin_(origin), now_(start_) {
    writers_.resize(std::size_t{1} * start_.extent().volume());
  }

  void add(const EditDescriptor& edit, bool is_selected) {
    const DenseChunk before = now_;
    oracle_apply(now_, origin_, {&edit, 1});
    for_each([&](int x, int y, int z, std::vector<Writer>& writers) {
      if (now_.at(x, y, z) != before.at(x, y, z))
        writers.push_back({now_.at(x, y, z), is_selected});
    });
  }

  const DenseChunk& now() const { return now_; }
  /// Goes back from the last writer of each voxel while that writer is selected.
  DenseChunk restored(bool forgets_order = false) {
    DenseChunk out = start_;
    for_each([&](int x, int y, int z, std::vector<Writer>& writers) {
      auto last = writers.rbegin();
      while (last != writers.rend() && last->is_selected) ++last;
      if (forgets_order && !writers.empty() && !writers.back().is_selected) last = writers.rend();
      if (last != writers.rend()) out.set(x, y, z, last->wrote);
    });
    return out;
  }

 private:
  struct Writer {
    Material wrote;
    bool is_selected;
  };
  template <class F>
  void for_each(F&& f) {
    std::size_t slot = 0;
    for (int z = 0; z < start_.side_z(); ++z) {
      for (int y = 0; y < start_.side_y(); ++y) {
        for (int x = 0; x < start_.side_x(); ++x) f(x, y, z, writers_[slot++]);
      }
    }
  }

  DenseChunk start_;
  VoxelPos origin_;
  DenseChunk now_;
  std::vector<std::vector<Writer>> writers_;
};

/// Compares the listed differences with two dense chunks, voxel by voxel.
bool tells_the_differences(const std::vector<Difference>& listed, const DenseChunk& now,
                           const DenseChunk& restored, AxisOrder order) {
  std::size_t next = 0;
  const std::uint32_t volume = now.extent().volume();
  for (std::uint32_t i = 0; i < volume; ++i) {
    const VoxelPos p = dense_pos(now.extent(), order, i);
    const Material is = now.at(p.x, p.y, p.z);
    const Material ought = restored.at(p.x, p.y, p.z);
    while (next < listed.size() && listed[next].last <= i) ++next;
    const bool is_listed = next < listed.size() && listed[next].first <= i;
    if (is_listed != (is != ought)) return false;
    if (is_listed && (listed[next].now != is || listed[next].restored != ought)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("restoring equals going back through the history of each voxel",
          "[edits][restore][property]") {
  SplitMix64 rng{41 + Catch::rngSeed()};
  ApplyScratch scratch;
  std::size_t with_differences = 0;
  std::size_t detected = 0;
  for (int round = 0; round < 220; ++round) {
    const RunChunk start = random_chunk(rng, 16, 6);
    const VoxelPos origin = {rng.between(-40, 40), rng.between(-40, 40), rng.between(-40, 40)};
    ChunkRestore restore(start, origin);
    HistoryOracle oracle(DenseChunk::of(start), origin);
    const std::uint64_t selected_of_ten = 1 + rng.below(9);
    const std::size_t count = 1 + rng.below(round % 8 == 0 ? 160 : 24);
    CAPTURE(Catch::rngSeed(), round, count, selected_of_ten);
    for (std::size_t i = 0; i < count; ++i) {
      const EditDescriptor edit = random_edit_near(rng, origin, start.extent);
      const bool is_selected = rng.below(10) < selected_of_ten;
      restore.add(edit, is_selected, scratch);
      oracle.add(edit, is_selected);
      if (rng.below(6) != 0) continue;
      restore.flush(scratch);
      REQUIRE(DenseChunk::of(restore.now()) == oracle.now());
      REQUIRE(DenseChunk::of(restore.restored()) == oracle.restored());
    }
    restore.flush(scratch);
    REQUIRE(validate(restore.now()).has_value());
    REQUIRE(validate(restore.restored()).has_value());
    const DenseChunk restored = oracle.restored();
    REQUIRE(DenseChunk::of(restore.now()) == oracle.now());
    REQUIRE(DenseChunk::of(restore.restored()) == restored);
    std::vector<Difference> differences;
    append_differences(restore.now(), restore.restored(), differences);
    REQUIRE(tells_the_differences(differences, oracle.now(), restored, start.order));
    REQUIRE(restore.has_differences() == !differences.empty());
    with_differences += differences.empty() ? 0 : 1;
    detected += oracle.restored(true) == restored ? 0 : 1;
  }
  CHECK(with_differences > 100);
  CHECK(detected > 100);  // a wrong treatment of later edits by others is detected
}

TEST_CASE("changes written into another chunk change exactly those stretches",
          "[edits][property]") {
  SplitMix64 rng{42 + Catch::rngSeed()};
  ApplyScratch scratch;
  for (int round = 0; round < 300; ++round) {
    RunChunk chunk = random_chunk(rng, 20, 5);
    RunChunk other = random_chunk(rng, chunk.extent, chunk.order, 5);
    Digest digest = digest_of(chunk);
    const DenseChunk before = DenseChunk::of(chunk);
    DenseChunk expected = DenseChunk::of(other);
    std::vector<EditDescriptor> edits(1 + rng.below(4));
    for (EditDescriptor& edit : edits) edit = random_edit_near(rng, {0, 0, 0}, chunk.extent);
    const ApplyResult result = apply_stack(chunk, digest, {0, 0, 0}, edits, scratch);
    write_changes(other, changes_of(scratch, result), scratch);
    const DenseChunk after = DenseChunk::of(chunk);
    for (int z = 0; z < after.side_z(); ++z) {
      for (int y = 0; y < after.side_y(); ++y) {
        for (int x = 0; x < after.side_x(); ++x) {
          if (after.at(x, y, z) != before.at(x, y, z)) expected.set(x, y, z, after.at(x, y, z));
        }
      }
    }
    CAPTURE(Catch::rngSeed(), round, edits);
    REQUIRE(validate(other).has_value());
    REQUIRE(DenseChunk::of(other) == expected);
  }
}

}  // namespace runstone::test
