#include "server/admin/server_config.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "common/core/assert.hpp"
#include "common/core/hex.hpp"
#include "common/core/tile_keys.hpp"
#include "common/core/utc_text.hpp"
#include "protocol/codec/server_list.hpp"
#include "protocol/rules/chat_text.hpp"
#include "server/admin/border_setting.hpp"
#include "server/admin/edit_budget_text.hpp"
#include "server/admin/operators.hpp"
#include "server/admin/reserved_names.hpp"
#include "server/history/retention_plan.hpp"
#include "server/settings/address_check.hpp"
#include "server/settings/settings_table.hpp"
#include "server/store/place_rule.hpp"
#include "server/store/store.hpp"

namespace runstone {
namespace {

/// A field whose text has a form of its own.
struct FormField {
  /// Sets the member. Fails if the text is no value: what is wrong with it.
  Result<void, std::string> (*set)(ServerConfig& config, const std::string& text);
  std::string (*print)(const ServerConfig& config);
};
template <class Enum>
struct Choice {
  const char* name;
  Enum value;
};
constexpr std::array<Choice<LogLevel>, 4> kLogLevels = {{{"debug", LogLevel::debug},
                                                         {"info", LogLevel::info},
                                                         {"warn", LogLevel::warn},
                                                         {"error", LogLevel::error}}};
constexpr std::array<Choice<LogFormat>, 2> kLogFormats = {
    {{"text", LogFormat::text}, {"json", LogFormat::json}}};
constexpr std::array<Choice<AddressForm>, 3> kAddressForms = {
    {{"full", AddressForm::full}, {"short", AddressForm::prefix}, {"none", AddressForm::none}}};
constexpr std::array<Choice<ChunkEncoding>, 3> kEncodings = {{{"packed", ChunkEncoding::packed},
                                                              {"raw", ChunkEncoding::raw},
                                                              {"coded", ChunkEncoding::coded}}};

/// Returns "a, b or c".
template <class Choices>
std::string names_of(const Choices& choices) {
  std::string names;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (i != 0) names += i + 1 == choices.size() ? " or " : ", ";
    names += choices[i].name;
  }
  return names;
}

/// A field with one value of an enumeration. `Choices` has a name for each value.
template <auto Member, const auto& Choices>
FormField choice_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            for (const auto& choice : Choices) {
              if (text != choice.name) continue;
              config.*Member = choice.value;
              return {};
            }
            return failure("must be " + names_of(Choices));
          },
          [](const ServerConfig& config) -> std::string {
            return std::find_if(Choices.begin(), Choices.end(),
                                [&](const auto& choice) { return choice.value == config.*Member; })
                ->name;
          }};
}

FormField operators_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            auto keys = parse_operators(text);
            if (!keys) return failure(keys.error());
            config.operators = *std::move(keys);
            return {};
          },
          [](const ServerConfig& config) {
            std::string text;
            for (const PublicKey& key : config.operators) {
              text += (text.empty() ? "" : ", ") + to_hex(key);
            }
            return text;
          }};
}

FormField border_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            const auto border = parse_border(text);
            if (!border) return failure(border.error());
            config.border = *border;
            return {};
          },
          [](const ServerConfig& config) { return border_setting_text(config.border); }};
}

FormField builder_budget_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            const auto budget = parse_edit_budget(text);
            if (!budget) return failure("must be " + edit_budget_rule());
            config.builder_budget = *budget;
            return {};
          },
          [](const ServerConfig& config) { return text_of(config.builder_budget); }};
}

/// A folder of this machine.
FormField world_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            if (text.empty()) return failure("must not be empty");
            if (is_database(text))
              return failure("must be a folder: the address of a database belongs into `store`");
            if (auto checked = check_folder(text); !checked) return checked;
            config.world = text;
            return {};
          },
          [](const ServerConfig& config) { return config.world; }};
}

FormField store_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            if (!text.empty()) {
              if (auto checked = check_database_address(text); !checked) return checked;
            }
            config.store = text;
            return {};
          },
          [](const ServerConfig& config) { return config.store; }};
}

/// An address that other programs connect to, or an empty text.
template <auto Member, auto Check>
FormField address_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            if (!text.empty()) {
              if (auto checked = Check(text); !checked) return checked;
            }
            config.*Member = text;
            return {};
          },
          [](const ServerConfig& config) { return config.*Member; }};
}

FormField page_address_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            if (!is_page_address(text))
              return failure("must be https://HOST or http://HOST, perhaps with a port and a path");
            config.page_address = text;
            return {};
          },
          [](const ServerConfig& config) { return config.page_address; }};
}

