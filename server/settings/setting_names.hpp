// The names of settings: their flags on a command line, and their variables in the environment.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace runstone {

struct SettingField {
  std::string name, help;
  bool is_flag = false;  // true or false
};

/// The values of the environment by variable.
using Environment = std::map<std::string, std::string>;
/// Returns the environment of this program. Thread: any, while none changes the environment.
Environment program_environment();

/// Returns true if a variable is none of a setting, although it begins as one: it is of another
/// program or of the tests of this project, or container software sets it for a service with such a
/// name.
bool is_foreign_variable(std::string_view name, std::string_view value);

/// Returns the flag of a setting: "--sessions-max" for "sessions_max".
std::string flag_name(const std::string& setting);
std::string upper_case(std::string text);

/// Adds a flag for each setting. Parsing writes the texts of the given ones to `texts`, by setting;
/// a flag without a value is "true". `settings` and `texts` must outlive the parsing.
void add_setting_flags(CLI::App& app, const std::vector<SettingField>& settings,
                       std::map<std::string, std::string>& texts);

/// Returns "; did you mean FLAG?" for an argument that the program does not know, or an empty text
/// if no flag is near. A value behind '=' does not matter.
std::string nearest_flag(const CLI::App& app, std::string_view argument);

}  // namespace runstone
