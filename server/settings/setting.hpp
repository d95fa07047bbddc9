// Setting: one value of a program's configuration, as text. Values are checked when they are set,
// so a configuration is always valid. Thread: any.
#pragma once
#include <charconv>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "common/core/result.hpp"
#include "server/settings/toml_settings.hpp"

namespace runstone {

template <class Config>
struct Setting {
  std::string name;  // such as "sessions_max"
  std::string help;  // unit and range
  SettingType type = SettingType::text;
  /// Sets the value. Fails and changes nothing if the text is no value: what is wrong with it.
  std::function<Result<void, std::string>(Config& config, const std::string& text)> set;
  /// Returns a text that sets an equal value.
  std::function<std::string(const Config& config)> print;
};

/// A number without an upper limit that a host could reach.
inline constexpr std::uint64_t kNoSettingMax = 1'000'000'000'000'000ULL;

/// A number in min..max. `what` says what is counted.
template <class Config>
Setting<Config> number_setting(std::string name, std::uint64_t Config::* member, std::uint64_t min,
                               std::uint64_t max, const std::string& what) {
  std::string help = what + ", " + std::to_string(min);
  help += max == kNoSettingMax ? " or more" : ".." + std::to_string(max);
  const auto set = [=](Config& config, const std::string& text) -> Result<void, std::string> {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || rest != end) return failure("must be a whole number: " + help);
    if (value < min || value > max) return failure("is out of range: " + help);
    config.*member = value;
    return {};
  };
  return {std::move(name), help, SettingType::number, set,
          [=](const Config& config) { return std::to_string(config.*member); }};
}

/// A text, which may be empty if it is optional.
template <class Config>
Setting<Config> text_setting(std::string name, std::string help, std::string Config::* member,
                             bool is_optional) {
  const auto set = [=](Config& config, const std::string& text) -> Result<void, std::string> {
    if (text.empty() && !is_optional) return failure("must not be empty");
    config.*member = text;
    return {};
  };
  return {std::move(name), std::move(help), SettingType::text, set,
          [=](const Config& config) { return config.*member; }};
}

template <class Config>
Setting<Config> flag_setting(std::string name, std::string help, bool Config::* member) {
  const auto set = [=](Config& config, const std::string& text) -> Result<void, std::string> {
    if (text != "true" && text != "false") return failure("must be true or false: " + help);
    config.*member = text == "true";
    return {};
  };
  return {std::move(name), help, SettingType::flag, set,
          [=](const Config& config) { return std::string(config.*member ? "true" : "false"); }};
}

}  // namespace runstone
