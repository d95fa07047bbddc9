#include "common/rights/rights_change.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

ErrorCode invalid(const RightsChange& change) {
  const auto result = validate(change);
  REQUIRE_FALSE(result.has_value());
  return result.error().code;
}

ErrorCode unreadable(const Bytes& bytes) {
  ByteReader in(bytes);
  read_rights_change(in);
  REQUIRE_FALSE(in.ok());
  return in.error().code;
}

Bytes bytes_of(const RightsChange& change) {
  Bytes out;
  encode(change, out);
  return out;
}

/// A box with as many members and roles as there can be, and the longest fields.
ProtectedBox largest_box() {
  ProtectedBox box;
  box.name = std::string(kRightsNameBytesMax, 'n');
  box.box = {{-kWorldLimit, -kWorldLimit, -kWorldLimit}, {kWorldLimit, kWorldLimit, kWorldLimit}};
  box.priority = -kBoxPriorityMax;
  box.owner = key_of(255);
  for (std::size_t i = 0; i < kBoxMembersMax; ++i) {
    box.members.push_back(key_of(static_cast<std::uint8_t>(i)));
  }
  for (std::size_t i = 0; i < kBoxRolesMax; ++i) {
    std::string role(kRightsNameBytesMax, 'r');
    role.back() = static_cast<char>('a' + i);
    box.roles.push_back(role);
  }
  return box;
}

}  // namespace

TEST_CASE("changes at the limits are valid and have few bytes", "[rights]") {
  const RightsChange box = Protect{largest_box()};
  REQUIRE(validate(box).has_value());
  CHECK(bytes_of(box).size() == 2677);
  const Restrict restrict {RestrictionKind::freeze, key_of(1), std::numeric_limits<TimeUs>::max(),
                           std::string(kReasonBytesMax, 'x')};
  REQUIRE(validate(restrict).has_value());
  CHECK(bytes_of(restrict).size() <= kRightsChangeBytesMax);
  CHECK(validate(GrantRole{key_of(1), ""}).has_value());
}

TEST_CASE("quotas of a role have their ranges, and a role without any has no bytes for them",
          "[rights]") {
  const auto with = [](const Budget& edits, std::uint32_t loads) {
    Role role{"a", {}, 0, 0, 0};
    role.edit_budget = edits;
    role.chunk_loads_per_second = loads;
    return DefineRole{role};
  };
  constexpr auto kLoadsMax = static_cast<std::uint32_t>(kBudgetPerSecondMax);
  CHECK(validate(with({kBudgetPerSecondMax, kBudgetBurstMax}, kLoadsMax)).has_value());
  CHECK(invalid(with({kBudgetPerSecondMax + 1, 1}, 0)) == ErrorCode::bad_value);
  CHECK(invalid(with({1, kBudgetBurstMax + 1}, 0)) == ErrorCode::bad_value);
  CHECK(invalid(with({1, 0}, 0)) == ErrorCode::bad_value);
  CHECK(invalid(with({0, 1}, 0)) == ErrorCode::bad_value);
  CHECK(invalid(with({}, kLoadsMax + 1)) == ErrorCode::bad_value);
  const Bytes no_quotas{14, 1, 'a', 0, 0, 0, 0, 0, 0, 0, 0};
  ByteReader in(no_quotas);
  read_rights_change(in);
  CHECK_FALSE(in.ok());
}

TEST_CASE("each field of a change has its range", "[rights]") {
  CHECK(invalid(DefineRole{{"Bad", {}, 0, 0, 0}}) == ErrorCode::bad_value);
  CHECK(invalid(DefineRole{{"a", RightSet::of_bits(1U << kRightCount), 0, 0, 0}}) ==
        ErrorCode::bad_value);
  CHECK(invalid(RemoveRole{""}) == ErrorCode::bad_value);
  CHECK(invalid(GrantRole{{}, "a b"}) == ErrorCode::bad_value);
  CHECK(invalid(SetDefaultRole{""}) == ErrorCode::bad_value);
  CHECK(invalid(Restrict{RestrictionKind::ban, key_of(1), -1, ""}) == ErrorCode::bad_value);
  CHECK(invalid(Restrict{RestrictionKind::ban, key_of(1), 0, "a\nb"}) == ErrorCode::bad_value);
  CHECK(invalid(Restrict{RestrictionKind::ban, key_of(1), 0,
                         std::string(kReasonBytesMax + 1, 'x')}) == ErrorCode::limit_exceeded);
  CHECK(invalid(Restrict{static_cast<RestrictionKind>(3), key_of(1), 0, ""}) ==
        ErrorCode::bad_value);
  const AddressRange range{AddressBlock{0}, 32};
  CHECK(invalid(Restrict{RestrictionKind::mute, range, 0, ""}) == ErrorCode::bad_value);
  CHECK(invalid(Lift{RestrictionKind::freeze, range}) == ErrorCode::bad_value);
  CHECK(invalid(Lift{RestrictionKind::ban, AddressRange{AddressBlock{1}, 32}}) ==
        ErrorCode::not_canonical);
  CHECK(invalid(Lift{RestrictionKind::ban, AddressRange{AddressBlock{0}, 65}}) ==
        ErrorCode::not_canonical);
  CHECK(invalid(Unprotect{"x y"}) == ErrorCode::bad_value);
  CHECK(invalid(CorrectTime{0, 1}) == ErrorCode::bad_value);
  CHECK(invalid(CorrectTime{1, 0}) == ErrorCode::bad_value);
  CHECK(invalid(CorrectTime{-1, kSequenceMax + 1}) == ErrorCode::bad_value);
  CHECK(validate(CorrectTime{std::numeric_limits<TimeUs>::max(), 1}).has_value());
  CHECK(validate(CorrectTime{std::numeric_limits<TimeUs>::min(), kSequenceMax}).has_value());
}

