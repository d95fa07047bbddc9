// The target decodes any bytes as a message. Input: 1 byte (bit 0: sender; bits 1-2: class; bit 3:
// the edge of the world is known and 16), then the message. A message that decodes is encoded again
// and must decode to the same message.
#include <cstdint>

#include "protocol/codec/messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  if (size == 0 || (data[0] >> 1 & 3) == 3) return 0;
  const Sender sender = (data[0] & 1) == 0 ? Sender::client : Sender::server;
  const auto frame_class = static_cast<FrameClass>(data[0] >> 1 & 3);
  const std::uint16_t edge = (data[0] & 8) == 0 ? 0 : 16;
  const Bytes aligned(data + 1, data + size);
  const auto message = decode_message(sender, frame_class, aligned, edge);
  if (!message) return 0;
  // A Hello or Welcome of another protocol decodes to its version alone.
  const auto* hello = std::get_if<Hello>(&*message);
  if (hello != nullptr && hello->protocol != kProtocolVersion) return 0;
  const auto* welcome = std::get_if<Welcome>(&*message);
  if (welcome != nullptr && welcome->protocol != kProtocolVersion) return 0;
  const EncodedMessage again = encode_message(*message);
  RUNSTONE_ASSERT(again.frame_class == frame_class);
  const auto twice = decode_message(sender, frame_class, *again.bytes, edge);
  RUNSTONE_ASSERT(twice && *twice == *message);
  return 0;
}
