// Materials that are added while people play: the order of messages, old clients, and refusals.
#include "server/world/commit/changes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "tests/unit/server/world/commit/feature_bench.hpp"

namespace runstone::test {
namespace {

const std::vector<MaterialRow> kLimeAndIce = {
    {"lime", {1, 2, 3, 255}, Visibility::opaque, MaterialBody::passable},
    {"ice",
     {9, 9, 9, 90},
     Visibility::transparent,
     MaterialBody::solid,
     MaterialLook{1, 2, 3, 4, MaterialPattern::tiles}}};
constexpr Material kLime = 5, kIce = 6;  // the bench has air and four others

struct MaterialBench : FeatureBench {
  using FeatureBench::FeatureBench;

  AddedAt add(const std::vector<MaterialRow>& rows) {
    const auto added = server.changes().add_materials(rows, now());
    INFO((added ? "" : added.error().what));
    REQUIRE(added.has_value());
    return *added;
  }
  MaterialsRefusal refusal(const std::vector<MaterialRow>& rows) {
    const std::size_t records = environment.records.size();
    const std::size_t size = server.order().materials().size();
    const auto added = server.changes().add_materials(rows, now());
    REQUIRE_FALSE(added.has_value());
    CHECK(environment.records.size() == records);
    CHECK(server.order().materials().size() == size);
    return added.error();
  }
  std::vector<MaterialsAdded> added_to(SessionId session) const {
    return environment.messages<MaterialsAdded>(session, kEdge);
  }
  std::vector<Reject> rejects(SessionId session) const {
    return environment.messages<Reject>(session, kEdge);
  }
  /// Returns the place of the session's first message of a kind among all messages that were sent.
  template <class Kind>
  std::size_t place_of(SessionId session) const {
    const auto& sent = environment.sent;
    const auto found = std::ranges::find_if(sent, [&](const auto& each) {
      return each.session == session && each.message.kind == kKindOf<Kind>;
    });
    return static_cast<std::size_t>(found - sent.begin());
  }
};

std::vector<MaterialRow> many_rows(std::size_t count, const std::string& prefix) {
  std::vector<MaterialRow> rows;
  for (std::size_t i = 0; i < count; ++i)
    rows.push_back({prefix + std::to_string(i), {1, 2, 3, 255}, Visibility::opaque});
  return rows;
}

TEST_CASE("added materials are a record, reach the sessions first, and can be used at once",
          "[world][materials]") {
  MaterialBench bench;
  bench.join_with(1, 1);
  bench.join_with(2, 2);
  bench.view(1, kSmall);
  bench.view(2, kSmall);
  bench.edit(1, 1, kAtOrigin, kLime);
  bench.tick();
  REQUIRE(bench.rejects(1).size() == 1);
  CHECK(bench.rejects(1)[0].reason == RejectReason::unknown_material);

  const AddedAt at = bench.add(kLimeAndIce);
  CHECK(at.first == kLime);
  CHECK(at.seq == 1);
  const EditRecord& record = bench.environment.records.back();
  CHECK(record.cause == Cause::materials);
  CHECK(record.op.author == 0);
  CHECK(validate_fields(record).has_value());
  CHECK(*added_materials_of(record.edit) == AddedMaterials{kLime, kLimeAndIce});
  CHECK(bench.server.order().materials()[kIce].name == "ice");

  bench.edit(1, 2, kAtOrigin, kIce);
  bench.edit(1, 3, kAtOrigin, kIce + 1);
  bench.tick();
  CHECK(bench.rejects(1).size() == 2);
  for (const SessionId session : {1U, 2U}) {
    REQUIRE(bench.added_to(session).size() == 1);
    CHECK(bench.added_to(session)[0] == MaterialsAdded{kLime, kLimeAndIce});
    REQUIRE(bench.commits(session).size() == 1);  // the record itself is sent to nobody
    CHECK(bench.place_of<MaterialsAdded>(session) < bench.place_of<Commit>(session));
  }
  bench.join_with(3, 3);
  CHECK(bench.added_to(3).empty());
  CHECK(bench.environment.messages<Welcome>(3, 0).at(0).materials ==
        bench.server.order().materials());
}

TEST_CASE("a client without the feature is asked to connect again", "[world][materials]") {
  MaterialBench bench;
  bench.join_with(1, 1);
  bench.join_with(2, 2, 0);
  bench.add(kLimeAndIce);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 2);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::closing);
  CHECK(bench.environment.closed[0].text == "the world has new materials: connect again");
  bench.join_with(3, 2, 0);
  CHECK(bench.environment.closed.size() == 1);
}

TEST_CASE("materials that are added during a handshake follow session accepted",
          "[world][materials]") {
  MaterialBench bench;
  const bool has_feature = GENERATE(true, false);
  CAPTURE(has_feature);
  const auto [h, welcome] = bench.greet(1, 1, has_feature ? kFeatureMaterials : 0);
  bench.add(many_rows(kAddedMaterialsMax, "a"));
  bench.add(kLimeAndIce);
  CHECK(bench.added_to(1).empty());
  bench.server.received(1, bench.client_auth(1, h, welcome), bench.now());
  REQUIRE(bench.environment.messages<SessionAccepted>(1, kEdge).size() == 1);
  if (!has_feature) {
    REQUIRE(bench.environment.closed.size() == 1);
    CHECK(bench.environment.closed[0].reason == GoodbyeReason::closing);
    return;
  }
  MaterialTable table = welcome.materials;
  for (const MaterialsAdded& part : bench.added_to(1))
    REQUIRE(table.append(part.first, part.rows).has_value());
  CHECK(table == bench.server.order().materials());
  CHECK(bench.place_of<SessionAccepted>(1) < bench.place_of<MaterialsAdded>(1));
}

TEST_CASE("bad rows are refused with their number, all of them or none", "[world][materials]") {
  MaterialBench bench;
  CHECK(bench.refusal({}).what == "0 materials: 1 to 512 can be added at a time");
  CHECK(bench.refusal(many_rows(kAddedMaterialsMax + 1, "a")).what ==
        "513 materials: 1 to 512 can be added at a time");
  const MaterialsRefusal taken = bench.refusal({kLimeAndIce[0], {"m3", {1, 2, 3, 255}, {}}});
  CHECK(taken.row == 1);
  CHECK(taken.what == "name is already taken");
  bench.add(kLimeAndIce);
  CHECK(bench.refusal(kLimeAndIce).row == 0);
}

TEST_CASE("a full log refuses new materials, and nothing is half done", "[world][materials]") {
  MaterialBench bench;
  bench.join_with(1, 1);
  bench.environment.log_room = false;
  CHECK(bench.refusal(kLimeAndIce).what.find("try again later") != std::string::npos);
  bench.environment.log_room = true;
  bench.server.set_disk_is_full(true, bench.now());
  bench.tick();
  CHECK(bench.added_to(1).empty());
  CHECK(bench.environment.records.empty());
  bench.server.set_disk_is_full(false, bench.now());
  CHECK(bench.add(kLimeAndIce).first == kLime);
  bench.server.log_failed();
  CHECK(bench.refusal({{"late", {1, 2, 3, 255}, {}}}).what ==
        "the world takes no changes any more");
}

TEST_CASE("a session whose queue has no room for new materials is closed", "[world][materials]") {
  MaterialBench bench;
  bench.join_with(1, 1);
  bench.environment.full.insert(1);
  bench.add(kLimeAndIce);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::timed_out);
}

}  // namespace
}  // namespace runstone::test
