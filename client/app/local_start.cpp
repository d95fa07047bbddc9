#include "client/app/local_start.hpp"

#include <chrono>
#include <exception>
#include <thread>

#include "client/local/local_worlds.hpp"
#include "client/net/key_file.hpp"

namespace runstone {

Result<LocalServerConfig, std::string> local_server_config(const std::string& name,
                                                           const NewLocalWorld& creation,
                                                           const std::string& key_file) {
  if (const auto named = check_world_name(name); !named) return failure(named.error());
  const std::string worlds = local_worlds_folder();
  if (worlds.empty())
    return failure("no place for local worlds: neither XDG_DATA_HOME nor HOME names a folder");
  LocalServerConfig config;
  config.folder = worlds + "/" + name;
  config.creation = creation;
  try {
    config.player = load_or_create_key(key_file).public_key;
  } catch (const std::exception& error) {
    return failure(error.what());
  }
  return config;
}

Result<std::unique_ptr<LocalServer>, std::string> start_local_world(
    ClientOptions& options, const volatile std::sig_atomic_t& stop) {
  const auto config =
      local_server_config(options.local_world, options.local_creation, options.key_file);
  if (!config) return failure(config.error());
  auto server = LocalServer::start(*config);
  if (!server) return failure(server.error());
  while ((*server)->poll() == LocalServer::State::starting) {
    if (stop != 0) return failure("interrupted");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if ((*server)->poll() == LocalServer::State::ended) return failure((*server)->failure_text());
  options.server = {"127.0.0.1", (*server)->port()};
  return server;
}

}  // namespace runstone
