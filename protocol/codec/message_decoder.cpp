#include <cstdint>
#include <tuple>
#include <utility>

#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {
namespace {

/// The tables of the union Body, in its order and so in the order of Message.
using Bodies =
    std::tuple<wire::Hello, wire::Welcome, wire::ClientAuth, wire::SessionAccepted, wire::View,
               wire::ChunkRequest, wire::Chunk, wire::EditRequest, wire::Commit, wire::Reject,
               wire::Durable, wire::DigestCheck, wire::Move, wire::PlayerPoses, wire::PlayerList,
               wire::Ping, wire::Pong, wire::Goodbye, wire::ChunkUnavailable, wire::HistoryRequest,
               wire::HistoryState, wire::CommandRequest, wire::CommandOutput, wire::ReceiveAck,
               wire::UniformChunks, wire::CachedChunks, wire::ChunksNotModified, wire::ChunkEdits>;
static_assert(std::tuple_size_v<Bodies> == kMessageKindCount);

using ReadBody = Result<Message> (*)(const wire::Message&, const BodyReader&);

template <std::size_t kKind>
Result<Message> read_body(const wire::Message& message, const BodyReader& reader) {
  using Body = std::tuple_element_t<kKind, Bodies>;
  static_assert(static_cast<std::size_t>(wire::BodyTraits<Body>::enum_value) == kKind + 1);
  return reader.read(*message.body_as<Body>());
}

template <std::size_t... kKind>
constexpr std::array<ReadBody, kMessageKindCount> readers(std::index_sequence<kKind...> /*all*/) {
  return {read_body<kKind>...};
}

}  // namespace

Result<const wire::Message*> open_message(Sender sender, FrameClass frame_class, ByteView bytes) {
  // The verifier checks alignment only relative to the first byte of the buffer.
  RUNSTONE_ASSERT(reinterpret_cast<std::uintptr_t>(bytes.data()) % 8 == 0);
  if (bytes.size() > message_bytes_max(sender, frame_class)) {
    return fail(ErrorCode::limit_exceeded, "message exceeds the limit of its class");
  }
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), kVerifierDepthMax, kVerifierTablesMax);
  if (!wire::VerifyMessageBuffer(verifier))
    return fail(ErrorCode::broken_invariant, "message does not verify");
  const wire::Message& message = *wire::GetMessage(bytes.data());
  // The generated verifier accepts types of the union that it does not know.
  const auto type = static_cast<std::size_t>(message.body_type());
  if (type == 0 || type > kMessageKindCount)
    return fail(ErrorCode::unknown_kind, "unknown message type");
  if (message.body() == nullptr) return fail(ErrorCode::broken_invariant, "message has no body");
  const MessageInfo& info = info_of(type - 1);
  if (!may_send(info, sender)) return bad("message not allowed from this side");
  if (info.frame_class != frame_class) return bad("message came in the wrong class");
  return &message;
}

Result<Message> decode_message(Sender sender, FrameClass frame_class, ByteView bytes,
                               std::uint16_t chunk_edge) {
  static constexpr auto kReaders = readers(std::make_index_sequence<kMessageKindCount>());
  const auto message = open_message(sender, frame_class, bytes);
  if (!message) return Unexpected<Error>{message.error()};
  return kReaders[kind_of(bytes)](**message, BodyReader{chunk_edge, bytes.size()});
}

}  // namespace runstone
