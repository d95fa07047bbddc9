#include "bench/network/attack.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <string_view>
#include <utility>

#include "bench/network/attack_thread.hpp"
#include "bench/network/edit_attacks.hpp"
#include "bench/network/map_attacks.hpp"
#include "bench/network/session_attacks.hpp"
#include "bench/network/view_attacks.hpp"

namespace runstone::bench {
namespace {

constexpr std::array<Attack, 24> kAttacks = {{
    {kQuiet, "nobody attacks", stay_away, false},
    {"elsewhere", "as many threads copy bytes in the kernel: no attack, only a busy machine",
     keep_the_machine_busy, false},
    {"never-reads", "a view of radius 64, without ever reading", never_read},
    {"unread-pings", "the same, and 9,000 pings a second whose answers are not read", ping_unread},
    {"byte-a-second", "a view of radius 64, one byte read a second", read_a_byte_a_second},
    {"views",
     "views of radius 64 anywhere in the world, 9,000 a second and as many as the socket takes",
     flood_views},
    {"absurd-views", "views of radius 255", flood_absurd_views},
    {"claims", "claims of 29,791 chunks, again and again, and of 117,649", claim_falsely},
    {"half-open", "connections that send nothing or half a hello, from one address and from 250",
     open_halfway},
    {"handshakes", "TLS handshakes that end when the server has signed, one after another",
     shake_hands},
    {"garbage",
     "random bytes, frames of 64 KiB, frames cut short, inverted bits, messages without end",
     send_garbage},
    {"chunk-requests", "64 chunks of a view a message, again and again", request_chunks},
    {"edits", "single voxels, 9,000 a second and as many as the socket takes", edit_too_often},
    {"large-edits", "the same with spheres of 905,000 voxels", edit_too_much},
    {"pastes", "the same with clipboards of 47 KB", paste_much},
    {"wide-edits", "the same with layers of 1,024 x 901 voxels, each in other chunks", edit_widely},
    {"tiny-chunks",
     "checkerboards in the chunks that the honest clients see: small on the wire, large in memory",
     build_tiny_chunks},
    {"teleports", "20 jumps a second anywhere on the ground, with a view of radius 64 each",
     teleport},
    {"spread-views",
     "a view of radius 64 on the ground, far from all others, and another one every 4 s",
     spread_views},
    {"seats", "as many sessions of one key as the server gives, which say nothing", take_seats},
    {kSeatsByRange,
     "each thread has an address in one /24, opens as many sessions as the server gives, each with "
     "another key, and holds them with pings",
     take_seats_of_range},
    {"travel", "requests of the past, likewise", travel_too_often},
    {"commands", "command lines, likewise, half of them 1 KiB of nonsense", command_too_often},
    {"map",
     "random tiles of the gateway's map, eight at a time for each thread, each from an address of "
     "another /24",
     request_random_tiles, true, true},
}};

AttackOutcome play_thread(const std::function<void(AttackThread&)>& play, const AttackPlan& plan,
                          unsigned index, const std::atomic<bool>& is_stopped) {
  if (plan.uses_idle_cores) {
    const sched_param none{};
    (void)::sched_setscheduler(0, SCHED_IDLE, &none);  // below every nice level
  } else {
    constexpr int kLowest = 19;
    (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kLowest);
  }
  AttackThread thread(plan, index, is_stopped);
  play(thread);
  rusage used{};
  if (::getrusage(RUSAGE_THREAD, &used) == 0) {
    const auto seconds_of = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
    };
    thread.outcome.core_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  }
  return std::move(thread.outcome);
}

}  // namespace

std::string alike(const std::string& reason) {
  constexpr std::string_view kSpeaks = "client speaks protocol ";
  std::string out = reason.substr(0, reason.find(" (at byte"));
  const std::size_t at = out.find(kSpeaks);
  if (at != std::string::npos) {
    const std::size_t number = at + kSpeaks.size();
    out.replace(number, out.find(',', number) - number, "N");
  }
  return out;
}

std::span<const Attack> all_attacks() { return kAttacks; }

void AttackOutcome::merge(const AttackOutcome& other) {
  for (const auto& [ending, count] : other.endings) endings[ending] += count;
  connections += other.connections;
  bytes_sent += other.bytes_sent;
  bytes_received += other.bytes_received;
  core_seconds += other.core_seconds;
}

RunningAttack::RunningAttack(std::function<void(AttackThread&)> play, const AttackPlan& plan)
    : play_(std::move(play)), outcomes_(plan.clients) {
  for (unsigned i = 0; i < plan.clients; ++i) {
    threads_.emplace_back([=, this] { outcomes_[i] = play_thread(play_, plan, i, is_stopped_); });
  }
}

RunningAttack::~RunningAttack() {
  stop();
  for (std::thread& thread : threads_) thread.join();
}

AttackOutcome RunningAttack::finish() {
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  AttackOutcome sum;
  for (const AttackOutcome& outcome : outcomes_) sum.merge(outcome);
  return sum;
}

}  // namespace runstone::bench
