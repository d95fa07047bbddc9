// Recorded edits in virtual time: when they are due, and when the schedule delays them.
#include "client/bots/play_schedule.hpp"

#include <catch2/catch.hpp>
#include <deque>

using namespace runstone;

namespace {

constexpr TimeUs kSecond = 1'000'000;
constexpr TimeUs kBegin = 77 * kSecond;

std::vector<std::size_t> take_all(PlaySchedule& schedule, TimeUs now_us) {
  std::vector<std::size_t> indexes;
  while (const auto turn = schedule.next(now_us)) indexes.push_back(turn->index);
  return indexes;
}

/// The rate limit of a server: tokens are refilled, up to `burst`.
struct Limit {
  double per_second, burst, tokens = burst;
  TimeUs last_us = kBegin;
  bool take(TimeUs now_us) {
    tokens = std::min(burst, tokens + static_cast<double>(now_us - last_us) / 1e6 * per_second);
    last_us = now_us;
    if (tokens < 1) return false;
    tokens -= 1;
    return true;
  }
};

}  // namespace

TEST_CASE("edits are due at their recorded times, divided by the speed", "[bots][play]") {
  PlaySchedule schedule({0, 0, kSecond, 5 * kSecond}, 2);
  CHECK(take_all(schedule, kBegin).empty());  // before begin()
  schedule.begin(kBegin);
  CHECK(take_all(schedule, kBegin) == std::vector<std::size_t>{0, 1});
  CHECK(take_all(schedule, kBegin + kSecond / 2 - 1).empty());
  CHECK(schedule.due(kBegin + kSecond / 2 - 1) == 2);
  const auto third = schedule.next(kBegin + kSecond);  // late
  REQUIRE(third.has_value());
  CHECK(third->index == 2);
  CHECK(third->due_us == kBegin + kSecond / 2);
  CHECK(schedule.due(kBegin + 3 * kSecond) == 4);
  CHECK(take_all(schedule, kBegin + 3 * kSecond) == std::vector<std::size_t>{3});
  CHECK_FALSE(schedule.done());
  for (int i = 0; i < 3; ++i) schedule.accepted();
  schedule.dropped();
  CHECK(schedule.done());
}

TEST_CASE("at speed 0 an edit is due when there is room for it", "[bots][play]") {
  PlaySchedule schedule({0, 3600 * kSecond}, 0);
  schedule.begin(kBegin);
  CHECK(schedule.due(kBegin) == 2);
  const auto first = schedule.next(kBegin), second = schedule.next(kBegin + 9);
  REQUIRE((first.has_value() && second.has_value()));
  CHECK(first->due_us == kBegin);
  CHECK(second->due_us == kBegin + 9);
}

TEST_CASE("a tiny speed and a far time give valid due times", "[bots][play]") {
  PlaySchedule schedule({0, std::numeric_limits<TimeUs>::max()}, 1e-9);
  schedule.begin(kBegin);
  CHECK(take_all(schedule, kBegin + kSecond) == std::vector<std::size_t>{0});
}

TEST_CASE("open edits are bounded, and so is the rate", "[bots][play]") {
  PlaySchedule schedule(std::vector<TimeUs>(100'000, 0), 0);
  schedule.begin(kBegin);
  std::size_t handed = 0;
  TimeUs now_us = kBegin;
  for (; now_us < kBegin + kSecond; now_us += 1'000) handed += take_all(schedule, now_us).size();
  CHECK(handed == kPlayUnansweredMax);
  handed = 0;
  for (const TimeUs end_us = now_us + 4 * kSecond; now_us < end_us; now_us += 1'000) {
    while (schedule.unanswered() != 0) schedule.accepted();
    handed += take_all(schedule, now_us).size();
  }
  CHECK(handed > 31'000);
  CHECK(handed < 33'000);
}

TEST_CASE(
    "after a retry the open edits are answered first, and then the retries are "
    "submitted first",
    "[bots][play]") {
  PlaySchedule schedule({0, 1, 2, 3, 4, 5}, 1);
  schedule.begin(kBegin);
  std::deque<PlaySchedule::DueEdit> sent;
  while (const auto turn = schedule.next(kBegin + 3)) sent.push_back(*turn);
  REQUIRE(sent.size() == 4);
  schedule.accepted();  // 0
  schedule.retry(sent[2], kBegin + 10);
  schedule.retry(sent[1], kBegin + 10);
  CHECK(schedule.waiting() == 2);
  CHECK(take_all(schedule, kBegin + 2 * kPlayPauseUs).empty());  // 3 is not answered
  schedule.accepted();
  CHECK(take_all(schedule, kBegin + 10 + kPlayPauseUs - 1).empty());
  const auto first = schedule.next(kBegin + 10 + kPlayPauseUs);
  REQUIRE(first.has_value());
  CHECK(first->index == 1);
  CHECK(first->due_us == sent[1].due_us);
  CHECK(take_all(schedule, kBegin + 10 + kPlayPauseUs).empty());  // no catching up
  std::vector<std::size_t> rest;
  for (TimeUs us = 0; us < 5'000; us += 100) {
    for (const std::size_t index : take_all(schedule, kBegin + 10 + kPlayPauseUs + us))
      rest.push_back(index);
  }
  CHECK(rest == std::vector<std::size_t>{2, 4, 5});
}

TEST_CASE("the rate converges below the limit of a server, and every edit is accepted in the end",
          "[bots][play]") {
  constexpr std::size_t kEdits = 30'000;
  PlaySchedule schedule(std::vector<TimeUs>(kEdits, 0), 0);
  schedule.begin(kBegin);
  Limit limit{500, 1'000};
  std::vector<int> taken(kEdits, 0);
  std::uint64_t pushed = 0;
  TimeUs now_us = kBegin;
  // Answers arrive with the next step, 5 ms later.
  std::vector<PlaySchedule::DueEdit> sent;
  for (; !schedule.done() && now_us < kBegin + 120 * kSecond; now_us += 5'000) {
    for (const PlaySchedule::DueEdit& turn : std::exchange(sent, {})) {
      if (limit.take(now_us)) {
        ++taken[turn.index];
        schedule.accepted();
      } else {
        ++pushed;
        schedule.retry(turn, now_us);
      }
    }
    while (const auto turn = schedule.next(now_us)) sent.push_back(*turn);
  }
  CHECK(schedule.done());
  CHECK(taken == std::vector<int>(kEdits, 1));
  CHECK(pushed > 0);
  CHECK(pushed < 200);                    // the rate adapts
  CHECK(now_us - kBegin < 75 * kSecond);  // 58 s is what the limit allows
}
