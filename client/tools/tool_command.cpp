#include "client/tools/tool_command.hpp"

#include <vector>

namespace runstone {
namespace {

ToolEdits without_edits(const Result<void, std::string>& done) {
  if (!done) return failure(done.error());
  return std::vector<EditDescriptor>{};
}

struct Carrier {
  ToolBox& box;
  const Replica& replica;
  const Material held;

  ToolEdits operator()(const ToolChoice& c) const { return without_edits(box.choose(c.name)); }
  ToolEdits operator()(const ParameterChange& c) const {
    return without_edits(box.set_parameter(c.name, c.value));
  }
  ToolEdits operator()(const TextChange& c) const {
    return without_edits(box.set_text(c.name, c.text));
  }
  ToolEdits operator()(const PlacesChange& c) const {
    box.type_places(c.typed);
    return without_edits({});
  }
  ToolEdits operator()(const TypedApply&) const {
    if (!replica.opened()) return failure("no world is open");
    return box.apply_typed(replica, held);
  }
  ToolEdits operator()(const SelectionChange& c) const {
    if (c.box) return without_edits(box.select(*c.box, c.mode));
    box.select(std::nullopt);
    return without_edits({});
  }
  ToolEdits operator()(const SelectionCommand& c) const {
    using Kind = SelectionCommand::Kind;
    if (!replica.opened()) return failure("no world is open");
    switch (c.kind) {
      case Kind::copy:
        return without_edits(box.copy(replica, c.is_solid));
      case Kind::cut:
        return box.cut(replica, c.is_solid);
      case Kind::clear:
        return box.fill(replica, kEmpty);
      case Kind::fill:
        return box.fill(replica, c.material);
      case Kind::replace:
        return box.replace(replica, c.material, c.other);
      case Kind::stack:
        return box.stack(replica, c.direction, c.count);
      case Kind::move:
        return box.move(replica, c.direction, c.count);
      case Kind::grow:
        return without_edits(c.is_all_around ? box.grow_all(c.count)
                                             : box.grow(c.direction, c.count));
      case Kind::shift:
        return without_edits(box.shift(c.direction, c.count));
      case Kind::keep:
      case Kind::drop:
        return without_edits(box.narrow(replica, c.filter, c.kind == Kind::keep));
    }
    return without_edits({});
  }
  ToolEdits operator()(const PasteNudge& c) const {
    if (!replica.opened()) return failure("no world is open");
    return box.nudge(replica, c.direction);
  }
  ToolEdits operator()(const ClipboardTurn& c) const {
    if (const auto done = box.rotate(c.quarters); !done || !c.mirror) return without_edits(done);
    return without_edits(box.mirror(*c.mirror));
  }
  ToolEdits operator()(const ClipboardReshape& c) const {
    return without_edits(box.reshape(c.rotation));
  }
  ToolEdits operator()(const SymmetryChange& c) const {
    box.set_symmetry(c.symmetry);
    return without_edits({});
  }
  ToolEdits operator()(const PreviewChange& c) const {
    box.show_preview(c.is_shown);
    return without_edits({});
  }
};

}  // namespace

ToolEdits carry_out(ToolBox& box, const Replica& replica, Material held,
                    const ToolCommand& command) {
  return std::visit(Carrier{box, replica, held}, command);
}

}  // namespace runstone
