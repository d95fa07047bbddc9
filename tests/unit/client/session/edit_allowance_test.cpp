#include "client/session/edit_allowance.hpp"

#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test {
namespace {

using namespace session_bench;

const EditDescriptor kClick{SetVoxel{{1, 2, 3}}, {}, 1};
const EditDescriptor kFourChunks{FillBox{{{14, 0, 14}, {18, 1, 18}}}, {}, 1};

TEST_CASE("an allowance pays the prices of edits and fills again", "[session]") {
  EditAllowance allowance;
  CHECK(allowance.wait_us(kFourChunks, 0) == 0);  // before welcome nothing is limited
  allowance.set({10, 5}, 16);
  REQUIRE(allowance.wait_us(kFourChunks, 0) == 0);
  allowance.pay(kFourChunks, 0);
  CHECK(allowance.wait_us(kClick, 0) == 0);
  CHECK(allowance.wait_us(kFourChunks, 0) == 300'000);
  CHECK(allowance.wait_us(kFourChunks, 300'000) == 0);
}

TEST_CASE("a reconnection does not fill an allowance, another budget does", "[session]") {
  EditAllowance allowance;
  allowance.set({10, 4}, 16);
  allowance.pay(kFourChunks, 0);
  allowance.set({10, 4}, 16);
  CHECK(allowance.wait_us(kClick, 0) == 100'000);
  allowance.set({10, 8}, 16);
  CHECK(allowance.wait_us(kClick, 0) == 0);
}

TEST_CASE("a refusal of the server empties an allowance", "[session]") {
  EditAllowance allowance;
  allowance.set({10, 4}, 16);
  allowance.refused(0);
  CHECK(allowance.wait_us(kClick, 0) == 100'000);
}

TEST_CASE_METHOD(SessionBench, "an edit beyond the budget is refused before it is shown",
                 "[session]") {
  server.edit_budget = {1, 2};
  open();
  for (int i = 0; i < 2; ++i) REQUIRE(session.offer(kClick, now, now).has_value());
  const auto refused = session.offer(kClick, now, now);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(session.edit_wait_us(kClick, now) > 0);
  CHECK(session.edit_wait_us(kClick, now + 1'000'000) == 0);
  CHECK(session.replica().local_edits().all().size() == 2);
}

}  // namespace
}  // namespace runstone::test
