#include <cstdint>
#include <tuple>
#include <utility>

#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {
namespace {

/// The table of each kind of message, in the order of Message.
using Bodies =
    std::tuple<wire::Hello, wire::Welcome, wire::ClientAuth, wire::SessionAccepted, wire::View,
               wire::ChunkRequest, wire::Chunks, wire::EditRequest, wire::Commit, wire::Reject,
               wire::Durable, wire::DigestCheck, wire::Move, wire::PlayerPoses, wire::PlayerList,
               wire::Ping, wire::Pong, wire::Goodbye, wire::ChunkUnavailable, wire::HistoryRequest,
               wire::ViewState, wire::CommandRequest, wire::CommandOutput, wire::ReceiveAck,
               wire::UniformChunks, wire::CachedChunks, wire::ChunksNotModified, wire::Permissions,
               wire::ProtectedGround, wire::ChatRequest, wire::ChatLines, wire::KeyRequest,
               wire::SealedKey, wire::KeyDeposit, wire::KeyDeposited, wire::MaterialsAdded,
               wire::LogMarksRequest, wire::LogMarks, wire::RestorePreview, wire::PreviewShare,
               wire::PlayerPreview, wire::FollowRequest, wire::FollowAnswer, wire::LogPart,
               wire::RelayOpen, wire::Relay, wire::RelayClose, wire::RelayCharge, wire::Resume,
               wire::Resumed, wire::Servers, wire::BuildsRequest, wire::Builds,
               wire::BuildPieceRequest, wire::BuildPiece, wire::BuildOffer, wire::BuildUpload,
               wire::BuildAnswer, wire::ShapesGiven, wire::TexturesGiven, wire::TexturesWanted,
               wire::TextureParts, wire::WorldTime, wire::ChatWithdrawn, wire::VeiledCommit,
               wire::VeilPatches>;
static_assert(std::tuple_size_v<Bodies> == kMessageKindCount);

using ReadBody = Result<Message> (*)(ByteView, const BodyReader&);

template <std::size_t kKind>
Result<Message> read_body(ByteView bytes, const BodyReader& reader) {
  const auto body = open_body<std::tuple_element_t<kKind, Bodies>>(bytes);
  if (!body) return failure(body.error());
  return reader.read(**body);
}

template <std::size_t... kKind>
constexpr std::array<ReadBody, kMessageKindCount> readers(std::index_sequence<kKind...> /*all*/) {
  return {read_body<kKind>...};
}

}  // namespace

Result<Message> decode_message(Sender sender, MessageKind kind, ByteView bytes,
                               std::uint16_t chunk_edge) {
  static constexpr auto kReaders = readers(std::make_index_sequence<kMessageKindCount>());
  RUNSTONE_ASSERT(kind < kMessageKindCount && may_send(info_of(kind), sender));
  if (bytes.size() > message_bytes_max(sender, info_of(kind).frame_class))
    return fail(ErrorCode::limit_exceeded, "message exceeds the limit of its class");
  return kReaders[kind](bytes, BodyReader{chunk_edge});
}

}  // namespace runstone
