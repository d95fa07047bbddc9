#include "bench/network/tun_link.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/network/descriptor.hpp"
#include "common/core/hash.hpp"

namespace runstone::bench {
namespace {

using test::LinkFate;
using test::LinkModel;
using test::TimeNs;

constexpr const char* kDevice = "rs0";
constexpr int kBatch = 64;  // packets read from one side before the other side is read
constexpr std::size_t kLatesMax = 1'000'000;
// The number of packets that may wait for the forwarder. It is large, so that no packet is lost
// outside of the model.
constexpr int kKernelPackets = 20'000;

TimeNs link_now() { return static_cast<TimeNs>(now_ns()); }

std::string failed(const char* what) { return std::string(what) + ": " + std::strerror(errno); }

/// Opens a TUN device in the calling thread's namespace, with its address, and brings it up. Sets
/// `why` and returns an invalid descriptor if that fails.
Descriptor open_tun(const char* address, std::string& why) {
  Descriptor tun(::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC));
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!tun || !socket) {
    why = failed("cannot open /dev/net/tun");
    return {};
  }
  const auto request = [] {
    ifreq out{};
    std::strncpy(out.ifr_name, kDevice, IFNAMSIZ - 1);
    return out;
  };
  const auto inet = [](const char* text) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    ::inet_pton(AF_INET, text, &in.sin_addr);
    sockaddr out{};
    std::memcpy(&out, &in, sizeof in);
    return out;
  };
  const auto control = [&](int descriptor, unsigned long what, ifreq& it, const char* name) {
    if (why.empty() && ::ioctl(descriptor, what, &it) != 0) why = failed(name);
  };
  ifreq it = request();
  it.ifr_flags = IFF_TUN | IFF_NO_PI;
  control(tun.get(), TUNSETIFF, it, "cannot make a TUN device");
  it = request();
  it.ifr_addr = inet(address);
  control(socket.get(), SIOCSIFADDR, it, "cannot set the address of a TUN device");
  it = request();
  it.ifr_netmask = inet("255.255.255.0");
  control(socket.get(), SIOCSIFNETMASK, it, "cannot set the netmask of a TUN device");
  it = request();
  it.ifr_mtu = TunLink::kMtu;
  control(socket.get(), SIOCSIFMTU, it, "cannot set the MTU of a TUN device");
  it = request();
  it.ifr_qlen = kKernelPackets;
  control(socket.get(), SIOCSIFTXQLEN, it, "cannot set the queue of a TUN device");
  it = request();
  it.ifr_flags = IFF_UP | IFF_RUNNING;
  control(socket.get(), SIOCSIFFLAGS, it, "cannot bring a TUN device up");
  if (!why.empty()) return {};
  // A connection must not use the kernel's cached metrics of earlier connections.
  const Descriptor metrics(::open("/proc/sys/net/ipv4/tcp_no_metrics_save", O_WRONLY | O_CLOEXEC));
  if (!metrics || ::write(metrics.get(), "1", 1) != 1) {
    why = failed("cannot set tcp_no_metrics_save");
    return {};
  }
  return tun;
}

enum Side : std::size_t { kServer = 0, kClient = 1 };

/// Returns the client's TCP port of a packet from `side`, or 0 for any other packet.
std::uint16_t connection_of(const std::uint8_t* packet, std::size_t bytes, Side side) {
  constexpr std::size_t kIpv4HeaderMin = 20;
  if (bytes < kIpv4HeaderMin || packet[0] >> 4 != 4 || packet[9] != IPPROTO_TCP) return 0;
  const std::size_t header = std::size_t{packet[0] & 15U} * 4;
  if (bytes < header + 4) return 0;
  const std::uint8_t* const port = packet + header + (side == kServer ? 2 : 0);
  return static_cast<std::uint16_t>(port[0] << 8 | port[1]);
}

struct Packet {
  TimeNs due_ns = 0;
  std::uint64_t number = 0;  // packets due at the same time keep their order
  Side to = kServer;
  std::vector<std::uint8_t> bytes;
};
struct Later {
  bool operator()(const Packet& a, const Packet& b) const {
    return a.due_ns != b.due_ns ? a.due_ns > b.due_ns : a.number > b.number;
  }
};

void add(test::LinkCounts& sum, const test::LinkCounts& one) {
  sum.packets += one.packets;
  sum.bytes += one.bytes;
  sum.lost += one.lost;
  sum.no_room += one.no_room;
}

}  // namespace

struct TunLink::Forwarder {
  Forwarder(const test::LinkProfile& link, std::uint64_t random_seed)
      : profile(link), seed(random_seed) {}

  void start() {
    thread = std::thread([this] { forward(); });
    // A packet is forwarded when it is due, however busy the measured programs keep the cores.
    sched_param first{};
    first.sched_priority = 1;
    counts.real_time = ::pthread_setschedparam(thread.native_handle(), SCHED_RR, &first) == 0;
  }

  void forward() {
    const std::uint64_t began_ns = now_ns();
    while (!read_and_send()) wait();
    counts.busy = static_cast<double>(core_ns()) / static_cast<double>(now_ns() - began_ns);
  }