FormField message_of_the_day_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            auto line = text.empty() ? Result<std::string, std::string>(text) : chat_text(text);
            if (!line) return failure("must be one line of text: " + line.error());
            config.message_of_the_day = *std::move(line);
            return {};
          },
          [](const ServerConfig& config) { return config.message_of_the_day; }};
}

FormField announcements_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            auto announcements = parse_announcements(text);
            if (!announcements) return failure(announcements.error());
            config.announcements = *std::move(announcements);
            return {};
          },
          [](const ServerConfig& config) { return text_of(config.announcements); }};
}

constexpr std::uint64_t kBackupEveryMin = 60, kBackupEveryMax = 366ULL * 86'400;

FormField backup_every_field() {
  return {
      [](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
        const auto us = text == "0" ? std::optional<TimeUs>(0) : parse_duration(text);
        const std::uint64_t seconds = us ? static_cast<std::uint64_t>(*us) / 1'000'000 : 1;
        if (seconds != 0 && (seconds < kBackupEveryMin || seconds > kBackupEveryMax))
          return failure(
              "must be a duration of a minute to a year, such as 6h, 90m or 1d, or 0: no backups");
        config.backup_every_s = seconds;
        return {};
      },
      [](const ServerConfig& config) -> std::string {
        const std::uint64_t seconds = config.backup_every_s;
        if (seconds == 0) return "0";
        if (seconds % 3600 == 0) return std::to_string(seconds / 3600) + "h";
        if (seconds % 60 == 0) return std::to_string(seconds / 60) + "m";
        return std::to_string(seconds) + "s";
      }};
}

FormField reserved_names_field() {
  return {[](ServerConfig& config, const std::string& text) -> Result<void, std::string> {
            auto names = parse_reserved_names(text);
            if (!names) return failure(names.error());
            config.reserved_names = *std::move(names);
            return {};
          },
          [](const ServerConfig& config) {
            std::string text;
            for (const std::string& name : config.reserved_names)
              text += (text.empty() ? "" : ", ") + name;
            return text;
          }};
}

