// The target decodes any bytes as a message. Input: 1 byte (bits 0-5: kind; bit 6: the edge of the
// world is known and 16; bit 7: of a kind that both sides send, the server is the sender, and of the
// first kinds, the kind is 64 more), then the message. A message that decodes is encoded again and
// must decode to the same message.
#include <cstdint>

#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  if (size == 0) return 0;
  // The first kinds have one sender, so bit 7 is free for them.
  constexpr MessageKind kBeyond = kMessageKindCount - 64;
  static_assert(kBeyond <= 2 && info_of(MessageKind{0}).sent_by != SentBy::both &&
                info_of(MessageKind{1}).sent_by != SentBy::both);
  MessageKind kind = data[0] & 63u;
  if ((data[0] & 128) != 0 && kind < kBeyond) kind += 64;
  const std::uint16_t edge = (data[0] & 64) == 0 ? 0 : 16;
  const bool is_from_client = may_send(info_of(kind), Sender::client) &&
                              ((data[0] & 128) == 0 || !may_send(info_of(kind), Sender::server));
  const Sender sender = is_from_client ? Sender::client : Sender::server;
  const Bytes aligned(data + 1, data + size);
  const auto message = decode_message(sender, kind, aligned, edge);
  if (!message) return 0;
  RUNSTONE_ASSERT(message->index() == kind);
  // A Hello or Welcome of another protocol decodes to its version alone.
  const auto* hello = std::get_if<Hello>(&*message);
  if (hello != nullptr && hello->protocol != kProtocolVersion) return 0;
  const auto* welcome = std::get_if<Welcome>(&*message);
  if (welcome != nullptr && welcome->protocol != kProtocolVersion) return 0;
  const EncodedMessage again = encode_message(*message);
  RUNSTONE_ASSERT(again.kind == kind);
  const auto twice = decode_message(sender, kind, *again.bytes, edge);
  RUNSTONE_ASSERT(twice && *twice == *message);
  return 0;
}
