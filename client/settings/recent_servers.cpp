#include "client/settings/recent_servers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "client/settings/toml_rows.hpp"
#include "client/settings/toml_text.hpp"
#include "common/os/private_file.hpp"
#include "common/os/text_file.hpp"
#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

constexpr std::size_t kServersBytesMax = 1 << 16;
constexpr std::size_t kServerTextBytesMax = 512;

std::optional<RecentServer> read_row(const toml::table& row) {
  auto address = line_of(row.get("address"), kServerTextBytesMax);
  auto world = line_of(row.get("world"), kServerTextBytesMax);
  auto name = line_of(row.get("name"), kServerTextBytesMax);
  const auto joined_us = row["joined_us"].value<std::int64_t>();
  if (!address || address->empty() || !world || !name || !joined_us) return std::nullopt;
  return RecentServer{*std::move(address), *std::move(world), *std::move(name), *joined_us};
}

}  // namespace

void add_recent(std::vector<RecentServer>& servers, RecentServer server) {
  std::erase_if(servers, [&](const RecentServer& s) { return s.address == server.address; });
  servers.insert(servers.begin(), std::move(server));
  if (servers.size() > kRecentServersMax) servers.resize(kRecentServersMax);
}

std::string to_toml(const std::vector<RecentServer>& servers) {
  std::string out = "# The servers that runstone-client joined, newest first.\n";
  for (const RecentServer& s : servers) {
    out +=
        fmt::format("\n[[server]]\naddress = {}\nworld = {}\nname = {}\njoined_us = {}\n",
                    toml_string(s.address), toml_string(s.world), toml_string(s.name), s.joined_us);
  }
  return out;
}

Result<std::vector<RecentServer>, std::string> read_recent_servers(std::string_view toml) {
  std::vector<RecentServer> out;
  const auto read = each_toml_row(toml, "server", [&](const toml::table& row) {
    if (out.size() == kRecentServersMax) return;
    if (auto server = read_row(row)) out.push_back(*std::move(server));
  });
  if (!read) return failure(read.error());
  return out;
}

std::string default_servers_file() {
  const std::string folder = user_folder(UserFolder::state);
  return folder.empty() ? "" : folder + "/servers.toml";
}

LoadedServers load_recent_servers(const std::string& file) {
  LoadedServers out;
  std::error_code error;
  if (file.empty() || (!std::filesystem::exists(file, error) && !error)) return out;
  const auto text = read_text_file(file, kServersBytesMax);
  if (!text) {
    out.warning = text.error();
    return out;
  }
  auto servers = read_recent_servers(*text);
  if (servers) {
    out.servers = *std::move(servers);
    return out;
  }
  const std::string kept = set_aside(file);
  out.warning = file + ":" + servers.error() + "; the list of servers is empty now" +
                (kept.empty() ? "" : ", and the broken file is kept as " + kept);
  return out;
}

Result<void, std::string> save_recent_server(const std::string& file, RecentServer server) {
  if (file.empty())
    return failure("servers are not listed: neither XDG_STATE_HOME nor HOME names a folder");
  std::vector<RecentServer> servers = load_recent_servers(file).servers;
  add_recent(servers, std::move(server));
  return write_private_file(file, to_toml(servers));
}

}  // namespace runstone
