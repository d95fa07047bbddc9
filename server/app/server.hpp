// Server: a whole Runstone server in this process: world folder, threads, sockets. The program runs one;
// tests run several. Needs start_logging().
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "server/admin/server_config.hpp"
#include "server/app/digest_list.hpp"
#include "server/app/world_folder.hpp"

namespace runstone {

/// What a server leaves behind.
struct StopReport {
  bool is_clean = false;  // everything ordered is on disk, in the log and in snapshots
  Digest world_digest;    // over all edited chunks
  DigestList digests;     // of them
  std::string error;      // first row that could not be read while summing up; empty if none
};

class Server {
 public:
  /// Opens or makes the world, binds, recovers, and runs. The error is one line for the operator; nothing was
  /// overwritten. `on_failure` is called once, from another thread, if the log cannot be written any more:
  /// the caller then stops the server.
  static Result<std::unique_ptr<Server>, std::string> start(
      const ServerConfig& config, const WorldCreation& creation, std::function<void()> on_failure = [] {});
  /// stop(), if nobody did.
  ~Server();

  std::uint16_t port() const;
  void log_counters();
  /// Goodbyes, drains the log, writes all snapshots, ends all threads. Blocks. Once.
  StopReport stop();

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone
