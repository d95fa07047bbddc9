#include "server/settings/toml_settings.hpp"

#include <toml++/toml.h>

#include <sstream>

namespace runstone {

Result<std::vector<TomlSetting>, TextError> read_toml_settings(std::string_view toml,
                                                               std::string_view file) {
  toml::table table;
  try {
    table = toml::parse(toml, file);
  } catch (const toml::parse_error& error) {
    return Unexpected<TextError>{
        {std::string(file), error.source().begin.line, "", std::string(error.description())}};
  }
  std::vector<TomlSetting> out;
  for (const auto& [key, node] : table) {
    TomlSetting setting{key.source().begin.line, std::string(key.str()), std::nullopt, {}};
    if (const auto text = node.value_exact<std::string>()) {
      setting.type = SettingType::text;
      setting.text = *text;
    } else if (const auto flag = node.value_exact<bool>()) {
      setting.type = SettingType::flag;
      setting.text = *flag ? "true" : "false";
    } else if (const auto number = node.value_exact<std::int64_t>()) {
      setting.type = SettingType::number;
      setting.text = std::to_string(*number);
    }
    out.push_back(std::move(setting));
  }
  return out;
}

bool can_be(const TomlSetting& value, SettingType wanted) {
  return value.type == wanted || (wanted == SettingType::flag && value.type == SettingType::text);
}

std::string type_rule(SettingType type) {
  return type == SettingType::number ? "must be a whole number"
         : type == SettingType::text ? "must be a text"
                                     : "must be true or false";
}

std::string toml_line(const std::string& name, SettingType type, const std::string& text,
                      const std::string& help) {
  std::string value = text;
  if (type == SettingType::text) {
    std::ostringstream quoted;
    const toml::value<std::string> node(text);
    // In double quotes. Texts of other scripts are printed as they are.
    quoted << toml::toml_formatter(node, toml::format_flags::allow_unicode_strings);
    value = quoted.str();
  }
  return name + " = " + value + "  # " + help + "\n";
}

}  // namespace runstone
