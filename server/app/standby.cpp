#include "server/app/standby.hpp"

#include <utility>

#include "server/runtime/logging.hpp"
#include "server/world/cluster/handover.hpp"

namespace runstone {
namespace {

constexpr std::chrono::milliseconds kStartLookPause{250};
// A server that follows may have edits that the database lacks. So a server that starts waits for a
// second before it takes a world without an owner. A server that follows takes it earlier, unless it
// has not noticed yet that the owner is gone.
constexpr int kLooksWithoutOwner = 4;
// A start can fail because of something that passes: another server was faster, or the database takes no
// further connection. So it is tried several times, kStartLookPause apart.
constexpr int kStartsMax = 20;
// Between two looks of a server that follows. When a world is handed over to another server, this one
// connects to the next owner about so much later.
constexpr std::chrono::milliseconds kWatchPause{50};
// An owner that stops lets go of the connection first, and of the lease a moment later. Edits of players
// wait meanwhile.
constexpr std::chrono::milliseconds kOwnerlessPause{4};
constexpr int kOwnerlessLooksMax = 500;
// Other servers leave a free lease alone for so long. A server that the owner has chosen, or that has
// followed an owner that is gone, takes the lease within some 0.1 s.
constexpr std::chrono::microseconds kSuccessorTime{kFollowersKeptUs};

}  // namespace

Result<std::unique_ptr<Server>, std::string> start_as_standby(
    const std::string& place, const std::function<bool(std::chrono::milliseconds)>& stops_within,
    const StartServer& start, const StartServer& follow) {
  LeaseWatch lease(place);
  std::string told;
  int looks_without_owner = 0, starts = 0;
  for (;;) {
    const auto owner = lease.owner();
    std::string reason;
    if (!owner || *owner) looks_without_owner = starts = 0;
    if (!owner) {
      reason = owner.error().message();
    } else if (*owner) {
      auto followed = follow();
      if (followed) return followed;
      reason = (*owner)->name + " owns the world, and cannot be followed: " + followed.error();
    } else if (++looks_without_owner <= kLooksWithoutOwner) {
      reason = "nobody owns the world, and a server that follows may take it over";
    } else {
      if (++starts == 1) logger("app").info("STANDBY: nobody owns the world: taking it over");
      auto started = start();
      if (started || starts == kStartsMax) return started;
      reason = started.error();
    }
    if (reason != told) logger("app").info("STANDBY: waiting, because {}", reason);
    told = reason;
    if (stops_within(kStartLookPause)) return std::unique_ptr<Server>();
  }
}

TakeoverWatch::TakeoverWatch(const std::string& place, Server& server,
                             std::function<void()> on_failure, CommandReply handed_over)
    : lease_(place),
      server_(server),
      on_failure_(std::move(on_failure)),
      handed_over_(std::move(handed_over)),
      not_before_(std::chrono::steady_clock::now()) {
  if (handed_over_) {
    not_before_ += kSuccessorTime;
    ownerless_looks_left_ = kOwnerlessLooksMax;
  }
  thread_ = std::thread([this] { run(); });
}

TakeoverWatch::~TakeoverWatch() {
  {
    const std::lock_guard guard(mutex_);
    is_stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
  answer("the server stops", false);
}

/// Looks every kWatchPause. While there is no owner, or the connection with it is not live, looks every
/// kOwnerlessPause instead, at most kOwnerlessLooksMax times.
void TakeoverWatch::run() {
  const auto stops_within = [this](std::chrono::milliseconds pause) {
    std::unique_lock lock(mutex_);
    return wake_.wait_for(lock, pause, [this] { return is_stopping_; });
  };
  while (look()) {
    auto left = kWatchPause;
    do {
      const bool is_live = server_.follow_state().is_live;
      if (is_live) {
        ownerless_looks_left_ = kOwnerlessLooksMax;
        answer("another server owns the world now, and this one follows it", true);
      }
      if (stops_within(kOwnerlessPause)) return;
      left -= kOwnerlessPause;
      if ((!is_live || ownerless_since_) && ownerless_looks_left_ > 0) {
        --ownerless_looks_left_;
        break;
      }
    } while (left > kOwnerlessPause);
  }
}

bool TakeoverWatch::leaves_lease() {
  const auto now = std::chrono::steady_clock::now();
  if (!ownerless_since_) ownerless_since_ = now;
  const bool others_come_first = !has_followed_ || server_.follow_state().hears_owner;
  return now < not_before_ || (others_come_first && now - *ownerless_since_ < kSuccessorTime);
}

void TakeoverWatch::answer(const std::string& outcome, bool is_ok) {
  if (const CommandReply reply = std::exchange(handed_over_, {})) reply({outcome, true, is_ok});
}

bool TakeoverWatch::look() {
  if (server_.ownership() == OwnershipState::forked) {
    fail("the owner has other edits than this server: start it again");
    return false;
  }
  const auto owner = lease_.owner();
  if (!owner) {
    warn(owner.error().message());
    return true;
  }
  if (*owner) {
    told_.clear();
    ownerless_since_.reset();
    not_before_ = {};  // the successor has come
    // When another server has become the owner, the connection may still be with the one before.
    const bool is_same_owner = std::exchange(term_, (*owner)->term) == (*owner)->term;
    has_followed_ = is_same_owner && (has_followed_ || server_.follow_state().is_live);
    if (!(*owner)->address.empty()) server_.connect_to((*owner)->address);
    return true;
  }
  if (leaves_lease()) return true;
  if (told_.empty()) logger("app").info("STANDBY: nobody owns the world: taking it over");
  const auto taken = server_.take_over();
  if (taken) {
    answer("handover: no other server owns the world now, and this one owns it again", false);
    return false;
  }
  if (taken.error().must_stop) {
    fail(taken.error().what);
    return false;
  }
  warn("the world cannot be taken over: " + taken.error().what);
  return true;
}

/// Logs why this server can neither follow nor own the world, once for each reason.
void TakeoverWatch::warn(const std::string& why) {
  if (why != told_) logger("app").warn("STANDBY: waiting, because {}", why);
  told_ = why;
}

void TakeoverWatch::fail(const std::string& why) {
  logger("app").error("STANDBY: {}", why);
  on_failure_();
}

bool hand_over_and_watch(const std::string& place, Server& server,
                         std::optional<TakeoverWatch>& watch,
                         const std::function<void()>& on_failure,
                         std::optional<SessionId> successor, const CommandReply& reply) {
  const auto done = server.hand_over(successor);
  if (done) {
    watch.emplace(place, server, on_failure, reply);
    return true;
  }
  refuse(reply, "handover: " + done.error().what);
  if (!done.error().must_stop) return true;
  logger("app").error("STANDBY: the world was not handed over: {}", done.error().what);
  return false;
}

}  // namespace runstone
