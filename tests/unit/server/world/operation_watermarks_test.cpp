#include "server/world/operation_watermarks.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

TEST_CASE("refusals are bounded in all, and those of the instance refused longest ago go first",
          "[world]") {
  OperationWatermarks marks;
  constexpr std::size_t kInstances =
      OperationWatermarks::kRefusalsTotalMax / OperationWatermarks::kRefusalsMax;
  const auto refuse_all = [&](ClientInstance instance) {
    for (ClientSequence seq = 1; seq <= OperationWatermarks::kRefusalsMax; ++seq) {
      marks.refuse({1, instance, seq}, RejectReason::busy);
    }
  };
  for (ClientInstance instance = 1; instance <= kInstances; ++instance) refuse_all(instance);
  REQUIRE(marks.refusal_count() == OperationWatermarks::kRefusalsTotalMax);
  marks.refuse({1, 1, 5'000}, RejectReason::rate_limited);  // instance 1 is the newest now
  CHECK(marks.refusal_count() == OperationWatermarks::kRefusalsTotalMax);
  marks.refuse({1, 9'999, 1}, RejectReason::busy);
  CHECK(marks.refusal_count() ==
        OperationWatermarks::kRefusalsTotalMax + 1 - OperationWatermarks::kRefusalsMax);
  CHECK(marks.answer_to({1, 2, 10}) ==
        RejectReason::already_resolved);  // forgotten, but decided still
  CHECK(marks.knows({1, 2, 10}));
  CHECK(marks.answer_to({1, 1, 5'000}) == RejectReason::rate_limited);
  CHECK(marks.answer_to({1, 3, 10}) == RejectReason::busy);
}

TEST_CASE("a hundred thousand instances with one refusal each stay within the bound", "[world]") {
  OperationWatermarks marks;
  for (ClientInstance instance = 1; instance <= 100'000; ++instance) {
    marks.refuse({2, instance, 1}, RejectReason::busy);
  }
  CHECK(marks.refusal_count() == OperationWatermarks::kRefusalsTotalMax);
  CHECK(marks.answer_to({2, 100'000, 1}) == RejectReason::busy);
}

TEST_CASE("a forgotten author leaves nothing, and others stay", "[world]") {
  OperationWatermarks marks;
  for (const AuthorId author : {1U, 2U, 3U}) {
    marks.raise({author, 7, 4});
    marks.refuse({author, 8, 5}, RejectReason::busy);
  }
  marks.forget(2);
  marks.forget(9);  // unknown: allowed
  CHECK(marks.mark_count() == 4);
  CHECK(marks.refusal_count() == 2);
  CHECK_FALSE(marks.knows({2, 7, 1}));
  CHECK(marks.answer_to({1, 8, 5}) == RejectReason::busy);
  CHECK(marks.of(3, 7) == 4);
}

}  // namespace
}  // namespace runstone
