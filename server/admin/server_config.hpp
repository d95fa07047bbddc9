// ServerConfig: every setting of the server with its default, unit and range. Their names and their
// precedence follow the rule of SettingsTable, with the prefix RUNSTONE_. Values are checked when
// they are set, so a ServerConfig is always valid. It is read once and passed on by const
// reference. docs/server-reference.md describes the settings.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/core/text_error.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/default_port.hpp"
#include "server/admin/announcements.hpp"
#include "server/admin/log_format.hpp"
#include "server/admin/log_level.hpp"
#include "server/limits/address_form.hpp"
#include "server/settings/setting_names.hpp"
#include "server/world/environment/world_border.hpp"

namespace runstone {

struct ServerConfig {
  // Place.
  std::string world = "world";  // folder
  /// Address of the PostgreSQL database that holds the rows of the world: postgresql://... The
  /// folder `world` then holds the log of the chat and the socket of `runstone-server control`.
  /// Empty: the world is a file in the folder.
  std::string store;
  /// Follow the server that owns the world of `store`, and take the world over when it ends.
  bool standby = false;
  /// Seconds without an answer of `store` until another server may take the world over, 2..60.
  std::uint64_t lease_s = 5;
  /// HOST, HOST:PORT or [V6]:PORT, at which other servers of the world of `store` reach this one.
  /// Empty: see peer_address_of().
  std::string peer_address;
  /// HOST, HOST:PORT or [V6]:PORT, at which players reach this server of the world of `store`.
  /// Empty: players are not told of this server.
  std::string player_address;
  /// https://HOST/PATH of the runstone-web of this server. Empty: browsers are not told of this
  /// server.
  std::string page_address;
  /// Hand the world over to a server that follows when most edits come from the players there.
  bool move_to_builders = false;
  // HOST:PORT, or [V6]:PORT; port 0 takes a free port.
  std::string listen = "0.0.0.0:" + std::to_string(kDefaultPort);
  /// Connections are not encrypted. Only for an address of this machine, unless `i_know` is set.
  bool insecure = false, i_know = false;
  /// PEM files: a certificate chain of an authority and its secret key. Empty: the server makes a
  /// certificate of its own.
  std::string tls_certificate, tls_key;
  std::string public_address;  // HOST or HOST:PORT in links for players
  /// Path of a Unix socket for a gateway such as runstone-web, which names the address of each
  /// player by a PROXY header. Empty: none. Beside it the server answers questions at the socket
  /// with ".status" behind its name.
  std::string gateway_socket;
  bool gateway_group = false;  // programs of the file's group may use these sockets as well
  /// The gateway may pass on commands of operators who have a token (docs/operators-page.md).
  bool operators_page = false;
  LogLevel log_level = LogLevel::info;
  LogFormat log_format = LogFormat::text;
  AddressForm log_addresses = AddressForm::full;  // of players, in log lines
  // Threads.
  std::uint64_t io_threads = 2;      // 1..64: sockets and the world strand
  std::uint64_t worker_threads = 2;  // 1..64: generate, load, encode
  // Sessions.
  std::uint64_t sessions_max = 256;           // 1..65536
  std::uint64_t sessions_per_key = 4;         // of one player, 0: no limit
  std::uint64_t sessions_per_address = 64;    // 0: no limit
  std::uint64_t range_seats_percent = 50;     // of the seats that others leave, 1..100
  std::uint64_t connections_per_second = 20;  // of one address, ten times at once, 0: no limit
  std::uint64_t handshakes_per_address = 32;  // unauthenticated connections, 1..65536
  std::uint64_t view_radius_max = 16;         // chunks, 0..64
  std::uint64_t tile_levels_max = 8;          // levels of detail of far ground, 0..8; 0: none
  std::uint64_t view_interval_ms = 50;        // least time between two views of a session, 0..10000
  /// Chunks that are generated or read for a player, ten times as many at once, 0: no limit.
  std::uint64_t chunk_loads_per_second = 2'000;
  ChunkEncoding encoding = ChunkEncoding::packed;  // sent to clients that can read it
  std::uint64_t idle_s = 60;                       // seconds without a message, 5..86400
  std::uint64_t messages_per_second = 10'000;      // per session, 0: no limit
  /// KiB read from each session per second, twice as many at once, 0: no limit. Reading pauses
  /// above the limit. The sessions of an address together have `budgets_per_address` times as much.
  std::uint64_t read_kib_per_second = 512;
  std::uint64_t control_queue_kib = 16'384;  // KiB per session, 64..1048576
  std::uint64_t edit_queue_kib = 4'096;      // KiB per session, 64..1048576
  std::uint64_t chunk_queue_kib = 4'096;     // KiB per session, 64..1048576
  /// KiB sent to each session per second, 0: no limit. Only terrain waits at the limit.
  std::uint64_t session_kib_per_second = 0;
  /// KiB sent to all sessions together per second, 0: no limit. Sessions with terrain to send share
  /// it.
  std::uint64_t server_kib_per_second = 0;
  std::set<PublicKey> operators;  // players who may give every command
  // Names.
  std::uint64_t names_per_key = 3;          // names that a key may own, 1..16
  std::uint64_t names_per_address = 64;     // names claimed from one address an hour, 0: no limit
  std::vector<std::string> reserved_names;  // besides kReservedNames; nobody may have them
  // Edits.
  std::uint64_t edit_volume_max = 1'000'000;  // voxels per edit, 1..2^40
  std::uint64_t height_max = 1ULL << 29;      // voxels above y = 0 where edits may be, 1..2^29
  std::uint64_t depth_max = 1ULL << 29;       // voxels below y = 0 where edits may be, 0..2^29
  std::optional<WorldBorder> border;          // edits lie within it; nullopt: there is none
  std::uint64_t reach_max = 0;                // voxels from the player to the edit, 0: no limit
  /// Voxels a second at which `reach_max` follows a player who jumps, 0: at once .. 2^30.
  std::uint64_t speed_max = 0;
  EditBudget builder_budget{100, 4'000};  // of a player; kNamedBudgets has names
  std::uint64_t budgets_per_address = 4;  // of one address, times that of a player, 0: no limit
  // The library of builds.
  std::uint64_t build_mib = 64;               // MiB of the file of one build, 1..1024
  std::uint64_t builds_max = 100'000;         // builds, 0..1000000
  std::uint64_t builds_mib = 4'096;           // MiB of all files, 0..10^9
  std::uint64_t builds_per_player = 200;      // builds that a player has added, 0..1000000
  std::uint64_t builds_mib_per_player = 256;  // MiB of their files, 0..10^9
  // Chat.
  std::uint64_t chat_per_minute = 30;  // lines of a player, ten at once, 0: no limit .. 60000
  std::uint64_t chat_days = 30;        // for which lines stay on disk, 0: none is written .. 36500
  std::string message_of_the_day;      // for players who join; empty: none
  // Retention.
  std::uint64_t retention_days = 0;  // days that edits stay in the log; 0: for ever; at most 36500
  std::vector<Announcement> announcements;  // lines that are written to all players
  // Backups that the server makes by itself.
  std::uint64_t backup_every_s = 0;       // seconds between two backups, 0: none, 60..31622400
  std::string backup_folder;              // that holds them; not in the world's folder
  std::uint64_t backup_keep_hourly = 24;  // see BackupPolicy, 0..100000
  std::uint64_t backup_keep_daily = 7;    // 0..100000
  std::uint64_t backup_keep_weekly = 8;   // 0..100000
  // World and disk.
  std::uint64_t memory_mib = 512;            // MiB of chunks and of edits that wait, 16..1048576
  std::uint64_t snapshot_edits = 20'000;     // between two rounds of snapshots, 1..10^9
  std::uint64_t snapshot_s = 30;             // seconds between two rounds, 1..86400
  std::uint64_t keyframe_edits = 32'768;     // least number between two keyframes, 0: none .. 10^9
  std::uint64_t log_queue_records = 65'536;  // above it edits are rejected as busy, 1..10^7
  /// MiB of free disk space below which edits are rejected as busy, 0: no reserve .. 10^9.
  std::uint64_t disk_reserve_mib = 64;
  /// Seconds until a stop leaves what is in no snapshot to the next start, 1..3600. Containers
  /// usually have ten seconds.
  std::uint64_t stop_s = 8;
  std::uint64_t digest_check_ms = 1'000;  // between two digest checks of a session, 10..3600000
  std::uint64_t digest_check_chunks = 8;  // digests per check, 0: none .. 1024
  std::uint64_t counters_s = 60;          // seconds between two lines of activity, 0: never
  friend bool operator==(const ServerConfig&, const ServerConfig&) = default;
};

/// Returns the place of the world, see create_world().
inline const std::string& world_place(const ServerConfig& config) {
  return config.store.empty() ? config.world : config.store;
}
/// Returns all settings, in the order of the struct.
const std::vector<SettingField>& config_fields();
/// Returns "RUNSTONE_SESSIONS_MAX" for "sessions_max".
std::string environment_name(const std::string& field);

/// Returns the value of a field as text. Two values are equal if their texts are.
std::string config_text(const ServerConfig& config, const std::string& field);
/// Sets one field to its value in `from`.
void copy_config(ServerConfig& config, const ServerConfig& from, const std::string& field);

/// Sets one field from the text of a flag or variable. The error names the field and says what is
/// wrong.
Result<void, std::string> set_config(ServerConfig& config, const std::string& field,
                                     const std::string& text);
/// Sets the fields that a TOML file names; `file` is only for messages. Fails on unknown keys and
/// wrong values, with their line; `config` is then unchanged.
Result<void, TextError> read_config_toml(ServerConfig& config, std::string_view toml,
                                         std::string_view file);
/// Sets the fields that the environment names, see SettingsTable::read_environment(). Variables that
/// begin with RUNSTONE_WEB_ are for runstone-web.
Result<void, std::string> read_config_environment(ServerConfig& config,
                                                  const Environment& environment);
/// Returns all fields as TOML, which read_config_toml() reads back to an equal configuration.
std::string to_toml(const ServerConfig& config);

}  // namespace runstone
