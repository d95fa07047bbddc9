#include "client/play/edit_tool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "client/session/session_edit_port.hpp"
#include "client/tools/action_source.hpp"

namespace runstone {
namespace {

/// The chunks that a preview compares and meshes in one turn. A paste of 64 voxels a side touches
/// 27 chunks of edge 32 at most, and takes two steps for each of them.
constexpr std::size_t kPreviewChunks = 64;
/// The edits of an action that are offered in one turn. Each is predicted in up to some thirty chunks.
constexpr std::size_t kBuildEdits = 8;
/// The greatest radius of a stroke that others see while it is drawn.
constexpr std::int32_t kStrokeRadiusShared = 16;

const char* name_of(SymmetryKind kind) {
  switch (kind) {
    case SymmetryKind::none:
      break;
    case SymmetryKind::x:
      return "mirrored along x";
    case SymmetryKind::z:
      return "mirrored along z";
    case SymmetryKind::both:
      return "mirrored along x and z";
    case SymmetryKind::point:
      return "turned by a half turn";
  }
  return "";
}

/// Returns what an action does, as a verb.
std::string name_of(const ToolAction& action) {
  if (action.pattern) return "mix";
  if (clears_at_end(action)) return "move";
  if (action.edits.empty() || std::holds_alternative<Paste>(action.edits.front().shape))
    return "paste";
  if (action.edits.front().material == kEmpty) return "clear";
  return action.edits.front().mask.kind == MaskKind::only_material ? "replace" : "fill";
}

}  // namespace

std::optional<RayHit> EditTool::pick() const {
  const MaterialTable& materials = box_.materials();
  const auto is_liquid = [&materials](Material material) {
    return materials.knows(material) && materials[material].body == MaterialBody::liquid;
  };
  return runstone::pick(session_.replica(), *shapes_, player_.eye(), player_.direction(), kReach,
                        is_liquid(player_.held()) ? MaterialPredicate() : is_liquid);
}

Aim EditTool::aim() const {
  Aim out{player_.eye(), player_.direction(), std::nullopt, player_.held()};
  if (!fixed_aim_) {
    out.hit = pick();
  } else if (const auto material = session_.replica().shown_at(fixed_aim_->voxel)) {
    out.hit = RayHit{fixed_aim_->voxel, *material, fixed_aim_->face, 0};
  }
  return out;
}

Result<void, std::string> EditTool::press(ToolButton button, TimeUs now_us) {
  if (!session_.replica().opened()) return failure("no world is open");
  return propose_beside(box_.press(session_.replica(), aim(), button), now_us);
}

Result<void, std::string> EditTool::carry_out(const ToolCommand& command, TimeUs now_us) {
  const Selected selected = box_.selected();
  auto done = propose_beside(runstone::carry_out(box_, session_.replica(), player_.held(), command),
                             now_us);
  // It did not move. An equal selection is not set again, because that ends the preview.
  if (!done && box_.selected() != selected) box_.select(selected);
  return done;
}

Result<void, std::string> EditTool::propose_beside(const ToolEdits& made, TimeUs now_us) {
  const bool is_one = made && (made->edits.size() == 1 || made->has_followers);
  if (is_one && made->edits.front().material != kEmpty) {
    const auto* const voxel = std::get_if<SetVoxel>(&made->edits.front().shape);
    if (voxel != nullptr && player_.is_in(voxel->at))
      return failure("you stand there: step back first");
  }
  return propose(made, now_us);
}

void EditTool::drag() {
  if (session_.replica().opened()) box_.drag(aim());
}

Result<void, std::string> EditTool::release(TimeUs now_us) {
  if (!session_.replica().opened()) return {};
  return propose(box_.release(session_.replica(), aim()), now_us);
}

Result<void, std::string> EditTool::propose(const ToolEdits& made, TimeUs now_us) {
  if (!made) return failure(made.error());
  if (session_.replica().opened() && needs_build(*made)) return build(*made);
  const std::vector<EditDescriptor>& edits = made->edits;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const ActionPart part = part_of(*made, i);
    if (made->has_followers && i > 0) {
      follow(edits[i], now_us);
    } else if (auto done = propose(edits[i], now_us, now_us, part); !done) {
      box_.forget_pasted();
      return done;
    }
  }
  return {};
}

void EditTool::follow(const EditDescriptor& edit, TimeUs now_us) {
  const auto seq = session_.offer(edit, now_us, now_us, action_);
  if (seq) recorder_.submitted(*seq, now_us);
}

bool EditTool::needs_build(const ToolAction& action) const {
  const bool is_long = !action.has_followers && action.edits.size() > kBuildEdits;
  return is_long || !is_small(action, session_.replica().edit_limits());
}

Result<void, std::string> EditTool::build(std::string name, std::unique_ptr<EditSource> source,
                                          OnRefusal on_refusal) {
  if (sender_ != nullptr) {
    box_.forget_pasted();  // the build may be its paste
    return failure("a " + build_name_ + " is under way: wait for it, or stop it first");
  }
  box_.begin_action();
  sender_ = std::make_unique<ActionSender>(std::move(source), on_refusal);
  build_name_ = std::move(name);
  return {};
}

Result<void, std::string> EditTool::build(const ToolAction& action) {
  if (!session_.replica().opened()) return failure("no world is open");
  if (action.empty()) return {};
  return build(name_of(action), source_of(action, session_.replica().edit_limits()),
               clears_at_end(action) ? OnRefusal::stop : OnRefusal::skip);
}

void EditTool::take(const ReplicaChanges& changes, TimeUs now_us) {
  if (!changes.rejects.empty()) box_.forget_pasted();
  if (sender_ != nullptr) sender_->take(changes, now_us);
}

