#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "client/app/client.hpp"

namespace {

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int) { stop_requested = 1; }

int run(runstone::ClientOptions options) {
  using namespace runstone;
  std::optional<Script> script;
  if (!options.script.empty()) {
    std::ifstream in(options.script, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    auto parsed = parse_script(text, options.script);
    if (!parsed) {
      std::fprintf(stderr, "%s\n", parsed.error().message().c_str());
      return kExitNoStart;
    }
    script = std::move(*parsed);
  }
  Client client(std::move(options), script ? &*script : nullptr);
  return client.run(stop_requested);
}

}  // namespace

int main(int argc, char** argv) {
  auto parsed = runstone::parse_options(argc, argv);
  if (!parsed.options) return parsed.exit_code;
  // Standard output is for the table.
  spdlog::set_default_logger(spdlog::stderr_logger_mt("client"));
  spdlog::set_level(parsed.options->verbose ? spdlog::level::debug : spdlog::level::info);
  struct sigaction action{};
  action.sa_handler = request_stop;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  int code = runstone::kExitNoStart;
  try {
    code = run(std::move(*parsed.options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "runstone-client: %s\n", error.what());
  }
  spdlog::shutdown();
  return code;
}
