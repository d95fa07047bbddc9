// LeaseTerms: how a program takes the lease of a world in a database
// (server/store/postgres_lease.hpp).
#pragma once
#include <chrono>
#include <string>

namespace runstone {

struct LeaseTerms {
  /// Names the program in messages to others. An empty name stands for the machine and the process.
  std::string owner;
  /// After this time without a renewal, another program may take the world over.
  std::chrono::milliseconds length{5'000};
  /// Wait while another program has the lease, because it may have ended. It has not if it renews
  /// the lease: taking the lease fails then. Without waiting, it fails at once.
  bool waits = true;
  /// A program that could not renew its lease for so long counts as one that has lost it. 0: there
  /// is no such limit.
  std::chrono::milliseconds alone_max{0};
};

}  // namespace runstone
