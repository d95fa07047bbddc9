// How long a preview takes: one author's last hour in a long log with keyframes. Hidden: run it with
// RUNSTONE_LOG_EDITS=10000000 unit_rollback "[.preview_bench]".
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <iostream>

#include "server/history/keyframe_maker.hpp"
#include "server/rollback/restore_plan.hpp"
#include "server/rollback/selection.hpp"
#include "tests/support/builder_session.hpp"
#include "tests/support/sample_world.hpp"
#include "tests/support/temp_folder.hpp"

namespace runstone::test {

TEST_CASE("a preview of an author's last hour in a long log", "[.preview_bench]") {
  const char* const asked = std::getenv("RUNSTONE_LOG_EDITS");
  const std::size_t count = asked == nullptr ? 200'000 : std::strtoull(asked, nullptr, 10);
  const TempFolder folder;
  WorldMeta meta = sample_meta();
  meta.chunk_edge = 32;
  REQUIRE(create_world(folder.path(), meta).has_value());
  const auto store = *open_world(folder.path(), StoreAccess::read_write);
  const Epoch epoch = *store->raise_epoch();
  const auto generator = *make_generator(meta.generator, meta.materials);
  BuilderSession session(7, 8);
  std::vector<EditRecord> batch;
  TimeUs last_us = 0;
  for (std::size_t i = 0; i < count; ++i) {
    batch.push_back(session.next());
    batch.back().version.epoch = epoch;
    last_us = batch.back().time_us;
    if (batch.size() < 20'000 && i + 1 < count) continue;
    REQUIRE(store->append({}, batch).has_value());
    batch.clear();
  }
  KeyframeMaker maker(*store, *generator, KeyframePolicy{});
  const auto made =
      maker.make_due([&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
        return store->save_keyframe(chunks, keyframe);
      });
  REQUIRE(made.has_value());
  for (int run = 0; run < 3; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    SelectionFilter filter;
    filter.authors = {3};
    filter.from_us = last_us - 3'600'000'000;
    const auto selection = select_edits(*store, filter);
    REQUIRE(selection.has_value());
    const auto selected = std::chrono::steady_clock::now();
    RestorePlanner planner(*store, *generator);
    std::uint64_t voxels = 0;
    for (const auto& [key, edits] : selection->chunks) {
      const auto plan = planner.plan(key, edits, std::nullopt, count);
      REQUIRE(plan.has_value());
      voxels += plan->voxels;
    }
    const auto end = std::chrono::steady_clock::now();
    const auto ms = [](auto span) { return std::chrono::duration<double, std::milli>(span).count(); };
    std::cout << "log edits=" << count << " keyframes=" << maker.made() << " selected=" << selection->edits
              << " chunks=" << selection->chunks.size() << " voxels=" << voxels
              << " select_ms=" << ms(selected - begin) << " plan_ms=" << ms(end - selected) << "\n";
  }
}

}  // namespace runstone::test
