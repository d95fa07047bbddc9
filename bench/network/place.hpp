// Place: a network in which sockets are made and programs are started: the machine's, or a private
// namespace. A namespace has no name. The kernel removes it, and all devices in it, with the last
// thing that holds it, however this program ends.
#pragma once
#include <asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.hpp"

namespace runstone::bench {

class Place {
 public:
  /// Returns the network of this process.
  static std::unique_ptr<Place> here();
  /// Makes a namespace with nothing in it but its loopback device, which is up. Requires
  /// CAP_SYS_ADMIN. Fails with the reason.
  static Result<std::unique_ptr<Place>, std::string> make_namespace();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// Runs `work` on the place's thread and waits for it. The sockets that it opens, the devices
  /// that it attaches and the programs that it starts belong to the place. Thread: any, but not
  /// from within `work`.
  void run(const std::function<void()>& work);

 private:
  Place() = default;
  asio::thread_pool thread_{
      // Lives as long as the place: programs are killed with the thread that started them.
      1};
};

}  // namespace runstone::bench
