// FaultyWriter: calls a store as a server does, on a disk with a fault, and checks each error.
#pragma once
#include <catch2/catch.hpp>

#include "server/store/store.hpp"
#include "tests/support/sql/disk_fault.hpp"

namespace runstone::test {

class FaultyWriter {
 public:
  FaultyWriter(FaultVfs& vfs, const DiskFault& fault) : vfs_(vfs), fault_(fault) {}

  /// Calls `call`, and once more without the fault if there was no room. Returns false if the server
  /// would end.
  template <class Call>
  bool does(const Call& call) {
    const auto done = call();
    if (done) return true;
    check(done.error());
    if (done.error().kind != StoreError::Kind::full) return false;
    vfs_.heal();
    const auto again = call();
    INFO((again ? "" : again.error().message()));
    REQUIRE(again.has_value());
    return true;
  }
  /// Checks that an error names the fault, and that a later try may succeed.
  void check(const StoreError& error) const {
    INFO(error.message());
    CHECK(error.may_pass());
    CHECK(error.kind != StoreError::Kind::locked);
    CHECK(says_why(error.what, fault_));
    if (fault_.system_error == EIO) CHECK(error.kind == StoreError::Kind::io);
  }

 private:
  FaultVfs& vfs_;
  const DiskFault& fault_;
};

/// Opens a world after the fault. Requires that it is sound.
inline std::unique_ptr<Store> sound_world(const std::string& place) {
  auto store = open_world(place, StoreAccess::read_write);
  INFO((store ? "" : store.error().message()));
  REQUIRE(store.has_value());
  const auto sound = (*store)->check();
  INFO((sound ? "" : sound.error().message()));
  REQUIRE(sound.has_value());
  return *std::move(store);
}

}  // namespace runstone::test
