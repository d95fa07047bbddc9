#include "server/world/order/large_actions.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

using Standing = LargeActions::Standing;

OperationId op_of(AuthorId author, ClientSequence seq, ClientInstance instance = 7) {
  return {author, instance, seq};
}

}  // namespace

TEST_CASE("an action of any number of edits names its first one", "[world][undo]") {
  LargeActions actions;
  actions.begin(op_of(1, 5));
  CHECK(actions.find(op_of(1, 5)) == Standing::open);
  CHECK(actions.order(op_of(1, 5), 5, 100) == 0);
  for (Sequence seq = 101; seq < 5'000; ++seq)
    REQUIRE(actions.order(op_of(1, seq - 95), 5, seq) == 100);
  CHECK(actions.find(op_of(1, 6)) == Standing::unknown);
  CHECK(actions.find(op_of(1, 5, 8)) == Standing::unknown);
}

TEST_CASE("other actions of the client do not end an action", "[world][undo]") {
  LargeActions actions;
  actions.begin(op_of(1, 1));
  CHECK(actions.order(op_of(1, 1), 1, 10) == 0);
  actions.begin(op_of(1, 2));
  CHECK(actions.order(op_of(1, 2), 2, 11) == 0);
  CHECK(actions.order(op_of(1, 3), 1, 12) == 10);
  CHECK(actions.order(op_of(1, 4), 2, 13) == 11);
}

TEST_CASE("an action that was found in the log goes on", "[world][undo]") {
  LargeActions actions;
  actions.remember(op_of(1, 5), 100, false);
  CHECK(actions.order(op_of(1, 90), 5, 400) == 100);
  actions.remember(op_of(1, 6), 101, true);
  CHECK(actions.find(op_of(1, 6)) == Standing::ended);
}

TEST_CASE("an action that its player has undone takes no more edits", "[world][undo]") {
  LargeActions actions;
  actions.begin(op_of(1, 5));
  actions.order(op_of(1, 5), 5, 100);
  actions.order(op_of(1, 6), 5, 107);
  CHECK(actions.end(2, 100) == 0);  // of another player
  CHECK(actions.end(1, 99) == 0);
  CHECK(actions.find(op_of(1, 5)) == Standing::open);
  CHECK(actions.end(1, 100) == 107);
  CHECK(actions.find(op_of(1, 5)) == Standing::ended);
}

TEST_CASE("the actions of a client and the clients are bounded", "[world][undo]") {
  LargeActions actions;
  for (ClientSequence seq = 1; seq <= LargeActions::kActionsOfClientMax; ++seq) {
    actions.begin(op_of(1, seq));
    actions.order(op_of(1, seq), seq, seq);
  }
  actions.order(op_of(1, 50), 1, 50);  // the first one has the newest edit now
  actions.begin(op_of(1, 60));
  CHECK(actions.find(op_of(1, 1)) == Standing::open);
  CHECK(actions.find(op_of(1, 2)) == Standing::unknown);
  for (AuthorId author = 2; author <= LargeActions::kClientsMax + 1; ++author)
    actions.begin(op_of(author, 1));
  CHECK(actions.size() == LargeActions::kClientsMax);
  CHECK(actions.find(op_of(1, 1)) == Standing::unknown);
  CHECK(actions.order(op_of(1, 70), 1, 9'000) == 0);  // it was accepted before it was forgotten
  CHECK(actions.order(op_of(1, 71), 1, 9'001) == 9'000);
}

}  // namespace runstone
