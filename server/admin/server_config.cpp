#include "server/admin/server_config.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <variant>

#include "common/core/assert.hpp"
#include "common/core/hex.hpp"
#include "common/core/tile_keys.hpp"
#include "protocol/rules/chat_text.hpp"
#include "server/admin/edit_budget_text.hpp"
#include "server/admin/operators.hpp"
#include "server/admin/reserved_names.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kNoMax = 1'000'000'000'000'000ULL;

struct NumberField {
  std::uint64_t ServerConfig::* member;
  std::uint64_t min, max;
};
/// A field that takes any text that is not empty.
struct TextField {
  std::string ServerConfig::* member;
};
/// A field whose text has a form of its own.
struct FormField {
  /// Sets the member, or returns what is wrong with the text.
  std::optional<std::string> (*set)(ServerConfig& config, const std::string& text);
  std::string (*print)(const ServerConfig& config);
};
/// A field that is true or false.
struct SwitchField {
  bool ServerConfig::* member;
};
struct Field {
  std::string name, help;
  std::variant<NumberField, TextField, FormField, SwitchField> kind;
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
  return {[](ServerConfig& config, const std::string& text) -> std::optional<std::string> {
            for (const auto& choice : Choices) {
              if (text != choice.name) continue;
              config.*Member = choice.value;
              return std::nullopt;
            }
            return "must be " + names_of(Choices);
          },
          [](const ServerConfig& config) -> std::string {
            return std::find_if(Choices.begin(), Choices.end(),
                                [&](const auto& choice) { return choice.value == config.*Member; })
                ->name;
          }};
}

/// A field that takes any text, also none.
template <std::string ServerConfig::* Member>
FormField optional_text_field() {
  return {[](ServerConfig& config, const std::string& text) -> std::optional<std::string> {
            config.*Member = text;
            return std::nullopt;
          },
          [](const ServerConfig& config) { return config.*Member; }};
}

FormField operators_field() {
  return {[](ServerConfig& config, const std::string& text) -> std::optional<std::string> {
            auto keys = parse_operators(text);
            if (!keys) return keys.error();
            config.operators = *std::move(keys);
            return std::nullopt;
          },
          [](const ServerConfig& config) {
            std::string text;
            for (const PublicKey& key : config.operators) {
              text += (text.empty() ? "" : ", ") + to_hex(key);
            }
            return text;
          }};
}

FormField builder_budget_field() {
  return {[](ServerConfig& config, const std::string& text) -> std::optional<std::string> {
            const auto budget = parse_edit_budget(text);
            if (!budget) return "must be " + edit_budget_rule();
            config.builder_budget = *budget;
            return std::nullopt;
          },
          [](const ServerConfig& config) { return text_of(config.builder_budget); }};
}

FormField message_of_the_day_field() {
  return {[](ServerConfig& config, const std::string& text) -> std::optional<std::string> {
            auto line = text.empty() ? Result<std::string, std::string>(text) : chat_text(text);
            if (!line) return "must be one line of text: " + line.error();
            config.message_of_the_day = *std::move(line);
            return std::nullopt;
          },
          [](const ServerConfig& config) { return config.message_of_the_day; }};
}

FormField reserved_names_field() {
  return {[](ServerConfig& config, const std::string& text) -> std::optional<std::string> {
            auto names = parse_reserved_names(text);
            if (!names) return names.error();
            config.reserved_names = *std::move(names);
            return std::nullopt;
          },
          [](const ServerConfig& config) {
            std::string text;
            for (const std::string& name : config.reserved_names)
              text += (text.empty() ? "" : ", ") + name;
            return text;
          }};
}

