// SettingsTable: all settings of a program. They follow one naming rule:
//   file         sessions_max = 64
//   environment  RUNSTONE_SESSIONS_MAX=64    (with the program's prefix)
//   flag         --sessions-max 64
// The order of precedence is flag, environment, file, default. An unknown name is an error in all
// three, which names the nearest setting. Thread: any.
#pragma once
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/nearest_name.hpp"
#include "common/core/result.hpp"
#include "server/settings/setting.hpp"
#include "server/settings/setting_names.hpp"

namespace runstone {

template <class Config>
class SettingsTable {
 public:
  /// `prefix`: of variables of the environment, such as "RUNSTONE_". `other_prefix`: of those among
  /// them that belong to another program, such as "RUNSTONE_WEB_"; empty: there are none.
  SettingsTable(std::string prefix, std::vector<Setting<Config>> settings,
                std::string other_prefix = {})
      : prefix_(std::move(prefix)),
        other_prefix_(std::move(other_prefix)),
        settings_(std::move(settings)) {
    fields_.reserve(settings_.size());
    for (const Setting<Config>& setting : settings_) {
      fields_.push_back({setting.name, setting.help, setting.type == SettingType::flag});
      names_.push_back(setting.name);
      variables_.push_back(variable(setting.name));
    }
  }

  /// Returns all settings, in the order of the table. They live as long as the table.
  const std::vector<SettingField>& fields() const { return fields_; }
  /// Returns the name of the variable of a setting, such as "RUNSTONE_SESSIONS_MAX".
  std::string variable(const std::string& name) const { return prefix_ + upper_case(name); }
  /// Returns the value of a setting that exists. Two values are equal if their texts are.
  std::string text(const Config& config, const std::string& name) const {
    const Setting<Config>* setting = find(name);
    RUNSTONE_ASSERT(setting != nullptr);
    return setting->print(config);
  }

  /// Sets one value from the text of a flag or variable. The error names the setting and says what
  /// is wrong.
  Result<void, std::string> set(Config& config, const std::string& name,
                                const std::string& text) const {
    const Setting<Config>* setting = find(name);
    if (setting == nullptr) return failure(name + ": no such setting" + did_you_mean(name, names_));
    if (const auto done = setting->set(config, text); !done)
      return failure(name + (setting->has_secret ? "" : " = \"" + text + "\"") + ": " +
                     done.error());
    return {};
  }
  /// Sets the values that a TOML file names; `file` is only for messages. Fails on unknown names
  /// and wrong values, with their line; `config` is then unchanged. `sections`: a kind of sections
  /// that the caller reads (read_toml_sections); empty: there are none.
  Result<void, TextError> read_toml(Config& config, std::string_view toml, std::string_view file,
                                    std::string_view sections = {}) const {
    auto values = read_toml_settings(toml, file, sections);
    if (!values) return failure(values.error());
    std::erase_if(*values, [&](const TomlSetting& value) {
      return !sections.empty() && value.key == sections;
    });
    return read_values(config, *values, file);
  }
  /// Sets the values of a file that was read. Fails and changes nothing if one is wrong.
  Result<void, TextError> read_values(Config& config, const std::vector<TomlSetting>& values,
                                      std::string_view file) const {
    Config read = config;
    for (const TomlSetting& value : values) {
      const Setting<Config>* setting = find(value.key);
      const auto wrong = [&](std::string why) {
        return failure(TextError{std::string(file), value.line, value.key, std::move(why)});
      };
      if (setting == nullptr && value.is_empty_header && is_header(value.key)) continue;
      if (setting == nullptr) return wrong("no such setting" + did_you_mean(value.key, names_));
      if (!can_be(value, setting->type))
        return wrong(type_rule(setting->type) + ": " + setting->help);
      if (const auto done = setting->set(read, value.text); !done) return wrong(done.error());
    }
    config = std::move(read);
    return {};
  }
  /// Sets the values that the environment names. Fails if a value is wrong, and if a variable with
  /// the prefix is of no setting; is_foreign_variable() says which ones do not count. The error
  /// names the variable.
  Result<void, std::string> read_environment(Config& config, const Environment& environment) const {
    for (const auto& [name, value] : environment) {
      if (!name.starts_with(prefix_)) continue;
      const auto found = std::find(variables_.begin(), variables_.end(), name);
      if (found == variables_.end()) {
        if (!other_prefix_.empty() && name.starts_with(other_prefix_)) continue;
        if (is_foreign_variable(name, value)) continue;
        return failure(name + ": no setting has this variable of the environment" +
                       nearest_variable(name));
      }
      const auto done =
          set(config, names_[static_cast<std::size_t>(found - variables_.begin())], value);
      if (!done) return failure(name + ": " + done.error());
    }
    return {};
  }
  /// Returns all values as TOML, which read_toml() reads back to an equal configuration.
  std::string to_toml(const Config& config) const {
    std::string out;
    for (const Setting<Config>& setting : settings_)
      out += toml_line(setting.name, setting.type, setting.print(config), setting.help);
    return out;
  }

 private:
  /// Returns true if settings can stand under this header: a name begins with it and "_".
  bool is_header(const std::string& header) const {
    return std::any_of(names_.begin(), names_.end(),
                       [&](const std::string& name) { return name.starts_with(header + "_"); });
  }
  /// Returns "; did you mean VARIABLE?" or an empty text. The prefix is no part of the comparison.
  std::string nearest_variable(std::string_view name) const {
    const std::string_view nearest = nearest_name(name.substr(prefix_.size()), names_);
    return nearest.empty() ? std::string()
                           : "; did you mean " + variable(std::string(nearest)) + "?";
  }
  const Setting<Config>* find(std::string_view name) const {
    const auto found =
        std::find_if(settings_.begin(), settings_.end(),
                     [&](const Setting<Config>& setting) { return setting.name == name; });
    return found == settings_.end() ? nullptr : &*found;
  }

  const std::string prefix_, other_prefix_;
  const std::vector<Setting<Config>> settings_;
  std::vector<SettingField> fields_;
  std::vector<std::string> names_, variables_;  // in the order of settings_
};

}  // namespace runstone
