#include "server/rollback/rollback_service.hpp"

#include <algorithm>
#include <charconv>

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "server/rollback/player_actions.hpp"
#include "server/rollback/rollback_groups.hpp"

namespace runstone {
namespace {

constexpr std::size_t kPreviewsMax = 16;  // selections are large: the oldest one goes
constexpr std::size_t kListedMax = 20;
constexpr TimeUs kSliceIntervalUs = 45'000;  // of one job: a little less than a tick

/// Both corners inside, as commands take a box.
std::string text_of_box(const VoxelBox& box) {
  return text_of(box.min) + " to " + text_of(VoxelPos{box.max.x - 1, box.max.y - 1, box.max.z - 1});
}

std::string counted(std::uint64_t count, const char* one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace

struct RollbackService::Preview {
  enum class State { computing, ready, applied };
  std::uint64_t number = 0;
  State state = State::computing;
  std::shared_ptr<const Selection> selection;
  std::uint64_t voxels = 0, chunks = 0;  // that would change
  std::string extra, error;
  std::shared_ptr<std::atomic<bool>> is_wanted = std::make_shared<std::atomic<bool>>(true);
  Sequence rollback = 0;  // its first edit, once applied
  std::string name() const { return "p" + std::to_string(number); }
};

struct RollbackService::Job {
  Job(RestoreOrder order, std::string name_, CommandReply reply_)
      : job(std::move(order)), name(std::move(name_)), reply(std::move(reply_)) {}
  RestoreJob job;
  std::string name;  // "undo", or what the person called it
  CommandReply reply;
  std::optional<TimeUs> wrote_us;            // when it last wrote a slice, steady clock
  std::shared_ptr<Preview> preview;          // of a rollback
  std::optional<AuthorId> player_change_of;  // of an undo or redo
  bool has_told_wait = false;
  /// Empty: nothing holds it up.
  std::string wait_text() const {
    const std::string& limit = job.progress().waits_for;
    return limit.empty() ? limit : "waits: " + limit;
  }
};

RollbackService::RollbackService(WorldServer& world, Workers& workers, RandomBytes random)
    : world_(world), workers_(workers), random_(std::move(random)), own_instance_(new_instance()) {}
RollbackService::~RollbackService() = default;

void RollbackService::stop() {
  goes_on_->store(false);
  for (auto& [number, preview] : previews_) preview->is_wanted->store(false);
}

ClientInstance RollbackService::new_instance() {
  std::array<std::uint8_t, 8> bytes{};
  random_(bytes);
  ClientInstance instance = 0;
  for (const std::uint8_t byte : bytes) instance = instance << 8 | byte;
  return instance;
}

void RollbackService::when_durable(const Clocks& now, const CommandReply& reply,
                                   std::function<void()> begin) {
  world_.commit(now);
  if (!world_.accepts_edits())
    return refuse(reply, "not now: the server stops, or its log cannot be written");
  if (world_.durable() >= world_.head()) return begin();
  waiting_.push_back({world_.head(), std::move(begin), reply});
}

// ---- undo and redo
// -----------------------------------------------------------------------------------------------

std::string RollbackService::busy_text(AuthorId author) const {
  std::string text = "one of yours is still under way";
  for (const auto& job : jobs_) {
    if (job->player_change_of == author && !job->wait_text().empty())
      text += ", and " + job->wait_text();
  }
  return text;
}

void RollbackService::change_player_actions(AuthorId author, Cause cause, const Clocks& now,
                                            CommandReply reply) {
  const std::string name = cause == Cause::undo ? "undo" : "redo";
  if (player_changes_.contains(author)) return refuse(reply, name + ": " + busy_text(author));
  when_durable(now, reply, [this, author, cause, name, reply] {
    if (!player_changes_.insert(author).second)
      return refuse(reply, name + ": " + busy_text(author));
    auto found = std::make_shared<StoreResult<PlayerActionSearch>>(PlayerActionSearch());
    workers_.run(
        [found, author, cause, end = world_.durable(), goes_on = goes_on()](
            WorldReader& reader, const Generator& generator) {
          *found = next_player_change(reader, generator, author, cause, end, goes_on);
        },
        [this, found, author, cause, name, reply](const std::string& error) {
          player_changes_.erase(author);
          if (!error.empty()) return refuse(reply, name + ": " + error);
          if (!*found) {
            return refuse(reply, found->error().kind == StoreError::Kind::cancelled
                                     ? name + ": not now: the server stops"
                                     : name + ": " + found->error().message());
          }
          std::optional<PlayerChange>& next = found->value().change;
          if (!next && found->value().has_given_up) {
            return refuse(reply,
                          name + ": nothing is left of the " + std::to_string(kPassedActionsMax) +
                              " edits that are next: others have built over them, or they changed "
                              "nothing; it looks no further back");
          }
          if (!next) return refuse(reply, "nothing to " + name);
          PlayerChange& change = *next;
          RestoreOrder order;
          order.author = author;
          order.instance = own_instance_;
          order.first_seq = std::max(world_.resolved(author, own_instance_), kGroupBegins) + 1;
          order.payer = author;
          order.cause = cause;
          order.subject = change.action;
          order.selection = std::make_shared<const Selection>(std::move(change.selection));
          player_changes_.insert(author);
          start_job(std::move(order), name, reply).player_change_of = author;
        });
  });
}

// ---- rollback
// ----------------------------------------------------------------------------------------------------

void RollbackService::preview(const SelectionFilter& filter, const Clocks& now, CommandReply reply,
                              Viewer see, Seen seen) {
  when_durable(now, reply, [this, filter, reply, see, seen] {
    const auto preview = std::make_shared<Preview>();
    preview->number = next_preview_++;
    previews_[preview->number] = preview;
    if (previews_.size() > kPreviewsMax) {
      previews_.begin()->second->is_wanted->store(false);
      previews_.erase(previews_.begin());
    }
    SelectionFilter until_now = filter;
    until_now.last = std::min(filter.last, world_.durable());
    const auto work = [preview, until_now, see, seen, end = world_.durable()](
                          WorldReader& reader, const Generator& generator) {
      const auto goes_on = [preview] { return preview->is_wanted->load(); };
      auto selection = select_edits(reader, until_now, goes_on);
      if (!selection) {
        preview->error = selection.error().message();
        return;
      }
      preview->selection = std::make_shared<const Selection>(*std::move(selection));
      RestorePlanner planner(reader, generator, goes_on);
      for (const auto& [key, edits] : preview->selection->chunks) {
        if (!goes_on()) {
          preview->error = "cancelled";
          return;
        }
        const auto plan = planner.plan(key, edits, preview->selection->box, end);
        if (!plan) {
          preview->error = plan.error().message();
          return;
        }
        preview->voxels += plan->voxels;
        preview->chunks += plan->voxels > 0 ? 1 : 0;
        if (see && plan->voxels > 0) see(*plan);
      }
      if (seen && preview->voxels > 0) preview->extra = seen(reader, generator, preview->name());
    };
    workers_.run(work, [this, preview, reply](const std::string& error) {
      const std::string name = preview->name();
      const std::string wrong = error.empty() ? preview->error : error;
      if (!wrong.empty()) {
        previews_.erase(preview->number);
        return refuse(reply, "rollback preview: " + wrong);
      }
      if (!previews_.contains(preview->number)) {
        return refuse(reply, "rollback preview: " + name +
                                 " was forgotten: too many were asked for meanwhile");
      }
      const Selection& s = *preview->selection;
      if (s.edits == 0 || preview->voxels == 0) {
        previews_.erase(preview->number);
        const std::string why =
            s.edits == 0 ? "no edit matches"
                         : counted(s.edits, "edit") + " match, but nothing of them is left: " +
                               "others have built there, or it was taken back before";
        return reply({"rollback preview: nothing to do: " + why, true, true});
      }
      preview->state = Preview::State::ready;
      std::string text = "preview " + name + ": would take back " + counted(s.edits, "edit") +
                         " (" + utc_text(s.first_us) + " to " + utc_text(s.last_us) +
                         "): " + counted(preview->voxels, "voxel") + " in " +
                         counted(preview->chunks, "chunk") + " would change\n";
      text += "area " + text_of_box(*s.area()) + "\n";
      if (!preview->extra.empty()) text += preview->extra + "\n";
      text += "nothing has changed yet: `rollback apply " + name + "` does it, `rollback cancel " +
              name + "` forgets it";
      reply({text, true, true});
    });
  });
}

RollbackService::Preview* RollbackService::find_preview(const std::string& id) {
  if (!id.starts_with('p')) return nullptr;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(id.data() + 1, id.data() + id.size(), number);
  if (error != std::errc() || end != id.data() + id.size()) return nullptr;
  const auto found = previews_.find(number);
  return found == previews_.end() ? nullptr : found->second.get();
}

void RollbackService::apply(const std::string& id, AuthorId author, CommandReply reply) {
  Preview* const preview = find_preview(id);
  if (preview == nullptr) {
    return refuse(reply,
                  "rollback apply: there is no preview \"" + id + "\" (rollback list names them)");
  }
  if (preview->state == Preview::State::computing) {
    return refuse(reply, "rollback apply: " + id + " is still being computed");
  }
  if (preview->state == Preview::State::applied) {
    return refuse(reply, "rollback apply: " + id + " was applied before");
  }
  if (!world_.accepts_edits())
    return refuse(reply, "rollback apply: the server stops, or its log cannot be written");
  preview->state = Preview::State::applied;
  RestoreOrder order;
  order.author = author;
  order.instance = new_instance();
  order.cause = Cause::rollback;
  order.selection = preview->selection;
  reply({"rollback " + id + " begins: " + counted(preview->voxels, "voxel") + " in " +
             counted(preview->chunks, "chunk") + "; `rollback cancel " + id + "` stops it",
         false, true});
  start_job(std::move(order), "rollback " + id, std::move(reply)).preview =
      previews_[preview->number];
}

void RollbackService::cancel(const std::string& id, CommandReply reply) {
  for (const auto& job : jobs_) {
    const bool is_it =
        (job->preview && job->preview->name() == id) ||
        (job->job.progress().first != 0 && std::to_string(job->job.progress().first) == id);
    if (!is_it || job->player_change_of) continue;
    job->job.cancel();
    return reply({"rollback " + id + " stops", true, true});
  }
  Preview* const preview = find_preview(id);
  if (preview == nullptr)
    return refuse(reply, "rollback cancel: there is no preview or running rollback \"" + id + "\"");
  if (preview->state == Preview::State::applied) {
    return refuse(reply, "rollback cancel: " + id + " is applied already: `rollback undo " +
                             std::to_string(preview->rollback) + "` takes it back");
  }
  preview->is_wanted->store(false);
  previews_.erase(preview->number);
  reply({"preview " + id + " is forgotten", true, true});
}

void RollbackService::undo_rollback(const std::string& id, AuthorId author, const Clocks& now,
                                    CommandReply reply) {
  Sequence seq = 0;
  if (const Preview* preview = find_preview(id)) {
    seq = preview->rollback;
    if (seq == 0) return refuse(reply, "rollback undo: " + id + " has not changed anything yet");
  } else {
    const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), seq);
    if (error != std::errc() || end != id.data() + id.size() || seq == 0) {
      return refuse(
          reply, "rollback undo: \"" + id + "\" is no id of a rollback (rollback list names them)");
    }
  }
  for (const auto& job : jobs_) {
    if (job->job.progress().first == seq) {
      return refuse(reply, "rollback undo: " + id + " is still being applied: cancel it first");
    }
  }
  when_durable(now, reply, [this, seq, author, reply] {
    if (seq > world_.head())
      return refuse(reply, "rollback undo: there is no edit " + std::to_string(seq));
    auto found = std::make_shared<StoreResult<Selection>>(Selection());
    workers_.run(
        [found, seq, goes_on = goes_on()](WorldReader& reader, const Generator&) {
          const auto group = rollback_group(reader, seq);
          *found = group ? select_edits(reader, group->edits, goes_on)
                         : StoreResult<Selection>(Unexpected<StoreError>{group.error()});
        },
        [this, found, seq, author, reply](const std::string& error) {
          if (!error.empty()) return refuse(reply, "rollback undo: " + error);
          if (!*found) return refuse(reply, "rollback undo: " + found->error().message());
          RestoreOrder order;
          order.author = author;
          order.instance = new_instance();
          order.cause = Cause::undo;
          order.selection = std::make_shared<const Selection>(*std::move(*found));
          start_job(std::move(order), "undo of rollback " + std::to_string(seq), reply);
        });
  });
}

void RollbackService::list(CommandReply reply) {
  std::string text;
  for (const auto& [number, preview] : previews_) {
    if (preview->state == Preview::State::computing)
      text += preview->name() + " is being computed\n";
    if (preview->state == Preview::State::ready) {
      text += preview->name() + " preview: " + counted(preview->selection->edits, "edit") + ", " +
              counted(preview->voxels, "voxel") + "\n";
    }
  }
  for (const auto& job : jobs_) {
    const RestoreJob::Progress& p = job->job.progress();
    text += job->name + " is being applied: " + std::to_string(p.chunks_done) + " of " +
            counted(p.chunks, "chunk");
    if (!job->wait_text().empty()) text += " (" + job->wait_text() + ")";
    text += "\n";
  }
  auto groups =
      std::make_shared<StoreResult<std::vector<RollbackGroup>>>(std::vector<RollbackGroup>());
  workers_.run(
      [groups](WorldReader& reader, const Generator&) {
        *groups = rollback_groups(reader, kListedMax);
      },
      [groups, text, reply](const std::string& error) {
        if (!error.empty()) return refuse(reply, "rollback list: " + error);
        if (!*groups) return refuse(reply, "rollback list: " + groups->error().message());
        std::string all = text;
        for (const RollbackGroup& group : **groups) {
          all += "rollback " + std::to_string(group.id) + " " + utc_text(group.time_us) + " by " +
                 (group.op.author == 0 ? "the server" : "#" + std::to_string(group.op.author)) +
                 ": " + counted(group.edits.size(), "edit");
          if (group.taken_back_by != 0)
            all += ", taken back by " + std::to_string(group.taken_back_by);
          all += "\n";
        }
        if (all.empty()) all = "no previews, and no rollback was ever applied\n";
        all.pop_back();
        reply({all, true, true});
      });
}

// ---- jobs
// ----------------------------------------------------------------------------------------------------------

RollbackService::Job& RollbackService::start_job(RestoreOrder order, std::string name,
                                                 CommandReply reply) {
  jobs_.push_back(std::make_shared<Job>(std::move(order), std::move(name), std::move(reply)));
  return *jobs_.back();
}

void RollbackService::step(Job& job, const Clocks& now) {
  // Ticks also come whenever a worker has answered, and must not add up to more than a slice an interval.
  if (!job.wrote_us || now.steady_us - *job.wrote_us >= kSliceIntervalUs) {
    const std::uint64_t written = job.job.progress().edits;
    job.job.step(world_, now);
    if (job.job.progress().edits != written) job.wrote_us = now.steady_us;
  }
  if (job.preview) job.preview->rollback = job.job.progress().first;
  auto work = job.job.next_work(world_);
  if (!work) return;
  const auto self =
      std::find_if(jobs_.begin(), jobs_.end(), [&](const auto& j) { return j.get() == &job; });
  auto chunks = std::make_shared<std::vector<RestoredChunk>>();
  workers_.run(
      [chunks, work = *std::move(work), goes_on = goes_on()](WorldReader& reader,
                                                             const Generator& generator) {
        *chunks = restore_chunks(reader, generator, work, goes_on);
      },
      [held = *self, chunks](const std::string& error) {
        if (!error.empty()) return held->job.work_failed(error);
        held->job.computed(std::move(*chunks));
      });
}

void RollbackService::tell_wait(Job& job) const {
  if (!job.player_change_of || job.has_told_wait || job.wait_text().empty()) return;
  job.has_told_wait = true;
  job.reply({job.name + " " + job.wait_text(), false, true});
}

bool RollbackService::answer_if_ended(Job& job) {
  const RestoreJob::Progress& p = job.job.progress();
  const RestoreJob::State state = job.job.state();
  if (state == RestoreJob::State::applying) return false;
  const bool is_on_disk = world_.durable() >= p.last;
  if (!is_on_disk && world_.accepts_edits()) return false;  // said when it is true
  const std::string what = counted(p.voxels, "voxel") + " in " + counted(p.chunks_changed, "chunk");
  const std::string undo_hint =
      p.first == 0 || job.player_change_of
          ? std::string()
          : "; `rollback undo " + std::to_string(p.first) + "` takes it back";
  std::string text = job.name;
  switch (state) {
    case RestoreJob::State::done:
      text += job.player_change_of
                  ? ": " + what
                  : " done: " + what + (p.first == 0 ? "; nothing was left to change" : "");
      break;
    case RestoreJob::State::cancelled:
      text += " was cancelled after " + std::to_string(p.chunks_done) + " of " +
              counted(p.chunks, "chunk");
      break;
    default:
      text += " failed after " + std::to_string(p.chunks_done) + " of " +
              counted(p.chunks, "chunk") + ": " + p.error;
      break;
  }
  text += undo_hint;
  if (!is_on_disk)
    text += " (not all of it is on disk yet: what is not will be missing after a restart)";
  job.reply({text, true, state == RestoreJob::State::done && is_on_disk});
  if (job.player_change_of) player_changes_.erase(*job.player_change_of);
  return true;
}

void RollbackService::tick(const Clocks& now) {
  std::vector<Waiting> ready;
  const bool is_closed = !world_.accepts_edits();
  std::erase_if(waiting_, [&](Waiting& w) {
    if (world_.durable() < w.needed && !is_closed) return false;
    ready.push_back(std::move(w));
    return true;
  });
  for (Waiting& w : ready) {
    if (world_.durable() >= w.needed) {
      w.begin();
    } else {
      refuse(w.reply, "not now: the server stops, or its log cannot be written");
    }
  }
  const std::vector<std::shared_ptr<Job>> jobs(jobs_.begin(), jobs_.end());
  for (const auto& job : jobs) {
    step(*job, now);
    tell_wait(*job);
  }
  std::erase_if(jobs_, [this](const auto& job) { return answer_if_ended(*job); });
}

}  // namespace runstone
