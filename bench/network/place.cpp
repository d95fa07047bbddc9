#include "bench/network/place.hpp"

#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <asio/post.hpp>
#include <cerrno>
#include <cstring>
#include <future>

namespace runstone::bench {
namespace {

/// Returns an empty text, or the reason of a failure.
std::string enter_new_namespace() {
  const auto failed = [](const char* what) {
    return std::string(what) + ": " + std::strerror(errno);
  };
  if (::unshare(CLONE_NEWNET) != 0) return failed("cannot make a network namespace");
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return failed("cannot make a socket");
  ifreq request{};
  std::strncpy(request.ifr_name, "lo", IFNAMSIZ - 1);
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  const std::string why = ::ioctl(socket, SIOCSIFFLAGS, &request) == 0
                              ? ""
                              : failed("cannot bring the loopback device up");
  ::close(socket);
  return why;
}

}  // namespace

std::unique_ptr<Place> Place::here() { return std::unique_ptr<Place>(new Place); }

Result<std::unique_ptr<Place>, std::string> Place::make_namespace() {
  auto place = here();
  std::string why;
  place->run([&] { why = enter_new_namespace(); });  // of that one thread
  if (!why.empty()) return failure(why);
  return place;
}

void Place::run(const std::function<void()>& work) {
  std::packaged_task<void()> task([&work] { work(); });
  std::future<void> done = task.get_future();
  asio::post(thread_, std::ref(task));
  done.get();
}

}  // namespace runstone::bench
