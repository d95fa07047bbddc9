#include "server/world/ground/session_turns.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

TEST_CASE("sessions take turns, also if one of them comes again at once") {
  SessionTurns turns;
  CHECK(turns.empty());
  CHECK_FALSE(turns.take_next());
  for (const SessionId session : {3u, 1u, 2u, 1u}) turns.insert(session);
  CHECK(turns.take_next() == SessionId{1});
  turns.insert(1);
  CHECK(turns.take_next() == SessionId{2});
  turns.insert(1);
  CHECK(turns.take_next() == SessionId{3});
  CHECK(turns.take_next() == SessionId{1});
  CHECK(turns.empty());
  turns.insert(5);
  turns.erase(5);
  CHECK_FALSE(turns.take_next());
}

}  // namespace
}  // namespace runstone::test
