#include "bench/network/join_probe.hpp"

#include <algorithm>
#include <chrono>

#include "bench/network/attack_client.hpp"
#include "bench/network/child.hpp"
#include "common/core/hash.hpp"

namespace runstone::bench {
namespace {

// 127.2.2.2, 127.2.3.2 and so on, which nobody else uses: each is of another /24.
constexpr std::uint32_t kAddress = 0x7F020202, kAddresses = 8;
constexpr int kNewcomerMsMax = 5'000;
constexpr double kPauseSeconds = 0.1;

}  // namespace

JoinProbe::JoinProbe(std::uint16_t port, bool is_encrypted)
    : thread_([this, port, is_encrypted] { run(port, is_encrypted); }) {}

JoinProbe::~JoinProbe() {
  is_over_ = true;
  if (thread_.joinable()) thread_.join();
}

JoinProbe::Joins JoinProbe::finish() {
  is_over_ = true;
  thread_.join();
  return joins_;
}

void JoinProbe::run(std::uint16_t port, bool is_encrypted) {
  const TlsContext tls = TlsContext::client();
  for (std::uint64_t who = 0; !is_over_ && !interrupted(); ++who) {
    const auto began = std::chrono::steady_clock::now();
    const std::uint32_t from = kAddress + (static_cast<std::uint32_t>(who % kAddresses) << 8);
    AttackClient newcomer(port, from, is_encrypted ? &tls : nullptr);
    ++joins_.tried;
    if (newcomer.open_session(mix64(~who), 1, kNewcomerMsMax)) {
      ++joins_.open;
      const std::chrono::duration<double, std::milli> took =
          std::chrono::steady_clock::now() - began;
      joins_.slowest_ms = std::max(joins_.slowest_ms, took.count());
    }
    pause_for(kPauseSeconds);
  }
}

}  // namespace runstone::bench
