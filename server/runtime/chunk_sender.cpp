#include "server/runtime/chunk_sender.hpp"

#include <asio/post.hpp>
#include <optional>
#include <utility>

#include "server/history/missing_edits.hpp"
#include "server/runtime/logging.hpp"

namespace runstone {

bool ChunkSender::send_snapshot(const std::shared_ptr<NetSession>& session, std::uint32_t view,
                                const ChunkKey& key, const ChunkPtr& chunk) {
  return queue_snapshot(session, view, key, chunk, session->encodings().of(key));
}

bool ChunkSender::send_changed_tile(const std::shared_ptr<NetSession>& session, std::uint32_t view,
                                    const ChunkKey& key, const ChunkPtr& tile) {
  return queue_snapshot(session, view, key, tile, session->encodings().chunks);
}

bool ChunkSender::queue_snapshot(const std::shared_ptr<NetSession>& session, std::uint32_t view,
                                 const ChunkKey& key, const ChunkPtr& chunk,
                                 ChunkEncoding encoding) {
  const auto place = session->reserve_chunk(key, view);
  if (!place) return false;
  asio::post(workers_, [this, session, key, chunk, encoding, place = *place] {
    session->fill_chunk(place, encoded_.snapshot(key, chunk, encoding));
  });
  return true;
}

bool ChunkSender::send_update(const std::shared_ptr<NetSession>& session, std::uint32_t view,
                              const ChunkKey& key, const ChunkPtr& chunk, Version held) {
  const auto place = session->reserve_chunk(key, view);
  if (!place) return false;
  asio::post(workers_, [this, session, key, chunk, held, place = *place] {
    session->fill_chunk(place, encode_update(key, chunk, held, session->encodings().of(key)));
  });
  return true;
}

ChunkEntry ChunkSender::encode_update(const ChunkKey& key, const ChunkPtr& chunk, Version held,
                                      ChunkEncoding encoding) {
  std::optional<ChunkEdits> edits;
  const auto read = chunks_.with_reader([&](WorldReader& reader) {
    auto missing =
        missing_edits(reader, key, *chunk, held, chunk_bytes_about(chunk->voxels, encoding));
    if (missing) {
      edits = *std::move(missing);
    } else {
      logger("store").error("{}", missing.error().message());
    }
  });
  if (!read) logger("store").error("{}", read.error().message());
  return edits ? encode_chunk_edits(*edits) : encoded_.snapshot(key, chunk, encoding);
}

}  // namespace runstone
