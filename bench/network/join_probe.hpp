// JoinProbe: an honest client that joins and leaves again and again during another measurement. It
// counts how often a server accepts it, and measures the time until then. It has a thread of its own,
// and connects from several /24 in turn.
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>

namespace runstone::bench {

class JoinProbe {
 public:
  /// `is_encrypted`: the server speaks TLS.
  JoinProbe(std::uint16_t port, bool is_encrypted);
  ~JoinProbe();
  JoinProbe(const JoinProbe&) = delete;
  JoinProbe& operator=(const JoinProbe&) = delete;

  struct Joins {
    unsigned tried = 0, open = 0;
    double slowest_ms = 0;  // of the accepted ones, to the end of the handshake
  };
  /// Ends the probe. Call it once.
  Joins finish();

 private:
  void run(std::uint16_t port, bool is_encrypted);
  std::atomic<bool> is_over_{false};
  Joins joins_;
  std::thread thread_;
};

}  // namespace runstone::bench
