#include "bench/network/attack_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/harness/statistics.hpp"
#include "bench/network/attack.hpp"
#include "bench/network/attack_result.hpp"
#include "bench/network/attack_table.hpp"
#include "bench/network/attacked_server.hpp"
#include "bench/network/echo_probe.hpp"
#include "bench/network/fleet.hpp"
#include "bench/network/join_probe.hpp"
#include "bench/network/page_probe.hpp"
#include "bench/network/page_times.hpp"
#include "tests/support/tls/pem_files.hpp"

namespace runstone::bench {
namespace {

constexpr double kEchoesPerSecond = 100;
constexpr double kSecondAttackMax = 60;  // seconds that the attack at the stop may last longer

/// Returns the reasons in the log lines for ended sessions, such as "timed_out: no message for too
/// long".
std::map<std::string, std::uint64_t> reasons_in(const std::string& log) {
  const auto quoted = [](const std::string& line, std::string_view name) {
    const std::size_t at = line.find(name);
    if (at == std::string::npos) return std::string();
    const std::size_t begin = at + name.size();
    return line.substr(begin, line.find('"', begin) - begin);
  };
  std::map<std::string, std::uint64_t> out;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) {
    const std::size_t reason = line.find(" reason=");
    const std::size_t open = line.find('(', reason);
    if (reason == std::string::npos || open == std::string::npos) continue;
    const std::string text = quoted(line, " text=\""), error = quoted(line, " error=\"");
    ++out[alike(line.substr(open + 1, line.find(')', open) - open - 1) + ": " +
                (text.empty() ? error : text))];
  }
  return out;
}

class AttackRun {
 public:
  AttackRun(Testbed& testbed, TestbedLink& link, const Attack& attack)
      : testbed_(testbed), options_(testbed.options()), link_(link), attack_(attack) {}

  Result<AttackResult, std::string> run() {
    if (const auto started = start(); !started) return failure(started.error());
    out_.name = attack_.name;
    out_.is_hostile = attack_.is_hostile;
    for (const AttackPhase phase : kAttackPhases) {
      if (const auto done = play(phase); !done) return failure(done.error());
    }
    if (const auto ended = stop(); !ended) return failure(ended.error());
    if (web_) {
      if (const auto ended = testbed_.stop_server(*web_); !ended) return failure(ended.error());
    }
    out_.logged = reasons_in(server_.program->log());
    return out_;
  }

 private:
  /// Starts the server and, if the attack needs it, a gateway with default settings and a map.
  Done start() {
    std::vector<std::string> flags;
    const std::string socket = testbed_.fresh("web.sock");
    if (attack_.needs_gateway) flags = {"--gateway-socket", socket};
    auto server = start_attacked_server(testbed_, link_, flags);
    if (!server) return failure(server.error());
    server_ = *std::move(server);
    if (!attack_.needs_gateway) return {};
    flags = {"--world", server_.world};
    if (!options_.insecure) {
      pem_.emplace("localhost");
      flags.insert(flags.end(),
                   {"--tls-certificate", pem_->chain_file(), "--tls-key", pem_->key_file()});
    }
    auto web = testbed_.start_gateway(link_, socket, flags);
    if (!web) return failure(web.error());
    web_ = *std::move(web);
    out_.has_gateway = true;
    return {};
  }

  AttackPlan plan(double seconds, std::uint64_t seed) const {
    const std::uint16_t web_port = web_ ? web_->port : 0;
    return {server_.port,
            options_.attackers,
            options_.attacker_addresses,
            seconds,
            seed,
            !options_.insecure,
            !options_.quick,
            web_port};
  }

  /// Starts a reader for each page, if there is a gateway.
  std::vector<std::unique_ptr<PageProbe>> start_readers() const {
    std::vector<std::unique_ptr<PageProbe>> out;
    if (!web_) return out;
    for (const char* page : kProbedPages)
      out.push_back(std::make_unique<PageProbe>(web_->port, page, !options_.insecure));
    return out;
  }

