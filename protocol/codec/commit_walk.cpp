#include "protocol/codec/commit_walk.hpp"

#include "common/core/assert.hpp"
#include "protocol/codec/body_reader.hpp"

namespace runstone {

Result<void> CommitWalk::read(ByteView bytes, std::uint16_t chunk_edge, const OnEdit& on_edit) {
  RUNSTONE_ASSERT(chunk_edge != 0);
  const auto commit = open_body<wire::Commit>(bytes);
  if (!commit) return failure(commit.error());
  const Epoch epoch = (*commit)->epoch();
  return BodyReader{chunk_edge}.read_edits(
      **commit, edit_, chunks_, [&] { return on_edit({{epoch, edit_.seq}, edit_, chunks_}); });
}

}  // namespace runstone
