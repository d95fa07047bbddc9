#include "server/settings/setting_names.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

namespace runstone {

std::string flag_name(const std::string& setting) {
  std::string out = "--" + setting;
  std::replace(out.begin(), out.end(), '_', '-');
  return out;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

void add_setting_flags(CLI::App& app, const std::vector<SettingField>& settings,
                       std::map<std::string, std::string>& texts) {
  for (const SettingField& setting : settings) {
    CLI::Option* const flag = app.add_option_function<std::string>(
        flag_name(setting.name),
        [&texts, &setting](const std::string& text) {
          texts[setting.name] = setting.is_flag && text.empty() ? "true" : text;
        },
        setting.help);
    flag->group("Settings");
    if (setting.is_flag) flag->expected(0, 1);
  }
}

}  // namespace runstone
