#include "server/admin/rights_change_text.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "protocol/codec/key_fingerprint.hpp"

namespace runstone::rights_change_text_test {

TEST_CASE("each change of rights is one readable line", "[admin][rights]") {
  const PublicKey key{1};
  const std::string ana = key_fingerprint(key);
  CHECK(rights_change_text(DefineRole{{"mason", {Right::build, Right::see}, 1000, 3, 4096}}) ==
        "role mason := see,build volume 1000 claims 3 claim-volume 4096");
  Role slow{"slow", {Right::see}, 0, 0, 0};
  slow.edit_budget = {25, 900};
  slow.view_radius_max = 6;
  slow.chunk_loads_per_second = 100;
  CHECK(rights_change_text(DefineRole{slow}) == "role slow := see edits 25/900 view 6 loads 100");
  CHECK(rights_change_text(DefineRole{{"nobody", {}, 0, 0, 0}}) == "role nobody := none");
  CHECK(rights_change_text(RemoveRole{"mason"}) == "role mason removed");
  CHECK(rights_change_text(GrantRole{key, "mason"}) == "gave " + ana + " the role mason");
  CHECK(rights_change_text(GrantRole{key, "mason", 1'000'000}) ==
        "gave " + ana + " the role mason until 1970-01-01T00:00:01Z");
  CHECK(rights_change_text(GrantRole{key, ""}) == "took the role of " + ana + " back");
  CHECK(rights_change_text(SetDefaultRole{"mason"}) == "default role mason");
  CHECK(rights_change_text(Restrict{RestrictionKind::ban, key, 1'000'000'000'000'000, "grief"}) ==
        "banned " + ana + " until 2001-09-09T01:46:40Z: grief");
  CHECK(rights_change_text(Restrict{RestrictionKind::mute, key, 0, ""}) == "muted " + ana);
  const AddressRange range{address_block_v4(0xc0'00'02'00), 32 + 24};
  CHECK(rights_change_text(Lift{RestrictionKind::ban, range}) == "no longer banned: 192.0.2.0/24");
  CHECK(rights_change_text(Lift{RestrictionKind::freeze, key}) == "no longer frozen: " + ana);
  CHECK(rights_change_text(Protect{{"town", {{1, 2, 3}, {5, 6, 7}}, 4, key, {key}, {"a", "b"}}}) ==
        "protected town 1 2 3 to 4 5 6 priority 4 owner " + ana + " members " + ana + " roles a,b");
  CHECK(rights_change_text(Protect{{"strip", columns(1, 2, 4, 5), 0, {}, {}, {}}}) ==
        "protected strip columns 1 2 to 3 4");
  CHECK(rights_change_text(Unprotect{"town"}) == "no longer protected: town");
  CHECK(rights_change_text(SetPassword{{{"mason", {1}, {2}}}}) ==
        "set a password for the role mason");
  CHECK(rights_change_text(SetPassword{}) == "removed the password");
  CHECK(rights_change_text(CorrectTime{-63'072'000'000'000 - 7'200'000'000 - 5'000'000, 1}) ==
        "set the time of the log back by 730d2h");
  CHECK(rights_change_text(CorrectTime{7'200'000'000, 1}) ==
        "set the time of the log forward by 2h");
  CHECK(rights_change_text(CorrectTime{std::numeric_limits<TimeUs>::min(), 1}) ==
        "set the time of the log back by 106751991d4h");
  CHECK(rights_change_text(AcceptPassword{key}) == ana + " joined with the password");
}

}  // namespace runstone::rights_change_text_test
