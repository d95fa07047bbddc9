// Place: a network in which sockets are made and programs are started: the machine's own, or a namespace that nobody
// else sees. A namespace has no name: the kernel takes it, and all devices in it, back with the last thing that holds
// it, however this program ends.
#pragma once
#include <asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.hpp"

namespace runstone::bench {

class Place {
 public:
  /// The network of this process.
  static std::unique_ptr<Place> here();
  /// A new one with nothing in it but its loopback device, which is up. Needs CAP_SYS_ADMIN; the error says what
  /// failed.
  static Result<std::unique_ptr<Place>, std::string> make_namespace();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// Runs `work` on the place's thread and waits for it: sockets that it opens, devices that it attaches and programs
  /// that it starts belong to the place. Any thread, but not from within `work`.
  void run(const std::function<void()>& work);

 private:
  Place() = default;
  asio::thread_pool thread_{
      1};  // lives as long as the place: programs are killed with the thread that started them
};

}  // namespace runstone::bench
