#include "client/session/lost_edits.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

const EditDescriptor kOfAction{SetVoxel{{1, 2, 3}}, {}, 4};

}  // namespace

TEST_CASE("edits that are submitted again stay in their action", "[client_session]") {
  LocalEdits edits;
  const auto add = [&edits](ClientSequence action) {
    return edits.add(kOfAction, {}, 1, action).value();
  };
  const ClientSequence first = add(kBeginsAction), alone = 4;
  static_cast<void>(add(first));
  static_cast<void>(add(first));
  REQUIRE(add(0) == alone);
  const ClientSequence other = add(kBeginsAction);
  LostEdits lost;
  for (ClientSequence seq = first; seq <= other; ++seq)
    lost.take(edits, {seq, RejectReason::busy, {}, 0}, 10, 20);
  std::vector<ClientSequence> actions;
  ClientSequence next = 100;
  while (lost.due(20 + LostEdits::kAgainUs) != nullptr) {
    actions.push_back(lost.action());
    lost.offered(next++);
  }
  CHECK(actions == std::vector<ClientSequence>{kBeginsAction, 100, 100, 0, kBeginsAction});
}

}  // namespace runstone::test
