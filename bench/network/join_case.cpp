#include "bench/network/join_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/harness/statistics.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kViewRadius = 6, kViewRadiusV = 3;  // chunks
constexpr double kWaitSeconds = 120;
constexpr double kNearMostMsMax = 1000;  // the target on broadband

struct Part {
  const char* part;
  const char* time;
  const char* title;
};
constexpr std::array<Part, 6> kParts = {{{"near", "first_ms", "first chunk"},
                                         {"near", "most_ms", "near view 80 %"},
                                         {"near", "all_ms", "near view"},
                                         {"view", "most_ms", "view 80 %"},
                                         {"view", "all_ms", "view"},
                                         {"", "", "bytes received"}}};
constexpr std::size_t kNearMost = 1, kBytes = 5;
using Join = std::array<double, kParts.size()>;

Result<Join, std::string> join_once(Testbed& testbed, TestbedLink& link, const std::string& address,
                                    const std::string& script) {
  const std::string report_file = testbed.fresh("report.json");
  auto client = testbed.start_client(
      link, "runstone-client",
      {"--connect", address, "--name", "newcomer", "--no-render", "--view",
       fmt::to_string(kViewRadius), "--view-vertical", fmt::to_string(kViewRadiusV), "--script",
       script, "--report", report_file});
  if (!client) return failure(client.error());
  if (const auto ended = testbed.finish(**client, 2 * kWaitSeconds); !ended) {
    return failure(ended.error());
  }
  const auto report = read_report(report_file);
  if (!report) return failure(report.error());
  Join out{};
  for (std::size_t i = 0; i < kBytes; ++i) {
    const nlohmann::json& time = (*report)["join"][kParts[i].part][kParts[i].time];
    if (time.is_null()) return failure(fmt::format("a join never had its {}", kParts[i].title));
    out[i] = number_in(time);
  }
  out[kBytes] = number_in((*report)["net"]["bytes_received"]);
  return out;
}

/// Measures all joins of one profile, except the one that warms the server.
Result<std::vector<Join>, std::string> joins_of(Testbed& testbed, const test::LinkProfile& profile,
                                                const std::string& world) {
  const auto failed = [](const auto& what) { return failure(what.error()); };
  auto link = testbed.make_link(profile);
  if (!link) return failed(link);
  auto server = testbed.start_server(**link, world, {});
  if (!server) return failed(server);
  const std::string script = testbed.fresh("script.txt");
  write_text(script, fmt::format("wait loaded {}\nquit\n", kWaitSeconds));
  std::vector<Join> out;
  for (unsigned i = 0; i <= testbed.options().repetitions; ++i) {
    const auto join = join_once(testbed, **link, server->address, script);
    if (!join) return failed(join);
    if (i != 0) out.push_back(*join);
  }
  if (const auto ended = testbed.stop_server(*server); !ended) return failed(ended);
  return out;
}

}  // namespace

Done measure_joins(Testbed& testbed, NetFindings& findings) {
  const auto world = testbed.imported_world();
  if (!world) return failure(world.error());
  std::string& table = findings.tables;
  const auto into = std::back_inserter(table);
  fmt::format_to(
      into,
      "\n### Joins\n\nms from the start of the connection, median and slowest of {}:\n\n| link |",
      testbed.options().repetitions);
  for (const Part& part : kParts) fmt::format_to(into, " {} |", part.title);
  fmt::format_to(into, "\n|---|---|---|---|---|---|---|\n");
  for (const test::LinkProfile& profile : testbed.profiles()) {
    const auto joins = joins_of(testbed, profile, *world);
    if (!joins) return failure(fmt::format("join, {}: {}", profile.name, joins.error()));
    const char* link = name_of(profile.passes_all() ? LinkKind::loopback : testbed.kind());
    fmt::format_to(into, "| {} ({}) |", profile.name, link);
    for (std::size_t i = 0; i < kParts.size(); ++i) {
      std::vector<double> samples;
      for (const Join& join : *joins) samples.push_back(join[i]);
      const double middle = median(samples),
                   slowest = *std::max_element(samples.begin(), samples.end());
      fmt::format_to(into, " {}, {} |", number_text(middle), number_text(slowest));
      std::string name =
          i == kBytes ? "bytes" : fmt::format("{}_{}", kParts[i].part, kParts[i].time);
      findings.figures.push_back({"join", std::string(profile.name), link, "median", name, middle});
      findings.figures.push_back({"join", std::string(profile.name), link, "max", name, slowest});
      if (i == kNearMost && profile.name == "broadband") {
        findings.targets.push_back(
            {"join on broadband, imported world, warm server: 80 % of the near view meshed",
             number_text(kNearMostMsMax) + " ms",
             fmt::format("{} ms; the slowest {} ms", number_text(middle), number_text(slowest)),
             slowest <= kNearMostMsMax ? Verdict::met : Verdict::missed});
      }
    }
    fmt::format_to(into, "\n");
    fmt::print(testbed.progress(), "join {}\n", profile.name);
    testbed.progress().flush();
  }
  return {};
}

}  // namespace runstone::bench
