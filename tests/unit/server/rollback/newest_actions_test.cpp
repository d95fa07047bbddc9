#include "server/rollback/newest_actions.hpp"

#include "tests/unit/server/rollback/rollback_bench.hpp"

namespace runstone::test {

TEST_CASE("the edits of an action are one line of the log, and so are those of its undo",
          "[rollback]") {
  RollbackBench bench;
  const AuthorId ana = bench.join(kBuilder);
  bench.join(kGriefer);
  std::vector<EditDescriptor> edits;
  for (std::int32_t i = 0; i < 5; ++i) edits.push_back({SetVoxel{{i * 10, 1, -i}}, {}, 1});
  bench.set(kGriefer, {1, 2, 3}, 2);
  bench.edit_as_one(kBuilder, edits);
  bench.set(kGriefer, {1, 2, 4}, 2);
  bench.write_log();
  const auto all = newest_actions(*bench.store, {}, 20);
  REQUIRE(all.has_value());
  REQUIRE(all->size() == 3);
  const LogAction& action = all->at(1);
  CHECK(action.newest.version.seq == 6);
  CHECK(action.first == 2);
  CHECK(action.edits == 5);
  CHECK(action.box == VoxelBox{{0, 1, -4}, {41, 2, 1}});
  CHECK(all->at(2).edits == 1);

  bench.service.undo(ana, bench.bench.now(), bench.reply());
  bench.run_all();
  const auto newest = newest_actions(*bench.store, {}, 1);
  REQUIRE(newest.has_value());
  REQUIRE(newest->size() == 1);
  CHECK(newest->front().newest.cause == Cause::undo);
  CHECK(newest->front().edits == newest->front().newest.version.seq - 7);

  SelectionFilter of_ana;
  of_ana.authors = {ana};
  const auto mine = newest_actions(*bench.store, of_ana, 20);
  REQUIRE(mine.has_value());
  CHECK(mine->size() == 2);
}

}  // namespace runstone::test
