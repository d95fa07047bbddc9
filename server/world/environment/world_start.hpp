// WorldStart: what the store remembers when a server starts. The log above the checkpoint follows
// by WorldServer::replay_onto_stack().
#pragma once
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/given_texture.hpp"
#include "common/rights/change_rules.hpp"
#include "server/world/environment/chat_entry.hpp"
#include "server/world/environment/library_rows.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

/// The end of the log when a server starts.
struct LogPosition {
  Epoch epoch = 1;          // of this start, already raised
  Sequence last = 0;        // last sequence in the log; every record of the log is durable
  Epoch last_epoch = 0;     // of that record
  TimeUs last_time_us = 0;  // of that record; 0 if the log is empty
  // The log's time begins with this time, or with the wall clock if nullopt.
  std::optional<TimeUs> begin_us = std::nullopt;
};

/// The state that the store remembers.
struct WorldStart {
  LogPosition log;
  Sequence checkpoint = 0;
  std::vector<std::pair<ChunkKey, Version>> snapshots;
  std::vector<PlayerRow> players;
  std::vector<NameClaim> name_claims;
  std::vector<RightsRecord> rights;  // all changes of rights, in the order of the log
  std::vector<ChatEntry> chat;       // the newest lines, the last one last
  AuthorId author_max = 0;           // the highest author number ever stored
  std::vector<HighWater> resolved;
  std::vector<LibraryRow> library;  // all builds, ascending
  /// All textures, in the order of the log. A TextureTable takes all of them.
  std::vector<std::shared_ptr<const GivenTexture>> textures;
};

}  // namespace runstone
