#include "bench/network/siege_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "bench/network/attack.hpp"
#include "bench/network/attacked_server.hpp"
#include "bench/network/fleet.hpp"
#include "bench/network/siege_flags.hpp"
#include "bench/network/siege_result.hpp"
#include "bench/network/siege_table.hpp"

namespace runstone::bench {
namespace {

constexpr std::size_t kQuietWindowsMax = 3;  // before the attacks, and after them

/// Returns the number of lines of level error in a server's log: "TIME error MODULE: ...".
std::uint64_t errors_in(const std::string& log) {
  std::uint64_t out = 0;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) {
    const std::size_t level = line.find(' ') + 1;
    if (level != 0 && line.compare(level, 6, "error ") == 0) ++out;
  }
  return out;
}

/// Returns the attacks that take turns: the hostile ones that the options name, or all of them. A
/// siege has no gateway.
std::vector<const Attack*> siege_attacks(const NetOptions& options) {
  std::vector<const Attack*> out;
  for (const Attack& attack : all_attacks()) {
    const auto& wanted = options.attacks;
    const bool is_wanted =
        wanted.empty() || std::find(wanted.begin(), wanted.end(), attack.name) != wanted.end();
    if (attack.is_hostile && !attack.needs_gateway && is_wanted) out.push_back(&attack);
  }
  return out;
}

class SiegeRun {
 public:
  SiegeRun(Testbed& testbed, TestbedLink& link)
      : testbed_(testbed),
        options_(testbed.options()),
        link_(link),
        attacks_(siege_attacks(options_)),
        windows_(static_cast<std::size_t>(options_.siege_seconds / kSiegeWindowSeconds)),
        // A short siege has fewer quiet windows, so that there is an attack in it.
        quiet_windows_(std::min(kQuietWindowsMax, (windows_ - 1) / 2)) {}

  Result<SiegeResult, std::string> run() {
    auto server = start_attacked_server(testbed_, link_, siege_flags(options_.siege_bots));
    if (!server) return failure(server.error());
    server_ = *std::move(server);
    began_ = SteadyClock::now();
    for (std::size_t i = 0; i < windows_; ++i) {
      const Attack* attack = attack_of(i);
      if (const auto done = play(i, attack); !done) {
        return failure(fmt::format("window {} ({}): {}", i,
                                   attack == nullptr ? kQuiet : attack->name, done.error()));
      }
    }
    const auto stop_s = stop_attacked_server(testbed_, server_, [this] { look(); });
    if (!stop_s) return failure(stop_s.error());
    out_.stop_s = *stop_s;
    out_.errors = errors_in(server_.program->log());
    return out_;
  }

 private:
  using SteadyClock = std::chrono::steady_clock;

  /// Returns the attack of a window, or null if the window is quiet.
  const Attack* attack_of(std::size_t index) const {
    const bool is_quiet = index < quiet_windows_ || index >= windows_ - quiet_windows_;
    return is_quiet || attacks_.empty() ? nullptr : attacks_[index % attacks_.size()];
  }

  Done play(std::size_t index, const Attack* attack) {
    auto fleet = Fleet::join(
        testbed_, link_, server_.address,
        {.clients = options_.siege_bots, .seconds = kSiegeWindowSeconds, .has_replicas = false});
    if (!fleet) return failure(fleet.error());
    SiegeWindow window;
    window.attack = attack == nullptr ? kQuiet : attack->name;
    window.from_s = seconds();
    const double written_before_kb = written_kb(server_);
    std::optional<RunningAttack> running;
    if (attack != nullptr) running.emplace(attack->play, plan(index));
    while (seconds() < window.from_s + kSiegeWindowSeconds) {
      window.resident_mb = std::max(window.resident_mb, look());
      if (!pause_for(kLookSeconds)) return failure("interrupted");
    }
    window.to_s = seconds();
    window.disk_kb_s = (written_kb(server_) - written_before_kb) / (window.to_s - window.from_s);
    if (running) running->finish();
    const auto seen = fleet->finish(testbed_);
    if (!seen) return failure(seen.error());
    window.seen = *seen;
    fmt::print(testbed_.progress(), "siege: window {} of {}, {}: p99 {} ms, {} MB\n", index + 1,
               windows_, window.attack, number_text(seen->p99_ms), number_text(window.resident_mb));
    testbed_.progress().flush();
    out_.windows.push_back(std::move(window));
    return {};
  }

  /// Returns a plan with keys that no other window uses.
  AttackPlan plan(std::size_t index) const {
    return {server_.port,
            options_.attackers,
            options_.attacker_addresses,
            kSiegeWindowSeconds,
            options_.seed + index * options_.attackers,
            !options_.insecure,
            !options_.quick};
  }

  double seconds() const {
    return std::chrono::duration<double>(SteadyClock::now() - began_).count();
  }

  /// Returns the server's memory in MB.
  double look() {
    const double now_mb = resident_mb(server_);
    out_.resident_max_mb = std::max(out_.resident_max_mb, now_mb);
    return now_mb;
  }

  Testbed& testbed_;
  const NetOptions& options_;
  TestbedLink& link_;
  const std::vector<const Attack*> attacks_;
  const std::size_t windows_, quiet_windows_;
  TestbedServer server_;
  SteadyClock::time_point began_;
  SiegeResult out_;
};

}  // namespace

Done measure_siege(Testbed& testbed, NetFindings& findings) {
  const NetOptions& options = testbed.options();
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return failure(link.error());
  const auto result = SiegeRun(testbed, **link).run();
  if (!result) return failure("siege, " + result.error());
  add_siege_figures(*result, findings.figures);
  add_siege_targets(*result, options, findings.targets);
  findings.tables += siege_table(*result, options);
  return {};
}

}  // namespace runstone::bench
