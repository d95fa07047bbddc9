#include "bench/network/message_flood.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "bench/network/attack_thread.hpp"
#include "common/core/assert.hpp"
#include "tests/support/codec/random_message.hpp"

namespace runstone::bench {
namespace {

constexpr std::size_t kDrawnMessages = 64;
// A drawn place is inside a world of a larger edge with a low probability.
constexpr int kDrawsMax = 1'000'000;
constexpr int kWaitMsMax = 3'000, kFloodAgainMs = 20;

/// Sets the numbers that depend on the messages before.
void set_number(runstone::Message& message, std::uint64_t number) {
  const auto low = static_cast<std::uint32_t>(number);
  if (auto* edit = std::get_if<EditRequest>(&message)) {
    edit->client_seq = number;
    edit->action = 0;
  }
  if (auto* request = std::get_if<HistoryRequest>(&message)) request->request = low;
  if (auto* command = std::get_if<CommandRequest>(&message)) command->id = low;
  // More bytes than the server has sent would be a broken rule.
  if (auto* ack = std::get_if<ReceiveAck>(&message)) ack->chunk_bytes = 1;
}

/// Waits until the server has sent terrain, which can be acknowledged.
void receive_terrain(AttackThread& thread, AttackClient& client) {
  constexpr std::uint64_t kTerrainBytes = 4 * 1024;
  client.queue(View{1, {}, 2, 2});
  const std::uint64_t before = client.bytes_received();
  for (int ms = 0; ms < kWaitMsMax && client.bytes_received() < before + kTerrainBytes; ++ms) {
    if (!client.is_open() || thread.is_over()) return;
    client.flush();
    client.wait(1, true);
    client.read();
  }
}

/// Returns a connection at this stage of the handshake, or null.
std::unique_ptr<AttackClient> connect_to_stage(AttackThread& thread, SessionStage stage,
                                               std::uint64_t features) {
  if (stage == SessionStage::open) return thread.join(0, features);
  auto client = thread.connect(thread.own_address());
  if (client == nullptr) return nullptr;
  client->queue_hello(thread.random().next(), 1, features);
  for (int ms = 0; stage == SessionStage::authenticating && ms < kWaitMsMax; ++ms) {
    if (!client->is_open() || client->is_welcome() || thread.is_over()) break;
    client->flush();
    client->wait(1, true);
    client->continue_handshake(false);
  }
  return client;
}

}  // namespace

std::vector<MessageKind> client_kinds() {
  std::vector<MessageKind> out;
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    if (may_send(info_of(kind), Sender::client)) out.push_back(kind);
  }
  return out;
}

FloodMessages::FloodMessages(MessageKind kind, std::uint16_t edge, SplitMix64& random) {
  for (int draws = 0; drawn_.size() < kDrawnMessages; ++draws) {
    RUNSTONE_ASSERT(draws < kDrawsMax);
    runstone::Message message = test::random_message(random, kind);
    set_number(message, 1);
    const EncodedMessage encoded = encode_message(message);
    if (decode_message(Sender::client, kind, *encoded.bytes, edge))
      drawn_.push_back(std::move(message));
  }
}

runstone::Message FloodMessages::next() {
  runstone::Message message = drawn_[count_ % drawn_.size()];
  set_number(message, ++count_);
  return message;
}

void flood_messages(AttackThread& thread, MessageKind kind) {
  const SessionStage stage = info_of(kind).stage.value_or(SessionStage::open);
  const std::uint64_t features = AttackClient::kFeatures | info_of(kind).feature;
  std::optional<FloodMessages> messages;
  while (thread.may_connect()) {
    const auto client = connect_to_stage(thread, stage, features);
    if (client == nullptr) continue;
    if (!messages) messages.emplace(kind, client->welcome().chunk_edge, thread.random());
    messages->restart();
    if (kind == kKindOf<ReceiveAck>) receive_terrain(thread, *client);
    thread.send_to(*client, [&](AttackClient& to) { to.queue(messages->next()); }, kNoLimit);
    if (!thread.is_over()) thread.pause_ms(kFloodAgainMs);
  }
}

}  // namespace runstone::bench