const std::vector<Field>& fields() {
  using C = ServerConfig;
  const auto number = [](const char* name, std::uint64_t C::* member, std::uint64_t min,
                         std::uint64_t max, const std::string& what) {
    std::string range = what + ", " + std::to_string(min);
    range += max == kNoMax ? " or more" : ".." + std::to_string(max);
    return Field{name, range, NumberField{member, min, max}};
  };
  static const std::vector<Field> all = {
      {"world", "folder of the world", TextField{&C::world}},
      {"listen", "HOST, HOST:PORT, [V6]:PORT or :PORT; port 0 takes a free one",
       TextField{&C::listen}},
      {"insecure", "connections are not encrypted; for 127.0.0.1 and [::1] only",
       SwitchField{&C::insecure}},
      {"i_know", "allow insecure on every address", SwitchField{&C::i_know}},
      {"public_address", "HOST or HOST:PORT at which players reach the server, for invites",
       optional_text_field<&C::public_address>()},
      {"gateway_socket", "path of a Unix socket for runstone-web; empty: none",
       optional_text_field<&C::gateway_socket>()},
      {"gateway_group", "programs of the socket's group may use it as well, mode 0660",
       SwitchField{&C::gateway_group}},
      {"tls_certificate", "PEM file: certificate chain of an authority; empty: the server's own",
       optional_text_field<&C::tls_certificate>()},
      {"tls_key", "PEM file: secret key of tls_certificate", optional_text_field<&C::tls_key>()},
      {"log_level", names_of(kLogLevels), choice_field<&C::log_level, kLogLevels>()},
      {"log_format", names_of(kLogFormats) + " (one object a line)",
       choice_field<&C::log_format, kLogFormats>()},
      {"log_addresses", names_of(kAddressForms) + "; short: the /24 of IPv4, the /48 of IPv6",
       choice_field<&C::log_addresses, kAddressForms>()},
      number("io_threads", &C::io_threads, 1, 64, "threads for sockets and the world strand"),
      number("worker_threads", &C::worker_threads, 1, 64,
             "threads that generate, load and encode chunks"),
      number("sessions_max", &C::sessions_max, 1, 65'536, "sessions"),
      number("sessions_per_key", &C::sessions_per_key, 0, 65'536,
             "sessions of one player, 0: no limit"),
      number("sessions_per_address", &C::sessions_per_address, 0, 65'536,
             "sessions from one address, 0: no limit"),
      number("connections_per_second", &C::connections_per_second, 0, 1'000'000,
             "connections a second from one address, ten times as many at once, 0: no limit"),
      number("handshakes_per_address", &C::handshakes_per_address, 1, 65'536,
             "connections from one address that have not authenticated"),
      number("view_radius_max", &C::view_radius_max, 0, 64, "chunks; larger views are cut to it"),
      number("tile_levels_max", &C::tile_levels_max, 0, kTileLevelMax,
             "levels of detail that clients may see far ground in, 0: none"),
      number("view_interval_ms", &C::view_interval_ms, 0, 10'000,
             "milliseconds between two views of a session that take effect"),
      number("chunk_loads_per_second", &C::chunk_loads_per_second, 0, kBudgetPerSecondMax,
             "chunks that are generated or read for a player, ten times as many at once, "
             "0: no limit"),
      {"encoding", "packed, raw or coded (smallest, slowest), where the client reads it",
       choice_field<&C::encoding, kEncodings>()},
      number("idle_s", &C::idle_s, 5, 86'400, "seconds without a message until a session ends"),
      number("messages_per_second", &C::messages_per_second, 0, kNoMax,
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
      {"operators",
       "public keys, in hex, of players who may give every command; separated by blanks or commas",
       operators_field()},
      number("names_per_key", &C::names_per_key, 1, 16, "names that a player may own"),
      number("names_per_address", &C::names_per_address, 0, 1'000'000,
             "names an hour that players of one address may claim, 0: no limit"),
      {"reserved_names",
       "names that nobody may have, besides server, admin and the like; separated by commas",
       reserved_names_field()},
      number("edit_volume_max", &C::edit_volume_max, 1, 1ULL << 40, "voxels per edit"),
      number("height_max", &C::height_max, 1, 1ULL << 29, "voxels above y = 0 where edits may be"),
      number("depth_max", &C::depth_max, 0, 1ULL << 29, "voxels below y = 0 where edits may be"),
      number("reach_max", &C::reach_max, 0, 1ULL << 30,
             "voxels from a player to the farthest voxel of an edit, 0: no limit"),
      number("speed_max", &C::speed_max, 0, 1ULL << 30,
             "voxels a second at which the reach follows a player who jumps, 0: at once"),
      {"builder_budget",
       names_of(kNamedBudgets) + ", or units a second / units at once: how much a player edits",
       builder_budget_field()},
      number("budgets_per_address", &C::budgets_per_address, 0, 1'000'000,
             "times the budgets of a player for all players of one address, 0: no limit"),
      number("chat_per_minute", &C::chat_per_minute, 0, 60'000,
             "lines of chat a minute of a player, ten of them at once, 0: no limit"),
      number("chat_days", &C::chat_days, 0, 36'500,
             "days for which the log of the chat keeps lines, 0: nothing is written to disk"),
      {"message_of_the_day", "text for players who join, at most 512 bytes; empty: none",
       message_of_the_day_field()},
      number("memory_mib", &C::memory_mib, 16, 1'048'576,
             "MiB of chunks and of edits that wait, then views wait and edits are rejected"),
      number("snapshot_edits", &C::snapshot_edits, 1, 1'000'000'000,
             "edits between two rounds of snapshots"),
      number("snapshot_s", &C::snapshot_s, 1, 86'400, "seconds between two rounds of snapshots"),
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
  };
  return all;
}

const Field* find(std::string_view name) {
  const auto found = std::find_if(fields().begin(), fields().end(),
                                  [&](const Field& f) { return f.name == name; });
  return found == fields().end() ? nullptr : &*found;
}

/// Sets a number. Returns what is wrong with the value, or nullopt.
std::optional<std::string> assign(ServerConfig& config, const Field& field, std::uint64_t value) {
  const auto* number = std::get_if<NumberField>(&field.kind);
  if (number == nullptr) return "must be a text";
  if (value < number->min || value > number->max) return "is out of range: " + field.help;
  config.*number->member = value;
  return std::nullopt;
}

/// Sets a text. Returns what is wrong with the value, or nullopt.
std::optional<std::string> assign(ServerConfig& config, const Field& field,
                                  const std::string& value) {
  if (const auto* form = std::get_if<FormField>(&field.kind)) return form->set(config, value);
  if (const auto* flag = std::get_if<SwitchField>(&field.kind)) {
    if (value != "true" && value != "false") return "must be true or false: " + field.help;
    config.*flag->member = value == "true";
    return std::nullopt;
  }
  const auto* text = std::get_if<TextField>(&field.kind);
  if (text == nullptr) return "must be a whole number: " + field.help;
  if (value.empty()) return "must not be empty";
  config.*text->member = value;
  return std::nullopt;
}

/// Returns the text of a field.
std::string text_of(const ServerConfig& config, const Field& field) {
  if (const auto* form = std::get_if<FormField>(&field.kind)) return form->print(config);
  if (const auto* flag = std::get_if<SwitchField>(&field.kind))
    return config.*flag->member ? "true" : "false";
  if (const auto* number = std::get_if<NumberField>(&field.kind))
    return std::to_string(config.*number->member);
  return config.*std::get<TextField>(field.kind).member;
}

std::string with_replaced(std::string text, char from, char to, bool upper) {
  for (char& c : text) {
    if (c == from) c = to;
    if (upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return text;
}

}  // namespace

std::vector<ConfigField> config_fields() {
  std::vector<ConfigField> all;
  for (const Field& field : fields()) {
    all.push_back({field.name, field.help, std::holds_alternative<SwitchField>(field.kind)});
  }
  return all;
}

std::string environment_name(const std::string& field) {
  return "RUNSTONE_" + with_replaced(field, '_', '_', true);
}
std::string flag_name(const std::string& field) {
  return "--" + with_replaced(field, '_', '-', false);
}

std::string config_text(const ServerConfig& config, const std::string& name) {
  const Field* field = find(name);
  RUNSTONE_ASSERT(field != nullptr);
  return text_of(config, *field);
}

void copy_config(ServerConfig& config, const ServerConfig& from, const std::string& name) {
  const auto copied = set_config(config, name, config_text(from, name));
  RUNSTONE_ASSERT(copied.has_value());
}

Result<void, std::string> set_config(ServerConfig& config, const std::string& name,
                                     const std::string& text) {
  const Field* field = find(name);
  if (field == nullptr) return Unexpected<std::string>{name + ": no such setting"};
  std::optional<std::string> wrong;
  if (!std::holds_alternative<NumberField>(field->kind)) {
    wrong = assign(config, *field, text);
  } else {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const bool is_number = error == std::errc{} && rest == end;
    wrong = is_number ? assign(config, *field, value) : "must be a whole number: " + field->help;
  }
  if (wrong) return Unexpected<std::string>{name + " = \"" + text + "\": " + *wrong};
  return {};
}

Result<void, TextError> read_config_toml(ServerConfig& config, std::string_view toml,
                                         std::string_view file) {
  const auto wrong = [&](std::uint32_t line, std::string_view key, std::string_view what) {
    return Unexpected<TextError>{{std::string(file), line, std::string(key), std::string(what)}};
  };
  toml::table table;
  try {
    table = toml::parse(toml, file);
  } catch (const toml::parse_error& error) {
    return wrong(error.source().begin.line, "", error.description());
  }
  ServerConfig read = config;  // an error leaves `config` unchanged
  for (const auto& [key, node] : table) {
    const std::uint32_t line = key.source().begin.line;
    const Field* field = find(key.str());
    if (field == nullptr) return wrong(line, key.str(), "no such setting");
    std::optional<std::string> what;
    if (const auto text = node.value_exact<std::string>()) {
      what = assign(read, *field, *text);
    } else if (const auto flag = node.value_exact<bool>();
               flag && std::holds_alternative<SwitchField>(field->kind)) {
      what = assign(read, *field, std::string(*flag ? "true" : "false"));
    } else if (const auto number = node.value_exact<std::int64_t>(); number && *number >= 0) {
      what = assign(read, *field, static_cast<std::uint64_t>(*number));
    } else {
      what = "must be a whole number or a text: " + field->help;
    }
    if (what) return wrong(line, key.str(), *what);
  }
  config = std::move(read);
  return {};
}

Result<void, std::string> read_config_environment(
    ServerConfig& config,
    const std::function<std::optional<std::string>(const std::string&)>& look_up) {
  for (const Field& field : fields()) {
    const auto text = look_up(environment_name(field.name));
    if (!text) continue;
    const auto set = set_config(config, field.name, *text);
    if (!set) return Unexpected<std::string>{environment_name(field.name) + ": " + set.error()};
  }
  return {};
}

std::string to_toml(const ServerConfig& config) {
  std::string out;
  for (const Field& field : fields()) {
    out += field.name + " = ";
    if (std::holds_alternative<NumberField>(field.kind) ||
        std::holds_alternative<SwitchField>(field.kind)) {
      out += text_of(config, field);
    } else {
      out += '"';
      for (const char c : text_of(config, field)) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
      }
      out += '"';
    }
    out += "  # " + field.help + "\n";
  }
  return out;
}

}  // namespace runstone
