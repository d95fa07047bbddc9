#include "common/core/epoch_branch.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace runstone;

namespace {

constexpr TimeUs kBegin = 1'767'225'600'000'000;  // 2026-01-01T00:00:00Z
constexpr TimeUs kTenMinutes = 600'000'000;

}  // namespace

TEST_CASE("a new branch begins behind every epoch of the old one", "[epochs]") {
  for (const Epoch epoch : {0U, 1U, 511U, 512U, 513U, 25'687'040U, 4'000'000'000U}) {
    CAPTURE(epoch);
    for (const TimeUs now : {TimeUs{0}, kBegin, kBegin + 1000 * kTenMinutes}) {
      const Epoch next = next_branch(epoch, now);
      CHECK(next > epoch);
      CHECK_FALSE(is_same_branch(next, epoch));
      CHECK(is_same_branch(next, next + kEpochsPerBranch - 1));
    }
  }
}

TEST_CASE("two branches from one backup differ if ten minutes lie between them", "[epochs]") {
  const TimeUs now = kBegin + 47'000 * kTenMinutes;
  const Epoch first = next_branch(7, now), second = next_branch(7, now + kTenMinutes);
  CHECK(first == 47'000 * kEpochsPerBranch);
  CHECK(second > first);
  CHECK_FALSE(is_same_branch(first, second));
}

TEST_CASE("starts of a server stay on their branch", "[epochs]") {
  CHECK(is_same_branch(1, 511));
  CHECK_FALSE(is_same_branch(511, 512));
}

TEST_CASE("epochs end without going back", "[epochs]") {
  constexpr Epoch kMax = std::numeric_limits<Epoch>::max();
  CHECK(next_branch(kMax, 0) == kMax);
  CHECK(next_branch(1, std::numeric_limits<TimeUs>::max()) > 1);
}
