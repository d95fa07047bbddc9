#include "server/place/place_service.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "protocol/rules/paste_limits.hpp"
#include "server/rollback/count_text.hpp"

namespace runstone {
namespace {

constexpr TimeUs kReportIntervalUs = 2'000'000;
constexpr TimeUs kSliceIntervalUs = 45'000;  // of one job: a little less than a tick

/// Returns how far a job is, such as "is at 40 percent: 120000 voxels a second, 30 s left".
std::string progress_text(const PlaceJob::Progress& p, TimeUs elapsed_us) {
  const auto seconds = static_cast<std::uint64_t>(std::max<TimeUs>(1, elapsed_us / 1'000'000));
  const std::uint64_t percent = p.cells_done / std::max<std::uint64_t>(1, p.cells / 100);
  std::string text = "is at " + std::to_string(std::min<std::uint64_t>(percent, 99)) +
                     " percent: " + counted(p.voxels / seconds, "voxel") + " a second";
  if (percent > 0)
    text += ", " +
            std::to_string(seconds * (100 - std::min<std::uint64_t>(percent, 100)) / percent) +
            " s left";
  return p.waits_for.empty() ? text : text + "; it waits: " + p.waits_for;
}

std::optional<std::string> box_refusal(const PlaceOrder& order) {
  const VoxelPos sides = order.build->sides();
  const std::array<std::pair<std::int64_t, std::int64_t>, 3> axes = {
      {{order.at.x, sides.x}, {order.at.y, sides.y}, {order.at.z, sides.z}}};
  for (const auto& [at, side] : axes) {
    if (at < -kWorldLimit || at + side > kWorldLimit) {
      return "it does not lie in the world there: coordinates are " + std::to_string(-kWorldLimit) +
             " to " + std::to_string(kWorldLimit - 1);
    }
  }
  return std::nullopt;
}

}  // namespace

struct PlaceService::Job {
  Job(PlaceOrder order, const PasteLimits& limits, std::string name_, CommandReply reply_)
      : job(std::move(order), limits), name(std::move(name_)), reply(std::move(reply_)) {}
  PlaceJob job;
  std::string name;
  CommandReply reply;
  std::optional<TimeUs> wrote_us;      // when it last ordered a slice, steady clock
  TimeUs began_us = 0, report_us = 0;  // steady clock: the begin, and when it next answers
};

PlaceService::PlaceService(WorldServer& world, RollbackService& rollback,
                           RollbackService::Workers& workers, RandomBytes random)
    : world_(world), rollback_(rollback), workers_(workers), random_(std::move(random)) {}
PlaceService::~PlaceService() = default;

std::optional<std::string> PlaceService::refusal(const PlaceOrder& order) const {
  if (auto why = box_refusal(order)) return why;
  if (!world_.order().accepts_edits()) {
    return "not now: the server stops, its log cannot be written, or another server owns the world";
  }
  for (const auto& job : jobs_) {
    if (job->job.order().author != order.author) continue;
    return job->name +
           ", which you place, is still under way (`builds cancel` ends it and takes it back)";
  }
  if (jobs_.size() >= kJobsMax) {
    return std::to_string(kJobsMax) + " builds are being placed: try again when one is done";
  }
  return std::nullopt;
}

void PlaceService::place(PlaceOrder order, const std::string& name, const Clocks& now,
                         CommandReply reply) {
  if (const auto why = refusal(order)) return refuse(reply, name + ": " + *why);
  std::array<std::uint8_t, 8> bytes{};
  random_(bytes);
  order.instance = 0;
  for (const std::uint8_t byte : bytes) order.instance = order.instance << 8 | byte;
  const PasteLimits limits = paste_limits(world_.order().authority().limits());
  jobs_.push_back(std::make_shared<Job>(std::move(order), limits, name, std::move(reply)));
  jobs_.back()->began_us = now.steady_us;
  jobs_.back()->report_us = now.steady_us + kReportIntervalUs;
}

void PlaceService::cancel(AuthorId author, const Clocks& now, CommandReply reply) {
  std::string names;
  for (const auto& job : jobs_) {
    if (author != 0 && job->job.order().author != author) continue;
    if (job->job.state() != PlaceJob::State::placing) continue;
    names += (names.empty() ? "" : ", ") + job->name;
    job->job.cancel();
  }
  if (names.empty()) return refuse(reply, "no build is being placed");
  reply(CommandAnswer::last("ended: " + names));
  tick(now);
}

void PlaceService::step(const std::shared_ptr<Job>& job, const Clocks& now) {
  // tick() is also called whenever a worker has answered, so the interval bounds the rate of edits.
  if (!job->wrote_us || now.steady_us - *job->wrote_us >= kSliceIntervalUs) {
    const std::uint64_t written = job->job.progress().edits;
    job->job.step(world_, now);
    if (job->job.progress().edits != written) job->wrote_us = now.steady_us;
  }
  auto source = job->job.next_work();
  if (!source) return;
  auto parts = std::make_shared<PlacedParts>();
  workers_.run([parts, source, edge = world_.order().authority().limits().chunk_edge](
                   WorldReader&, const Generator&) { *parts = cut_parts(*source, edge); },
               [job, parts](const std::string& error) {
                 if (!error.empty()) return job->job.work_failed(error);
                 job->job.computed(std::move(*parts));
               });
}

void PlaceService::report(Job& job, const Clocks& now) const {
  if (job.job.state() != PlaceJob::State::placing || now.steady_us < job.report_us) return;
  job.report_us = now.steady_us + kReportIntervalUs;
  job.reply(CommandAnswer::progress(
      job.name + " " + progress_text(job.job.progress(), now.steady_us - job.began_us)));
}

bool PlaceService::answer_if_ended(Job& job, const Clocks& now) {
  using State = PlaceJob::State;
  const State state = job.job.state();
  if (state == State::placing) return false;
  const bool is_open = world_.order().accepts_edits();
  if (is_open && job.job.has_queued(world_)) return false;
  job.job.note_sequences(world_);
  const PlaceJob::Progress& p = job.job.progress();
  const bool is_on_disk = world_.order().durable() >= p.last;
  if (!is_on_disk && is_open) return false;  // the answer waits for the disk
  std::string text = job.name;
  if (state == State::done) {
    text += " is placed: " + counted(p.voxels, "voxel") + " in " + counted(p.edits, "edit");
    if (p.edits > 0) text += "; `undo` takes them back as one action";
  } else {
    text += state == State::failed ? " failed" : " was ended";
    text += " after " + counted(p.voxels, "voxel");
    if (state == State::failed) text += ": " + p.error;
  }
  if (p.edits_refused > 0)
    text += "; " + counted(p.edits_refused, "part") + " left out: " + p.refusal;
  if (!is_on_disk)
    text += " (not all of it is on disk yet: what is not will be missing after a restart)";
  if (state == State::cancelled && p.first != 0) {
    job.reply(CommandAnswer::progress(text + "; it is being taken back"));
    rollback_.undo_action(job.job.order().author, job.job.order().instance, p.first, now,
                          job.reply);
    return true;
  }
  const bool is_nothing = p.edits == 0 && p.edits_refused > 0;
  job.reply(CommandAnswer::last(text, state == State::done && is_on_disk && !is_nothing));
  return true;
}

void PlaceService::tick(const Clocks& now) {
  const std::vector<std::shared_ptr<Job>> jobs(jobs_.begin(), jobs_.end());
  for (const auto& job : jobs) {
    step(job, now);
    report(*job, now);
  }
  std::erase_if(jobs_, [&](const auto& job) { return answer_if_ended(*job, now); });
}

}  // namespace runstone