  /// Returns true if the link is to end.
  bool read_and_send() {
    for (const Side from : {kServer, kClient}) {
      for (int i = 0; i < kBatch && read(from); ++i) {
      }
      send();
    }
    std::uint64_t word = 0;
    return ::read(stopped.get(), &word, sizeof word) == sizeof word;
  }

  bool read(Side from) {
    std::array<std::uint8_t, 2048> buffer;
    const ssize_t got = ::read(tuns[from].get(), buffer.data(), buffer.size());
    if (got <= 0) return false;
    const auto bytes = static_cast<std::size_t>(got);
    const auto passage =
        link(from, connection_of(buffer.data(), bytes, from)).push(bytes, link_now());
    if (passage.fate != LinkFate::arrives) return true;
    Packet packet;
    packet.due_ns = passage.due_ns;
    packet.number = next_number++;
    packet.to = from == kServer ? kClient : kServer;
    if (!spare.empty()) {
      packet.bytes = std::move(spare.back());
      spare.pop_back();
    }
    packet.bytes.assign(buffer.data(), buffer.data() + bytes);
    under_way.push_back(std::move(packet));
    std::push_heap(under_way.begin(), under_way.end(), Later{});
    return true;
  }

  void send() {
    while (!under_way.empty()) {
      const TimeNs late_ns = link_now() - under_way.front().due_ns;
      if (late_ns < 0) return;
      std::pop_heap(under_way.begin(), under_way.end(), Later{});
      Packet& packet = under_way.back();
      if (::write(tuns[packet.to].get(), packet.bytes.data(), packet.bytes.size()) < 0)
        ++counts.refused;
      spare.push_back(std::move(packet.bytes));
      under_way.pop_back();
      if (lates_us.size() < kLatesMax) lates_us.push_back(static_cast<double>(late_ns) / 1000);
    }
  }

  void wait() {
    std::array<pollfd, 3> files = {{{tuns[kServer].get(), POLLIN, 0},
                                    {tuns[kClient].get(), POLLIN, 0},
                                    {stopped.get(), POLLIN, 0}}};
    if (under_way.empty()) {
      ::ppoll(files.data(), files.size(), nullptr, nullptr);
      return;
    }
    constexpr TimeNs kSecond = 1'000'000'000;
    const TimeNs left_ns = std::clamp<TimeNs>(under_way.front().due_ns - link_now(), 0, kSecond);
    const timespec pause{left_ns / kSecond, left_ns % kSecond};
    ::ppoll(files.data(), files.size(), &pause, nullptr);
  }

  LinkModel& link(Side from, std::uint16_t connection) {
    auto& all = links[from];
    const auto it = all.find(connection);
    if (it != all.end()) return it->second;
    return all.emplace(connection, LinkModel(profile, mix64(seed + 2 * all.size() + from)))
        .first->second;
  }

  const test::LinkProfile profile;
  const std::uint64_t seed;
  std::array<std::unique_ptr<Place>, 2> places;
  std::array<Descriptor, 2> tuns;
  Descriptor stopped;
  // by the side from which packets come
  std::array<std::unordered_map<std::uint16_t, LinkModel>, 2> links;
  std::vector<Packet> under_way;  // a heap, the next packet due at the front
  std::vector<std::vector<std::uint8_t>> spare;
  std::vector<double> lates_us;
  std::uint64_t next_number = 0;
  TunCounts counts;
  std::thread thread;
};

TunLink::TunLink(std::unique_ptr<Forwarder> forwarder) : forwarder_(std::move(forwarder)) {}

TunLink::~TunLink() { stop(); }

Result<std::unique_ptr<TunLink>, std::string> TunLink::make(const test::LinkProfile& profile,
                                                            std::uint64_t seed) {
  auto forwarder = std::make_unique<Forwarder>(profile, seed);
  for (const Side side : {kServer, kClient}) {
    auto place = Place::make_namespace();
    if (!place) return failure(place.error());
    std::string why;
    (*place)->run([&] {
      forwarder->tuns[side] = open_tun(side == kServer ? kServerAddress : kClientAddress, why);
    });
    if (!why.empty()) return failure(why);
    forwarder->places[side] = *std::move(place);
  }
  forwarder->stopped = Descriptor(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
  if (!forwarder->stopped) return failure(failed("cannot make an event"));
  forwarder->start();
  return std::unique_ptr<TunLink>(new TunLink(std::move(forwarder)));
}

Place& TunLink::server_side() { return *forwarder_->places[kServer]; }
Place& TunLink::client_side() { return *forwarder_->places[kClient]; }

TunCounts TunLink::stop() {
  Forwarder& it = *forwarder_;
  if (!it.thread.joinable()) return it.counts;
  const std::uint64_t one = 1;
  while (::write(it.stopped.get(), &one, sizeof one) != sizeof one && errno == EINTR) {
  }
  it.thread.join();
  for (const auto& [connection, link] : it.links[kServer]) add(it.counts.to_client, link.counts());
  for (const auto& [connection, link] : it.links[kClient]) add(it.counts.to_server, link.counts());
  if (!it.lates_us.empty()) {
    it.counts.late_us_p99 = quantile(it.lates_us, 0.99);
    it.counts.late_us_max = *std::max_element(it.lates_us.begin(), it.lates_us.end());
  }
  return it.counts;
}

}  // namespace runstone::bench
