// runstone-server: runs a world, imports, compacts, backs up, packs, restores or repairs one, or
// gives a running server a command.
// Exit codes: 0 stopped, and every edit is in the log (control: the command succeeded), 1 failed
// while running, 2 could not start, 3 control: the command is in force and not on disk yet
// (docs/server-reference.md).
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/signal_set.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "common/os/open_files.hpp"
#include "common/os/output_file.hpp"
#include "common/os/program.hpp"
#include "common/os/text_file.hpp"
#include "common/runs/dense.hpp"
#include "server/admin/console.hpp"
#include "server/app/backup_child.hpp"
#include "server/app/backup_schedule.hpp"
#include "server/app/first_invite.hpp"
#include "server/app/input_end.hpp"
#include "server/app/new_world.hpp"
#include "server/app/server.hpp"
#include "server/app/server_options.hpp"
#include "server/app/standby.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/view_memory.hpp"

namespace runstone {
namespace {

enum ExitCode { kStopped = 0, kFailed = 1, kCannotStart = 2, kUnsaved = 3 };

int cannot_start(const std::string& line) {
  std::cerr << "runstone-server: " << line << "\n";
  return kCannotStart;
}

Result<ServerConfig, std::string> read_config(const ServerOptions& options) {
  ServerConfig config;
  if (!options.config_file.empty()) {
    const auto toml = read_text_file(options.config_file, kTextFileBytesMax);
    if (!toml) return failure(toml.error());
    const auto read = read_config_toml(config, *toml, options.config_file);
    if (!read) return failure(read.error().message());
  }
  const auto environment = read_config_environment(config, program_environment());
  if (!environment) return failure(environment.error());
  for (const auto& [field, text] : options.settings) {
    const auto set = set_config(config, field, text);
    if (!set) return failure(flag_name(field) + ": " + set.error());
  }
  return config;
}

/// Raises the limit of open files: a socket for each session and each connection in the handshake,
/// the world's files, and a reserve.
void allow_files_for(const ServerConfig& config) {
  const std::size_t needed = config.sessions_max + 256;
  const std::size_t allowed = allow_open_files(needed);
  if (allowed >= needed) return;
  logger("app").warn(
      "sessions_max={} needs {} open files, and the hard limit is {}: see ulimit -Hn",
      config.sessions_max, needed, allowed);
}

/// The signals that end the loop, and those that log the counters and read the settings again. It is
/// made before the server starts, so that a signal during the start is handled afterwards; the first
/// process of a container would otherwise ignore it.
class Signals {
 public:
  explicit Signals(asio::io_context& loop)
      : loop_(loop),
        stop_(loop, SIGINT, SIGTERM),
        counters_(loop, SIGUSR1),
        reload_(loop, SIGHUP) {}

  /// Waits. Returns true at once if a signal to stop comes.
  bool stops_within(std::chrono::milliseconds time) {
    bool stops = false;
    asio::steady_timer timer(loop_, time);
    stop_.async_wait([&](const asio::error_code& error, int /*signal*/) {
      stops = !error;
      timer.cancel();
    });
    timer.async_wait([&](const asio::error_code& /*error*/) { stop_.cancel(); });
    loop_.restart();
    loop_.run();
    loop_.restart();
    return stops;
  }

  /// Runs until a signal comes or the failure callback stops the loop.
  void wait_for_the_end(Server& server, const std::function<void()>& reload) {
    stop_.async_wait([this](const asio::error_code& error, int /*signal*/) {
      if (!error) loop_.stop();
    });
    wait_for_counters(server);
    wait_for_reload(reload);
    loop_.run();
    // The signals get their default effect again, so a second one ends the process at once.
    stop_.clear();
    counters_.clear();
    reload_.clear();
  }

 private:
  void wait_for_counters(Server& server) {
    counters_.async_wait([this, &server](const asio::error_code& error, int /*signal*/) {
      if (error) return;
      server.log_counters();
      wait_for_counters(server);
    });
  }

  void wait_for_reload(const std::function<void()>& reload) {
    reload_.async_wait([this, &reload](const asio::error_code& error, int /*signal*/) {
      if (error) return;
      reload();
      wait_for_reload(reload);
    });
  }

