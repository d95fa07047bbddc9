#include "tests/bench/network/hostile_fleet.hpp"

#include <algorithm>
#include <thread>

#include "tests/bench/network/child.hpp"

namespace runstone::bench {
namespace {

constexpr int kJoinMsMax = 3'000;
constexpr int kAgainMs = 20;  // after it was sent away
constexpr std::size_t kQueuedMax = 64 * 1024;
constexpr int kSmallBuffer = 4 * 1024;

}  // namespace

HostileFleet::HostileFleet(std::uint16_t port, unsigned index, double seconds, std::uint64_t seed)
    : port_(port),
      index_(index),
      began_(Clock::now()),
      ends_(began_ +
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))),
      random_(mix64(seed + index)) {}

bool HostileFleet::is_over() const { return Clock::now() >= ends_ || interrupted(); }

double HostileFleet::seconds() const {
  return std::chrono::duration<double>(Clock::now() - began_).count();
}

void HostileFleet::pause_ms(int ms) const {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

std::unique_ptr<HostileClient> HostileFleet::connect(std::uint32_t from, int receive_bytes) {
  if (is_over() || outcome.connections >= kConnectionsMax) return nullptr;
  ++outcome.connections;
  return std::make_unique<HostileClient>(port_, from, receive_bytes);
}

std::unique_ptr<HostileClient> HostileFleet::join(int receive_bytes) {
  auto client = connect(kLoopback, receive_bytes);
  if (client == nullptr || client->open_session(random_.next(), kJoinMsMax)) return client;
  end(*client);
  pause_ms(kAgainMs);
  return nullptr;
}

void HostileFleet::end(HostileClient& client) {
  ++outcome.endings[alike(client.ending())];
  outcome.bytes_sent += client.bytes_sent();
  outcome.bytes_received += client.bytes_received();
}

void HostileFleet::flood(const Step& begin, const Step& add, double per_second, bool reads) {
  while (!is_over() && outcome.connections < kConnectionsMax) {
    const auto client = join(reads ? 0 : kSmallBuffer);
    if (client == nullptr) continue;
    begin(*client);
    const double since = seconds();
    double added = 0;
    while (!is_over() && client->is_open()) {
      const double due = per_second == kNoLimit ? added + 1'000 : (seconds() - since) * per_second;
      for (; added < due && client->queued() < kQueuedMax; ++added) add(*client);
      client->flush();
      if (reads) client->read();
      if (per_second != kNoLimit || client->queued() > 0) client->wait(1, false);
    }
    client->read();  // the last word, also to those that never read
    end(*client);
    if (!is_over()) pause_ms(kAgainMs);
  }
}

}  // namespace runstone::bench
