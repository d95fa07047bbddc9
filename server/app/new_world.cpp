#include "server/app/new_world.hpp"

#include <filesystem>

#include "server/admin/server_config.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

/// Returns one spelling for "world", "./world" and "world/".
std::filesystem::path canonical(const std::string& folder) {
  return (std::filesystem::path(folder) / "").lexically_normal();
}

}  // namespace

Result<void, std::string> allow_new_world(const std::string& place, bool create) {
  if (create || has_world(place)) return {};
  if (canonical(place) == canonical(ServerConfig{}.world)) return {};
  return failure(place_name(place) + ": holds no world; --create makes a new one there");
}

}  // namespace runstone
