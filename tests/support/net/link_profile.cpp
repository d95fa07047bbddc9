#include "tests/support/net/link_profile.hpp"

#include <algorithm>
#include <array>

namespace runstone::test {
namespace {

constexpr TimeNs kMs = 1'000'000;
constexpr std::uint64_t kMbit = 1'000'000;
constexpr std::uint64_t kQueueBytesMin = 64 * 1024;
constexpr std::uint64_t kNsPerSecond = 1'000'000'000;

constexpr std::array<LinkProfile, 5> kProfiles = {{
    {"loopback", 0, 0, 0, 0},
    {"lan", 400'000, 0, 1000 * kMbit, 0},
    {"broadband", 40 * kMs, 0, 50 * kMbit, 0},
    {"mobile", 120 * kMs, 20 * kMs, 5 * kMbit, 0},
    {"lossy", 40 * kMs, 0, 50 * kMbit, 0.02},
}};

}  // namespace

std::uint64_t LinkProfile::queue_bytes() const {
  const auto round_trip = static_cast<std::uint64_t>(round_trip_ns);
  return std::max(kQueueBytesMin, bits_per_second / 8 * round_trip / kNsPerSecond);
}

TimeNs LinkProfile::transmit_ns(std::uint64_t bytes) const {
  if (bits_per_second == 0) return 0;
  return static_cast<TimeNs>(bytes * 8 * kNsPerSecond / bits_per_second);
}

std::span<const LinkProfile> link_profiles() { return kProfiles; }

const LinkProfile* find_link_profile(std::string_view name) {
  const auto found = std::find_if(kProfiles.begin(), kProfiles.end(),
                                  [&](const LinkProfile& profile) { return profile.name == name; });
  return found == kProfiles.end() ? nullptr : &*found;
}

}  // namespace runstone::test
