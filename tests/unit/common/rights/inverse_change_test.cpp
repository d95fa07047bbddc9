#include <catch2/catch.hpp>

#include "common/rights/change_rules.hpp"
#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

/// Returns the inverse of the last of these changes.
std::optional<RightsChange> inverse_of_last(const std::vector<RightsChange>& changes) {
  std::vector<RightsRecord> records;
  for (const RightsChange& change : changes) {
    records.push_back({change, {10 * (records.size() + 1), 0, 0}});
  }
  return inverse_of(records, 10 * records.size());
}

const PublicKey kSubject = key_of(31);
const Role kGuard = {"guard", {Right::see}, 1, 2, 3};
const Role kOtherGuard = {"guard", {Right::see, Right::chat}, 4, 5, 6};

ProtectedBox box_of_side(std::int32_t side) {
  ProtectedBox box;
  box.name = "box";
  box.box = {{0, 0, 0}, {side, side, side}};
  return box;
}

}  // namespace

TEST_CASE("the inverse of a change of a role restores the role", "[rights]") {
  CHECK(inverse_of_last({DefineRole{kGuard}}) == RightsChange{RemoveRole{"guard"}});
  CHECK(inverse_of_last({DefineRole{kGuard}, DefineRole{kOtherGuard}}) ==
        RightsChange{DefineRole{kGuard}});
  CHECK(inverse_of_last({DefineRole{kGuard}, RemoveRole{"guard"}}) ==
        RightsChange{DefineRole{kGuard}});
  Role visitor = kGuard;
  visitor.name = kVisitorRole;
  CHECK(inverse_of_last({DefineRole{visitor}}) == RightsChange{RemoveRole{kVisitorRole}});
  CHECK(inverse_of_last({DefineRole{visitor}, RemoveRole{kVisitorRole}}) ==
        RightsChange{DefineRole{visitor}});
}

TEST_CASE("the inverse of a grant, a default role and a restriction restores them", "[rights]") {
  CHECK(inverse_of_last({GrantRole{kSubject, "guard"}}) == RightsChange{GrantRole{kSubject, ""}});
  CHECK(inverse_of_last({GrantRole{kSubject, "guard"}, GrantRole{kSubject, ""}}) ==
        RightsChange{GrantRole{kSubject, "guard"}});
  CHECK(inverse_of_last({SetDefaultRole{"guard"}}) == RightsChange{SetDefaultRole{kBuilderRole}});
  const Restrict mute{RestrictionKind::mute, kSubject, 60, "loud"};
  CHECK(inverse_of_last({mute}) == RightsChange{Lift{RestrictionKind::mute, kSubject}});
  CHECK(inverse_of_last({mute, Lift{RestrictionKind::mute, kSubject}}) == RightsChange{mute});
  CHECK(inverse_of_last({mute, Lift{RestrictionKind::ban, kSubject}}) ==
        RightsChange{Lift{RestrictionKind::ban, kSubject}});
  const AddressRange range{AddressBlock{0}, 40};
  CHECK(inverse_of_last({Restrict{RestrictionKind::ban, range, 0, ""}}) ==
        RightsChange{Lift{RestrictionKind::ban, range}});
}

TEST_CASE("the inverse of a change of a box restores the box", "[rights]") {
  CHECK(inverse_of_last({Protect{box_of_side(2)}}) == RightsChange{Unprotect{"box"}});
  CHECK(inverse_of_last({Protect{box_of_side(2)}, Protect{box_of_side(3)}}) ==
        RightsChange{Protect{box_of_side(2)}});
  CHECK(inverse_of_last({Protect{box_of_side(2)}, Unprotect{"box"}}) ==
        RightsChange{Protect{box_of_side(2)}});
}

TEST_CASE("a record that a later one has replaced has no inverse", "[rights]") {
  const std::vector<RightsRecord> records = {
      {DefineRole{kGuard}, {3, 0, 0}},
      {GrantRole{kSubject, "guard"}, {5, 0, 0}},
      {GrantRole{key_of(32), "guard"}, {6, 0, 0}},
      {GrantRole{kSubject, kVisitorRole}, {8, 0, 0}},
      {RemoveRole{"guard"}, {9, 0, 0}},
  };
  CHECK_FALSE(inverse_of(records, 3).has_value());
  CHECK_FALSE(inverse_of(records, 5).has_value());
  CHECK(inverse_of(records, 6) == RightsChange{GrantRole{key_of(32), ""}});
  CHECK(inverse_of(records, 8) == RightsChange{GrantRole{kSubject, "guard"}});
  CHECK_FALSE(inverse_of(records, 4).has_value());
  CHECK_FALSE(inverse_of({}, 1).has_value());
}

}  // namespace runstone::test
