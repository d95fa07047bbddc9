// What a session does with materials that are added while it is connected.
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test {

using namespace session_bench;

namespace {

constexpr MaterialLook kLook{1, 2, 3, 4, MaterialPattern::weave};
const std::vector<MaterialRow> kLime = {
    {"lime", {1, 2, 3, 255}, Visibility::opaque, MaterialBody::solid, kLook}};
const auto kFirst = static_cast<Material>(default_material_table().size());

struct MaterialSession : SessionBench {
  void open_with(std::uint64_t features) {
    greet();
    Welcome welcome = server.make_welcome();
    welcome.features = features;
    welcome.signature =
        sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
    receive(welcome);
    receive(SessionAccepted{6, 0});
    REQUIRE(session.is_open());
    static_cast<void>(sent());
  }
};

}  // namespace

TEST_CASE_METHOD(MaterialSession, "an edit with a new material is predicted as soon as it is known",
                 "[session][materials]") {
  open_with(kFeatureMaterials);
  CHECK((server.hello.features & kFeatureMaterials) != 0);
  CHECK_FALSE(session.offer(set({1, 1, 1}, kFirst), now, now).has_value());
  receive(MaterialsAdded{kFirst, kLime});
  CHECK(session.is_open());
  CHECK(session.welcome()->materials.find("lime") == kFirst);
  CHECK(session.welcome()->materials[kFirst].look == kLook);
  CHECK(session.offer(set({1, 1, 1}, kFirst), now, now).has_value());
  CHECK_FALSE(session.offer(set({1, 1, 1}, kFirst + 1), now, now).has_value());
  pong();
  session.tick(now);
  CHECK(take<EditRequest>(sent()).size() == 1);
}

TEST_CASE_METHOD(MaterialSession,
                 "new materials that do not fit the client's table end the session",
                 "[session][materials]") {
  open_with(kFeatureMaterials);
  MaterialsAdded wrong{kFirst, kLime};
  SECTION("a gap") { wrong.first = static_cast<Material>(kFirst + 1); }
  SECTION("an overlap") { wrong.first = static_cast<Material>(kFirst - 1); }
  SECTION("a name that is taken") { wrong.rows[0].name = default_material_table()[1].name; }
  receive(wrong);
  REQUIRE(session.end().has_value());
  CHECK(session.end()->reason == GoodbyeReason::malformed_message);
  CHECK_FALSE(session.end()->final);
  CHECK(session.welcome()->materials == default_material_table());
}

TEST_CASE_METHOD(MaterialSession, "new materials without the feature end the session",
                 "[session][materials]") {
  open_with(kFeatureRights);
  receive(MaterialsAdded{kFirst, kLime});
  REQUIRE(session.end().has_value());
  CHECK(session.end()->reason == GoodbyeReason::unexpected_message);
}

TEST_CASE_METHOD(MaterialSession, "another connection takes the table of its welcome",
                 "[session][materials]") {
  open_with(kFeatureMaterials);
  receive(MaterialsAdded{kFirst, kLime});
  session.disconnected();
  open_with(kFeatureMaterials);  // a server that lost the record
  CHECK(session.welcome()->materials == default_material_table());
  CHECK_FALSE(session.offer(set({1, 1, 1}, kFirst), now, now).has_value());
  receive(MaterialsAdded{kFirst, kLime});
  CHECK(session.offer(set({1, 1, 1}, kFirst), now, now).has_value());
}

TEST_CASE_METHOD(MaterialSession, "shapes that are given reach the client's table",
                 "[session][materials]") {
  const Shape slab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  open_with(kFeatureMaterials | kFeatureShapes);
  CHECK((server.hello.features & kFeatureShapes) != 0);
  receive(MaterialsAdded{kFirst, kLime});
  CHECK(session.shapes_number() == 0);
  receive(ShapesGiven{{{{1, slab}, {kFirst, slab}}}});
  REQUIRE(session.is_open());
  CHECK(session.welcome()->materials[1].shape == slab);
  CHECK(session.welcome()->materials[kFirst].shape == slab);
  CHECK(session.shapes_number() == 1);
  ShapesGiven wrong{{{{2, slab}}}};
  SECTION("a material that has one") { wrong.given.rows = {{1, slab}}; }
  SECTION("a material that nobody knows") {
    wrong.given.rows = {{static_cast<Material>(kFirst + 1), slab}};
  }
  SECTION("without the feature") {
    session.disconnected();
    open_with(kFeatureMaterials);
    receive(wrong);
    REQUIRE(session.end().has_value());
    CHECK(session.end()->reason == GoodbyeReason::unexpected_message);
    return;
  }
  receive(wrong);
  REQUIRE(session.end().has_value() == (wrong.given.rows[0].material != 2));
  if (session.end()) CHECK(session.end()->reason == GoodbyeReason::malformed_message);
}

}  // namespace runstone::test
