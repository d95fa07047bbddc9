// Shapes that are given while people play: who gets them, in which order, and what is refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "server/world/commit/changes.hpp"
#include "tests/unit/server/world/commit/feature_bench.hpp"

namespace runstone::test {
namespace {

const Shape kSlab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
const Shape kPlant{ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
constexpr std::uint64_t kBoth = kFeatureMaterials | kFeatureShapes;
constexpr Material kNew = 5;  // the bench has air and four others

MaterialRow row_with(const char* name, const Shape& shape) {
  MaterialRow row{name, {1, 2, 3, 255}, Visibility::opaque};
  row.shape = shape;
  return row;
}

struct ShapeBench : FeatureBench {
  using FeatureBench::FeatureBench;

  std::vector<ShapesGiven> given_to(SessionId session) const {
    return environment.messages<ShapesGiven>(session, kEdge);
  }
  /// Returns the welcome's table with everything that followed it.
  MaterialTable followed(SessionId session, MaterialTable table) const {
    for (const MaterialsAdded& m : environment.messages<MaterialsAdded>(session, kEdge))
      REQUIRE(table.append(m.first, m.rows).has_value());
    for (const ShapesGiven& m : given_to(session))
      REQUIRE(table.give_shapes(m.given.rows).has_value());
    return table;
  }
  Sequence give(const std::vector<GivenShape>& rows) {
    const auto given = server.changes().give_shapes(rows, now());
    INFO((given ? "" : given.error()));
    REQUIRE(given.has_value());
    return *given;
  }
};

}  // namespace

TEST_CASE("given shapes are a record, and reach the sessions with the feature",
          "[world][materials][shapes]") {
  ShapeBench bench;
  const Welcome with = bench.join_with(1, 1, kBoth);
  bench.join_with(2, 2, kFeatureMaterials);
  CHECK(bench.give({{3, kPlant}, {1, kSlab}}) == 1);
  const EditRecord& record = bench.environment.records.back();
  CHECK(record.cause == Cause::materials);
  CHECK(record.op.author == 0);
  CHECK(validate_fields(record).has_value());
  CHECK(*given_shapes_of(record.edit) == GivenShapes{{{1, kSlab}, {3, kPlant}}});
  REQUIRE(bench.given_to(1).size() == 1);
  CHECK(bench.given_to(1)[0].given == GivenShapes{{{1, kSlab}, {3, kPlant}}});
  CHECK(bench.given_to(2).empty());
  CHECK(bench.environment.closed.empty());
  const MaterialTable& table = bench.server.order().materials();
  CHECK(bench.followed(1, with.materials) == table);

  // Sessions that join later get the shapes in Welcome, but only with the feature.
  const Welcome later = bench.join_with(3, 3, kBoth);
  CHECK(later.materials == table);
  CHECK(bench.given_to(3).empty());
  const Welcome old = bench.join_with(4, 4, kFeatureMaterials);
  CHECK(old.materials.size() == table.size());
  CHECK(old.materials[1].shape.is_cube());
  CHECK((old.features & kFeatureShapes) == 0);
}

TEST_CASE("new materials with shapes are two records, and the rows come first",
          "[world][materials][shapes]") {
  ShapeBench bench;
  const Welcome with = bench.join_with(1, 1, kBoth);
  const Welcome without = bench.join_with(2, 2, kFeatureMaterials);
  const std::vector<MaterialRow> rows = {row_with("slab", kSlab), row_with("stone", {}),
                                         row_with("plant", kPlant)};
  const auto added = bench.server.changes().add_materials(rows, bench.now());
  REQUIRE(added.has_value());
  CHECK(added->first == kNew);
  CHECK(added->seq == 2);
  const auto& records = bench.environment.records;
  REQUIRE(records.size() == 2);
  REQUIRE(added_materials_of(records[0].edit) != nullptr);
  CHECK(added_materials_of(records[0].edit)->rows[0].shape.is_cube());
  CHECK(*given_shapes_of(records[1].edit) ==
        GivenShapes{{{kNew, kSlab}, {static_cast<Material>(kNew + 2), kPlant}}});
  const MaterialTable& table = bench.server.order().materials();
  CHECK(table[kNew].shape == kSlab);
  CHECK(bench.followed(1, with.materials) == table);
  CHECK(bench.followed(2, without.materials)[kNew].shape.is_cube());
  const auto& sent = bench.environment.sent;
  const auto place = [&](MessageKind kind) {
    return std::ranges::find_if(
               sent,
               [&](const auto& each) { return each.session == 1 && each.message.kind == kind; }) -
           sent.begin();
  };
  CHECK(place(kKindOf<MaterialsAdded>) < place(kKindOf<ShapesGiven>));
}

TEST_CASE("a new material has the pattern of plants if it gets their shape",
          "[world][materials][shapes]") {
  ShapeBench bench;
  const MaterialLook blades{1, 2, 3, 4, MaterialPattern::blades};
  std::vector<MaterialRow> rows = {row_with("slab", kSlab), row_with("stone", {}),
                                   row_with("plant", kPlant)};
  for (MaterialRow& row : rows) row.look = blades;
  REQUIRE(bench.server.changes().add_materials(rows, bench.now()).has_value());
  const MaterialLook plain{1, 2, 3, 4, MaterialPattern::none};
  const std::vector<MaterialRow>& recorded =
      added_materials_of(bench.environment.records[0].edit)->rows;
  REQUIRE(recorded.size() == 3);
  CHECK(recorded[0].look == plain);
  CHECK(recorded[1].look == plain);
  CHECK(recorded[2].look == blades);
  CHECK(bench.server.order().materials()[kNew + 2].look == blades);
}

TEST_CASE("shapes that are given during a handshake follow session accepted",
          "[world][materials][shapes]") {
  ShapeBench bench;
  const auto [h, welcome] = bench.greet(1, 1, kBoth);
  bench.give({{2, kSlab}});
  const auto added = bench.server.changes().add_materials({row_with("plant", kPlant)}, bench.now());
  REQUIRE(added.has_value());
  bench.give({{1, kPlant}});
  CHECK(bench.given_to(1).empty());
  bench.server.received(1, bench.client_auth(1, h, welcome), bench.now());
  REQUIRE(bench.environment.messages<SessionAccepted>(1, kEdge).size() == 1);
  CHECK(bench.given_to(1).size() == 1);
  CHECK(bench.followed(1, welcome.materials) == bench.server.order().materials());
}

TEST_CASE("many shapes are several records and messages", "[world][materials][shapes]") {
  ShapeBench bench;
  const Welcome welcome = bench.join_with(1, 1, kBoth);
  std::vector<GivenShape> given;
  for (std::size_t part = 0; part < 2; ++part) {
    std::vector<MaterialRow> rows;
    for (std::size_t i = 0; i < 400; ++i)
      rows.push_back({std::to_string(part) + "_" + std::to_string(i), {1, 2, 3, 255}, {}});
    for (MaterialRow& row : rows) row.visibility = Visibility::opaque;
    REQUIRE(bench.server.changes().add_materials(rows, bench.now()).has_value());
  }
  for (std::size_t i = 0; i < 800; ++i) {
    given.push_back({static_cast<Material>(kNew + i),
                     {ShapeForm::boxes,
                      {{{static_cast<std::uint8_t>(i & 15), static_cast<std::uint8_t>(i >> 4 & 15),
                         static_cast<std::uint8_t>(i >> 8)},
                        {16, 16, 16}}}}});
  }
  given[0].shape = kSlab;
  bench.give(given);
  CHECK(bench.environment.records.size() == 2 + 4);
  CHECK(bench.given_to(1).size() == 4);
  CHECK(bench.followed(1, welcome.materials) == bench.server.order().materials());
}

TEST_CASE("shapes that do not fit the table are refused, all of them or none",
          "[world][materials][shapes]") {
  ShapeBench bench;
  const auto refusal = [&](const std::vector<GivenShape>& rows) {
    const auto given = bench.server.changes().give_shapes(rows, bench.now());
    REQUIRE_FALSE(given.has_value());
    return given.error();
  };
  bench.give({{1, kSlab}});
  CHECK(refusal({{2, kSlab}, {1, kPlant}}) == "a shape is given to a material that has one");
  CHECK(refusal({{2, kSlab}, {kNew, kPlant}}) ==
        "a shape is given to a material that does not exist");
  CHECK(bench.server.order().materials()[2].shape.is_cube());
  CHECK(bench.environment.records.size() == 1);
  bench.environment.log_room = false;
  CHECK(refusal({{2, kSlab}}).find("try again later") != std::string::npos);
}

TEST_CASE("new materials and all of their shapes are one commit, or none of them is ordered",
          "[world][materials][shapes]") {
  ShapeBench bench;
  // More shapes than one record has.
  std::vector<MaterialRow> rows;
  for (std::size_t i = 0; i < kAddedMaterialsMax; ++i) {
    rows.push_back(row_with(("shaped_" + std::to_string(i)).c_str(), kSlab));
    auto& boxes = rows.back().shape.boxes;
    boxes.clear();
    for (std::uint8_t n = 0; n < 16; ++n) {
      const auto height = static_cast<std::uint8_t>(1 + (i >> (n % 8) & 1) + n % 3);
      boxes.push_back({{n, 0, static_cast<std::uint8_t>(n / 2)},
                       {static_cast<std::uint8_t>(n + 1), height, 16}});
    }
    boxes[0].max = {1, static_cast<std::uint8_t>(1 + i % 16),
                    static_cast<std::uint8_t>(1 + i / 16 % 16)};
    boxes[1].min[2] = static_cast<std::uint8_t>(i / 256);
  }
  const std::size_t table = bench.server.order().materials().size();
  bench.environment.log_records_max = 1;
  const auto refused = bench.server.changes().add_materials(rows, bench.now());
  REQUIRE_FALSE(refused.has_value());
  INFO(refused.error().what);
  CHECK(refused.error().what.find("log_queue_records") != std::string::npos);
  CHECK(bench.environment.records.empty());
  CHECK(bench.server.order().materials().size() == table);

  bench.environment.log_records_max = 1'000;
  const auto commits = bench.server.counters().commits;
  REQUIRE(bench.server.changes().add_materials(rows, bench.now()).has_value());
  CHECK(bench.environment.records.size() >= 3);
  CHECK(bench.server.counters().commits == commits + 1);
  for (std::size_t i = 0; i < rows.size(); ++i)
    CHECK(bench.server.order().materials()[static_cast<Material>(table + i)].shape ==
          rows[i].shape);
}

}  // namespace runstone::test
