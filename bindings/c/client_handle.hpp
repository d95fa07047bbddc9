// The object behind runstone_client: the client of the C++ library, and the events that a program
// has drained or that did not fit its buffer.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bindings/c/handle.hpp"
#include "client/api/world_client.hpp"
#include "common/core/text.hpp"

struct runstone_client : runstone::c_interface::Handle<0x746e6c63> {
  explicit runstone_client(runstone::WorldClient of) : client(std::move(of)) {}

  /// Returns the next events, `capacity` at most. Asks the client for events, with `chunks_max`
  /// chunks at most, only if none have waited. Allocates nothing itself, so that no event is lost
  /// if memory runs out.
  std::span<const runstone::WorldEvent> drain(std::size_t chunks_max, std::size_t capacity) {
    if (drained_end_ == events_.size()) {
      events_ = client.drain(chunks_max);
      drained_begin_ = drained_end_ = 0;
    }
    // The chunks of the events before are not needed any more.
    while (drained_begin_ < drained_end_) events_[drained_begin_++] = runstone::WorldOpened{};
    drained_end_ += std::min(capacity, events_.size() - drained_end_);
    return drained();
  }
  /// Returns the events of the last drain(), by the index that the program knows.
  std::span<const runstone::WorldEvent> drained() const {
    return std::span(events_).subspan(drained_begin_, drained_end_ - drained_begin_);
  }

  runstone::WorldClient client;

 private:
  std::vector<runstone::WorldEvent> events_;  // drained before, drained last, and waiting
  std::size_t drained_begin_ = 0, drained_end_ = 0;
};

namespace runstone::c_interface {

/// Refuses a call with the words of the client.
[[noreturn]] void refuse_as(const ClientRefusal& refusal);

/// Copies a text in UTF-8 to a field, cut to its size between two characters, with a zero at the
/// end.
template <std::size_t kSize>
void write_text(const std::string& from, char (&out)[kSize]) {
  out[cut_utf8(from, kSize - 1).copy(out, kSize - 1)] = '\0';
}

}  // namespace runstone::c_interface
