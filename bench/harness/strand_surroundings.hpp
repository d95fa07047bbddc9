// StrandSurroundings: what surrounds a WorldServer whose world strand is measured: a wire that
// loses all but the handshake, a log without a disk, and a list of the chunks to load, which the
// benchmark answers while its clock is stopped.
#pragma once
#include <deque>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/world/world_server.hpp"

namespace runstone::bench {

inline constexpr std::uint16_t kStrandEdge = 32;  // of the chunks

class StrandSurroundings : public WorldEnvironment {
 public:
  std::map<SessionId, EncodedMessage> welcomes;
  std::deque<ChunkKey> loads;

  bool send(SessionId session, const EncodedMessage& message) override;
  bool send_snapshot(SessionId /*session*/, std::uint32_t /*view*/, const ChunkKey& /*key*/,
                     const ChunkPtr& /*chunk*/) override {
    return true;
  }
  /// Ends the program: nobody may be closed.
  void close(SessionId session, GoodbyeReason reason, const std::string& text) override;
  bool log_has_room(std::size_t /*records*/) const override { return true; }
  std::size_t log_queued_bytes() const override { return 0; }
  void log_append(std::vector<PlayerRow> /*players*/,
                  std::vector<EditRecord> /*records*/) override {}
  void log_names(std::vector<NameChange> /*changes*/) override {}
  bool save_state(SavedState /*state*/) override { return true; }
  void load_chunk(const ChunkKey& key) override { loads.push_back(key); }
  void save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> /*chunks*/,
                      Sequence /*checkpoint*/) override {}
};

/// Returns the configuration of a world with 8 materials, and with tiles up to this level.
WorldConfig strand_config(std::uint8_t tile_levels);
/// Fills with bytes that are always the same.
void fill_constant(std::span<std::uint8_t> out);
/// Connects a player and passes the handshake, up to ClientAuth.
void join(WorldServer& server, const StrandSurroundings& surroundings, SessionId session,
          const KeyPair& keys, const std::string& name, std::uint64_t features, const Clocks& now);

}  // namespace runstone::bench
