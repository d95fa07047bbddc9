// TOML files of settings: one line a setting, perhaps under a header with the first word of its name.
// A program may also have sections, such as [server.valley], with settings of their own. Reads their
// values as text, and writes such lines. Which settings there are is known to SettingsTable. Thread:
// any.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"
#include "common/core/text_error.hpp"

namespace runstone {

/// How TOML writes a value. A flag is true or false.
enum class SettingType : std::uint8_t { number, text, flag };

struct TomlSetting {
  std::uint32_t line = 0;
  std::string key;
  std::optional<SettingType> type;  // nullopt: no setting has a value of this type
  std::string text;                 // as a flag of the command line has it
  bool is_empty_header = false;     // a header such as [backup] with no line below it
};
/// The settings under a header such as [server.valley].
struct TomlSection {
  std::uint32_t line = 0;
  std::string name;  // "valley"
  std::vector<TomlSetting> settings;
};
/// Returns the sections of a kind, such as "server", by name. Fails if the file is no TOML, or if
/// the kind is a value and no table of sections.
Result<std::vector<TomlSection>, TextError> read_toml_sections(std::string_view toml,
                                                               std::string_view file,
                                                               std::string_view kind);
/// Returns all keys of a file with their values. `file` is only for messages. A key `every` under the
/// header [backup] is `backup_every`, so settings whose names begin alike can stand under one header.
/// A header without a line below it is one key, so that a wrong one is found.
/// The kind of sections `sections` is one key without a value; empty: there are none. Fails if the
/// file is no TOML, or has a key twice.
Result<std::vector<TomlSetting>, TextError> read_toml_settings(std::string_view toml,
                                                               std::string_view file,
                                                               std::string_view sections = {});
/// Returns true if a setting of this type takes the value. A flag may also be quoted.
bool can_be(const TomlSetting& value, SettingType wanted);
/// Returns what a value of this type must be, such as "must be a whole number".
std::string type_rule(SettingType type);
/// Returns the line "name = value  # help".
std::string toml_line(const std::string& name, SettingType type, const std::string& text,
                      const std::string& help);

}  // namespace runstone
