#include "server/settings/toml_settings.hpp"

#include <toml++/toml.h>

#include <functional>
#include <set>
#include <sstream>

namespace runstone {

namespace {

Result<toml::table, TextError> parse_toml(std::string_view toml, std::string_view file) {
  try {
    return toml::parse(toml, file);
  } catch (const toml::parse_error& error) {
    return failure(TextError{std::string(file), error.source().begin.line, "",
                             std::string(error.description())});
  }
}

/// Appends the settings of a table. `prefix`: of their names. `is_header` says which tables in it are
/// headers; the others are values of a wrong type.
void append_settings(const toml::table& table, const std::string& prefix,
                     const std::function<bool(const std::string&)>& is_header,
                     std::vector<TomlSetting>& out) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const toml::table* const inner = node.as_table();
    if (inner != nullptr && !inner->is_inline() && !inner->empty() && is_header(name)) {
      append_settings(*inner, name + "_", [](const std::string&) { return false; }, out);
      continue;
    }
    TomlSetting setting{key.source().begin.line, name, std::nullopt, {}};
    setting.is_empty_header =
        inner != nullptr && !inner->is_inline() && inner->empty() && is_header(name);
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
}

std::vector<TomlSetting> settings_in(const toml::table& table) {
  std::vector<TomlSetting> out;
  append_settings(table, "", [](const std::string&) { return false; }, out);
  return out;
}

}  // namespace

Result<std::vector<TomlSetting>, TextError> read_toml_settings(std::string_view toml,
                                                               std::string_view file,
                                                               std::string_view sections) {
  const auto table = parse_toml(toml, file);
  if (!table) return failure(table.error());
  std::vector<TomlSetting> out;
  append_settings(*table, "", [&](const std::string& name) { return name != sections; }, out);
  std::set<std::string> names;
  for (const TomlSetting& setting : out) {
    if (!names.insert(setting.key).second)
      return failure(TextError{std::string(file), setting.line, setting.key, "is there twice"});
  }
  return out;
}

Result<std::vector<TomlSection>, TextError> read_toml_sections(std::string_view toml,
                                                               std::string_view file,
                                                               std::string_view kind) {
  const auto table = parse_toml(toml, file);
  if (!table) return failure(table.error());
  std::vector<TomlSection> out;
  const toml::node* const found = table->get(kind);
  if (found == nullptr) return out;
  const auto wrong = [&](const toml::node& node, const std::string& key) {
    return failure(TextError{std::string(file), node.source().begin.line, key,
                             "must be a section: [" + std::string(kind) + ".NAME]"});
  };
  if (!found->is_table()) return wrong(*found, std::string(kind));
  for (const auto& [key, node] : *found->as_table()) {
    const std::string name(key.str());
    if (!node.is_table()) return wrong(node, std::string(kind) + "." + name);
    out.push_back({node.source().begin.line, name, settings_in(*node.as_table())});
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
