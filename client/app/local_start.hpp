// Local start: the option --local starts a server for a world on this computer before the client
// connects.
#pragma once
#include <csignal>
#include <memory>
#include <string>

#include "client/app/options.hpp"
#include "client/local/local_server.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Returns the configuration of the server for the local world `name`, which is made by `creation`
/// if there is none. The player is the key of `key_file`, which is created if missing. Fails with a
/// line of text if the name or the key file cannot be used.
Result<LocalServerConfig, std::string> local_server_config(const std::string& name,
                                                           const NewLocalWorld& creation,
                                                           const std::string& key_file);

/// Starts the server of options.local_world, waits until it listens, and sets the address and the
/// key file in the options. Fails with a line of text if the server ends before it listens, or on
/// `stop`.
Result<std::unique_ptr<LocalServer>, std::string> start_local_world(
    ClientOptions& options, const volatile std::sig_atomic_t& stop);

}  // namespace runstone