std::optional<std::string> EditTool::step_build(TimeUs now_us) {
  if (sender_ == nullptr) return std::nullopt;
  SessionEditPort port(session_);
  sender_->step(port, now_us, kBuildEdits);
  if (!sender_->has_ended()) return std::nullopt;
  last_build_ = sender_->progress();
  sender_.reset();
  return end_text_of(build_name_, last_build_);
}

bool EditTool::stop_building() {
  if (sender_ == nullptr) return false;
  sender_->cancel();
  return true;
}

bool EditTool::has_built() const {
  if (sender_ == nullptr) return false;
  const ActionProgress& progress = sender_->progress();
  return sender_->under_way() > 0 || progress.edits_done > 0;
}

std::string EditTool::build_text() const {
  return sender_ == nullptr ? std::string() : text_of(build_name_, sender_->progress());
}

bool EditTool::has_preview() const {
  const bool is_plain =
      repeats() && box_.symmetry().kind == SymmetryKind::none && !box_.typed_places();
  return !is_plain && session_.replica().opened() && !session_.replica().past();
}

bool EditTool::step_preview() {
  if (!has_preview()) return false;
  return box_.step_preview(session_.replica(), aim(), kPreviewChunks);
}

std::span<const GhostChunk> EditTool::ghosts() const {
  return has_preview() ? std::span<const GhostChunk>(box_.ghosts()) : std::span<const GhostChunk>();
}

std::string EditTool::text() const {
  const Tool& tool = box_.tool();
  if (repeats() && box_.symmetry().kind == SymmetryKind::none) return {};
  std::string out = "tool: " + std::string(tool.name());
  for (const ToolParameter& p : tool.parameters()) {
    out += ", " + p.name + ' ';
    out += p.choices.empty() ? std::to_string(p.value)
                             : p.choices[static_cast<std::size_t>(p.value - p.low)];
  }
  if (box_.symmetry().kind != SymmetryKind::none)
    out += std::string(", ") + name_of(box_.symmetry().kind);
  if (!box_.points().empty()) out += ", places chosen: " + std::to_string(box_.points().size());
  if (box_.preview().missing_chunks() != 0) out += ", a part of the preview is not loaded";
  return out;
}

std::optional<EditTool::SharedStroke> EditTool::drawn_stroke() const {
  if (!box_.tool().is_drawn()) return std::nullopt;
  const std::int32_t edge = session_.replica().chunk_edge();
  const std::vector<EditDescriptor>& edits = box_.preview().edits();
  if (!edits.empty() && may_be_shared(edits, edge)) return std::nullopt;
  SharedStroke out;
  out.stroke = box_.next_stroke(aim());
  if (out.stroke && !check_stroke(*out.stroke)) out.stroke.reset();
  std::int32_t radius = 1;
  for (const ToolParameter& parameter : box_.tool().parameters()) {
    if (parameter.name == "radius") radius = parameter.value;
    if (parameter.name == "width") radius = parameter.value / 2;
  }
  const auto shared_radius = static_cast<std::uint16_t>(std::clamp(radius, 1, kStrokeRadiusShared));
  const Material material = box_.button() == ToolButton::place ? player_.held() : kEmpty;
  out.line.material = material;
  if (box_.points().size() < 2) {
    if (!out.stroke) return std::nullopt;
    out.line.shape = FillSphere{out.stroke->places.front(), shared_radius};
    while (!may_be_shared({out.line}, edge)) {
      auto& ball = std::get<FillSphere>(out.line.shape);
      if (ball.radius <= 1) return std::nullopt;
      ball.radius = static_cast<std::uint16_t>(ball.radius / 2);
    }
    return out;
  }
  FillStroke line{{box_.points().begin(), box_.points().end()}, shared_radius};
  for (;;) {
    out.line.shape = line;
    if (may_be_shared({out.line}, edge)) return out;
    if (line.radius > 1) {
      line.radius = static_cast<std::uint16_t>(line.radius / 2);
    } else if (line.points.size() > 2) {
      const auto half = static_cast<std::ptrdiff_t>(line.points.size() / 2);
      line.points.erase(line.points.begin(), line.points.begin() + half);
      if (line.points.size() < 2) return std::nullopt;
    } else {
      return std::nullopt;
    }
  }
}

std::string EditTool::measure_text() const {
  const auto box = session_.replica().opened() ? box_.spanned(aim()) : std::nullopt;
  if (!box) return {};
  const std::int64_t x = box->max.x - box->min.x, y = box->max.y - box->min.y,
                     z = box->max.z - box->min.z;
  return fmt::format("{} x {} x {} = {} {}   {} {} {} to {} {} {}", x, y, z, x * y * z,
                     x * y * z == 1 ? "voxel" : "voxels", box->min.x, box->min.y, box->min.z,
                     box->max.x - 1, box->max.y - 1, box->max.z - 1);
}

Result<void, std::string> EditTool::propose(const EditDescriptor& edit, TimeUs due_us,
                                            TimeUs now_us, ActionPart part) {
  if (part != ActionPart::next) box_.begin_action();
  if (part == ActionPart::first) action_ = 0;
  ClientSequence action = 0;
  if (part != ActionPart::alone) action = action_ != 0 ? action_ : kBeginsAction;
  const auto seq = session_.offer(edit, due_us, now_us, action);
  if (seq) {
    if (action == kBeginsAction) action_ = *seq;
    recorder_.submitted(*seq, due_us);
    return {};
  }
  if (session_.replica().local_edits().all().size() >= kLocalEditsMax) {
    recorder_.not_submitted();
  } else {
    ++refused_;
  }
  std::string why = session_.refusal_text(edit, seq.error());
  if (on_refused_) on_refused_(why);
  return failure(std::move(why));
}

}  // namespace runstone
