// BodyReader: reads the body of each kind of message and checks what the FlatBuffers verifier
// cannot check. Internal to the message decoder. The readers are in session_bodies.cpp,
// chunk_bodies.cpp, edit_bodies.cpp, rights_bodies.cpp, chat_bodies.cpp, key_transfer_bodies.cpp,
// material_bodies.cpp, preview_bodies.cpp, server_bodies.cpp, server_list_bodies.cpp,
// build_bodies.cpp and texture_bodies.cpp.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/wire_fields.hpp"
#include "protocol/schema/runstone_generated.h"

namespace runstone {

inline Unexpected<Error> bad(const char* what) { return fail(ErrorCode::bad_value, what); }

/// Returns true if a reader can subtract this time from another one without an overflow.
inline bool is_time(TimeUs t) { return t >= -kWireTimeUsMax && t <= kWireTimeUsMax; }

/// Returns the table in these bytes, which must be 8-aligned. Fails if they do not verify.
template <class Table>
Result<const Table*> open_body(ByteView bytes) {
  // The verifier checks alignment only relative to the first byte of the buffer.
  RUNSTONE_ASSERT(reinterpret_cast<std::uintptr_t>(bytes.data()) % 8 == 0);
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), kVerifierDepthMax, kVerifierTablesMax);
  if (!verifier.VerifyBuffer<Table>(nullptr))
    return fail(ErrorCode::broken_invariant, "message does not verify");
  return flatbuffers::GetRoot<Table>(bytes.data());
}

struct BodyReader {
  std::int32_t chunk_edge;  // 0 before Welcome

  // ---- session_bodies.cpp
  Result<Message> read(const wire::Hello& t) const;
  Result<Message> read(const wire::Welcome& t) const;
  Result<Message> read(const wire::ClientAuth& t) const;
  Result<Message> read(const wire::SessionAccepted& t) const;
  Result<Message> read(const wire::Ping& t) const;
  Result<Message> read(const wire::Pong& t) const;
  Result<Message> read(const wire::WorldTime& t) const;
  Result<Message> read(const wire::Goodbye& t) const;
  Result<Message> read(const wire::Move& t) const;
  Result<Message> read(const wire::PlayerPoses& t) const;
  Result<Message> read(const wire::PlayerList& t) const;
  Result<Message> read(const wire::CommandRequest& t) const;
  Result<Message> read(const wire::CommandOutput& t) const;
  Result<Message> read(const wire::ReceiveAck& t) const;

  // ---- chunk_bodies.cpp
  Result<Message> read(const wire::View& t) const;
  Result<Message> read(const wire::ChunkRequest& t) const;
  Result<Message> read(const wire::CachedChunks& t) const;
  Result<Message> read(const wire::Chunks& t) const;
  Result<Message> read(const wire::UniformChunks& t) const;
  Result<Message> read(const wire::ChunksNotModified& t) const;
  Result<Message> read(const wire::ChunkUnavailable& t) const;
  Result<Message> read(const wire::HistoryRequest& t) const;
  Result<Message> read(const wire::ViewState& t) const;
  Result<Message> read(const wire::DigestCheck& t) const;

  // ---- edit_bodies.cpp
  Result<Message> read(const wire::EditRequest& t) const;
  Result<Message> read(const wire::Commit& t) const;
  Result<Message> read(const wire::VeiledCommit& t) const;
  Result<Message> read(const wire::VeilPatches& t) const;
  Result<Message> read(const wire::Reject& t) const;
  Result<Message> read(const wire::Durable& t) const;
  Result<Message> read(const wire::Resume& t) const;
  Result<Message> read(const wire::Resumed& t) const;

  // ---- rights_bodies.cpp
  Result<Message> read(const wire::Permissions& t) const;
  Result<Message> read(const wire::ProtectedGround& t) const;

  // ---- chat_bodies.cpp
  Result<Message> read(const wire::ChatRequest& t) const;
  Result<Message> read(const wire::ChatLines& t) const;
  Result<Message> read(const wire::ChatWithdrawn& t) const;

  // ---- key_transfer_bodies.cpp
  Result<Message> read(const wire::KeyRequest& t) const;
  Result<Message> read(const wire::SealedKey& t) const;
  Result<Message> read(const wire::KeyDeposit& t) const;
  Result<Message> read(const wire::KeyDeposited& t) const;

  // ---- material_bodies.cpp
  Result<Message> read(const wire::MaterialsAdded& t) const;
  Result<Message> read(const wire::ShapesGiven& t) const;

  // ---- log_mark_bodies.cpp
  Result<Message> read(const wire::LogMarksRequest& t) const;
  Result<Message> read(const wire::LogMarks& t) const;

  // ---- restore_preview_bodies.cpp
  Result<Message> read(const wire::RestorePreview& t) const;

  // ---- preview_bodies.cpp
  Result<Message> read(const wire::PreviewShare& t) const;
  Result<Message> read(const wire::PlayerPreview& t) const;

  // ---- server_bodies.cpp
  Result<Message> read(const wire::FollowRequest& t) const;
  Result<Message> read(const wire::FollowAnswer& t) const;
  Result<Message> read(const wire::LogPart& t) const;
  Result<Message> read(const wire::RelayOpen& t) const;
  Result<Message> read(const wire::Relay& t) const;
  Result<Message> read(const wire::RelayClose& t) const;
  Result<Message> read(const wire::RelayCharge& t) const;

  // ---- server_list_bodies.cpp
  Result<Message> read(const wire::Servers& t) const;

  // ---- build_bodies.cpp
  Result<Message> read(const wire::BuildsRequest& t) const;
  Result<Message> read(const wire::Builds& t) const;
  Result<Message> read(const wire::BuildPieceRequest& t) const;
  Result<Message> read(const wire::BuildPiece& t) const;
  Result<Message> read(const wire::BuildOffer& t) const;
  Result<Message> read(const wire::BuildUpload& t) const;
  Result<Message> read(const wire::BuildAnswer& t) const;

  // ---- texture_bodies.cpp
  Result<Message> read(const wire::TexturesGiven& t) const;
  Result<Message> read(const wire::TexturesWanted& t) const;
  Result<Message> read(const wire::TextureParts& t) const;

  using TakeEdit = std::function<Result<void>()>;
  /// Reads each edit of a commit into `edit` and the chunks that it touches into `touched`, then
  /// calls `take`, which may move from both. Before Welcome, `touched` stays
  /// empty.
  Result<void> read_edits(const wire::Commit& t, OrderedEdit& edit,
                          std::vector<ChunkCoord>& touched, const TakeEdit& take) const;

  /// Returns the chunk edge that bounds keys: before Welcome, the largest one allows the fewest
  /// coordinates.
  std::int32_t key_edge() const {
    return chunk_edge != 0 ? chunk_edge : static_cast<std::int32_t>(kSideMax);
  }
};

}  // namespace runstone
