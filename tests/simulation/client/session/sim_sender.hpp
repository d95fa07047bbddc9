// SimSender: the sending end of a connection. It has a bounded queue per class, and interleaves
// fragments of the classes by the priorities of the real sender, or sometimes in another order.
#pragma once
#include <array>
#include <deque>
#include <functional>
#include <utility>

#include "common/core/hash.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/simulation/client/session/sim_pipe.hpp"
#include "tests/simulation/client/session/virtual_time.hpp"

namespace runstone::test {

class SimSender {
 public:
  SimSender(VirtualTime& time, SplitMix64& rng, SimPipe& pipe, std::size_t class_bytes_max,
            std::function<void()> drained)
      : time_(time),
        rng_(rng),
        pipe_(pipe),
        class_bytes_max_(class_bytes_max),
        drained_(std::move(drained)),
        alive_(std::make_shared<int>(0)) {}

  bool send(const EncodedMessage& message) {
    Queue& queue = queues_[static_cast<std::size_t>(class_of(message))];
    if (queue.bytes != 0 && queue.bytes + message.bytes->size() > class_bytes_max_) {
      was_full_ = true;
      return false;
    }
    queue.bytes += message.bytes->size();
    queue.messages.push_back(message);
    pump_later();
    return true;
  }
  bool idle() const {
    for (const Queue& queue : queues_) {
      if (!queue.messages.empty()) return false;
    }
    return true;
  }

 private:
  struct Queue {
    std::deque<EncodedMessage> messages;
    std::size_t sent = 0;   // bytes of the front message already framed
    std::size_t bytes = 0;  // of all messages
  };

  void pump_later() {
    if (pumping_) return;
    pumping_ = true;
    time_.after(rng_.between(20, 400), [this, weak = std::weak_ptr(alive_)] {
      if (weak.expired()) return;
      pumping_ = false;
      pump();
    });
  }

  void pump() {
    static constexpr std::array<std::size_t, 3> kPriority = {1, 0, 2};  // edits, control, chunks
    const std::size_t rotate = rng_.below(8) == 0 ? rng_.below(3) : 0;
    for (std::size_t i = 0; i < 3; ++i) {
      Queue& queue = queues_[kPriority[(i + rotate) % 3]];
      if (queue.messages.empty()) continue;
      send_fragment(queue);
      break;
    }
    if (!idle())
      pump_later();
    else if (std::exchange(was_full_, false))
      drained_();
  }

  void send_fragment(Queue& queue) {
    const EncodedMessage& message = queue.messages.front();
    const std::size_t left = message.bytes->size() - queue.sent;
    const std::size_t take = std::min<std::size_t>(left, 1 + rng_.below(kFragmentBytesMax));
    const FrameHeader header = writer_.next(message.kind, take, take < left);
    Bytes out(header.begin(), header.end());
    const auto begin = message.bytes->begin() + static_cast<std::ptrdiff_t>(queue.sent);
    out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(take));
    pipe_.send(out);
    queue.sent += take;
    if (take == left) {
      queue.bytes -= message.bytes->size();
      queue.sent = 0;
      queue.messages.pop_front();
    }
  }

  VirtualTime& time_;
  SplitMix64& rng_;
  SimPipe& pipe_;
  std::size_t class_bytes_max_;
  std::function<void()> drained_;
  std::shared_ptr<int> alive_;
  FrameWriter writer_;
  std::array<Queue, kFrameClassCount> queues_;
  bool pumping_ = false;
  bool was_full_ = false;
};

}  // namespace runstone::test
