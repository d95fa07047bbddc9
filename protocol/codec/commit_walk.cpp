#include "protocol/codec/commit_walk.hpp"

#include "common/core/assert.hpp"
#include "protocol/codec/body_reader.hpp"

namespace runstone {

Result<bool> CommitWalk::read(ByteView bytes, std::uint16_t chunk_edge, const OnEdit& on_edit) {
  RUNSTONE_ASSERT(chunk_edge != 0);
  const auto message = open_message(Sender::server, FrameClass::edits, bytes);
  if (!message) return Unexpected<Error>{message.error()};
  const wire::Commit* commit = (*message)->body_as_Commit();
  if (commit == nullptr) return false;
  const Epoch epoch = commit->epoch();
  const auto ok = BodyReader{chunk_edge, bytes.size()}.read_edits(
      *commit, edit_, chunks_,
      [&](Sequence seq) { return on_edit({{epoch, seq}, edit_, chunks_}); });
  if (!ok) return Unexpected<Error>{ok.error()};
  return true;
}

}  // namespace runstone
