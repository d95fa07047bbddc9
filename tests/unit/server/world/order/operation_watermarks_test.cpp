#include "server/world/order/operation_watermarks.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

TEST_CASE("rejections are bounded in all, and the instance rejected longest ago loses its first",
          "[world]") {
  OperationWatermarks marks;
  constexpr std::size_t kInstances =
      OperationWatermarks::kRejectionsTotalMax / OperationWatermarks::kRejectionsMax;
  const auto refuse_all = [&](ClientInstance instance) {
    for (ClientSequence seq = 1; seq <= OperationWatermarks::kRejectionsMax; ++seq) {
      marks.reject({1, instance, seq}, RejectReason::busy);
    }
  };
  for (ClientInstance instance = 1; instance <= kInstances; ++instance) refuse_all(instance);
  REQUIRE(marks.rejection_count() == OperationWatermarks::kRejectionsTotalMax);
  marks.reject({1, 1, 5'000}, RejectReason::rate_limited);  // instance 1 is the newest now
  CHECK(marks.rejection_count() == OperationWatermarks::kRejectionsTotalMax);
  marks.reject({1, 9'999, 1}, RejectReason::busy);
  CHECK(marks.rejection_count() ==
        OperationWatermarks::kRejectionsTotalMax + 1 - OperationWatermarks::kRejectionsMax);
  CHECK(marks.answer_to({1, 2, 10}) ==
        RejectReason::already_resolved);  // the reason is dropped; the operation stays resolved
  CHECK(marks.knows({1, 2, 10}));
  CHECK(marks.answer_to({1, 1, 5'000}) == RejectReason::rate_limited);
  CHECK(marks.answer_to({1, 3, 10}) == RejectReason::busy);
}

TEST_CASE("a rejected operation that another owner has ordered counts as accepted", "[world]") {
  OperationWatermarks marks;
  marks.reject({1, 7, 5}, RejectReason::busy);
  marks.reject({1, 7, 6}, RejectReason::busy);
  marks.raise({1, 7, 5});
  CHECK(marks.answer_to({1, 7, 5}) == RejectReason::already_resolved);
  CHECK(marks.answer_to({1, 7, 6}) == RejectReason::busy);
  CHECK(marks.of(1, 7) == 6);
  CHECK(marks.rejection_count() == 1);
  marks.raise({1, 7, 6});
  CHECK(marks.rejection_count() == 0);
}

TEST_CASE("a hundred thousand instances with one rejection each stay within the bound", "[world]") {
  OperationWatermarks marks;
  for (ClientInstance instance = 1; instance <= 100'000; ++instance) {
    marks.reject({2, instance, 1}, RejectReason::busy);
  }
  CHECK(marks.rejection_count() == OperationWatermarks::kRejectionsTotalMax);
  CHECK(marks.answer_to({2, 100'000, 1}) == RejectReason::busy);
}

TEST_CASE("a removed author leaves nothing, and others stay", "[world]") {
  OperationWatermarks marks;
  for (const AuthorId author : {1U, 2U, 3U}) {
    marks.raise({author, 7, 4});
    marks.reject({author, 8, 5}, RejectReason::busy);
  }
  marks.forget(2);
  marks.forget(9);  // unknown keys are ignored
  CHECK(marks.mark_count() == 4);
  CHECK(marks.rejection_count() == 2);
  CHECK_FALSE(marks.knows({2, 7, 1}));
  CHECK(marks.answer_to({1, 8, 5}) == RejectReason::busy);
  CHECK(marks.of(3, 7) == 4);
}

TEST_CASE("after a repair that lost watermarks, instances of before are refused", "[world]") {
  OperationWatermarks marks;
  const std::vector<HighWater> rows = {
      {1, 7, 4, 900}, {1, 8, 2, 1'100}, lost_watermarks(2, 1'000), {3, 7, 5, 800}};
  marks.restore(rows);
  CHECK(marks.of(1, 7) == 4);
  CHECK(marks.may_be_applied({1, 7, 5}));        // its watermark may be too low
  CHECK_FALSE(marks.may_be_applied({1, 8, 3}));  // it began after the repair
  CHECK(marks.may_be_applied({2, 9, 6}));        // it has no watermark, and edited before
  CHECK_FALSE(marks.may_be_applied({2, 9, 1}));
  CHECK_FALSE(marks.may_be_applied({3, 7, 6}));  // the author is newer than the repair
  marks.raise({2, 9, 1});
  CHECK_FALSE(marks.may_be_applied({2, 9, 2}));
  CHECK_FALSE(marks.may_be_applied({0, 5, 9}));  // the server
}

TEST_CASE("without a repair no instance is refused", "[world]") {
  OperationWatermarks marks;
  marks.restore(std::vector<HighWater>{{1, 7, 4, 900}});
  CHECK_FALSE(marks.may_be_applied({1, 7, 5}));
  CHECK_FALSE(marks.may_be_applied({1, 9, 6}));
}

}  // namespace
}  // namespace runstone
