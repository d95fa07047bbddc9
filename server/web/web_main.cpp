// runstone-web: a gateway for browsers in front of servers on the same machine. SIGHUP reads the
// certificate again.
// Exit codes: 0 stopped by SIGINT or SIGTERM, 2 could not start (docs/server-reference.md).
#include <signal.h>

#include <exception>
#include <iostream>
#include <string>

#include "common/os/open_files.hpp"
#include "common/os/output_file.hpp"
#include "common/os/program.hpp"
#include "common/os/text_file.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_gateway.hpp"
#include "server/web/web_log.hpp"
#include "server/web/web_options.hpp"

namespace runstone {
namespace {

enum ExitCode { kStopped = 0, kCannotStart = 2 };

int cannot_start(const std::string& line) {
  log_web_line(line);
  return kCannotStart;
}

Result<WebConfig, std::string> read_config(const WebOptions& options) {
  WebConfig config;
  if (!options.config_file.empty()) {
    const auto toml = read_text_file(options.config_file, kTextFileBytesMax);
    if (!toml) return failure(toml.error());
    const auto read = read_web_toml(config, *toml, options.config_file);
    if (!read) return failure(read.error().message());
  }
  const auto environment = web_settings().read_environment(config, program_environment());
  if (!environment) return failure(environment.error());
  for (const auto& [field, text] : options.settings) {
    const auto set = web_settings().set(config, field, text);
    if (!set) return failure(flag_name(field) + ": " + set.error());
  }
  if (const auto checked = check_servers(config); !checked) return failure(checked.error());
  return config;
}

/// Raises the limit of open files: two sockets for each connection, and a reserve. If the hard limit
/// is lower, it lowers sockets_max, so that every connection that is accepted can reach its server.
Result<void, std::string> allow_files_for(WebConfig& config) {
  const std::size_t reserve = 64 + 16 * config.servers.size();
  const std::size_t needed = 2 * config.sockets_max + reserve;
  const std::size_t allowed = allow_open_files(needed);
  if (allowed >= needed) return {};
  const std::string why = "sockets_max=" + std::to_string(config.sockets_max) + " needs " +
                          std::to_string(needed) + " open files, and the hard limit is " +
                          std::to_string(allowed);
  if (allowed < reserve + 2) return failure(why + ": see ulimit -Hn");
  config.sockets_max = (allowed - reserve) / 2;
  log_web_line(why + ": sockets_max is " + std::to_string(config.sockets_max) +
               " instead, see ulimit -Hn");
  return {};
}

std::string socket_names(const WebConfig& config) {
  std::string out = config.servers.empty() ? config.gateway_socket : "";
  for (const WebServer& server : config.servers)
    out += (out.empty() ? "" : ",") + server.gateway_socket;
  return out;
}

int web_program(int argc, char** argv) {
  const auto [options, exit_code] = parse_web_options(argc, argv);
  if (!options) return exit_code;
  auto config = read_config(*options);
  if (!config) return cannot_start(config.error());
  if (options->print_config) {
    std::cout << to_web_toml(*config);
    return kStopped;
  }
  if (const auto allowed = allow_files_for(*config); !allowed) return cannot_start(allowed.error());
  // The threads inherit the mask, so the signals wait for sigwait().
  sigset_t stops;
  sigemptyset(&stops);
  sigaddset(&stops, SIGINT);
  sigaddset(&stops, SIGTERM);
  sigaddset(&stops, SIGHUP);
  ::pthread_sigmask(SIG_BLOCK, &stops, nullptr);
  const auto gateway = WebGateway::start(*config);
  if (!gateway) return cannot_start(gateway.error());
  const std::uint16_t port = (*gateway)->port();
  if (!options->port_file.empty()) {
    const auto written = write_output_file(options->port_file, std::to_string(port) + "\n");
    if (!written) return cannot_start(written.error());
  }
  log_web_line("listening port=" + std::to_string(port) + " encryption=" +
               ((*gateway)->is_encrypted() ? "tls" : "none") + " server=" + socket_names(*config));
  int signal = SIGHUP;
  for (;;) {
    ::sigwait(&stops, &signal);
    if (signal != SIGHUP) break;
    (*gateway)->reload_certificate();
  }
  ::pthread_sigmask(SIG_UNBLOCK, &stops, nullptr);  // a second signal ends the process at once
  log_web_line("stopping");
  return kStopped;
}

}  // namespace
}  // namespace runstone

int main(int argc, char** argv) {
  return runstone::run_program("runstone-web", runstone::kCannotStart,
                               [&] { return runstone::web_program(argc, argv); });
}
