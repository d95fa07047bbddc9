// runstone-server: runs a world, or imports one. Exit codes: 0 stopped cleanly, 1 failed while running,
// 2 could not start (docs/server.md).
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/signal_set.hpp>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include "common/runs/dense.hpp"
#include "server/app/import_program.hpp"
#include "server/app/logging.hpp"
#include "server/app/server.hpp"

namespace runstone {
namespace {

enum ExitCode { kStopped = 0, kFailed = 1, kCannotStart = 2 };

struct Arguments {
  std::map<std::string, std::string> settings;  // by field, as given
  std::string config_file, port_file, digests_file;
  bool print_config = false;
  WorldCreation creation;
  ImportRequest import;
};

int cannot_start(const std::string& line) {
  std::cerr << "runstone-server: " << line << "\n";
  return kCannotStart;
}

Result<ServerConfig, std::string> read_config(const Arguments& arguments) {
  ServerConfig config;
  if (!arguments.config_file.empty()) {
    std::ifstream in(arguments.config_file, std::ios::binary);
    if (!in) return Unexpected<std::string>{arguments.config_file + ": cannot be read"};
    const std::string toml((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const auto read = read_config_toml(config, toml, arguments.config_file);
    if (!read) return Unexpected<std::string>{read.error().message()};
  }
  const auto look_up = [](const std::string& name) -> std::optional<std::string> {
    const char* text = std::getenv(name.c_str());
    if (text == nullptr) return std::nullopt;
    return text;
  };
  const auto environment = read_config_environment(config, look_up);
  if (!environment) return Unexpected<std::string>{environment.error()};
  for (const auto& [field, text] : arguments.settings) {
    const auto set = set_config(config, field, text);
    if (!set) return Unexpected<std::string>{flag_name(field) + ": " + set.error()};
  }
  return config;
}

/// Runs until a signal comes or the failure callback stops the loop.
void wait_for_the_end(asio::io_context& main_loop, Server& server) {
  asio::signal_set stop(main_loop, SIGINT, SIGTERM);
  stop.async_wait([&](const asio::error_code& error, int /*signal*/) {
    if (!error) main_loop.stop();
  });
  asio::signal_set counters(main_loop, SIGUSR1);
  std::function<void()> wait_for_counters = [&] {
    counters.async_wait([&](const asio::error_code& error, int /*signal*/) {
      if (error) return;
      server.log_counters();
      wait_for_counters();
    });
  };
  wait_for_counters();
  main_loop.run();
  // The signals have their default effect again: a second one ends the process at once.
}

int run(const Arguments& arguments) {
  const auto config = read_config(arguments);
  if (!config) return cannot_start(config.error());
  if (arguments.print_config) {
    std::cout << to_toml(*config);
    return kStopped;
  }
  start_logging(config->log_level);
  if (!arguments.port_file.empty()) {  // before the world is touched
    if (const auto written = write_text_file(arguments.port_file, ""); !written) {
      return cannot_start(written.error().message());
    }
  }
  asio::io_context main_loop;
  auto server = Server::start(*config, arguments.creation,
                              [&] { asio::post(main_loop, [&main_loop] { main_loop.stop(); }); });
  if (!server) return cannot_start(server.error());
  if (!arguments.port_file.empty()) {
    const auto written = write_text_file(arguments.port_file, std::to_string((*server)->port()) + "\n");
    if (!written) return cannot_start(written.error().message());
  }
  wait_for_the_end(main_loop, **server);
  logger("app").info("stopping");
  const StopReport report = (*server)->stop();
  if (!report.error.empty()) logger("store").error("{}", report.error);
  bool is_written = true;
  if (!arguments.digests_file.empty()) {
    const auto written = write_digests_json(arguments.digests_file, report.digests);
    is_written = written.has_value();
    if (!is_written) logger("app").error("{}", written.error().message());
  }
  std::cout << "stopped seq=" << report.digests.seq << " edited_chunks=" << report.digests.chunks.size()
            << " world_digest=" << to_hex(report.world_digest) << " dense expansions: " << dense_expansions()
            << "\n";
  return report.is_clean && report.error.empty() && is_written ? kStopped : kFailed;
}

int import_main(const Arguments& arguments) {
  const auto imported = import_world(arguments.import, std::cout);
  return imported ? static_cast<int>(kStopped) : cannot_start(imported.error());
}

int server_program(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Runstone world server"};
  app.set_version_flag("--version", "runstone-server 0.1.0 protocol " + std::to_string(kProtocolVersion));
  app.add_option("--config", arguments.config_file,
                 "TOML file of settings; environment and flags win over it");
  app.add_flag("--print-config", arguments.print_config, "print all settings as TOML and exit");
  app.add_option("--port-file", arguments.port_file, "write the port here once the server listens");
  app.add_option("--digests", arguments.digests_file, "write the digests of all edited chunks here on stop");
  app.add_option("--generator", arguments.creation.generator, "new world: empty, flat or terrain");
  app.add_option("--generator-parameters", arguments.creation.generator_parameters, "new world: TOML text");
  app.add_option("--seed", arguments.creation.seed, "new world: seed of the generator");
  app.add_option("--edge", arguments.creation.edge, "new world: edge of a chunk, 16, 32, 64 or 128 voxels");
  app.add_option("--materials", arguments.creation.materials_file, "new world: TOML file of materials");
  for (const ConfigField& field : config_fields()) {
    app.add_option_function<std::string>(
           flag_name(field.name),
           [&arguments, name = field.name](const std::string& text) { arguments.settings[name] = text; },
           field.help)
        ->group("Settings");
  }
  CLI::App* import = app.add_subcommand("import", "make a new world from a Luanti world");
  import->add_option("--luanti", arguments.import.luanti, "folder that holds map.sqlite")->required();
  import->add_option("--world", arguments.import.world, "folder of the new world")->required();
  import->add_option("--edge", arguments.import.edge, "edge of a chunk, 16, 32, 64 or 128 voxels");
  import->add_flag("--keep-all", arguments.import.keep_all, "keep plants, torches and the like as cubes");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kStopped : kCannotStart;
  }
  return import->parsed() ? import_main(arguments) : run(arguments);
}

}  // namespace
}  // namespace runstone

int main(int argc, char** argv) {
  try {
    const int code = runstone::server_program(argc, argv);
    spdlog::shutdown();  // lines still queued are written
    return code;
  } catch (const std::exception& error) {
    return runstone::cannot_start(error.what());
  }
}
