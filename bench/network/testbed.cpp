#include "bench/network/testbed.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/os/child_program.hpp"

namespace runstone::bench {
namespace {

constexpr double kStartSeconds = 60;
constexpr double kImportSeconds = 300;

std::string program_file(const std::string& name) {
  return sibling_program("",
                         name == "runstone-client" ? "RUNSTONE_CLIENT"
                         : name == "runstone-bot"  ? "RUNSTONE_BOT"
                         : name == "runstone-web"  ? "RUNSTONE_WEB"
                                                   : "RUNSTONE_SERVER",
                         name);
}

/// Waits until a program of the server's side listens, and returns it with its address.
Result<TestbedServer, std::string> wait_for_port(
    TestbedLink& link, const std::string& port_file,
    Result<std::unique_ptr<Child>, std::string> program) {
  if (!program) return failure(program.error());
  TestbedServer out{*std::move(program), "", 0};
  const bool listens = wait_until(kStartSeconds, [&] {
    std::ifstream in(port_file);
    return static_cast<bool>(in >> out.port) || out.program->wait(0).has_value();
  });
  if (!listens || out.port == 0) return failure(out.program->explain("did not start"));
  const auto entrance = link.entrance(out.port);
  if (!entrance) return failure(entrance.error());
  out.address = fmt::format("{}:{}", link.server_address(), *entrance);
  return out;
}

}  // namespace

std::vector<test::LinkProfile> Testbed::profiles() const {
  std::vector<test::LinkProfile> out;
  for (const test::LinkProfile& profile : test::link_profiles()) {
    const auto& wanted = options_.profiles;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), profile.name) != wanted.end())
      out.push_back(profile);
  }
  return out;
}

Result<std::unique_ptr<TestbedLink>, std::string> Testbed::make_link(
    const test::LinkProfile& profile) {
  return TestbedLink::make(profile, kind_, options_.seed);
}

std::string Testbed::fresh(const std::string& name) {
  return folder_ / fmt::format("{}-{}", names_++, name);
}

Result<TestbedServer, std::string> Testbed::start_server(TestbedLink& link,
                                                         const std::string& world,
                                                         const std::vector<std::string>& flags) {
  const std::string port_file = fresh("port");
  std::vector<std::string> words = {program_file("runstone-server"),
                                    "--world",
                                    world,
                                    "--create",
                                    "--generator",
                                    "terrain",
                                    "--seed",
                                    "1",
                                    "--listen",
                                    link.server_address() + ":0",
                                    "--port-file",
                                    port_file};
  words.insert(words.end(), flags.begin(), flags.end());
  if (options_.insecure) words.insert(words.end(), {"--insecure", "--i-know"});
  auto server = wait_for_port(
      link, port_file, Child::start(link.server_side(), std::move(words), fresh("server.log")));
  if (server) server->world = world;
  return server;
}

Result<TestbedServer, std::string> Testbed::start_gateway(TestbedLink& link,
                                                          const std::string& socket,
                                                          const std::vector<std::string>& flags) {
  const std::string port_file = fresh("port");
  std::vector<std::string> words = {
      program_file("runstone-web"), "--gateway-socket", socket,   "--listen",
      link.server_address() + ":0", "--port-file",      port_file};
  words.insert(words.end(), flags.begin(), flags.end());
  return wait_for_port(link, port_file,
                       Child::start(link.server_side(), std::move(words), fresh("gateway.log")));
}

Done Testbed::stop_server(TestbedServer& server) {
  server.program->terminate();
  return finish(*server.program, kStartSeconds);
}

Result<std::unique_ptr<Child>, std::string> Testbed::start_client(
    TestbedLink& link, const std::string& program, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), program_file(program));
  if (options_.insecure) arguments.emplace_back("--insecure");
  return Child::start(link.client_side(), std::move(arguments), fresh(program + ".log"));
}

Done Testbed::finish(Child& child, double seconds) {
  const auto status = child.wait(seconds);
  if (interrupted()) return failure("interrupted");
  if (!status) return failure(child.explain("did not end in time"));
  if (!WIFEXITED(*status) || WEXITSTATUS(*status) != 0)
    return failure(child.explain(how_it_ended(*status)));
  return {};
}

Result<std::string, std::string> Testbed::imported_world() {
  if (!imported_.empty()) return imported_;
  const std::string world = fresh("luanti");
  const auto here = Place::here();
  auto import = Child::start(
      *here,
      {program_file("runstone-server"), "import", "--luanti", options_.luanti, "--world", world},
      fresh("import.log"));
  if (!import) return failure(import.error());
  if (const auto done = finish(**import, kImportSeconds); !done) return failure(done.error());
  imported_ = world;
  return imported_;
}

std::vector<std::string> without_player_limits(std::vector<std::string> flags) {
  for (const char* word : {"--builder-budget", "unlimited", "--budgets-per-address", "0",
                           "--sessions-per-key", "0", "--sessions-per-address", "0",
                           "--connections-per-second", "0", "--chunk-loads-per-second", "0"})
    flags.emplace_back(word);
  return flags;
}

Result<nlohmann::json, std::string> read_report(const std::string& file) {
  std::ifstream in(file);
  nlohmann::json out = nlohmann::json::parse(in, nullptr, false);
  if (out.is_discarded()) return failure(file + " is no report");
  return out;
}

double number_in(const nlohmann::json& value) {
  if (value.is_number()) return value.get<double>();
  // The client and the bots use different words.
  return value == "inf" || value == "infinite" ? std::numeric_limits<double>::infinity() : 0;
}

double counter_in(const std::string& log, std::string_view name) {
  std::ifstream in(log);
  double out = 0;
  const std::string wanted = fmt::format(" {}=", name);
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find(wanted);
    if (line.find("counters ") != std::string::npos && at != std::string::npos) {
      out = std::strtod(line.c_str() + at + wanted.size(), nullptr);
    }
  }
  return out;
}

bool output_has(const std::string& log, std::string_view what) {
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) {
    if (line.find(what) != std::string::npos) return true;
  }
  return false;
}

void write_text(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

}  // namespace runstone::bench
