// Which values of Permissions and ProtectedGround are refused.
#include <string>
#include <vector>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

struct PermissionFields {
  std::string role = "builder", edits_refused;
  bool has_role = true;
  Offset<wire::Permissions> operator()(FlatBufferBuilder& b) const {
    const auto r = has_role ? b.CreateString(role) : 0;
    return wire::CreatePermissions(b, r, ~0U, 7, b.CreateString(edits_refused));
  }
};

struct GroundFields {
  struct Box {
    std::uint64_t seq = 1;
    VoxelBox box = {{0, 0, 0}, {1, 2, 3}};
    std::int32_t priority = 0;
    std::string name = "spawn", owner;
    bool has_min = true, has_max = true;
  };
  std::vector<std::uint64_t> removed;
  std::vector<Box> boxes = {{}};
  Offset<wire::ProtectedGround> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::GroundBox>> rows;
    for (const Box& box : boxes) {
      const auto name = b.CreateString(box.name);
      const auto owner = b.CreateString(box.owner);
      const wire::Corner min(box.box.min.x, box.box.min.y, box.box.min.z);
      const wire::Corner max(box.box.max.x, box.box.max.y, box.box.max.z);
      rows.push_back(wire::CreateGroundBox(b, box.seq, box.has_min ? &min : nullptr,
                                           box.has_max ? &max : nullptr, box.priority, true, name,
                                           owner));
    }
    const auto gone = b.CreateVector(removed);
    return wire::CreateProtectedGround(b, gone, b.CreateVector(rows));
  }
};

/// Returns `count` boxes, or sequences, that ascend from 1.
std::vector<GroundFields::Box> ascending_boxes(std::size_t count) {
  std::vector<GroundFields::Box> boxes(count);
  for (std::size_t i = 0; i < count; ++i) boxes[i].seq = i + 1;
  return boxes;
}
std::vector<std::uint64_t> ascending_seqs(std::size_t count) {
  std::vector<std::uint64_t> seqs(count);
  for (std::size_t i = 0; i < count; ++i) seqs[i] = i + 1;
  return seqs;
}

}  // namespace

TEST_CASE("permissions are refused with a text of the wrong size", "[protocol][rights]") {
  refuses<Permissions, PermissionFields>(
      {[](auto& p) { p.role = ""; }, [](auto& p) { p.has_role = false; },
       [](auto& p) { p.role = std::string(33, 'a'); }, [](auto& p) { p.role = "a\nb"; },
       [](auto& p) { p.edits_refused = std::string(257, 'a'); },
       [](auto& p) { p.edits_refused = "\x1b[2J"; }});
  const auto unknown_rights = received<Permissions>(PermissionFields{});
  REQUIRE(unknown_rights.has_value());
  CHECK(std::get<Permissions>(*unknown_rights).rights == ~0U);
}

TEST_CASE("protected ground is refused with a bad box, a bad order, or too many",
          "[protocol][rights]") {
  refuses<ProtectedGround, GroundFields>({
      [](auto& g) { g.boxes.clear(); },
      [](auto& g) { g.boxes[0].seq = 0; },
      [](auto& g) { g.boxes[0].seq = kSequenceMax + 1; },
      [](auto& g) { g.boxes[0].box.max.x = 0; },
      [](auto& g) { g.boxes[0].box.min.y = 2; },
      [](auto& g) { g.boxes[0].box.max.z = kWorldLimit + 1; },
      [](auto& g) { g.boxes[0].box.min.z = -kWorldLimit - 1; },
      [](auto& g) { g.boxes[0].has_min = false; },
      [](auto& g) { g.boxes[0].has_max = false; },
      [](auto& g) { g.boxes[0].priority = kGroundPriorityMax + 1; },
      [](auto& g) { g.boxes[0].priority = -kGroundPriorityMax - 1; },
      [](auto& g) { g.boxes[0].name = ""; },
      [](auto& g) { g.boxes[0].name = std::string(33, 'a'); },
      [](auto& g) { g.boxes[0].owner = std::string(33, 'a'); },
      [](auto& g) { g.boxes = ascending_boxes(2), g.boxes[1].seq = 1; },
      [](auto& g) { g.boxes = ascending_boxes(kGroundBoxesMax + 1); },
      [](auto& g) { g.removed = {0}; },
      [](auto& g) { g.removed = {kSequenceMax + 1}; },
      [](auto& g) { g.removed = {2, 2}; },
      [](auto& g) { g.removed = ascending_seqs(kGroundBoxesMax + 1); },
  });
  GroundFields most{ascending_seqs(kGroundBoxesMax), ascending_boxes(kGroundBoxesMax)};
  CHECK(passes<ProtectedGround>(most));
  CHECK(passes<ProtectedGround>(GroundFields{{7}, {}}));
  GroundFields whole;
  whole.boxes[0].box = {{-kWorldLimit, -kWorldLimit, -kWorldLimit},
                        {kWorldLimit, kWorldLimit, kWorldLimit}};
  CHECK(passes<ProtectedGround>(whole));
}

}  // namespace runstone::test
