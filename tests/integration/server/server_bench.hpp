// ServerBench: a real server on a free loopback port over a world folder of its own, for integration tests.
#pragma once
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "server/app/logging.hpp"
#include "server/app/server.hpp"

namespace runstone::test {

/// A folder that is gone when the test ends.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "runstone-server-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline ServerConfig quiet_config(const std::string& world) {
  start_logging("error");
  ServerConfig config;
  config.world = world;
  config.listen = "127.0.0.1:0";
  config.log_level = "error";
  return config;
}

inline WorldCreation flat_creation() {
  WorldCreation creation;
  creation.generator = "flat";
  creation.edge = 16;
  return creation;
}

/// Requires the start to succeed.
inline std::unique_ptr<Server> start_server(const ServerConfig& config, const WorldCreation& creation) {
  auto server = Server::start(config, creation);
  INFO((server ? std::string() : server.error()));
  REQUIRE(server.has_value());
  return *std::move(server);
}

}  // namespace runstone::test
