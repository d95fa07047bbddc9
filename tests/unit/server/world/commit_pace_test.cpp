#include "server/world/commit_pace.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace runstone::test {
namespace {

struct Crowd {
  std::vector<TimeUs> waits;  // of the edits that began a commit
  TimeUs sent_us = 0;         // in all
  TimeUs clock_us = 1'000'000;
};

/// An edit every `every_us` for `seconds`; each commit takes `cost_us` of sending, spread over what follows it.
Crowd run(TimeUs every_us, TimeUs cost_us, int seconds) {
  Crowd crowd;
  CommitPace pace;
  const TimeUs end = crowd.clock_us + seconds * 1'000'000;
  TimeUs edit_us = crowd.clock_us;
  CommitSending sending;
  while (edit_us < end) {
    const TimeUs due = pace.due(edit_us, sending);
    crowd.waits.push_back(due - edit_us);
    sending.spent_us += cost_us;
    ++sending.calls;
    while (edit_us <= due) edit_us += every_us;  // these came while it waited
  }
  crowd.sent_us = sending.spent_us;
  return crowd;
}

}  // namespace

TEST_CASE("while sending is cheap, every edit is committed at once", "[world]") {
  const Crowd small = run(5'000, 200, 10);  // 200 commits a second, 20 receivers of 10 us
  CHECK(small.waits.size() == 2'000);
  for (const TimeUs wait : small.waits) CHECK(wait == 0);
}

TEST_CASE("a crowd's edits gather so that sending takes half a core", "[world]") {
  const Crowd crowd = run(500, 10'000, 10);  // 2,000 edits a second, 1,000 receivers of 10 us
  CHECK(crowd.sent_us > 4'500'000);
  CHECK(crowd.sent_us < 5'200'000);
  TimeUs longest = 0;
  for (const TimeUs wait : crowd.waits) longest = std::max(longest, wait);
  CHECK(longest <= CommitPace::kGatherUsMax);
  CHECK(longest >= 15'000);
}

TEST_CASE("however dear sending is, no edit gathers longer than the bound", "[world]") {
  const Crowd crowd = run(500, 60'000, 10);
  CHECK(crowd.waits.size() > 380);  // a commit every 25 ms or so
  for (const TimeUs wait : crowd.waits) CHECK(wait <= CommitPace::kGatherUsMax);
}

TEST_CASE("after a burst, calm pays back, and a clock that stands still does no harm", "[world]") {
  CommitPace pace;
  static_cast<void>(pace.due(1'000'000, {}));
  const CommitSending burst{40'000, 1, 0};
  CHECK(pace.due(1'000'000, burst) == 1'000'000 + CommitPace::kGatherUsMax);
  CHECK(pace.due(999'000, burst) == 999'000 + CommitPace::kGatherUsMax);
  CHECK(pace.due(1'200'000, burst) == 1'200'000);
}

TEST_CASE("receivers whose turn has not come count as if they had been sent to", "[world]") {
  CommitPace pace;
  CHECK(pace.due(1'000'000, {0, 0, 0}) == 1'000'000);
  // The first commit went to a thousand receivers, and none was sent to yet: some 10 ms of sending, half a core.
  CHECK(pace.due(1'000'500, {0, 0, 1'000}) == 1'000'500 + 2 * 10'000 - 2 * CommitPace::kSavedUsMax);
  // Half of them were, at 20 us each.
  CHECK(pace.due(1'000'500, {10'000, 500, 500}) == 1'000'500 + CommitPace::kGatherUsMax);
  // A receiver that does not read is due to nobody: the count is of those who wait for us.
  CHECK(pace.due(1'100'000, {20'000, 1'000, 0}) == 1'100'000);
}

}  // namespace runstone::test
