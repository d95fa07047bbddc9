// The names of settings, and their flags on a command line. Thread: any.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace runstone {

struct SettingField {
  std::string name, help;
  bool is_flag = false;  // true or false
};

/// Returns the flag of a setting: "--sessions-max" for "sessions_max".
std::string flag_name(const std::string& setting);
std::string upper_case(std::string text);

/// Adds a flag for each setting. Parsing writes the texts of the given ones to `texts`, by setting;
/// a flag without a value is "true". `settings` and `texts` must outlive the parsing.
void add_setting_flags(CLI::App& app, const std::vector<SettingField>& settings,
                       std::map<std::string, std::string>& texts);

}  // namespace runstone
