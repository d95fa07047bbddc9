// The commands for map, timeline, rollback and the library of builds.
#include "client/script/script_runner.hpp"

namespace runstone {
namespace {

/// A build of 64 MiB comes over a slow line.
constexpr TimeUs kLibraryUsMax = 600'000'000;
constexpr TimeUs kPanelUsMax = static_cast<TimeUs>(kScriptWaitSecondsMax) * 1'000'000;

}  // namespace

ScriptRunner::Progress ScriptRunner::wait_for_panel(bool is_busy, const char* what) {
  if (!is_busy) return Progress::done;
  const TimeUs due_us = state_.at_us + kPanelUsMax;
  if (now_us_ >= due_us) return give_up(what);
  due_us_ = now_us_ + 20'000;
  return Progress::waits;
}

ScriptRunner::Progress ScriptRunner::run(const script::ShowMap& c) {
  if (!started_) {
    start();
    host_.show_map(c.is_shown, c.is_full);
    // The map begins to draw in a later turn.
    due_us_ = now_us_;
    return c.is_shown ? Progress::waits : Progress::done;
  }
  return wait_for_panel(host_.loading_panels(), "the map was not drawn in time");
}

ScriptRunner::Progress ScriptRunner::run(const script::ZoomMap& c) {
  host_.zoom_map(c.pixels);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::ShowTimeline& c) {
  if (!started_) {
    start();
    host_.show_timeline(c.is_shown);
    due_us_ = now_us_;
    return c.is_shown ? Progress::waits : Progress::done;
  }
  return wait_for_panel(host_.loading_panels(), "the timeline did not come in time");
}

ScriptRunner::Progress ScriptRunner::run(const script::ShowLibrary& c) {
  if (!started_) {
    start();
    host_.show_library(c.is_shown);
    due_us_ = now_us_;
    return c.is_shown ? Progress::waits : Progress::done;
  }
  return wait_for_panel(host_.loading_panels(), "the list of builds did not come in time");
}

template <class Begin>
ScriptRunner::Progress ScriptRunner::use_library(const Begin& begin) {
  start();
  if (!state_.is_sent) {
    if (!host_.connected()) return wait_for_connection();
    begin();
    state_.is_sent = true;
  }
  if (host_.using_library()) {
    if (now_us_ >= state_.at_us + kLibraryUsMax)
      return give_up("the library of builds did not answer in time");
    due_us_ = now_us_ + 20'000;
    return Progress::waits;
  }
  if (const std::string why = host_.show_library_answer(); !why.empty()) return give_up(why);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::ListBuilds& c) {
  return use_library([&] { host_.list_library(c.name); });
}

ScriptRunner::Progress ScriptRunner::run(const script::TakeBuild& c) {
  return use_library([&] { host_.take_build(c.number); });
}

ScriptRunner::Progress ScriptRunner::run(const script::AddBuild& c) {
  return use_library([&] { host_.add_build(c.name); });
}

ScriptRunner::Progress ScriptRunner::run(const script::Rollback& c) {
  using Kind = script::Rollback::Kind;
  start();
  if (!state_.is_sent) {
    if (!host_.connected()) return wait_for_connection();
    const std::string refusal = c.kind == Kind::preview ? host_.preview_rollback(c.filters)
                                : c.kind == Kind::apply ? host_.apply_rollback()
                                : c.kind == Kind::undo  ? host_.undo_rollback()
                                                        : host_.forget_rollback();
    if (!refusal.empty()) return give_up("the rollback cannot begin: " + refusal);
    state_.is_sent = true;
  }
  const Progress progress =
      wait_for_panel(host_.rolling_back(), "the server did not answer in time");
  if (progress == Progress::done && !host_.show_rollback_answer()) fail_answer("the rollback");
  return progress;
}

}  // namespace runstone
