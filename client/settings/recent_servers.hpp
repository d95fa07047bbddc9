// RecentServers: the servers that a player joined, newest first, and their text form in TOML.
// The functions on files wait for the disk.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct RecentServer {
  std::string address;   // HOST:PORT, as parse_host_port() reads it
  std::string world;     // id of the world in hex
  std::string name;      // of the player there
  TimeUs joined_us = 0;  // UTC, of the last join
  friend bool operator==(const RecentServer&, const RecentServer&) = default;
};

/// The number of servers that are kept: those that were joined last.
inline constexpr std::size_t kRecentServersMax = 16;

/// Puts a server at the front. It replaces the entry of the same address.
void add_recent(std::vector<RecentServer>& servers, RecentServer server);

std::string to_toml(const std::vector<RecentServer>& servers);
/// Fails with the line and the reason if the text is not TOML. Entries with a missing or wrong
/// field are left out.
Result<std::vector<RecentServer>, std::string> read_recent_servers(std::string_view toml);

/// Returns $XDG_STATE_HOME/runstone/servers.toml, otherwise the one in ~/.local/state, or an empty
/// text if neither variable is an absolute path.
std::string default_servers_file();

struct LoadedServers {
  std::vector<RecentServer> servers;
  std::string warning;  // empty: none
};
/// Reads the file. A missing file gives no servers. A broken file is renamed to FILE.broken, which
/// the warning says.
LoadedServers load_recent_servers(const std::string& file);
/// Reads the file, puts the server at the front and replaces the file. Fails with a line that
/// begins with the file's name.
Result<void, std::string> save_recent_server(const std::string& file, RecentServer server);

}  // namespace runstone
