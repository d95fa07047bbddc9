#include "server/admin/retention_commands.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "common/core/utc_text.hpp"
#include "server/admin/amount_text.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/rollback_commands.hpp"
#include "server/rollback/count_text.hpp"
#include "server/store/removed_history.hpp"

namespace runstone {
namespace {

constexpr const char* kNoRetention = "this server cannot do that";

std::string causes_text(const LogVolume& volume) {
  std::string text;
  for (const auto& [cause, edits] : volume.causes)
    text += (text.empty() ? ", of them by cause: " : ", ") + std::string(name_of(cause)) + " " +
            std::to_string(edits);
  return text;
}

std::string space_text(const FreeSpace& free) {
  if (free.can_be_given_back) return "the free space goes back to the disk, in parts, at the end";
  if (!free.is_in_file) return "the database uses the free space for new rows";
  return "new edits use the free space. The file was made without a way to give it back while it is in "
         "use: `runstone-server compact --world DIR` does it at a stop, and makes one";
}

std::optional<std::uint64_t> configured_days(const CommandCall& call) {
  const auto& state = call.services.actions.retention_state;
  if (!state) return std::nullopt;
  const std::uint64_t days = state().days;
  return days == 0 ? std::nullopt : std::optional(days);
}

void show_retention(const CommandCall& call) {
  const auto& state = call.services.actions.retention_state;
  if (!state) return call.refuse(kNoRetention);
  call.on_worker(
      "retention: ", [](WorldReader& reader) { return reader.log_head(); },
      [call](const LogEnd& head) {
        RetentionState now = call.services.actions.retention_state();
        now.head = head;
        call.answer(retention_state_text(now));
      });
}

Result<std::optional<std::uint64_t>, std::string> parse_retention_preview(WordReader& reader) {
  std::optional<std::uint64_t> days;
  if (!reader.at_end()) {
    days = static_cast<std::uint64_t>(reader.number("retention preview", 0, kRetentionDaysMax));
    reader.expect_end("retention preview DAYS");
  }
  return reader.result(days);
}

/// Calls `go_on` with the plan of a retention that keeps so many days.
template <class GoOn>
void with_plan(const CommandCall& call, std::uint64_t days, GoOn go_on) {
  call.on_worker(
      "retention: ",
      [days, now_us = call.now.utc_us](WorldReader& reader) {
        return plan_retention(reader, days, now_us);
      },
      go_on);
}

void preview_retention(const CommandCall& call, const std::optional<std::uint64_t>& days) {
  const auto wanted = days ? days : configured_days(call);
  if (!wanted)
    return call.refuse(
        "retention preview: no policy is set (retention_days = 0): say how many days of edits stay, "
        "as in `retention preview 30`");
  with_plan(call, *wanted,
            [call](const RetentionPlan& plan) { call.answer(retention_plan_text(plan)); });
}

Result<std::uint64_t, std::string> parse_retention_run(WordReader& reader) {
  const auto days =
      static_cast<std::uint64_t>(reader.number("retention run", 0, kRetentionDaysMax));
  reader.expect_end("retention run DAYS");
  return reader.result(days);
}

void run_retention(const CommandCall& call, std::uint64_t days) {
  if (!call.services.actions.run_retention) return call.refuse(kNoRetention);
  with_plan(call, days, [call, days](const RetentionPlan& plan) {
    if (plan.removes_nothing()) return call.answer(retention_plan_text(plan));
    const std::string hazard =
        "edits that are removed can never be seen, rolled back or undone again\n" +
        retention_plan_text(plan) + "\nSo the edits of " + std::to_string(days) +
        " days would stay";
    if (call.refuse_unless_confirmed(hazard)) return;
    if (!call.services.actions.run_retention(days))
      return call.refuse(
          "retention run: one is under way already, or the log cannot be written (`retention` says "
          "more)");
    call.answer("removing " + counted(plan.volume.edits, "edit") + " up to " +
                removed_place(plan.cut) +
                " in small parts, while people play: `retention` says how far");
  });
}

void stop_retention(const CommandCall& call) {
  const auto& action = call.services.actions.stop_retention;
  if (!action) return call.refuse(kNoRetention);
  if (!action()) return call.refuse("retention stop: none is under way");
  const std::uint64_t days = configured_days(call).value_or(0);
  call.answer("it ends after its present part; what is removed stays removed" +
              std::string(days == 0 ? ""
                                    : "; the policy goes on in an hour, unless retention_days "
                                      "becomes another one (`reload`)"));
}

constexpr CommandRule kLookAtRetention = needs(Right::administer);

constexpr std::array<CommandRow, 4> kRetentionRows = {{
    {"retention", kLookAtRetention,
     "retention                 how long edits stay in the log, and what was removed",
     alone<show_retention>()},
    {"retention preview", kLookAtRetention,
     "retention preview [DAYS]  what would go if the edits of so many days stayed",
     parsed_by<parse_retention_preview, preview_retention>()},
    {.words = "retention run",
     .rule = kLocal,
     .help = "retention run DAYS        remove older edits from the log, while people play",
     .functions = parsed_by<parse_retention_run, run_retention>(),
     .may_be_confirmed = true},
    {"retention stop", kLocal, "retention stop            end what retention run has begun",
     alone<stop_retention>()},
}};

}  // namespace

std::span<const CommandRow> retention_commands() { return kRetentionRows; }

std::string retention_plan_text(const RetentionPlan& plan) {
  const LogVolume& volume = plan.volume;
  const std::string days = counted(plan.days, "day");
  const std::string reach =
      plan.head.version.seq == 0 ? "the first edit" : removed_place(plan.head);
  if (plan.newest.version.seq == 0) return "nothing would go: the log has no edit";
  if (plan.removes_nothing())
    return "nothing would go: no edit of the log is older than " + days +
           " before the newest one (" + utc_text(plan.newest.time_us) +
           ")\nreach       time travel, rollback and undo go back to " + reach;
  std::string text = "goes        " + counted(volume.edits, "edit") + " up to " +
                     removed_place(plan.cut) + causes_text(volume) + "; " +
                     counted(volume.keyframes, "keyframe");
  text += "\nstays       " + counted(plan.newest.version.seq - plan.cut.version.seq, "edit") +
          " of " + days + " before the newest one (" + utc_text(plan.newest.time_us) +
          "); the ground as it is; rights, materials, shapes, textures, clock, names, watermarks "
          "and the library";
  text += "\nbytes       about " + byte_count_text(volume.log_bytes) + " of edits and " +
          byte_count_text(volume.keyframe_bytes) + " of keyframes; the base takes at most " +
          byte_count_text(volume.base_bytes_max) + " of them";
  text += "\nfile        " + space_text(plan.free);
  text += "\nreach       time travel, rollback and undo go back to " + removed_place(plan.cut) +
          ", and now to " + reach;
  if (!plan.doubt.empty())
    text += "\nDOUBT       " + plan.doubt + ". A policy waits here; `retention run` does not";
  return text;
}

}  // namespace runstone
