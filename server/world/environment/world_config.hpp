// WorldConfig: the parameters of the world strand: the world and its limits.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/environment/world_border.hpp"
#include "server/world/environment/world_limits.hpp"

namespace runstone {

/// Returns the budget of a player whose view loads so many chunks a second; 0: no limit.
constexpr Budget chunk_load_budget(std::uint64_t per_second) {
  constexpr std::uint64_t kSecondsAtOnce = 10;
  return {per_second, per_second * kSecondsAtOnce};
}

struct WorldConfig {
  // The world.
  WorldId world_id{};
  std::uint16_t chunk_edge = 32;
  HeightLimits heights;  // edits must stay within them
  WorldPos spawn;
  MaterialTable materials;  // at the start; materials may be added later
  KeyPair server_keys;
  std::uint64_t features = kFeaturesKnown;  // optional parts of the protocol
  std::string link_address = "HOST";        // HOST or HOST:PORT in links for players
  /// This server's entry in the list of servers, see ServerEntry. Without an address it has none.
  std::string player_address, page_address;
  bool may_be_followed = false;  // the world is where other servers reach it, too
  // Limits of sessions.
  std::size_t sessions_max = 256;        // beyond it: server_full
  std::size_t sessions_per_key = 0;      // beyond it: server_full; 0: no limit
  std::size_t sessions_per_address = 0;  // beyond it: server_full; 0: no limit
  // Percent of the seats that others leave, which the addresses of one range may take. The last
  // seats are for ranges and networks without a session (joining.cpp). Beyond it: server_full. The
  // limit holds if sessions_per_address is not 0.
  std::uint64_t range_seats_percent = 100;
  std::size_t names_per_key = 3;              // that a key may own; owned names stay owned
  std::uint64_t names_per_address = 0;        // claimed within an hour; 0: no limit
  std::set<std::string> reserved_names;       // folded; nobody may have them
  std::set<PublicKey> operators;              // they have every right, whatever the log says
  std::uint8_t view_radius_max = 16;          // chunks; larger views are reduced to it
  std::uint8_t tile_levels_max = 0;           // of levels of detail that views may have; 0: none
  std::uint64_t edit_volume_max = 1'000'000;  // voxels per edit
  std::optional<WorldBorder> border;          // edits of players lie within it; nullopt: none
  double reach_max = 0;                       // voxels from the player to the edit; 0: no limit
  double speed_max = 0;                   // voxels a second of a player, for the reach; 0: no limit
  EditBudget edit_budget;                 // of a player's key
  Budget chunk_loads;                     // of a player's key: chunks generated or read
  std::uint64_t budgets_per_address = 0;  // of one address, times those of a key; 0: no limit
  Budget chat_budget;                     // of a player's key, see chat_state.hpp
  std::string message_of_the_day;         // a chat_text(), or empty: none
  std::size_t loads_per_session_max = 64;  // chunks one session may wait for at a time
  std::size_t loads_in_flight_max = 8;     // with the workers at a time, at least 1
  TimeUs view_interval_us = 50'000;        // between two views of a session that take effect
  // Chunks that views visit on a tick, all sessions together, at least 1.
  std::size_t view_chunks_per_tick = 65'536;
  TimeUs handshake_us_max = kHandshakeMsMax * 1'000;
  TimeUs idle_us_max = 60'000'000;                           // without any message; clients ping
  ChunkEncoding preferred_encoding = ChunkEncoding::packed;  // if the client offers it
  // Intervals.
  TimeUs pose_interval_us = 100'000;  // at least; longer with many sessions (presence.hpp)
  // Between two durable watermarks to a session that awaits none.
  TimeUs durable_interval_us = 1'000'000;
  TimeUs digest_check_interval_us = 1'000'000;
  std::size_t digest_check_chunks = 8;   // per session and interval
  TimeUs retry_interval_us = 100'000;    // after a full queue, unless drained() is called before
  std::size_t stack_load_edits = 1'024;  // an absent chunk with a longer stack is loaded
  LibraryLimits library;
  // Memory and disk.
  MemoryLimits memory;
  SnapshotPolicy snapshots;
  TimeUs stop_us_max = 8'000'000;  // after it, a stop begins no more snapshots
  bool move_to_builders = false;   // see OwnerChoice
};

/// Fills a buffer with unpredictable bytes (predictable ones in tests).
using RandomBytes = std::function<void(std::span<std::uint8_t>)>;

}  // namespace runstone
