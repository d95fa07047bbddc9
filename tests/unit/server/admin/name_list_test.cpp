#include "server/admin/name_list.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/key_fingerprint.hpp"

using namespace runstone;

TEST_CASE("names lists the owners, at most 500", "[admin][names]") {
  CHECK(name_list({}) == "nobody owns a name");
  const PublicKey key{7};
  CHECK(name_list({{"Ana", key, 3}, {"the mole", key, std::nullopt}}) ==
        "\"Ana\" " + key_fingerprint(key) + " #3\n\"the mole\" " + key_fingerprint(key));
  const std::string many = name_list(std::vector<OwnedName>(502, {"x", key, 3}));
  CHECK(many.ends_with("\nand 2 more"));
}
