#include "server/app/backup_schedule.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string_view>
#include <utility>
#include <vector>

#include "common/os/low_priority.hpp"
#include "server/backup/backup_folder.hpp"
#include "server/backup/world_backup.hpp"
#include "server/runtime/logging.hpp"
#include "server/store/store.hpp"

namespace runstone {
namespace {

constexpr TimeUs kSecondUs = 1'000'000;
constexpr TimeUs kRetryUs = 600 * kSecondUs;  // after a failure, if backups are not more frequent
/// The wall clock is read so often while the thread waits: it may be set, and machines sleep.
constexpr std::chrono::seconds kLookAgain{20};

TimeUs wall_now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

std::uint64_t seconds_of(TimeUs us) {
  return us <= 0 ? 0 : static_cast<std::uint64_t>(us / kSecondUs);
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// Returns the line that says why the program failed, without the name of the program.
std::string reason_in(const std::string& text) {
  const std::vector<std::string> lines = lines_of(text);
  std::string line = lines.empty() ? "the program said nothing" : lines.back();
  constexpr std::string_view kProgram = "runstone-server: ";
  if (line.starts_with(kProgram)) line.erase(0, kProgram.size());
  return line;
}

}  // namespace

Result<std::optional<BackupPlan>, std::string> backup_plan_of(const ServerConfig& config) {
  if (config.backup_every_s == 0) return std::optional<BackupPlan>();
  const std::string setting = "backup_every = " + config_text(config, "backup_every");
  if (!config.store.empty())
    return failure(setting + ": the world is in PostgreSQL: back it up with pg_dump");
  if (config.backup_folder.empty())
    return failure(setting + ": backup_folder is missing: name a folder for the backups");
  const std::string& folder = config.backup_folder;
  if (is_inside(folder, config.world) || is_inside(config.world, folder)) {
    return failure("backup_folder = " + folder + ": the folder of the world, " + config.world +
                   ", and that of the backups must not lie in each other");
  }
  return std::optional(
      BackupPlan{config.world,
                 folder,
                 config.backup_every_s,
                 {config.backup_keep_hourly, config.backup_keep_daily, config.backup_keep_weekly}});
}

TimeUs next_backup_us(std::optional<TimeUs> last_us, TimeUs now_us, TimeUs every_us) {
  return last_us ? std::min(*last_us, now_us) + every_us : now_us;
}

BackupSchedule::BackupSchedule(BackupPlan plan) : plan_(std::move(plan)), child_(plan_.world) {}

void BackupSchedule::start() {
  thread_ = std::thread([this] { run(); });
}

void BackupSchedule::ask_to_stop() {
  {
    const std::lock_guard guard(mutex_);
    stopping_ = true;
  }
  child_.ask_to_stop();
  changed_.notify_all();
}

void BackupSchedule::stop() {
  ask_to_stop();
  if (thread_.joinable()) thread_.join();
  child_.stop();
}

BackupState BackupSchedule::state() const {
  const TimeUs now_us = wall_now_us();
  const std::lock_guard guard(mutex_);
  BackupState state;
  if (last_) {
    state.last = last_->backup;
    state.last->age_s = seconds_of(now_us - last_->taken_us);
    state.last->ahead_s = seconds_of(last_->taken_us - now_us);
  }
  state.next_s = seconds_of(next_us_ - now_us);
  state.is_under_way = is_under_way_;
  state.failures = failures_;
  state.failure = failure_;
  return state;
}

void BackupSchedule::run() {
  lower_priority();
  lower_disk_priority();
  try {
    read_world();
    read_last();
  } catch (const std::exception& error) {
    logger("store").warn("backup: {}: {}", plan_.folder, error.what());
  }
  while (await_due()) {
    try {
      if (!make_and_note()) return;
    } catch (const std::exception& error) {
      // An exception that leaves a thread would end the server.
      note({plan_.folder + ": " + error.what(), false});
    }
  }
}

bool BackupSchedule::make_and_note() {
  read_world();
  const TimeUs begun_us = wall_now_us();
  const auto outcome = make_backup();
  if (!outcome) return false;
  if (outcome->is_ok) {
    made_us_ = begun_us;
    // The first backup has made it a folder of backups.
    if (const auto held = hold_folder(); !held) logger("store").warn("backup: {}", held.error());
  }
  read_last();
  note(*outcome);
  return true;
}

Result<void, std::string> BackupSchedule::hold_folder() {
  folder_lock_ = FileLock();  // the disk may be another one than last time
  if (!BackupFolder::is_one(plan_.folder)) return {};
  auto taken = FileLock::take(plan_.folder + "/server.lock");
  if (!taken && taken.error().is_held)
    return failure(plan_.folder + ": another server makes its backups there");
  if (taken) folder_lock_ = *std::move(taken);
  return {};
}

void BackupSchedule::read_world() {
  if (world_ != WorldId{}) return;
  if (const auto world = open_world(plan_.world, StoreAccess::read_only))
    world_ = (*world)->meta().world_id;
}

void BackupSchedule::read_last() {
  const TimeUs now_us = wall_now_us();
  std::optional<Last> last;
  const auto folder = BackupFolder::open(plan_.folder);
  if (folder && folder->world() == world_) {
    const auto newest = folder->newest(now_us);
    const auto found = newest ? folder->read_sizes(*newest) : BackupFolder::Entry{};
    if (newest && found.error.empty()) {
      last =
          Last{{found.name, 0, found.manifest.bytes(), found.manifest.new_bytes}, found.taken_us};
    }
  }
  const TimeUs every_us = static_cast<TimeUs>(plan_.every_s) * kSecondUs;
  const std::lock_guard guard(mutex_);
  const bool is_other = last && (!last_ || last_->backup.name != last->backup.name);
  if (is_other && last->taken_us > now_us) {
    logger("store").warn(
        "backup: the newest one, {}, is dated in the future: a clock was wrong, or is: its age is 0 "
        "until then",
        last->backup.name);
  }
  last_ = std::move(last);
  const auto last_us = last_ ? std::optional(last_->taken_us) : std::nullopt;
  // One that was made and cannot be read counts: otherwise the next one followed it at once.
  next_us_ = next_backup_us(std::max(last_us, made_us_), now_us, every_us);
}

bool BackupSchedule::await_due() {
  const TimeUs every_us = static_cast<TimeUs>(plan_.every_s) * kSecondUs;
  std::unique_lock lock(mutex_);
  for (;;) {
    const TimeUs now_us = wall_now_us();
    next_us_ = std::min(next_us_, now_us + every_us);  // the clock may have been set back
    if (stopping_ || next_us_ <= now_us) return !stopping_;
    const auto rest = std::chrono::microseconds(next_us_ - now_us);
    changed_.wait_for(lock, std::min<std::chrono::microseconds>(rest, kLookAgain));
  }
}

std::optional<BackupSchedule::Outcome> BackupSchedule::make_backup() {
  if (const auto held = hold_folder(); !held) return Outcome{held.error(), false};
  {
    const std::lock_guard guard(mutex_);
    is_under_way_ = true;
    outcome_.reset();
  }
  child_.run(
      {"backup", "add", "--world", plan_.world, "--folder", plan_.folder, "--keep-hourly",
       std::to_string(plan_.policy.hourly), "--keep-daily", std::to_string(plan_.policy.daily),
       "--keep-weekly", std::to_string(plan_.policy.weekly)},
      [this](const CommandAnswer& answer) {
        const std::lock_guard guard(mutex_);
        outcome_ = Outcome{answer.text, answer.is_ok};
        changed_.notify_all();
      });
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopping_ || outcome_; });
  is_under_way_ = false;
  if (stopping_) return std::nullopt;
  return outcome_;
}

void BackupSchedule::note(const Outcome& outcome) {
  const std::lock_guard guard(mutex_);
  is_under_way_ = false;
  if (outcome.is_ok) {
    failures_ = 0;
    failure_.clear();
    if (last_) {
      logger("store").info("BACKED UP: name={} bytes={} new_bytes={} folder={}", last_->backup.name,
                           last_->backup.bytes, last_->backup.new_bytes, plan_.folder);
    }
    for (const std::string& line : lines_of(outcome.text)) {
      if (line.starts_with("warning")) logger("store").warn("backup: {}", line);
    }
    return;
  }
  ++failures_;
  failure_ = reason_in(outcome.text);
  const TimeUs every_us = static_cast<TimeUs>(plan_.every_s) * kSecondUs;
  const TimeUs retry_us = std::min(every_us, kRetryUs);
  next_us_ = wall_now_us() + retry_us;
  logger("store").error(
      "BACKUP FAILED: {}: the server goes on, and tries again in {} s; older backups stay",
      failure_, retry_us / kSecondUs);
}

}  // namespace runstone