const SettingsTable<ServerConfig>& settings() {
  using C = ServerConfig;
  const auto number = number_setting<C>;
  const auto flag = flag_setting<C>;
  const auto text = [](const char* name, const char* help, std::string C::* member) {
    return text_setting(name, help, member, false);
  };
  const auto optional = [](const char* name, const char* help, std::string C::* member) {
    return text_setting(name, help, member, true);
  };
  const auto form = [](const char* name, const std::string& help, const FormField& field) {
    return Setting<C>{name, help, SettingType::text, field.set, field.print};
  };
  // A place may hold a password, also a mistyped one.
  const auto secret = [&form](const char* name, const std::string& help, const FormField& field) {
    Setting<C> out = form(name, help, field);
    out.has_secret = true;
    return out;
  };
  static const SettingsTable<C> all(
      "RUNSTONE_",
      {
          secret("world", "folder of the world", world_field()),
          secret("store", "address of a PostgreSQL database for the world: postgresql://...",
                 store_field()),
          flag(
              "standby",
              "follow the server that owns the world of `store`, and take the world over when it ends",
              &C::standby),
          number("lease_s", &C::lease_s, 2, 60,
                 "seconds without an answer of `store` until another server may take over"),
          form("peer_address",
               "HOST or HOST:PORT at which other servers of the world of `store` reach this one",
               address_field<&C::peer_address, &check_peer_address>()),
          form("player_address",
               "HOST or HOST:PORT at which players reach this server of the world of `store`; "
               "empty: players are not told of it",
               address_field<&C::player_address, &check_public_address>()),
          form(
              "page_address",
              "https://HOST/PATH of the pages of runstone-web for this server; empty: browsers are "
              "not told of it",
              page_address_field()),
          flag("move_to_builders",
               "hand the world over to a server that follows when most edits come from its players",
               &C::move_to_builders),
          text("listen", "HOST, HOST:PORT, [V6]:PORT or :PORT; port 0 takes a free one",
               &C::listen),
          flag("insecure", "connections are not encrypted; for 127.0.0.1 and [::1] only",
               &C::insecure),
          flag("i_know", "allow insecure on every address", &C::i_know),
          form("public_address", "HOST or HOST:PORT at which players reach the server, for invites",
               address_field<&C::public_address, &check_public_address>()),
          optional("gateway_socket", "path of a Unix socket for runstone-web; empty: none",
                   &C::gateway_socket),
          flag("gateway_group", "programs of the socket's group may use it as well, mode 0660",
               &C::gateway_group),
          flag("operators_page",
               "runstone-web may pass on commands of operators who entered by `page link`",
               &C::operators_page),
          optional("tls_certificate",
                   "PEM file: certificate chain of an authority; empty: the server's own",
                   &C::tls_certificate),
          optional("tls_key", "PEM file: secret key of tls_certificate", &C::tls_key),
          form("log_level", names_of(kLogLevels), choice_field<&C::log_level, kLogLevels>()),
          form("log_format", names_of(kLogFormats) + " (one object a line)",
               choice_field<&C::log_format, kLogFormats>()),
          form("log_addresses",
               names_of(kAddressForms) + "; short: the /24 of IPv4, the /48 of IPv6",
               choice_field<&C::log_addresses, kAddressForms>()),
          number("io_threads", &C::io_threads, 1, 64, "threads for sockets and the world strand"),
          number("worker_threads", &C::worker_threads, 1, 64,
                 "threads that generate, load and encode chunks"),
          number("sessions_max", &C::sessions_max, 1, 65'536, "sessions"),
          number("sessions_per_key", &C::sessions_per_key, 0, 65'536,
                 "sessions of one player, 0: no limit"),
          number("sessions_per_address", &C::sessions_per_address, 0, 65'536,
                 "sessions from one address, 0: no limit"),
          number("range_seats_percent", &C::range_seats_percent, 1, 100,
                 "percent of the seats that others leave, which one /24 of IPv4 or /48 of IPv6 may "
                 "take (8 at least, until the last eighth of the seats); no limit if "
                 "sessions_per_address is 0, or in local networks"),
          number("connections_per_second", &C::connections_per_second, 0, 1'000'000,
                 "connections a second from one address, ten times as many at once, 0: no limit"),
          number("handshakes_per_address", &C::handshakes_per_address, 1, 65'536,
                 "connections from one address that have not authenticated"),
          number("view_radius_max", &C::view_radius_max, 0, 64,
                 "chunks; larger views are cut to it"),
          number("tile_levels_max", &C::tile_levels_max, 0, kTileLevelMax,
                 "levels of detail that clients may see far ground in, 0: none"),
          number("view_interval_ms", &C::view_interval_ms, 0, 10'000,
                 "milliseconds between two views of a session that take effect"),
          number("chunk_loads_per_second", &C::chunk_loads_per_second, 0, kBudgetPerSecondMax,
                 "chunks that are generated or read for a player, ten times as many at once, "
                 "0: no limit"),
          form("encoding", "packed, raw or coded (smallest, slowest), where the client reads it",
               choice_field<&C::encoding, kEncodings>()),
          number("idle_s", &C::idle_s, 5, 86'400, "seconds without a message until a session ends"),
          number("messages_per_second", &C::messages_per_second, 0, kNoSettingMax,
                 "messages per session, 0: no limit"),
          number("read_kib_per_second", &C::read_kib_per_second, 0, 1ULL << 30,
                 "KiB a second from each session, beyond which reading waits, 0: no limit"),
          number("control_queue_kib", &C::control_queue_kib, 64, 1'048'576, "KiB per session"),
          number("edit_queue_kib", &C::edit_queue_kib, 64, 1'048'576, "KiB per session"),
          number("chunk_queue_kib", &C::chunk_queue_kib, 64, 1'048'576, "KiB per session"),
          number("session_kib_per_second", &C::session_kib_per_second, 0, 1ULL << 30,
                 "KiB a second to each session, beyond which terrain waits, 0: no limit"),
          number("server_kib_per_second", &C::server_kib_per_second, 0, 1ULL << 30,
                 "KiB a second to all sessions together, likewise, 0: no limit"),
          form(
              "operators",
              "public keys, in hex, of players who may give every command; separated by blanks or commas",
              operators_field()),
          number("names_per_key", &C::names_per_key, 1, 16, "names that a player may own"),
          number("names_per_address", &C::names_per_address, 0, 1'000'000,
                 "names an hour that players of one address may claim, 0: no limit"),
          form(
              "reserved_names",
              "names that nobody may have, besides server, admin and the like; separated by commas",
              reserved_names_field()),
          number("edit_volume_max", &C::edit_volume_max, 1, 1ULL << 40, "voxels per edit"),
          number("height_max", &C::height_max, 1, 1ULL << 29,
                 "voxels above y = 0 where edits may be"),
          number("depth_max", &C::depth_max, 0, 1ULL << 29,
                 "voxels below y = 0 where edits may be"),
          form(
              "border",
              "x z x z of two opposite columns, or x y z x y z of two opposite corners, all inside, "
              "or circle x z radius: players edit within it; empty: everywhere",
              border_field()),
          number("reach_max", &C::reach_max, 0, 1ULL << 30,
                 "voxels from a player to the farthest voxel of an edit, 0: no limit"),
          number("speed_max", &C::speed_max, 0, 1ULL << 30,
                 "voxels a second at which the reach follows a player who jumps, 0: at once"),
          form("builder_budget",
               names_of(kNamedBudgets) +
                   ", or units a second / units at once: how much a player edits",
               builder_budget_field()),
          number("budgets_per_address", &C::budgets_per_address, 0, 1'000'000,
                 "times the budgets of a player for all players of one address, 0: no limit"),
          number("build_mib", &C::build_mib, 1, 1'024,
                 "MiB of the file of one build of the library"),
          number("builds_max", &C::builds_max, 0, 1'000'000, "builds in the library"),
          number("builds_mib", &C::builds_mib, 0, 1'000'000'000,
                 "MiB of the files of all builds in the library"),
          number("builds_per_player", &C::builds_per_player, 0, 1'000'000,
                 "builds in the library that a player has added"),
          number("builds_mib_per_player", &C::builds_mib_per_player, 0, 1'000'000'000,
                 "MiB of the files of these builds"),
          number("chat_per_minute", &C::chat_per_minute, 0, 60'000,
                 "lines of chat a minute of a player, ten of them at once, 0: no limit"),
          number("chat_days", &C::chat_days, 0, 36'500,
                 "days for which the log of the chat keeps lines, 0: nothing is written to disk"),
          form("message_of_the_day", "text for players who join, at most 512 bytes; empty: none",
               message_of_the_day_field()),
          number("retention_days", &C::retention_days, 0, kRetentionDaysMax,
                 "days before the newest edit for which edits stay in the log, 0: for ever"),
          form(
              "announcements",
              "every 30m TEXT or at 20:00 TEXT (UTC), with | between several: lines that the server "
              "writes to all players; empty: none",
              announcements_field()),
          form("backup_every",
               "time between two backups that the server makes by itself, such as 6h; 0: none",
               backup_every_field()),
          optional("backup_folder", "folder that holds these backups, and nothing else",
                   &C::backup_folder),
          number("backup_keep_hourly", &C::backup_keep_hourly, 0, 100'000,
                 "hours of which the newest backup stays"),
          number("backup_keep_daily", &C::backup_keep_daily, 0, 100'000,
                 "days of which the newest backup stays"),
          number("backup_keep_weekly", &C::backup_keep_weekly, 0, 100'000,
                 "weeks of which the newest backup stays; all three 0: every backup stays"),
          number("memory_mib", &C::memory_mib, 16, 1'048'576,
                 "MiB of chunks and of edits that wait, then views wait and edits are rejected"),
          number("snapshot_edits", &C::snapshot_edits, 1, 1'000'000'000,
                 "edits between two rounds of snapshots"),
          number("snapshot_s", &C::snapshot_s, 1, 86'400,
                 "seconds between two rounds of snapshots"),
          number("keyframe_edits", &C::keyframe_edits, 0, 1'000'000'000,
                 "edits between two keyframes, at least, 0: none"),
          number("log_queue_records", &C::log_queue_records, 1, 10'000'000,
                 "records until edits are rejected busy"),
          number("disk_reserve_mib", &C::disk_reserve_mib, 0, 1'000'000'000,
                 "MiB of free disk space below which edits are rejected busy, 0: no reserve"),
          number("stop_s", &C::stop_s, 1, 3'600,
                 "seconds until a stop leaves what is in no snapshot to the next start"),
          number("digest_check_ms", &C::digest_check_ms, 10, 3'600'000,
                 "milliseconds between two digest checks of a session"),
          number("digest_check_chunks", &C::digest_check_chunks, 0, 1'024,
                 "digests per check, 0: none"),
          number("counters_s", &C::counters_s, 0, 86'400,
                 "seconds between two lines of activity, 0: never"),
      },
      "RUNSTONE_WEB_");
  return all;
}

}  // namespace

const std::vector<SettingField>& config_fields() { return settings().fields(); }
std::string environment_name(const std::string& field) { return settings().variable(field); }

std::string config_text(const ServerConfig& config, const std::string& name) {
  return settings().text(config, name);
}

void copy_config(ServerConfig& config, const ServerConfig& from, const std::string& name) {
  const auto copied = set_config(config, name, config_text(from, name));
  RUNSTONE_ASSERT(copied.has_value());
}

Result<void, std::string> set_config(ServerConfig& config, const std::string& name,
                                     const std::string& text) {
  return settings().set(config, name, text);
}

Result<void, TextError> read_config_toml(ServerConfig& config, std::string_view toml,
                                         std::string_view file) {
  return settings().read_toml(config, toml, file);
}

Result<void, std::string> read_config_environment(ServerConfig& config,
                                                  const Environment& environment) {
  return settings().read_environment(config, environment);
}

std::string to_toml(const ServerConfig& config) { return settings().to_toml(config); }

}  // namespace runstone
