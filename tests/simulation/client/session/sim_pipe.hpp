// SimPipe: one direction of a byte stream, as the worst case of TCP. Bytes arrive late, in pieces
// of any size, sometimes after a long stall, always in order. When the connection is cut, the rest
// is lost.
#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/hash.hpp"
#include "tests/simulation/client/session/virtual_time.hpp"

namespace runstone::test {

struct LinkFaults {
  std::int32_t delay_us_min = 200, delay_us_max = 40'000;
  std::uint32_t stalls_per_1000 = 5;  // pieces that wait up to two seconds more
  std::uint32_t piece_bytes_max = 3000;
};

class SimPipe {
 public:
  SimPipe(VirtualTime& time, SplitMix64& rng, const LinkFaults& faults,
          std::function<void(ByteView)> deliver)
      : time_(time),
        rng_(rng),
        faults_(faults),
        deliver_(std::make_shared<std::function<void(ByteView)>>(std::move(deliver))) {}

  void send(ByteView bytes) {
    while (!bytes.empty()) {
      const std::size_t piece =
          std::min<std::size_t>(bytes.size(), 1 + rng_.below(faults_.piece_bytes_max));
      TimeUs due = time_.now() + rng_.between(faults_.delay_us_min, faults_.delay_us_max);
      if (rng_.below(1000) < faults_.stalls_per_1000) due += rng_.between(0, 2'000'000);
      last_due_ = std::max(last_due_, due);
      // The event has a weak pointer to the callback, so that a cut pipe delivers nothing more.
      time_.after(
          last_due_ - time_.now(),
          [weak = std::weak_ptr(deliver_),
           data = Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(piece))] {
            if (const auto deliver = weak.lock()) (*deliver)(data);
          });
      bytes = bytes.subspan(piece);
    }
  }
  void cut() { deliver_.reset(); }

 private:
  VirtualTime& time_;
  SplitMix64& rng_;
  const LinkFaults& faults_;
  std::shared_ptr<std::function<void(ByteView)>> deliver_;
  TimeUs last_due_ = 0;
};

}  // namespace runstone::test
