#include "server/world/order/open_actions.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

OperationId op(AuthorId author, ClientSequence seq, ClientInstance instance = 7) {
  return {author, instance, seq};
}

}  // namespace

TEST_CASE("the edits after the first one of an action name it", "[world][undo]") {
  OpenActions actions;
  CHECK(actions.order(op(1, 5), 5, 100) == 0);
  CHECK(actions.order(op(2, 1), 0, 101) == 0);  // of another player
  CHECK(actions.order(op(1, 6), 5, 102) == 100);
  CHECK(actions.order(op(1, 7), 5, 103) == 100);
  CHECK(actions.order(op(1, 8, 9), 5, 104) == 0);  // of another client of the player
  CHECK(actions.order(op(1, 8), 8, 105) == 0);
  CHECK(actions.order(op(1, 9), 8, 106) == 105);
}

TEST_CASE("an action whose first edit was rejected begins with the next one", "[world][undo]") {
  OpenActions actions;
  CHECK(actions.order(op(1, 6), 5, 100) == 0);
  CHECK(actions.order(op(1, 7), 5, 101) == 100);
}

TEST_CASE("an edit by itself ends the action, and is kept nowhere", "[world][undo]") {
  OpenActions actions;
  CHECK(actions.order(op(1, 5), 5, 100) == 0);
  CHECK(actions.order(op(1, 6), 0, 101) == 0);
  CHECK(actions.size() == 0);
  CHECK(actions.order(op(1, 7), 5, 102) == 0);
}

TEST_CASE("an action has a bounded number of edits, and so have the clients", "[world][undo]") {
  OpenActions actions;
  CHECK(actions.order(op(1, 1), 1, 1) == 0);
  for (Sequence seq = 2; seq <= kActionEditsMax; ++seq)
    REQUIRE(actions.order(op(1, seq), 1, seq) == 1);
  CHECK(actions.order(op(1, kActionEditsMax + 1), 1, kActionEditsMax + 1) == 0);
  CHECK(actions.order(op(1, kActionEditsMax + 2), 1, kActionEditsMax + 2) == kActionEditsMax + 1);
  for (AuthorId author = 2; author <= OpenActions::kClientsMax + 1; ++author)
    actions.order(op(author, 1), 1, 1'000 + author);
  CHECK(actions.size() == OpenActions::kClientsMax);
  CHECK(actions.order(op(1, 999), 1, 9'000) == 0);  // the oldest one was forgotten
}

}  // namespace runstone
