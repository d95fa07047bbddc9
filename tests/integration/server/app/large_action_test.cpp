// An action of many edits whose server is killed in the middle, with kill -9: it goes on after the
// restart as the same action, and one undo takes all of it back.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "tests/integration/server/app/server_commands.hpp"
#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

constexpr ClientSequence kActionEdits = 3'000;
constexpr ClientInstance kBuilderInstance = 44;
constexpr std::uint64_t kBuilderFeatures = kFeatureLargeActions | kFeatureCommands;

/// Each edit of the action sets another voxel of the chunk at the origin.
EditRequest action_edit(ClientSequence seq) {
  const auto n = static_cast<std::int32_t>(seq);
  EditRequest request{seq, 0, {SetVoxel{{n % 16, n / 16 % 16, n / 256 % 16}}, {}, 2}};
  request.action = 1;
  request.is_optional = true;
  return request;
}

/// A client that keeps within the window of its session, and knows which edits have no answer.
class ActionClient {
 public:
  explicit ActionClient(std::uint16_t port) : client_(port) {
    client_.features = kBuilderFeatures;
    const auto accepted = client_.join(1, kBuilderInstance);
    REQUIRE(accepted.has_value());
    resolved_ = accepted->resolved;
    REQUIRE(client_.welcome.waiting_edits_max == kWaitingEditsMax);
  }
  RawClient& raw() { return client_; }
  ClientSequence resolved() const { return resolved_; }
  /// Sends the edits from `first` on and reads answers, until `last` is answered or `until` edits are
  /// durable. Returns false if the connection ended.
  bool send(ClientSequence first, ClientSequence last, Sequence until = kSequenceMax) {
    ClientSequence next = first;
    std::set<ClientSequence> under_way;
    while (next <= last || !under_way.empty()) {
      while (next <= last && under_way.size() < client_.welcome.waiting_edits_max) {
        under_way.insert(next);
        client_.send(action_edit(next++));
      }
      const auto message = client_.next();
      if (!message) return false;
      if (const auto* commit = std::get_if<Commit>(&*message)) {
        for (const OrderedEdit& edit : commit->edits) under_way.erase(edit.op.seq);
      } else if (const auto* reject = std::get_if<Reject>(&*message)) {
        CHECK(reject->reason == RejectReason::already_resolved);
        under_way.erase(reject->client_seq);
      } else if (const auto* durable = std::get_if<Durable>(&*message)) {
        if (durable->seq >= until) return true;
      }
    }
    return true;
  }

 private:
  RawClient client_;
  ClientSequence resolved_ = 0;
};

Digest digest_at_origin(RawClient& client) {
  client.send(View{1, {0, 0, 0}, 0, 0});
  const auto snapshot = client.next_of<ChunkSnapshot>();
  REQUIRE(snapshot.has_value());
  return snapshot->chunk.digest;
}

TEST_CASE("an action goes on after kill -9 of its server, and one undo takes all of it back",
          "[integration]") {
  const TempFolder folder;
  // The budget delays the action, so that some edits wait when the server is killed.
  const auto config_of = [&] {
    ServerConfig config = quiet_config(folder / "world");
    config.builder_budget = {2'000, 500};
    return config;
  };
  Digest before;
  {
    ServerProcess process(config_of);
    REQUIRE(process.port() != 0);
    ActionClient client(process.port());
    before = digest_at_origin(client.raw());
    REQUIRE(client.send(1, 1));
    REQUIRE(client.send(2, kActionEdits, 700));
    process.kill();
  }
  const auto server = start_server(config_of(), flat_creation());
  ActionClient client(server->port());
  const ClientSequence resolved = client.resolved();
  CHECK(resolved >= 700);
  CHECK(resolved < kActionEdits);
  REQUIRE(client.send(resolved - 20, kActionEdits));

  const Answer undone = command(client.raw(), "undo");
  INFO(undone.text);
  CHECK(undone.is_ok);
  CHECK(digest_at_origin(client.raw()) == before);
  CHECK(server->stop().is_clean);

  const auto store = open_world(folder / "world", StoreAccess::read_only);
  REQUIRE(store.has_value());
  ClientSequence last = 0;
  Sequence first = 0;
  const auto read = (*store)->read_log(1, kSequenceMax, [&](const EditRecord& record) {
    if (record.cause != Cause::player) {
      CHECK(record.cause == Cause::undo);
      CHECK(record.subject == first);
      return true;
    }
    CHECK(record.op.seq == ++last);  // none is lost, and none is there twice
    if (first == 0) first = record.version.seq;
    CHECK(record.subject == (last == 1 ? 0 : first));
    return true;
  });
  CHECK(read.has_value());
  CHECK(last == kActionEdits);
}

}  // namespace
}  // namespace runstone::test
