// HostileClients: clients that send the most expensive edits as fast as the server reads them, also
// after their budgets are used up. One half pastes clipboards of 47 KB a million voxels away. The
// other half fills boxes that touch thousands of chunks, each time in other chunks.
#pragma once
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "common/core/hash.hpp"
#include "tests/support/edits/hostile_edits.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {

class HostileClients {
 public:
  /// Starts the clients. Each has a thread, a key and an address of its own.
  HostileClients(std::uint16_t port, std::uint64_t seed) {
    for (std::uint8_t n = 0; n < kCount; ++n) {
      threads_.emplace_back([=, this] { attack(port, n, SplitMix64(seed * kCount + n)); });
    }
  }
  /// Waits until all clients have gone.
  ~HostileClients() {
    is_over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  HostileClients(const HostileClients&) = delete;
  HostileClients& operator=(const HostileClients&) = delete;

 private:
  static constexpr std::uint8_t kCount = 4;
  static constexpr std::uint8_t kFirstKey = 100;

  void attack(std::uint16_t port, std::uint8_t n, SplitMix64 random) const {
    RawClient client(port, INADDR_LOOPBACK + 1 + n);
    // A new instance each time: the server has resolved the sequences of the last one.
    const ClientInstance instance = 1'000 + random.below(1'000'000'000);
    if (!client.join(static_cast<std::uint8_t>(kFirstKey + n), instance)) return;
    const auto clipboard = n % 2 == 0 ? long_clipboard() : nullptr;
    for (ClientSequence seq = 1; !is_over_ && client.is_open(); ++seq) {
      client.send(
          EditRequest{seq, 0, clipboard ? far_paste(clipboard, n, random) : far_box(random)});
      // It reads a few messages only. If it read until none is left, the commits of others would
      // keep it from sending.
      for (int read = 0; read < kReadsMax && client.next(kReadMs); ++read) {
      }
    }
  }

  static EditDescriptor far_paste(const std::shared_ptr<const Clipboard>& clipboard, std::uint8_t n,
                                  SplitMix64& random) {
    const VoxelPos at{(1 << 20) + random.between(-64, 64), random.between(-64, 64),
                      ((n + 1) << 12) + random.between(-64, 64)};
    return {Paste{at, clipboard, {}}, {}, kEmpty};
  }
  static EditDescriptor far_box(SplitMix64& random) {
    constexpr std::int32_t kStep = 1'024, kPlaces = 500;
    const VoxelPos at{kStep * random.between(-kPlaces, kPlaces), random.between(-64, 64),
                      kStep * random.between(2, kPlaces)};
    return wide_box(at, static_cast<Material>(random.between(1, 4)));
  }

  static constexpr int kReadMs = 2, kReadsMax = 8;
  std::atomic<bool> is_over_{false};
  std::vector<std::thread> threads_;
};

}  // namespace runstone::test
