#include "common/os/user_folders.hpp"

#include <array>
#include <cstddef>
#include <cstdlib>

namespace runstone {
namespace {

struct Place {
  const char* variable;
  const char* below_home;
};
constexpr std::array<Place, 4> kPlaces = {{{"XDG_CONFIG_HOME", "/.config"},
                                           {"XDG_DATA_HOME", "/.local/share"},
                                           {"XDG_STATE_HOME", "/.local/state"},
                                           {"XDG_CACHE_HOME", "/.cache"}}};

/// Returns the variable's value if it is an absolute path, otherwise an empty text.
std::string absolute_path_in(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && value[0] == '/' ? value : "";
}

}  // namespace

std::string user_folder(UserFolder kind) {
  const auto& [variable, below_home] = kPlaces.at(static_cast<std::size_t>(kind));
  if (const std::string named = absolute_path_in(variable); !named.empty())
    return named + "/runstone";
  const std::string home = absolute_path_in("HOME");
  return home.empty() ? "" : home + below_home + "/runstone";
}

}  // namespace runstone
