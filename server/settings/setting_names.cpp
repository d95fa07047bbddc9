#include "server/settings/setting_names.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>

#include "common/core/nearest_name.hpp"

namespace runstone {
namespace {

// Programs that another one starts, and variables of tests and scripts.
constexpr std::array<std::string_view, 9> kForeignVariables = {
    "RUNSTONE_BENCH",      "RUNSTONE_BIN",    "RUNSTONE_BOT",
    "RUNSTONE_CLIENT",     "RUNSTONE_LEVELS", "RUNSTONE_PICTURES",
    "RUNSTONE_READ_MODEL", "RUNSTONE_SERVER", "RUNSTONE_WEB"};
constexpr std::string_view kTestPrefix = "RUNSTONE_TEST_";

/// Returns true for the variables that Kubernetes and Docker set for a service, such as
/// RUNSTONE_SERVICE_HOST, RUNSTONE_PORT=tcp://... and RUNSTONE_PORT_4747_TCP_ADDR for the service
/// "runstone".
bool is_of_service(std::string_view name, std::string_view value) {
  if (name.ends_with("_SERVICE_HOST") || name.find("_SERVICE_PORT") != std::string_view::npos)
    return true;
  if (name.ends_with("_PORT")) return value.find("://") != std::string_view::npos;
  constexpr std::string_view kPort = "_PORT_";
  const std::size_t port = name.find(kPort);
  if (port == std::string_view::npos) return false;
  const std::string_view rest = name.substr(port + kPort.size());
  const std::size_t digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
  const std::string_view protocol = rest.substr(digits);
  return digits > 0 && (protocol.starts_with("_TCP") || protocol.starts_with("_UDP"));
}

}  // namespace

Environment program_environment() {
  Environment out;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) continue;
    out.emplace(text.substr(0, equals), text.substr(equals + 1));
  }
  return out;
}

bool is_foreign_variable(std::string_view name, std::string_view value) {
  return std::find(kForeignVariables.begin(), kForeignVariables.end(), name) !=
             kForeignVariables.end() ||
         name.starts_with(kTestPrefix) || is_of_service(name, value);
}

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

std::string nearest_flag(const CLI::App& app, std::string_view argument) {
  if (!argument.starts_with("-")) return {};
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return did_you_mean(argument.substr(0, argument.find('=')), names);
}

}  // namespace runstone
