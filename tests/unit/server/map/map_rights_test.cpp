#include "server/map/map_rights.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {
MapRights after(const std::vector<RightsChange>& changes) {
  RightsState state;
  Sequence seq = 0;
  for (const RightsChange& change : changes) state.apply(change, {++seq, 1, 0});
  return rights_of_strangers(state, 0);
}
}  // namespace

TEST_CASE("strangers see of the map what the default role lets them see", "[map]") {
  CHECK(after({}).may_see);
  CHECK(after({}).may_look_back);
  CHECK(after({SetDefaultRole{kVisitorRole}}).may_look_back);
  const MapRights nobody = after({SetDefaultRole{kNobodyRole}});
  CHECK_FALSE(nobody.may_see);
  CHECK_FALSE(nobody.may_look_back);
  CHECK(nobody.why.find("invited players") != std::string::npos);
  Role guest;
  guest.name = "guest";
  guest.rights = {Right::see};
  const MapRights present = after({DefineRole{guest}, SetDefaultRole{"guest"}});
  CHECK(present.may_see);
  CHECK_FALSE(present.may_look_back);
  guest.rights = {Right::look_back};  // without the right to see
  CHECK_FALSE(after({DefineRole{guest}, SetDefaultRole{"guest"}}).may_look_back);
}

TEST_CASE("a password keeps strangers out of the map", "[map]") {
  JoinPassword password;
  const MapRights closed = after({SetPassword{password}});
  CHECK_FALSE(closed.may_see);
  CHECK(closed.why.find("password") != std::string::npos);
  CHECK(after({SetPassword{password}, SetPassword{std::nullopt}}).may_see);
}
