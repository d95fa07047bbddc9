#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "client/app/client.hpp"
#include "client/display/draw_program.hpp"
#include "common/os/stop_signals.hpp"

namespace {

std::atomic<bool> client_runs{false};

/// Xlib calls exit(1) on whatever thread finds the display gone. To scripts 1 means something else, and other
/// threads still use what exit() would go on to destroy.
void correct_exit() {
  if (client_runs) std::_Exit(runstone::kExitNoStart);
}

int run(runstone::ClientOptions options, const volatile std::sig_atomic_t& stop) {
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
  client_runs = true;
  std::atexit(
      correct_exit);  // after the driver is loaded: the newest comes first, and the driver's may hang
  const int code = client.run(stop);
  client_runs = false;
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  auto parsed = runstone::parse_options(argc, argv);
  if (!parsed.options) return parsed.exit_code;
  if (parsed.options->draw) {
    return runstone::draw_program(STDIN_FILENO, STDOUT_FILENO, parsed.options->workers,
                                  runstone::make_headless_screen);
  }
  // Standard output is for the table.
  spdlog::set_default_logger(spdlog::stderr_logger_mt("client"));
  spdlog::set_level(parsed.options->verbose ? spdlog::level::debug : spdlog::level::info);
  const volatile std::sig_atomic_t& stop = runstone::count_stop_signals();
  int code = runstone::kExitNoStart;
  try {
    code = run(std::move(*parsed.options), stop);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "runstone-client: %s\n", error.what());
  }
  spdlog::shutdown();
  return code;
}
