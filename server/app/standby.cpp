#include "server/app/standby.hpp"

#include <optional>

#include "server/runtime/logging.hpp"
#include "server/store/postgres_lease.hpp"

namespace runstone {
namespace {

constexpr std::chrono::milliseconds kPause{250};

/// Returns why the standby waits, or an empty text if nobody writes the world.
std::string reason_to_wait(LeaseWatch& lease) {
  const auto owner = lease.owner();
  if (!owner) return owner.error().message();
  return *owner ? **owner + " writes the world" : std::string();
}

}  // namespace

Result<std::unique_ptr<Server>, std::string> start_as_standby(
    const std::string& place, const std::function<bool(std::chrono::milliseconds)>& stops_within,
    const std::function<Result<std::unique_ptr<Server>, std::string>()>& start) {
  LeaseWatch lease(place);
  std::string told;
  for (;;) {
    const std::string reason = reason_to_wait(lease);
    if (reason.empty()) {
      logger("app").info("STANDBY: nobody writes the world: taking it over");
      auto started = start();
      if (started) return started;
      // Another standby was faster, or the database went away. It may show a moment later.
      if (stops_within(kPause)) return std::unique_ptr<Server>();
      if (reason_to_wait(lease).empty()) return started;
    } else if (reason != told) {
      logger("app").info("STANDBY: waiting, because {}", reason);
      told = reason;
    }
    if (stops_within(kPause)) return std::unique_ptr<Server>();
  }
}

}  // namespace runstone
