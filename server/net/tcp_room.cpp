#include "server/net/tcp_room.hpp"

#include <linux/inet_diag.h>
#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdint>

namespace runstone {
namespace {

// BBR's window while it measures, which is its smallest window at any time.
constexpr std::uint32_t kProbePackets = 4;
// BBR's window gain of 1, times 2^8. It has this gain only while it measures.
constexpr std::uint32_t kProbeWindowGain = 256;

bool measures_round_trip(int socket) {
  tcp_cc_info info{};
  socklen_t size = sizeof info;
  // Other congestion controls return other structures, of other sizes, or none.
  return ::getsockopt(socket, IPPROTO_TCP, TCP_CC_INFO, &info, &size) == 0 &&
         size == sizeof info.bbr && info.bbr.bbr_cwnd_gain == kProbeWindowGain;
}

}  // namespace

TcpRoom tcp_room(int socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  int unsent = 0;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 || info.tcpi_snd_mss == 0 ||
      ::ioctl(socket, SIOCOUTQNSD, &unsent) != 0) {
    return {SIZE_MAX, 0};
  }
  const auto round_trip_us = static_cast<TimeUs>(info.tcpi_rtt);
  // Packets in flight, counted as in the kernel's tcp_packets_in_flight(), and packets that wait to
  // be sent.
  const std::uint64_t away =
      std::uint64_t{info.tcpi_unacked} + info.tcpi_retrans -
      std::min<std::uint64_t>(info.tcpi_unacked, std::uint64_t{info.tcpi_sacked} + info.tcpi_lost);
  const std::uint64_t waiting =
      (static_cast<std::uint64_t>(unsent) + info.tcpi_snd_mss - 1) / info.tcpi_snd_mss;
  const bool measures = info.tcpi_snd_cwnd <= kProbePackets && measures_round_trip(socket);
  const std::uint64_t window = measures ? 1 : info.tcpi_snd_cwnd;
  return {static_cast<std::size_t>((window - std::min(window, away + waiting)) * info.tcpi_snd_mss),
          round_trip_us};
}

}  // namespace runstone
