#include "client/session/clock_offset.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

void ClockOffset::add(TimeUs sent_us, TimeUs server_us, TimeUs received_us) {
  if (received_us < sent_us) return;
  const TimeUs middle = sent_us + (received_us - sent_us) / 2;
  samples_[count_++ % kSamples] = {received_us - sent_us, server_us - middle};
}

const ClockOffset::Sample& ClockOffset::best() const {
  RUNSTONE_ASSERT(known());
  const auto end = samples_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kSamples));
  return *std::min_element(samples_.begin(), end, [](const Sample& a, const Sample& b) {
    return a.round_trip_us < b.round_trip_us;
  });
}

TimeUs ClockOffset::offset_us() const { return best().offset_us; }
TimeUs ClockOffset::round_trip_us() const { return best().round_trip_us; }
TimeUs ClockOffset::error_us() const { return (best().round_trip_us + 1) / 2; }

std::optional<TimeUs> ClockOffset::to_server(TimeUs local_us) const {
  if (!known()) return std::nullopt;
  return local_us + offset_us();
}

std::optional<TimeUs> ClockOffset::to_local(TimeUs server_us) const {
  if (!known()) return std::nullopt;
  return server_us - offset_us();
}

}  // namespace runstone
