#include "bench/network/attack_thread.hpp"

#include <algorithm>
#include <thread>

#include "bench/network/child.hpp"

namespace runstone::bench {
namespace {

constexpr int kJoinMsMax = 3'000;
constexpr int kAgainMs = 20;  // the pause after the server ended the session
constexpr std::size_t kQueuedMax = 64 * 1024;
constexpr int kSmallBuffer = 4 * 1024;

}  // namespace

AttackThread::AttackThread(const AttackPlan& plan, unsigned index,
                           const std::atomic<bool>& is_stopped)
    : port_(plan.port),
      web_port_(plan.web_port),
      index_(index),
      addresses_(plan.addresses),
      address_(address(index % plan.addresses)),
      is_stopped_(is_stopped),
      began_(Clock::now()),
      ends_(began_ + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(plan.seconds))),
      random_(mix64(plan.seed + index)) {
  if (plan.is_encrypted) tls_ = TlsContext::client();
}

bool AttackThread::is_over() const { return Clock::now() >= ends_ || is_stopped_ || interrupted(); }

double AttackThread::seconds() const {
  return std::chrono::duration<double>(Clock::now() - began_).count();
}

void AttackThread::pause_ms(int ms) const {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

std::unique_ptr<AttackClient> AttackThread::connect(std::uint32_t from, int receive_bytes) {
  if (!may_connect()) return nullptr;
  ++outcome.connections;
  return std::make_unique<AttackClient>(port_, from, tls(), receive_bytes);
}

std::unique_ptr<AttackClient> AttackThread::join(int receive_bytes, std::uint64_t features) {
  auto client = connect(address_, receive_bytes);
  if (client == nullptr || client->open_session(random_.next(), 1, kJoinMsMax, features))
    return client;
  end(*client);
  pause_ms(kAgainMs);
  return nullptr;
}

void AttackThread::end(AttackClient& client) {
  ++outcome.endings[alike(client.ending())];
  outcome.bytes_sent += client.bytes_sent();
  outcome.bytes_received += client.bytes_received();
}

void AttackThread::flood(const Step& begin, const Step& add, double per_second, bool reads) {
  while (may_connect()) {
    const auto client = join(reads ? 0 : kSmallBuffer);
    if (client == nullptr) continue;
    begin(*client);
    send_to(*client, add, per_second, reads);
    if (!is_over()) pause_ms(kAgainMs);
  }
}

void AttackThread::send_to(AttackClient& client, const Step& add, double per_second, bool reads) {
  const double since = seconds();
  double added = 0;
  while (!is_over() && client.is_open()) {
    const double due = per_second == kNoLimit ? added + 1'000 : (seconds() - since) * per_second;
    for (; added < due && client.queued() < kQueuedMax; ++added) add(client);
    client.flush();
    if (reads) client.read();
    if (per_second != kNoLimit || client.queued() > 0) client.wait(1, false);
  }
  // Clients that never read also get the goodbye here.
  client.read();
  end(client);
}

}  // namespace runstone::bench
