#include "server/world/order/commit_pace.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace runstone::test {
namespace {

struct PaceRun {
  std::vector<TimeUs> waits;  // of the first edit of each commit
  TimeUs sent_us = 0;         // in all
  TimeUs clock_us = 1'000'000;
};

/// Makes an edit every `every_us` for `seconds`. Each commit costs `cost_us` of sending, in the
/// time after it.
PaceRun run(TimeUs every_us, TimeUs cost_us, int seconds) {
  PaceRun large;
  CommitPace pace;
  const TimeUs end = large.clock_us + seconds * 1'000'000;
  TimeUs edit_us = large.clock_us;
  CommitSending sending;
  while (edit_us < end) {
    const TimeUs due = pace.due(edit_us, sending);
    large.waits.push_back(due - edit_us);
    sending.spent_us += cost_us;
    ++sending.calls;
    while (edit_us <= due) edit_us += every_us;  // edits that arrived while it waited
  }
  large.sent_us = sending.spent_us;
  return large;
}

}  // namespace

TEST_CASE("while sending is cheap, every edit is committed at once", "[world]") {
  const PaceRun small = run(5'000, 200, 10);  // 200 commits a second, 20 receivers of 10 us
  CHECK(small.waits.size() == 2'000);
  for (const TimeUs wait : small.waits) CHECK(wait == 0);
}

TEST_CASE("with many players edits gather so that sending takes half a core", "[world]") {
  const PaceRun large = run(500, 10'000, 10);  // 2,000 edits a second, 1,000 receivers of 10 us
  CHECK(large.sent_us > 4'500'000);
  CHECK(large.sent_us < 5'200'000);
  TimeUs longest = 0;
  for (const TimeUs wait : large.waits) longest = std::max(longest, wait);
  CHECK(longest <= CommitPace::kGatherUsMax);
  CHECK(longest >= 15'000);
}

TEST_CASE("whatever sending costs, no edit waits longer than the bound", "[world]") {
  const PaceRun large = run(500, 60'000, 10);
  CHECK(large.waits.size() > 380);  // a commit about every 25 ms
  for (const TimeUs wait : large.waits) CHECK(wait <= CommitPace::kGatherUsMax);
}

TEST_CASE("idle time pays back a burst, and a clock that stands still does no harm", "[world]") {
  CommitPace pace;
  static_cast<void>(pace.due(1'000'000, {}));
  const CommitSending burst{40'000, 1, 0};
  CHECK(pace.due(1'000'000, burst) == 1'000'000 + CommitPace::kGatherUsMax);
  CHECK(pace.due(999'000, burst) == 999'000 + CommitPace::kGatherUsMax);
  CHECK(pace.due(1'200'000, burst) == 1'200'000);
}

TEST_CASE("receivers that were not served yet count as if they had been", "[world]") {
  CommitPace pace;
  CHECK(pace.due(1'000'000, {0, 0, 0}) == 1'000'000);
  // The first commit has a thousand receivers, and none was served yet: about 10 ms of sending,
  // half a core.
  CHECK(pace.due(1'000'500, {0, 0, 1'000}) == 1'000'500 + 2 * 10'000 - 2 * CommitPace::kSavedUsMax);
  // Half of them were served, at 20 us each.
  CHECK(pace.due(1'000'500, {10'000, 500, 500}) == 1'000'500 + CommitPace::kGatherUsMax);
  // A receiver that does not read is not due: the count has only receivers that wait for this
  // server.
  CHECK(pace.due(1'100'000, {20'000, 1'000, 0}) == 1'100'000);
}

}  // namespace runstone::test
