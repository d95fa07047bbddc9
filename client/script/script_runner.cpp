#include "client/script/script_runner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/placed_material.hpp"
#include "client/tools/turned_materials.hpp"
#include "client/tools/voxel_joins.hpp"
#include "common/builds/build_transforms.hpp"
#include "common/core/key_text.hpp"

namespace runstone {
namespace {

/// The time between two steps of a walk or roam. It is short enough to look smooth to other
/// players.
constexpr TimeUs kWalkStepUs = 20'000;
constexpr double kUsPerSecond = 1e6;

VoxelPos voxel_of(const WorldPos& at) {
  const auto down = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  return {down(at.x), down(at.y), down(at.z)};
}

TimeUs after(TimeUs start_us, double seconds) {
  return start_us + static_cast<TimeUs>(std::llround(seconds * kUsPerSecond));
}

}  // namespace

void ScriptRunner::step(TimeUs now_us) {
  now_us_ = now_us;
  due_us_.reset();
  if (finished_ || !host_.ready()) return;
  roam();
  run_commands();
  if (roaming_ && !finished_)
    due_us_ = std::min(due_us_.value_or(INT64_MAX), now_us_ + kWalkStepUs);
}

void ScriptRunner::run_commands() {
  for (int i = 0; i < kStepCommandsMax; ++i) {
    if (next_ >= script_.commands.size()) {
      finished_ = true;
      return;
    }
    current_ = next_++;
    const Progress progress =
        std::visit([this](const auto& c) { return run(c); }, script_.commands[current_].step);
    if (progress == Progress::waits) {
      next_ = current_;
      return;
    }
    started_ = false;
    if (progress == Progress::stop) {
      finished_ = true;
      return;
    }
  }
  due_us_ = now_us_;  // more commands can run at once
}

void ScriptRunner::fail(const std::string& what) {
  failures_.push_back(script_.file + ":" + std::to_string(script_.commands[current_].line) + ": " +
                      what);
}

ScriptRunner::Progress ScriptRunner::give_up(const std::string& what) {
  fail(what);
  return Progress::stop;
}

void ScriptRunner::start() {
  if (started_) return;
  started_ = true;
  state_ = {};
  state_.at_us = state_.last_us = now_us_;
}

std::optional<WorldPos> ScriptRunner::resolve(const ScriptPosition& position) {
  using Base = ScriptCoordinate::Base;
  const WorldPos eye = host_.eye();
  const auto plain = [](const ScriptCoordinate& c, double player) {
    return c.base == Base::player ? player + c.offset : c.offset;
  };
  WorldPos out{plain(position[0], eye.x), plain(position[1], eye.y), plain(position[2], eye.z)};
  if (position[1].base == Base::surface) {
    const VoxelPos column = voxel_of(out);
    const auto top = host_.surface(column.x, column.z);
    if (!top) {
      fail("no surface is shown at x=" + std::to_string(column.x) +
           " z=" + std::to_string(column.z));
      return std::nullopt;
    }
    out.y = *top + position[1].offset;
  }
  const auto outside = [](double v) { return v < -kWorldLimit || v >= kWorldLimit; };
  if (outside(out.x) || outside(out.y) || outside(out.z)) {
    fail("position lies outside the world");
    return std::nullopt;
  }
  return out;
}

std::optional<VoxelPos> ScriptRunner::resolve_voxel(const ScriptPosition& position) {
  const auto at = resolve(position);
  if (!at) return std::nullopt;
  return voxel_of(*at);
}

std::optional<Material> ScriptRunner::resolve_material(const std::string& name) {
  const auto id = host_.material(name);
  if (id) return *id;
  fail(id.error());
  return std::nullopt;
}

std::optional<Mask> ScriptRunner::resolve_mask(const ScriptMask& mask) {
  if (mask.kind != MaskKind::only_material) return Mask{mask.kind, kEmpty};
  const auto id = resolve_material(mask.material);
  if (!id) return std::nullopt;
  return Mask{mask.kind, *id};
}

ScriptRunner::Progress ScriptRunner::build(const ToolAction& action) {
  if (!is_building_) {
    if (const auto begun = host_.build(action); !begun) {
      fail("edit refused: " + begun.error());
      return Progress::done;
    }
    is_building_ = true;
  }
  const auto built = host_.built();
  if (!built) return Progress::waits;
  is_building_ = false;
  if (!*built) fail("edit refused: " + built->error());
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::propose(const EditDescriptor& edit, ActionPart part) {
  if (is_building_ || host_.needs_build(std::vector{edit})) return build(std::vector{edit});
  if (const auto ok = validate(edit); !ok)
    return give_up(std::string("not an edit: ") + ok.error().what);
  if (const TimeUs wait_us = host_.edit_wait_us(edit, now_us_); wait_us > 0) {
    due_us_ = now_us_ + wait_us;
    return Progress::waits;
  }
  if (const auto ok = host_.propose(edit, now_us_, now_us_, part); !ok)
    fail("edit refused: " + ok.error());
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::Move& c) {
  const auto to = resolve(c.to);
  if (!to) return Progress::stop;
  roaming_.reset();
  host_.move_to(*to);
  return Progress::done;
}

bool ScriptRunner::go(const WorldPos& to, double distance) {
  const WorldPos from = host_.eye();
  const double dx = to.x - from.x, dy = to.y - from.y, dz = to.z - from.z;
  const double left = std::sqrt(dx * dx + dy * dy + dz * dz);
  if (distance >= left) {
    host_.move_to(to);
    return true;
  }
  const double share = distance / left;
  host_.move_to({from.x + dx * share, from.y + dy * share, from.z + dz * share});
  return false;
}

ScriptRunner::Progress ScriptRunner::run(const script::Walk& c) {
  if (!started_) {
    start();
    const auto to = resolve(c.to);  // once, because `~` means the player at the start
    if (!to) return Progress::stop;
    state_.centre = *to;
    roaming_.reset();
  }
  const double distance = c.speed * static_cast<double>(now_us_ - state_.last_us) / kUsPerSecond;
  state_.last_us = now_us_;
  if (go(state_.centre, distance)) return Progress::done;
  due_us_ = now_us_ + kWalkStepUs;
  return Progress::waits;
}

ScriptRunner::Progress ScriptRunner::run(const script::Roam& c) {
  const auto to = resolve(c.to);
  if (!to) return Progress::stop;
  roaming_ = Roaming{*to, host_.eye(), c.speed, now_us_};
  return Progress::done;
}

void ScriptRunner::roam() {
  if (!roaming_) return;
  const double distance =
      roaming_->speed * static_cast<double>(now_us_ - roaming_->last_us) / kUsPerSecond;
  roaming_->last_us = now_us_;
  if (go(roaming_->to, distance)) std::swap(roaming_->to, roaming_->back);
}

ScriptRunner::Progress ScriptRunner::run(const script::Look& c) {
  constexpr double kRadians = std::numbers::pi / 180;
  host_.look(c.yaw * kRadians, c.pitch * kRadians);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::TimeOfDay& c) {
  host_.set_time_of_day(c.share);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::SmoothEdges& c) {
  host_.set_antialiasing(c.antialiasing);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::LookAt& c) {
  const auto at = resolve(c.at);
  if (!at) return Progress::stop;
  const WorldPos eye = host_.eye();
  const double dx = at->x - eye.x, dy = at->y - eye.y, dz = at->z - eye.z;
  host_.look(std::atan2(dx, dz), std::atan2(dy, std::sqrt(dx * dx + dz * dz)));
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::propose_joined(const EditDescriptor& edit) {
  start_edits(joined_action(edit, host_.tool_box().materials(),
                            [this](VoxelPos at) { return host_.shown_at(at); }));
  return propose_edits();
}

ScriptRunner::Progress ScriptRunner::propose_named(const EditDescriptor& edit) {
  const MaterialTable& table = host_.tool_box().materials();
  const bool has_states = table.knows(edit.material) && table[edit.material].name.ends_with(']');
  if (!has_states) return propose_joined(edit);
  start_edits(ToolAction(std::vector{edit}));
  return propose_edits();
}

ScriptRunner::Progress ScriptRunner::run(const script::Set& c) {
  if (started_) return propose_edits();
  const auto at = resolve_voxel(c.at);
  const auto material = resolve_material(c.material);
  if (!at || !material) return Progress::stop;
  return propose_named({SetVoxel{*at}, {}, *material});
}

ScriptRunner::Progress ScriptRunner::run(const script::Box& c) {
  if (started_) return propose_edits();
  const auto a = resolve_voxel(c.from);
  const auto b = resolve_voxel(c.to);
  const auto material = resolve_material(c.material);
  const auto mask = resolve_mask(c.mask);
  if (!a || !b || !material || !mask) return Progress::stop;
  return propose_named({FillBox{box_between(*a, *b)}, *mask, *material});
}

ScriptRunner::Progress ScriptRunner::run(const script::Sphere& c) {
  const auto centre = resolve_voxel(c.centre);
  const auto material = resolve_material(c.material);
  const auto mask = resolve_mask(c.mask);
  if (!centre || !material || !mask) return Progress::stop;
  return propose({FillSphere{*centre, c.radius}, *mask, *material});
}

ScriptRunner::Progress ScriptRunner::run(const script::Stroke& c) {
  FillStroke stroke;
  stroke.radius = c.radius;
  for (const ScriptPosition& position : c.points) {
    const auto point = resolve_voxel(position);
    if (!point) return Progress::stop;
    stroke.points.push_back(*point);
  }
  const auto material = resolve_material(c.material);
  const auto mask = resolve_mask(c.mask);
  if (!material || !mask) return Progress::stop;
  return propose({std::move(stroke), *mask, *material});
}

ScriptRunner::Progress ScriptRunner::run(const script::Copy& c) {
  const auto a = resolve_voxel(c.from);
  const auto b = resolve_voxel(c.to);
  if (!a || !b) return Progress::stop;
  auto copied = host_.copy(box_between(*a, *b));
  if (!copied) return give_up("cannot copy \"" + c.name + "\": " + words_of(copied.error()));
  if (c.solid && (*copied)->solid() == 0)
    return give_up("cannot copy \"" + c.name + "\": there is nothing in the box");
  clipboards_[c.name] = {*std::move(copied), c.solid ? EmptyCells::skipped : EmptyCells::pasted};
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::Paste& c) {
  if (started_) return propose_edits();
  const auto clipboard = clipboards_.find(c.name);
  if (clipboard == clipboards_.end()) return give_up("nothing was copied as \"" + c.name + "\"");
  const auto at = resolve_voxel(c.at);
  const auto mask = resolve_mask(c.mask);
  if (!at || !mask) return Progress::stop;
  auto build = turned(*clipboard->second.build, c.orientation);
  if (build) {
    const TurnedMaterials now =
        turned_materials((*build)->palette(), c.orientation, host_.tool_box().materials());
    if (now.is_changed) build = with_materials(**build, now.ids);
  }
  if (!build) return give_up("cannot paste \"" + c.name + "\": " + words_of(build.error()));
  if (!is_in_world(*at, (*build)->sides()))
    return give_up("cannot paste \"" + c.name + "\": it reaches outside the world");
  const Replica& replica = host_.replica();
  start_edits(paste_of_build({*std::move(build), *at, *mask, clipboard->second.empty},
                             replica.opened() ? replica.edit_limits() : EditLimits{}));
  return propose_edits();
}

ScriptRunner::Progress ScriptRunner::run(const script::Dig&) {
  if (started_) return propose_edits();
  const auto hit = host_.pick();
  if (!hit) {
    fail("nothing to dig within reach");
    return Progress::done;
  }
  return propose_joined({SetVoxel{hit->voxel}, {}, kEmpty});
}

ScriptRunner::Progress ScriptRunner::run(const script::Place& c) {
  if (started_) return propose_edits();
  const auto material = resolve_material(c.material);
  if (!material) return Progress::stop;
  const auto hit = host_.pick();
  const auto at = hit ? place_against(*hit) : std::nullopt;
  if (!at) {
    fail("nothing to place against within reach");
    return Progress::done;
  }
  Aim aim = host_.aim();
  aim.hit = hit;
  const Material placed = placed_material(*material, click_of(aim), host_.tool_box().materials());
  return propose_joined({SetVoxel{*at}, {}, placed});
}

ScriptRunner::Progress ScriptRunner::run(const script::Burst& c) {
  const auto material = resolve_material(c.material);
  if (!material) return Progress::stop;
  if (!started_) {
    start();
    state_.random = SplitMix64(c.seed);
    state_.centre = host_.eye();
  }
  const VoxelPos centre = voxel_of(state_.centre);
  for (; state_.count < c.count; ++state_.count) {
    const TimeUs due_us = after(state_.at_us, state_.count / c.rate);
    if (due_us > now_us_) {
      due_us_ = due_us;
      return Progress::waits;
    }
    const auto offset = [&] { return state_.random.between(-c.radius, c.radius); };
    VoxelPos at = centre;
    at.x += offset();
    at.y += offset();
    at.z += offset();
    // A refused edit does not fail the script. The host counts it.
    static_cast<void>(
        host_.propose({SetVoxel{at}, {}, *material}, due_us, now_us_, ActionPart::alone));
  }
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::Wait& c) {
  start();
  const TimeUs due_us = after(state_.at_us, c.seconds);
  if (now_us_ >= due_us) return Progress::done;
  due_us_ = due_us;
  return Progress::waits;
}

ScriptRunner::Progress ScriptRunner::run(const script::WaitUntil& c) {
  if (!started_) {
    start();
    state_.mark = host_.sync_mark();
  }
  const char* name = "loaded";
  bool reached = false;
  switch (c.what) {
    case script::Until::loaded:
      reached = host_.loaded();
      break;
    case script::Until::horizon:
      reached = host_.sees_horizon();
      name = "complete to the horizon";
      break;
    case script::Until::durable:
      reached = host_.durable();
      name = "durable";
      break;
    case script::Until::synced:
      reached = host_.synced(state_.mark);
      name = "synced";
      break;
  }
  if (reached) return Progress::done;
  const TimeUs due_us = after(state_.at_us, c.seconds_max);
  if (now_us_ >= due_us) {
    fail(std::string("not ") + name + " in time");
    return Progress::done;
  }
  due_us_ = due_us;
  return Progress::waits;
}

ScriptRunner::Progress ScriptRunner::run(const script::Screenshot& c) {
  if (!started_) {
    start();
    host_.finish_preview();
    if (!host_.screenshot(c.file)) {
      fail("no screenshot: this client draws nothing");
      return Progress::done;
    }
  }
  const auto written = host_.screenshot_written();
  if (!written) return Progress::waits;
  if (!*written) fail(written->error());
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::Expect& c) {
  const auto at = resolve_voxel(c.at);
  const auto expected = resolve_material(c.material);
  if (!at || !expected) return Progress::stop;
  const auto present = host_.shown_at(*at);
  if (!present) {
    fail("expected " + c.material + " at " + text_of(*at) + ", but its chunk is not here");
  } else if (*present != *expected) {
    fail("expected " + c.material + " at " + text_of(*at) + ", found material " +
         std::to_string(*present));
  }
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::Digests& c) {
  if (const auto written = host_.digests(c.file); !written) fail(written.error());
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::HistoryRequest& c) {
  start();
  if (!host_.connected()) return wait_for_connection();
  // A new connection shows the live world, so the request is sent again.
  if (!state_.is_sent || state_.connections != host_.connections()) {
    HistoryRequest request;
    request.to = c.to;
    request.seq = c.seq;
    if (c.to == HistoryTarget::time) {
      request.utc_us =
          host_.utc_now_us() - static_cast<TimeUs>(std::llround(c.seconds_ago * kUsPerSecond));
    }
    host_.travel(request);
    state_.is_sent = true;
    state_.connections = host_.connections();
  }
  if (!host_.travelling()) {
    const std::string refusal = host_.travel_refusal();
    return refusal.empty() ? Progress::done : give_up("no such moment: " + refusal);
  }
  const TimeUs due_us = after(state_.at_us, kScriptWaitSecondsMax);
  if (now_us_ >= due_us) return give_up("the moment did not come in time");
  due_us_ = due_us;
  return Progress::waits;
}

ScriptRunner::Progress ScriptRunner::run(const script::Say& c) {
  start();
  if (!host_.connected()) return wait_for_connection();
  const std::string refusal = host_.say(c.text);
  if (!refusal.empty()) fail("the line is not sent: " + refusal);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::WaitChat& c) {
  start();
  if (host_.take_chat(c.text)) return Progress::done;
  const TimeUs due_us = after(state_.at_us, c.seconds_max);
  if (now_us_ >= due_us) {
    fail("nobody wrote \"" + c.text + "\" in time");
    return Progress::done;
  }
  due_us_ = due_us;
  return Progress::waits;
}

ScriptRunner::Progress ScriptRunner::run(const script::Command& c) {
  start();
  if (!state_.is_sent) {
    if (!host_.connected()) return wait_for_connection();
    const std::string refusal = host_.command(c.text);
    if (!refusal.empty()) return give_up("the command cannot be sent: " + refusal);
    state_.is_sent = true;
  }
  if (!host_.commanding()) {
    if (!host_.show_answer()) fail_answer("\"" + c.text + "\"");
    return Progress::done;
  }
  const TimeUs due_us = after(state_.at_us, kScriptWaitSecondsMax);
  if (now_us_ >= due_us) return give_up("the server did not answer in time");
  due_us_ = due_us;
  return Progress::waits;
}

ScriptRunner::Progress ScriptRunner::run(const script::Repeat& c) {
  if (c.times == 0) {
    next_ = c.end + 1;
  } else {
    repeats_left_.push_back(c.times);
  }
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::End& c) {
  if (--repeats_left_.back() != 0) {
    next_ = c.repeat + 1;
  } else {
    repeats_left_.pop_back();
  }
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::wait_for_connection() {
  const TimeUs due_us = after(state_.at_us, kScriptWaitSecondsMax);
  if (now_us_ >= due_us) return give_up("the connection did not come back in time");
  due_us_ = due_us;
  return Progress::waits;
}

void ScriptRunner::fail_answer(const std::string& what) {
  // It is not sent again: a second undo would take back another action.
  fail(host_.answer_lost() ? "the connection ended before the answer to " + what +
                                 " came: the server may have carried it out or not"
                           : "the server refused " + what);
}

ScriptRunner::Progress ScriptRunner::after_input() {
  start();
  if (!host_.handling_input()) return Progress::done;
  due_us_ = now_us_;
  return Progress::waits;
}

ScriptRunner::Progress ScriptRunner::run(const script::PressKey& c) {
  if (!started_) host_.press(*parse_key_chord(c.chord));
  return after_input();
}

ScriptRunner::Progress ScriptRunner::run(const script::Type& c) {
  if (!started_) host_.type(c.text);
  return after_input();
}

ScriptRunner::Progress ScriptRunner::run(const script::Click& c) {
  if (!started_) host_.click(c.x, c.y);
  return after_input();
}

ScriptRunner::Progress ScriptRunner::run(const script::ShowInterface& c) {
  host_.show_interface(c.is_shown);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::Inspect& c) {
  host_.inspect(c.mode, c.is_on);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::Quit&) { return Progress::stop; }

}  // namespace runstone