  Done play(AttackPhase phase) {
    const double seconds = options_.attack_seconds;
    auto fleet = Fleet::join(testbed_, link_, server_.address,
                             {.clients = options_.attack_bots,
                              .seconds = seconds,
                              .edits_per_second = kAttackedEditsPerSecond,
                              .has_replicas = false});
    if (!fleet) return failure(fleet.error());
    const double cores_before = server_.program->core_seconds();
    const double web_before = web_ ? web_->program->core_seconds() : 0;
    const double bots_before = fleet->bots().core_seconds();
    std::optional<RunningAttack> attack;
    std::optional<JoinProbe> probe;
    std::unique_ptr<EchoProbe> echo;
    if (phase == during) {
      auto started = EchoProbe::start(link_, kEchoesPerSecond);
      if (!started) return failure(started.error());
      echo = *std::move(started);
      written_before_kb_ = written_kb(server_);
      attack.emplace(attack_.play, plan(seconds, options_.seed));
      probe.emplace(server_.port, !options_.insecure);
    }
    const auto readers = start_readers();
    double& phase_mb = out_.resident_mb[phase];
    for (double waited = 0; waited < seconds; waited += kLookSeconds) {
      const double now_mb = look();
      phase_mb = phase == during ? std::max(phase_mb, now_mb) : now_mb;
      if (!pause_for(kLookSeconds)) return failure("interrupted");
    }
    for (std::size_t page = 0; page < readers.size(); ++page)
      out_.pages[phase].pages[page] = page_times(readers[page]->finish());
    out_.server_cores[phase] = (server_.program->core_seconds() - cores_before) / seconds;
    if (web_) out_.gateway_cores[phase] = (web_->program->core_seconds() - web_before) / seconds;
    if (phase == during) {
      out_.bot_cores = (fleet->bots().core_seconds() - bots_before) / seconds;
      out_.written_kb = written_kb(server_) - written_before_kb_;
      const std::vector<double> echoes = echo->stop();
      if (!echoes.empty()) out_.echo_p99_ms = quantile(echoes, 0.99);
      out_.joins = probe->finish();
      out_.outcome = attack->finish();
      out_.attacker_cores = out_.outcome.core_seconds / seconds;
    }
    const auto seen = fleet->finish(testbed_);
    if (!seen) return failure(seen.error());
    out_.seen[phase] = *seen;
    return {};
  }

  /// Attacks again, and stops the server meanwhile.
  Done stop() {
    RunningAttack attack(attack_.play,
                         plan(options_.attack_seconds + kSecondAttackMax, options_.seed + 1));
    for (double waited = 0; waited < options_.attack_seconds; waited += kLookSeconds) {
      look();
      if (!pause_for(kLookSeconds)) return failure("interrupted");
    }
    const auto seconds = stop_attacked_server(testbed_, server_, [this] { look(); });
    attack.stop();
    attack.finish();
    if (!seconds) return failure(seconds.error());
    out_.stop_s = *seconds;
    return {};
  }

  /// Returns the server's memory in MB. Updates the figures that last to the end of the server.
  double look() {
    const double now_mb = resident_mb(server_);
    out_.resident_max_mb = std::max(out_.resident_max_mb, now_mb);
    out_.written_all_kb = std::max(out_.written_all_kb, written_kb(server_) - written_before_kb_);
    return now_mb;
  }

  Testbed& testbed_;
  const NetOptions& options_;
  TestbedLink& link_;
  const Attack& attack_;
  TestbedServer server_;
  std::optional<test::PemFiles> pem_;
  std::optional<TestbedServer> web_;
  double written_before_kb_ = 0;  // before the attack began
  AttackResult out_;
};

bool is_wanted(const Attack& attack, const NetOptions& options) {
  // All rows are compared with the quiet one.
  return attack.name == std::string_view(kQuiet) || options.attacks.empty() ||
         std::find(options.attacks.begin(), options.attacks.end(), attack.name) !=
             options.attacks.end();
}

}  // namespace

Done measure_attacks(Testbed& testbed, NetFindings& findings) {
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return failure(link.error());
  const NetOptions& options = testbed.options();
  std::vector<AttackResult> results;
  for (const Attack& attack : all_attacks()) {
    if (!is_wanted(attack, options)) continue;
    auto result = AttackRun(testbed, **link, attack).run();
    if (!result) return failure(fmt::format("attack {}: {}", attack.name, result.error()));
    results.push_back(*std::move(result));
    fmt::print(testbed.progress(), "attack {}\n", attack.name);
    testbed.progress().flush();
  }
  add_attack_figures(results, options, findings.figures);
  add_attack_targets(results, options, findings.targets);
  findings.tables += attack_tables(results, options);
  return {};
}

}  // namespace runstone::bench