  asio::io_context& loop_;
  asio::signal_set stop_, counters_, reload_;
};

/// Logs what the operator must know about a stop that left something undone.
void log_stop(const StopReport& report, const ServerConfig& config) {
  if (report.state.lost_edits > 0) {
    logger("store").error(
        "EDITS ARE LOST: lost_edits={} were accepted and could not be written; clients that keep "
        "them offer them again",
        report.state.lost_edits);
  } else if (report.hands_over) {
    logger("app").info("every edit is in the log, and the next owner takes them from there");
  } else if (report.state.chunks_left > 0) {
    logger("store").warn(
        "chunks_left={} after stop_s={}: every edit is in the log, and the next start takes their "
        "edits from there",
        report.state.chunks_left, config.stop_s);
  } else if (!report.is_summed) {
    logger("store").warn("stop_s={} was too short to compute the world digest", config.stop_s);
  }
  if (!report.error.empty()) logger("store").error("{}", report.error);
}

/// Prints a line of a server that runs. Standard output may be gone by now, such as a pipe whose
/// reader has ended. This does not make the server fail. Returns true if the line is written.
bool print_line(const std::string& line) {
  std::cout << line << "\n";
  const auto written = flush_standard_output();
  if (!written) logger("app").warn("{}", written.error());
  return written.has_value();
}

/// Prints the link for the first administrator, but not into a journal, which others may read.
void welcome_administrator(Server& server) {
  if (is_journal(STDOUT_FILENO) || !print_line(make_first_invite(server)))
    logger("app").info("this world has no administrator: control invite role administrator");
}

int run(const ServerOptions& options) {
  const auto config = read_config(options);
  if (!config) return cannot_start(config.error());
  if (options.print_config) {
    std::cout << to_toml(*config);
    return kStopped;
  }
  if (config->standby) {
    if (config->store.empty())
      return cannot_start("standby: only a world in a database can be taken over, see `store`");
    if (options.stop_with_input) {
      return cannot_start(
          "standby: a server that waits does not watch its input: leave --stop-with-input out");
    }
    if (const auto can = Server::can_start(*config); !can) return cannot_start(can.error());
  }
  if (const auto allowed = allow_new_world(world_place(*config), options.create); !allowed) {
    return cannot_start(allowed.error());
  }
  const auto plan = backup_plan_of(*config);
  if (!plan) return cannot_start(plan.error());
  start_logging(config->log_level, config->log_format);
  if (!options.port_file.empty()) {  // before the world is opened
    if (const auto written = empty_output_file(options.port_file); !written) {
      return cannot_start(written.error());
    }
  }
  allow_files_for(*config);
  if (const auto warning = view_memory_warning(*config)) logger("app").warn("{}", *warning);
  asio::io_context main_loop;
  Signals signals(main_loop);
  const auto end = [&] { asio::post(main_loop, [&main_loop] { main_loop.stop(); }); };
  std::optional<BackupSchedule> schedule;  // outlives the server, whose commands ask for its state
  std::unique_ptr<Server> running;
  std::optional<TakeoverWatch> watch;
  BackupChild backup(config->world);
  OperatorActions actions;
  actions.stop = end;
  actions.reload = [&](CommandReply reply) {
    asio::post(main_loop, [&running, &options, reply = std::move(reply)]() mutable {
      if (running) running->reload(read_config(options), std::move(reply));
    });
  };
  actions.back_up = [&](const std::string& folder, CommandReply reply) {
    if (!config->store.empty())
      return refuse(reply, "the world is in PostgreSQL: back it up with pg_dump");
    backup.start(folder, std::move(reply));
  };
  if (*plan) {
    schedule.emplace(**plan);
    actions.backup_state = [&schedule] { return schedule->state(); };
  }
  actions.hand_over = [&](std::optional<SessionId> successor, CommandReply reply) {
    asio::post(main_loop, [&, successor, reply = std::move(reply)] {
      if (!running) return refuse(reply, "the server starts");
      if (!hand_over_and_watch(config->store, *running, watch, end, successor, reply))
        main_loop.stop();
    });
  };
  const auto start = [&] {
    return Server::start(*config, options.creation, end, actions, options.accept_losses);
  };
  const auto stops_within = [&](std::chrono::milliseconds time) {
    return signals.stops_within(time);
  };
  const auto follow = [&] { return Server::follow(*config, end, actions); };
  auto server =
      config->standby ? start_as_standby(config->store, stops_within, start, follow) : start();
  if (!server) return cannot_start(server.error());
  if (*server == nullptr) return kStopped;
  running = *std::move(server);
  if (!owns(running->ownership())) watch.emplace(config->store, *running, end);
  if (running->is_unclaimed() && config->operators.empty()) welcome_administrator(*running);
  std::unique_ptr<InputEnd> input;
  if (options.stop_with_input) {
    auto watched = InputEnd::watch(main_loop, end);
    if (!watched) return cannot_start(watched.error());
    input = *std::move(watched);
  }
  std::shared_ptr<Console> console;
  if (options.console || (!input && ::isatty(STDIN_FILENO) == 1)) {
    const auto run_line = [&running](const std::string& line, CommandReply reply) {
      running->command(line, std::move(reply));
    };
    auto opened = Console::open(main_loop, run_line, [](const std::string& failure) {
      logger("app").error("{}", failure);
    });
    if (opened) console = *opened;
    if (!opened) logger("app").error("{}", opened.error());
  }
  if (!options.port_file.empty()) {
    const auto written =
        write_output_file(options.port_file, std::to_string(running->port()) + "\n");
    if (!written) return cannot_start(written.error());
  }
  if (schedule) schedule->start();
  signals.wait_for_the_end(*running, [&] {
    running->reload(read_config(options), [](const CommandAnswer& /*the log has it*/) {});
  });
  watch.reset();
  // The world is stopped before anything waits for a backup, whose disk may hang.
  backup.ask_to_stop();
  if (schedule) schedule->ask_to_stop();
  if (console) console->close();
  logger("app").info("stopping");
  const OwnershipState part = running->ownership();
  const StopReport report = running->stop();
  if (!owns(part)) {
    print_line(has_failed(part) ? "stopped, because the server could not go on: see the log"
                                : "stopped, and another server owns the world");
    return has_failed(part) ? kFailed : kStopped;
  }
  log_stop(report, *config);
  backup.stop();
  if (schedule) schedule->stop();
  bool is_written = true;
  if (!options.digests_file.empty()) {
    const auto written = write_digests_json(options.digests_file, report.digests);
    is_written = written.has_value();
    if (!is_written) logger("app").error("{}", written.error());
  }
  print_line(stop_line(report) + " dense expansions: " + std::to_string(dense_expansions()));
  return report.state.is_durable() && report.error.empty() && is_written ? kStopped : kFailed;
}

/// Ends the process in any thread, as a power failure would: durable edits stay. It may not allocate.
[[noreturn]] void end_without_memory() {
  constexpr std::string_view kLine =
      "runstone-server: out of memory: the process ends; durable edits are safe\n";
  static_cast<void>(!::write(STDERR_FILENO, kLine.data(), kLine.size()));
  std::_Exit(kFailed);
}

int server_program(int argc, char** argv) {
  const auto [options, exit_code] = parse_server_options(argc, argv);
  if (!options) return exit_code;
  const auto exit_code_of = [](const Result<void, std::string>& done) {
    return done ? static_cast<int>(kStopped) : cannot_start(done.error());
  };
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const TimeUs now_us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  if (options->compact) return exit_code_of(compact_world(*options->compact, now_us, std::cout));
  if (options->copy) return exit_code_of(copy_between(*options->copy, std::cout));
  if (options->backup_folder)
    return exit_code_of(run_backup_folder(*options->backup_folder, now_us, std::cout));
  if (options->backup) return exit_code_of(back_up(*options->backup, now_us, std::cout));
  if (options->pack) return exit_code_of(pack_world(*options->pack, now_us, std::cout));
  if (options->restore) return exit_code_of(restore(*options->restore, now_us, std::cout));
  if (options->repair) return exit_code_of(repair(*options->repair, now_us, std::cout));
  if (options->control) {
    const auto done = control_server(*options->control, std::cout);
    if (!done) return cannot_start(done.error());
    return *done == ControlEnd::done ? kStopped : *done == ControlEnd::unsaved ? kUnsaved : kFailed;
  }
  if (!options->import) return run(*options);
  return exit_code_of(import_world(*options->import, std::cout));
}

}  // namespace
}  // namespace runstone

int main(int argc, char** argv) {
  std::set_new_handler(runstone::end_without_memory);
  return runstone::run_program("runstone-server", runstone::kCannotStart, [&] {
    const int code = runstone::server_program(argc, argv);
    spdlog::shutdown();  // writes the queued lines
    return code;
  });
}
