// LeaseTerms and LeaseOwner: the lease of a world in a database, as its owner asks for it and as others
// see it (server/store/postgres_lease.hpp).
#pragma once
#include <chrono>
#include <string>

namespace runstone {

struct LeaseTerms {
  /// Names the program in messages to others. An empty name stands for the machine and the process.
  std::string owner;
  /// After this time without a renewal, another program may take the world over.
  std::chrono::milliseconds length{5'000};
};

struct LeaseOwner {
  std::string name;
  std::chrono::milliseconds left{0};  // until the lease ends, unless it is renewed
};

}  // namespace runstone
