#include "server/names/name_reference.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("names that commands read as a number, a key, an address, a role or a pattern are found",
          "[names]") {
  for (const char* name : {"#1", "#", "#ana"}) {
    CAPTURE(name);
    CHECK(read_as_reference(name) == "the number of a player");
  }
  for (const char* name : {"192.0.2.7", "192.0.2.0/24", "::1", "2001:db8::/32", "fe80::1%eth0"}) {
    CAPTURE(name);
    CHECK(read_as_reference(name) == "an address");
  }
  CHECK(read_as_reference("9m1q-z7cr-04kd") == "the fingerprint of a key");
  CHECK(read_as_reference(std::string(64, 'a')) == "a key");
  CHECK(read_as_reference("role:builder") == "a role");
  CHECK(read_as_reference("role:") == "a role");
  for (const char* name : {"an*", "*", "* ana *"}) {
    CAPTURE(name);
    CHECK(read_as_reference(name) == "a pattern of names");
  }
  for (const char* name : {"ana", "ana #1", "192", "1.2", "9m1q-z7cr", "abba", "7/8", "address",
                           "role", "role builder", "a role:builder"}) {
    CAPTURE(name);
    CHECK(read_as_reference(name) == std::nullopt);
  }
}

TEST_CASE("a fingerprint is recognised in upper and lower case", "[names]") {
  CHECK(fingerprint_in("9m1q-Z7cr-04kd") == "9M1Q-Z7CR-04KD");
  CHECK(fingerprint_in("9M1QZ7CR04KD").empty());
}
