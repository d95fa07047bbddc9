#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "client/app/client.hpp"
#include "client/app/client_display.hpp"
#include "client/app/key_program.hpp"
#include "client/app/local_start.hpp"
#include "client/app/material_list.hpp"
#include "client/app/player_defaults.hpp"
#include "client/app/shell.hpp"
#include "client/display/draw_program.hpp"
#include "client/report/exit_code.hpp"
#include "client/settings/settings_file.hpp"
#include "common/os/program.hpp"
#include "common/os/stop_signals.hpp"
#include "common/os/text_file.hpp"

namespace {

std::atomic<bool> client_runs{false};

/// Ends the process with kExitNoStart. Xlib calls exit(1) on the thread that finds the display
/// lost. For scripts the exit code 1 has another meaning, and exit() would destroy objects that
/// other threads still use.
void end_after_lost_display() {
  if (client_runs) std::_Exit(runstone::kExitNoStart);
}

/// Ends the process as end_after_lost_display() does while it lives.
class LostDisplay {
 public:
  /// exit() calls the newest handler first. This one is registered after the driver has loaded,
  /// because the driver's handler may hang.
  LostDisplay() {
    client_runs = true;
    std::atexit(end_after_lost_display);
  }
  ~LostDisplay() { client_runs = false; }
  LostDisplay(const LostDisplay&) = delete;
  LostDisplay& operator=(const LostDisplay&) = delete;
};

int run_in_window(runstone::ClientOptions options, const volatile std::sig_atomic_t& stop) {
  using namespace runstone;
  const std::string file = default_settings_file();
  LoadedSettings loaded = load_settings(file);
  for (const std::string& warning : loaded.warnings) spdlog::warn("{}", warning);
  apply_settings(loaded.settings, options);
  ClientDisplay display(options);
  display.clipboard = std::make_unique<ClipboardFile>(default_clipboard_file());
  if (const auto loaded_clipboard = display.clipboard->load(display.tools); !loaded_clipboard)
    spdlog::warn("no clipboard: {}", loaded_clipboard.error());
  const LostDisplay lost_display;
  Shell shell(std::move(options), std::move(loaded), file, display);
  return shell.run(stop);
}

int run(runstone::ClientOptions options, const volatile std::sig_atomic_t& stop) {
  using namespace runstone;
  std::optional<Script> script;
  if (!options.script.empty()) {
    const auto text = read_text_file(options.script, kTextFileBytesMax);
    if (!text) {
      std::fprintf(stderr, "%s\n", text.error().c_str());
      return kExitNoStart;
    }
    auto parsed = parse_script(*text, options.script);
    if (!parsed) {
      std::fprintf(stderr, "%s\n", parsed.error().message().c_str());
      return kExitNoStart;
    }
    script = std::move(*parsed);
  }
  if (options.list_materials) return list_materials(options, stop);
  if (options.has_window() && !script) return run_in_window(std::move(options), stop);
  if (!options.local_world.empty()) use_kept_key({}, options);
  std::unique_ptr<LocalServer> local;
  if (!options.local_world.empty()) {
    auto started = start_local_world(options, stop);
    if (!started) throw std::runtime_error(started.error());
    local = *std::move(started);
  }
  ClientDisplay display(options);
  Client client(std::move(options), script ? &*script : nullptr, display);
  const LostDisplay lost_display;
  return client.run(stop).exit_code;
}

int key_program(int argc, const char* const* argv) {
  const auto parsed = runstone::parse_key_command(argc, argv);
  if (!parsed.command) return parsed.exit_code;
  const auto done = runstone::run_key_program(*parsed.command, std::cin, std::cout);
  if (done) return runstone::kExitOk;
  std::fprintf(stderr, "runstone-client key: %s\n", done.error().c_str());
  return runstone::kExitNoStart;
}

int client_program(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "key") return key_program(argc - 1, argv + 1);
  auto parsed = runstone::parse_options(argc, argv);
  if (!parsed.options) return parsed.exit_code;
  if (parsed.options->draw) {
    return runstone::draw_program(STDIN_FILENO, STDOUT_FILENO, parsed.options->workers, [] {
      return runstone::make_screen(runstone::make_headless_context());
    });
  }
  // Standard output is reserved for the table, so log lines go to standard error.
  spdlog::set_default_logger(spdlog::stderr_logger_mt("client"));
  spdlog::set_level(parsed.options->verbose ? spdlog::level::debug : spdlog::level::info);
  const volatile std::sig_atomic_t& stop = runstone::count_stop_signals();
  const int code = run(std::move(*parsed.options), stop);
  spdlog::shutdown();
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  return runstone::run_program("runstone-client", runstone::kExitNoStart,
                               [&] { return client_program(argc, argv); });
}