TEST_CASE("each field of a protected box has its range", "[rights]") {
  const auto broken = [](auto&& damage) {
    ProtectedBox box = largest_box();
    damage(box);
    return invalid(Protect{box});
  };
  CHECK(broken([](ProtectedBox& b) { b.name = ""; }) == ErrorCode::bad_value);
  CHECK(broken([](ProtectedBox& b) { b.box.max.y = b.box.min.y; }) == ErrorCode::bad_value);
  CHECK(broken([](ProtectedBox& b) { --b.box.min.x; }) == ErrorCode::bad_value);
  CHECK(broken([](ProtectedBox& b) { ++b.box.max.z; }) == ErrorCode::bad_value);
  CHECK(broken([](ProtectedBox& b) { b.box.max.z = std::numeric_limits<std::int32_t>::max(); }) ==
        ErrorCode::bad_value);
  CHECK(broken([](ProtectedBox& b) { b.priority = kBoxPriorityMax + 1; }) == ErrorCode::bad_value);
  CHECK(broken([](ProtectedBox& b) { --b.priority; }) == ErrorCode::bad_value);
  CHECK(broken([](ProtectedBox& b) { b.members.push_back(key_of(255)); }) ==
        ErrorCode::limit_exceeded);
  CHECK(broken([](ProtectedBox& b) { b.roles.push_back("z"); }) == ErrorCode::limit_exceeded);
  CHECK(broken([](ProtectedBox& b) { std::swap(b.members[3], b.members[4]); }) ==
        ErrorCode::not_canonical);
  CHECK(broken([](ProtectedBox& b) { b.members[3] = b.members[4]; }) == ErrorCode::not_canonical);
  CHECK(broken([](ProtectedBox& b) { std::swap(b.roles[0], b.roles[1]); }) ==
        ErrorCode::not_canonical);
  CHECK(broken([](ProtectedBox& b) { b.roles[0] = "A"; }) == ErrorCode::bad_value);
}

TEST_CASE("bytes that are no change are rejected with a reason", "[rights]") {
  CHECK(unreadable({}) == ErrorCode::truncated);
  CHECK(unreadable({0}) == ErrorCode::unknown_kind);
  CHECK(unreadable({17}) == ErrorCode::unknown_kind);
  CHECK(unreadable({2, 1, 'a', 0}) == ErrorCode::trailing_bytes);
  CHECK(unreadable({2, 0x81, 0, 'a'}) == ErrorCode::not_canonical);
  CHECK(unreadable({2, 33, 'a'}) == ErrorCode::bad_value);
  CHECK(unreadable({2, 0}) == ErrorCode::bad_value);
  CHECK(unreadable({1, 1, 'a', 0x80, 0x20, 0, 0, 0}) == ErrorCode::bad_value);  // right 12
  CHECK(unreadable({1, 1, 'a', 0, 0, 0x80, 0x80, 0x80, 0x80, 0x10, 0}) == ErrorCode::bad_value);
  CHECK(unreadable({6, 0, 2}) == ErrorCode::unknown_kind);
  CHECK(unreadable({15}) == ErrorCode::truncated);
  CHECK(unreadable({15, 2}) == ErrorCode::truncated);
  CHECK(unreadable({15, 0, 1}) == ErrorCode::bad_value);  // no step
  CHECK(unreadable({15, 2, 0}) == ErrorCode::bad_value);  // since no record
  CHECK(unreadable({15, 2, 1, 0}) == ErrorCode::trailing_bytes);
  CHECK(unreadable({15, 2, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1}) ==
        ErrorCode::bad_value);  // since a record above 63 bits

  // A box of one voxel without owner, members and roles, then with each field damaged.
  const Bytes box = {7, 1, 'a', 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  ByteReader in(box);
  read_rights_change(in);
  REQUIRE(in.ok());
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Bytes bytes = box;
    bytes[at] = value;
    return unreadable(bytes);
  };
  CHECK(with(10, 2) == ErrorCode::bad_value);   // flag of the owner
  CHECK(with(11, 65) == ErrorCode::bad_value);  // members
  CHECK(with(12, 17) == ErrorCode::bad_value);  // roles
  CHECK(with(10, 1) == ErrorCode::truncated);
  CHECK(with(11, 64) == ErrorCode::truncated);
}

TEST_CASE("only the protection of a box has a place", "[rights]") {
  CHECK(place_of(Protect{largest_box()}) == largest_box().box);
  CHECK_FALSE(place_of(Unprotect{"a"}).has_value());
  CHECK_FALSE(place_of(GrantRole{key_of(1), "builder"}).has_value());
}

}  // namespace runstone::test
