#include "bench/network/attacked_server.hpp"

#include <chrono>

namespace runstone::bench {
namespace {

constexpr double kStopPatience = 60;  // seconds until a server that was told to stop has failed

}  // namespace

Result<TestbedServer, std::string> start_attacked_server(Testbed& testbed, TestbedLink& link,
                                                         const std::vector<std::string>& flags) {
  std::vector<std::string> all = {"--generator", "terrain", "--seed", "7", "--idle-s", "5"};
  all.insert(all.end(), flags.begin(), flags.end());
  return testbed.start_server(link, testbed.fresh("world"), all);
}

double resident_mb(const TestbedServer& server) {
  return static_cast<double>(server.program->resident_bytes()) / 1e6;
}

double written_kb(const TestbedServer& server) {
  return static_cast<double>(server.program->written_bytes()) / 1e3;
}

Result<double, std::string> stop_attacked_server(Testbed& testbed, TestbedServer& server,
                                                 const std::function<void()>& look) {
  const auto began = std::chrono::steady_clock::now();
  server.program->terminate();
  wait_until(kStopPatience, [&] {
    look();
    return server.program->wait(0).has_value();
  });
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (const auto ended = testbed.finish(*server.program, 0); !ended) return failure(ended.error());
  return seconds;
}

}  // namespace runstone::bench
