#include "server/rollback/rollback_service.hpp"

#include <algorithm>
#include <charconv>

#include "common/core/utc_text.hpp"
#include "protocol/codec/restore_preview_messages.hpp"
#include "server/rollback/count_text.hpp"
#include "server/rollback/rollback_groups.hpp"

namespace runstone {
namespace {

// Selections are large, so the oldest preview is discarded when there are more.
constexpr std::size_t kPreviewsMax = 16;
// The greatest number of these previews that belong to players without the right `roll_back`. They
// do not displace other previews.
constexpr std::size_t kOwnPreviewsMax = 8;
constexpr std::size_t kListedMax = 20;
constexpr TimeUs kSliceIntervalUs = 45'000;  // of one job: a little less than a tick
// A preview that takes longer than the first time answers with its progress at the second interval.
constexpr TimeUs kFirstReportUs = 300'000, kReportIntervalUs = 2'000'000;

constexpr const char* kNotNow =
    "not now: the server stops, its log cannot be written, or another server owns the world";

/// Returns how far a job is, such as "is at 40 percent: 1200 voxels a second, 30 s left".
std::string progress_text(const RestoreJob::Progress& p, TimeUs elapsed_us) {
  const auto seconds = static_cast<std::uint64_t>(std::max<TimeUs>(1, elapsed_us / 1'000'000));
  std::string text = "is at " +
                     std::to_string(p.chunks_done * 100 / std::max<std::size_t>(1, p.chunks)) +
                     " percent: " + counted(p.voxels / seconds, "voxel") + " a second";
  if (p.chunks_done > 0) {
    const std::uint64_t left = seconds * (p.chunks - p.chunks_done) / p.chunks_done;
    text += ", " + std::to_string(left) + " s left";
  }
  return text;
}

/// Returns true if nobody but the author is connected. Then nobody else's edits need the time
/// between two slices.
bool is_alone(const WorldServer& world, AuthorId author) {
  if (world.session_count() != 1) return world.session_count() == 0;
  const auto online = world.people().online();
  return !online.empty() && online.front().author == author;
}

std::string name_of(Cause cause) { return cause == Cause::undo ? "undo" : "redo"; }

}  // namespace

struct RollbackService::Job {
  Job(RestoreOrder order, std::string name_, CommandReply reply_)
      : job(std::move(order)), name(std::move(name_)), reply(std::move(reply_)) {}
  RestoreJob job;
  std::string name;  // "undo", "redo", "rollback p1" or "undo of rollback 9120"
  CommandReply reply;
  std::optional<TimeUs> wrote_us;            // when it last wrote a slice, steady clock
  std::shared_ptr<RollbackPreview> preview;  // of a rollback
  std::optional<AuthorId> player_change_of;  // of an undo or redo
  bool has_reported_wait = false;
  // Of an undo or redo, steady clock: when it began, and when it next answers how far it is.
  TimeUs began_us = 0, report_us = 0;
  /// Returns what the job waits for, or an empty string if it does not wait.
  std::string wait_text() const {
    const std::string& limit = job.progress().waits_for;
    return limit.empty() ? limit : "waits: " + limit;
  }
};

RollbackService::RollbackService(WorldServer& world, Workers& workers, RandomBytes random)
    : world_(world),
      workers_(workers),
      random_(std::move(random)),
      player_instance_(new_instance()) {}
RollbackService::~RollbackService() = default;

void RollbackService::stop() {
  should_continue_->store(false);
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
  if (!world_.order().accepts_edits()) return refuse(reply, kNotNow);
  if (world_.order().durable() >= world_.order().head()) return begin();
  waiting_.push_back({world_.order().head(), std::move(begin), reply});
}

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
  if (player_changes_.contains(author))
    return refuse(reply, name_of(cause) + ": " + busy_text(author));
  world_.commit(now);
  player_changes_.insert(author);
  player_orders_.push_back(
      {author, cause, world_.order().authority().queue().newest_of(author), std::move(reply)});
  step_player_changes(now);
}

void RollbackService::step_player_changes(const Clocks& now) {
  const bool is_closed = !world_.order().accepts_edits();
  std::vector<PlayerChangeOrder> ready;
  std::erase_if(player_orders_, [&](PlayerChangeOrder& order) {
    const EditQueue& queue = world_.order().authority().queue();
    std::erase_if(order.before, [&](const OperationId& op) { return !queue.has(op); });
    if (!order.before.empty() && !is_closed) return false;
    ready.push_back(std::move(order));
    return true;
  });
  for (PlayerChangeOrder& order : ready) find_player_change(std::move(order), now);
}

void RollbackService::find_player_change(PlayerChangeOrder order, const Clocks& now) {
  // The author is free for another one if the log cannot be written any more.
  CommandReply reply = [this, author = order.author,
                        inner = order.reply](const CommandAnswer& answer) {
    player_changes_.erase(author);
    inner(answer);
  };
  when_durable(now, reply, [this, order = std::move(order)] {
    auto found = std::make_shared<SearchResult>(PlayerActionSearch());
    const Sequence end = world_.order().durable();
    workers_.run(
        [found, author = order.author, cause = order.cause, end, epoch = world_.order().epoch(),
         should_continue = should_continue()](WorldReader& reader, const Generator& generator) {
          *found =
              next_player_change(reader, generator, author, cause, end, epoch, should_continue);
        },
        [this, found, order, end](const std::string& error) {
          player_changes_.erase(order.author);
          if (!error.empty()) return refuse(order.reply, name_of(order.cause) + ": " + error);
          start_player_change(order, *found, end);
        });
  });
}

void RollbackService::start_player_change(const PlayerChangeOrder& asked, SearchResult& found,
                                          Sequence end) {
  const std::string name = name_of(asked.cause);
  if (!found) {
    return refuse(asked.reply, found.error().kind == StoreError::Kind::cancelled
                                   ? name + ": not now: the server stops"
                                   : name + ": " + found.error().message());
  }
  if (!found->change && found->has_given_up) {
    return refuse(asked.reply, name + ": nothing is left of the " +
                                   std::to_string(kPassedActionsMax) +
                                   " edits that are next: others have built over them, "
                                   "or they changed nothing; it looks no further back");
  }
  if (!found->change) return refuse(asked.reply, "nothing to " + name);
  PlayerChange& change = *found->change;
  player_changes_.insert(asked.author);
  if (asked.cause == Cause::undo && !asked.has_ended_action) {
    const Sequence newest = world_.people().edits().end_action(asked.author, change.action);
    const auto before = world_.order().authority().queue().newest_of(asked.author);
    // Edits of the action that came after the search, or are still to be ordered, are undone, too.
    if (newest > end || (newest != 0 && !before.empty())) {
      player_orders_.push_back({asked.author, asked.cause, before, asked.reply, true});
      return;
    }
  }
  start_action_job(asked.author, asked.cause, change.action, std::move(change.selection),
                   asked.reply);
}

void RollbackService::start_action_job(AuthorId author, Cause cause, Sequence action,
                                       Selection&& selection, CommandReply reply) {
  RestoreOrder order;
  order.author = author;
  order.instance = player_instance_;
  order.first_seq = std::max(world_.order().resolved(author, player_instance_), kGroupBegins) + 1;
  order.payer = author;
  order.cause = cause;
  order.subject = action;
  order.selection = std::make_shared<const Selection>(std::move(selection));
  start_job(std::move(order), name_of(cause), std::move(reply)).player_change_of = author;
}

void RollbackService::undo_action(AuthorId author, ClientInstance instance, Sequence action,
                                  const Clocks& now, CommandReply asked) {
  if (player_changes_.contains(author)) return refuse(asked, "undo: " + busy_text(author));
  player_changes_.insert(author);
  // The author is free for another one if it fails before its job begins.
  CommandReply reply = [this, author, asked](const CommandAnswer& answer) {
    player_changes_.erase(author);
    asked(answer);
  };
  when_durable(now, reply, [this, author, instance, action, asked, reply] {
    auto found = std::make_shared<StoreResult<Selection>>(Selection());
    workers_.run(
        [found, author, instance, action, should_continue = should_continue()](WorldReader& reader,
                                                                               const Generator&) {
          LogQuery query;
          query.author = author;
          query.cause = Cause::player;
          query.first = action;
          std::vector<Sequence> edits;
          const auto read = reader.query_log(query, [&](const EditRecord& record) {
            if (record.op.instance == instance) edits.push_back(record.version.seq);
            return should_continue();
          });
          *found = read ? select_edits(reader, edits, should_continue)
                        : StoreResult<Selection>(failure(read.error()));
        },
        [this, found, author, action, asked, reply](const std::string& error) {
          if (!error.empty()) return refuse(reply, "undo: " + error);
          if (!*found) return refuse(reply, "undo: " + found->error().message());
          start_action_job(author, Cause::undo, action, *std::move(*found), asked);
        });
  });
}

void RollbackService::preview(const SelectionFilter& filter, const Clocks& now, CommandReply reply,
                              RollbackPreview::PlanViewer viewer,
                              RollbackPreview::Summary summarise,
                              const std::optional<OwnGround>& own) {
  when_durable(now, reply, [this, filter, reply, viewer, summarise, own] {
    if (own && !make_room_for_own(own->author))
      return refuse(reply, "rollback preview: moderators keep too many previews: try again later");
    const auto preview = std::make_shared<RollbackPreview>();
    preview->number = next_preview_++;
    preview->own = own;
    previews_[preview->number] = preview;
    if (previews_.size() > kPreviewsMax) discard(previews_.begin()->first);
    computing_.push_back({preview, reply});
    SelectionFilter until_now = filter;
    until_now.last = std::min(filter.last, world_.order().durable());
    workers_.run(
        [preview, until_now, viewer, summarise, end = world_.order().durable()](
            WorldReader& reader, const Generator& generator) {
          preview->compute(reader, generator, until_now, end, viewer, summarise);
        },
        [this, preview, reply](const std::string& error) {
          answer_preview(*preview, error, reply);
        });
  });
}

void RollbackService::discard(std::uint64_t number) {
  const auto found = previews_.find(number);
  if (found == previews_.end()) return;
  found->second->is_wanted->store(false);
  previews_.erase(found);
}

bool RollbackService::make_room_for_own(AuthorId author) {
  std::vector<std::uint64_t> mine, others;  // the oldest first
  for (const auto& [number, preview] : previews_) {
    if (preview->own) (preview->own->author == author ? mine : others).push_back(number);
  }
  for (const std::uint64_t number : mine) discard(number);
  std::size_t discarded = 0;
  while (discarded < others.size() &&
         (others.size() - discarded >= kOwnPreviewsMax || previews_.size() >= kPreviewsMax))
    discard(others[discarded++]);
  return previews_.size() < kPreviewsMax;
}

void RollbackService::answer_preview(RollbackPreview& preview, const std::string& reader_error,
                                     const CommandReply& reply) {
  std::erase_if(computing_, [&](const Computing& c) { return c.preview.get() == &preview; });
  const std::string& error = reader_error.empty() ? preview.error : reader_error;
  if (!error.empty()) {
    previews_.erase(preview.number);
    return refuse(reply, "rollback preview: " + error);
  }
  if (!previews_.contains(preview.number)) {
    return refuse(reply, "rollback preview: " + preview.id() +
                             " was forgotten: too many were asked for meanwhile");
  }
  if (preview.is_empty()) {
    previews_.erase(preview.number);
    return reply({preview.text_of_nothing(), true, true, std::make_shared<const RestorePreview>()});
  }
  preview.state = RollbackPreview::State::ready;
  RestorePreview shown;
  shown.preview = preview.id();
  shown.voxels = preview.voxels;
  shown.chunks = preview.chunks;
  reply({preview.text(), true, true, std::make_shared<const RestorePreview>(std::move(shown))});
}

RollbackPreview* RollbackService::find_preview(const std::string& id) {
  if (!id.starts_with('p')) return nullptr;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(id.data() + 1, id.data() + id.size(), number);
  if (error != std::errc() || end != id.data() + id.size()) return nullptr;
  const auto found = previews_.find(number);
  return found == previews_.end() ? nullptr : found->second.get();
}

RollbackPreview* RollbackService::find_preview(const std::string& id, AuthorId author,
                                               Scope scope) {
  RollbackPreview* const preview = find_preview(id);
  const bool is_in_scope = preview != nullptr && (scope == Scope::all ||
                                                  (preview->own && preview->own->author == author));
  return is_in_scope ? preview : nullptr;
}

const OwnGround* RollbackService::own_ground(const std::string& id, AuthorId author) {
  const RollbackPreview* const preview = find_preview(id, author, Scope::own);
  return preview == nullptr ? nullptr : &*preview->own;
}

bool RollbackService::has_own_job(AuthorId author) const {
  return std::ranges::any_of(jobs_, [&](const auto& job) {
    return !job->player_change_of && job->job.order().payer == author;
  });
}

void RollbackService::apply(const std::string& id, AuthorId author, CommandReply reply,
                            Scope scope) {
  if (scope == Scope::own && has_own_job(author))
    return refuse(reply, "rollback apply: one of yours is still under way");
  RollbackPreview* const preview = find_preview(id, author, scope);
  if (preview == nullptr) {
    return refuse(reply,
                  "rollback apply: there is no preview \"" + id + "\" (rollback list names them)");
  }
  if (preview->state == RollbackPreview::State::computing) {
    return refuse(
        reply, "rollback apply: " + id + " is still being computed: " + preview->progress_text());
  }
  if (preview->state == RollbackPreview::State::applied) {
    return refuse(reply, "rollback apply: " + id + " was applied before");
  }
  if (!world_.order().accepts_edits())
    return refuse(reply, std::string("rollback apply: ") + kNotNow);
  preview->state = RollbackPreview::State::applied;
  RestoreOrder order;
  order.author = author;
  order.instance = new_instance();
  order.payer = scope == Scope::own ? author : 0;
  order.cause = Cause::rollback;
  order.selection = preview->selection;
  reply(CommandAnswer::progress("rollback " + id + " begins: " + counted(preview->voxels, "voxel") +
                                " in " + counted(preview->chunks, "chunk") + "; `rollback cancel " +
                                id + "` stops it"));
  start_job(std::move(order), "rollback " + id, std::move(reply)).preview =
      previews_[preview->number];
}

void RollbackService::cancel(const std::string& id, CommandReply reply, AuthorId author,
                             Scope scope) {
  for (const auto& job : jobs_) {
    const bool is_it =
        (job->preview && job->preview->id() == id) ||
        (job->job.progress().first != 0 && std::to_string(job->job.progress().first) == id);
    const bool is_in_scope = scope == Scope::all || job->job.order().payer == author;
    if (!is_it || job->player_change_of || !is_in_scope) continue;
    job->job.cancel();
    return reply(CommandAnswer::last("rollback " + id + " stops"));
  }
  RollbackPreview* const preview = find_preview(id, author, scope);
  if (preview == nullptr)
    return refuse(reply, "rollback cancel: there is no preview or running rollback \"" + id + "\"");
  if (preview->state == RollbackPreview::State::applied) {
    return refuse(reply, "rollback cancel: " + id + " is applied already: `rollback undo " +
                             std::to_string(preview->rollback) + "` takes it back");
  }
  discard(preview->number);
  reply(CommandAnswer::last("preview " + id + " is forgotten"));
}

Sequence RollbackService::rollback_named(const std::string& id, AuthorId author, Scope scope,
                                         const CommandReply& reply) {
  Sequence seq = 0;
  if (const RollbackPreview* preview = find_preview(id, author, scope)) {
    seq = preview->rollback;
    if (seq == 0) refuse(reply, "rollback undo: " + id + " has not changed anything yet");
  } else {
    const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), seq);
    if (error != std::errc() || end != id.data() + id.size() || seq == 0) {
      refuse(reply,
             "rollback undo: \"" + id + "\" is no id of a rollback (rollback list names them)");
      return 0;
    }
  }
  for (const auto& job : jobs_) {
    if (seq != 0 && job->job.progress().first == seq) {
      refuse(reply, "rollback undo: " + id + " is still being applied: cancel it first");
      return 0;
    }
  }
  return seq;
}

void RollbackService::undo_rollback(const std::string& id, AuthorId author, const Clocks& now,
                                    CommandReply reply, Scope scope) {
  const Sequence seq = rollback_named(id, author, scope, reply);
  if (seq == 0) return;
  when_durable(now, reply, [this, seq, author, reply, scope] {
    if (seq > world_.order().head())
      return refuse(reply, "rollback undo: there is no edit " + std::to_string(seq));
    auto found = std::make_shared<StoreResult<Selection>>(Selection());
    auto is_foreign = std::make_shared<bool>(false);
    workers_.run(
        [found, is_foreign, seq, author, scope, should_continue = should_continue()](
            WorldReader& reader, const Generator&) {
          if (scope == Scope::own) {
            // One record tells it. The group may have many.
            const auto first = reader.read_log(seq, seq, [&](const EditRecord& record) {
              *is_foreign = record.op.author != author;
              return false;
            });
            if (!first) *found = failure(first.error());
            if (!first || *is_foreign) return;
          }
          const auto group = rollback_group(reader, seq);
          *found = group ? select_edits(reader, group->edits, should_continue)
                         : StoreResult<Selection>(failure(group.error()));
        },
        [this, found, is_foreign, seq, author, scope, reply](const std::string& error) {
          if (!error.empty()) return refuse(reply, "rollback undo: " + error);
          if (*is_foreign)
            return refuse(reply, "rollback undo: " + std::to_string(seq) + " is not one of yours");
          if (!*found) return refuse(reply, "rollback undo: " + found->error().message());
          if (scope == Scope::own && has_own_job(author))
            return refuse(reply, "rollback undo: one of yours is still under way");
          RestoreOrder order;
          order.author = author;
          order.payer = scope == Scope::own ? author : 0;
          order.instance = new_instance();
          order.cause = Cause::undo;
          order.selection = std::make_shared<const Selection>(*std::move(*found));
          start_job(std::move(order), "undo of rollback " + std::to_string(seq), reply);
        });
  });
}

void RollbackService::list(CommandReply reply, AuthorId author, Scope scope) {
  std::string text;
  for (const auto& [number, preview] : previews_) {
    if (find_preview(preview->id(), author, scope) == nullptr) continue;
    if (preview->state == RollbackPreview::State::computing)
      text += preview->id() + " is being computed: " + preview->progress_text() + "\n";
    if (preview->state == RollbackPreview::State::ready) {
      text += preview->id() + " preview: " + counted(preview->selection->edits, "edit") + ", " +
              counted(preview->voxels, "voxel") + "\n";
    }
  }
  for (const auto& job : jobs_) {
    if (scope == Scope::own && job->job.order().payer != author) continue;
    const RestoreJob::Progress& p = job->job.progress();
    text += job->name + " is being applied: " + std::to_string(p.chunks_done) + " of " +
            counted(p.chunks, "chunk");
    if (!job->wait_text().empty()) text += " (" + job->wait_text() + ")";
    text += "\n";
  }
  auto groups =
      std::make_shared<StoreResult<std::vector<RollbackGroup>>>(std::vector<RollbackGroup>());
  workers_.run(
      [groups, of = scope == Scope::own ? std::optional(author) : std::nullopt](WorldReader& reader,
                                                                                const Generator&) {
        *groups = rollback_groups(reader, kListedMax, of);
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
        reply(CommandAnswer::last(all));
      });
}

RollbackService::Job& RollbackService::start_job(RestoreOrder order, std::string name,
                                                 CommandReply reply) {
  jobs_.push_back(std::make_shared<Job>(std::move(order), std::move(name), std::move(reply)));
  return *jobs_.back();
}

void RollbackService::step(Job& job, const Clocks& now) {
  // tick() is also called whenever a worker has answered, so the interval bounds the rate of
  // writes.
  const bool is_due = !job.wrote_us || now.steady_us - *job.wrote_us >= kSliceIntervalUs ||
                      is_alone(world_, job.job.order().author);
  // A worker plans the next chunks while a slice is written.
  begin_work(job);
  if (is_due) {
    const std::uint64_t written = job.job.progress().edits;
    job.job.step(world_, now);
    if (job.job.progress().edits != written) job.wrote_us = now.steady_us;
  }
  if (job.preview) job.preview->rollback = job.job.progress().first;
  begin_work(job);
}

void RollbackService::begin_work(Job& job) {
  auto work = job.job.next_work(world_);
  if (!work) return;
  const auto self =
      std::find_if(jobs_.begin(), jobs_.end(), [&](const auto& j) { return j.get() == &job; });
  auto chunks = std::make_shared<std::vector<RestoredChunk>>();
  workers_.run(
      [chunks, work = *std::move(work), should_continue = should_continue()](
          WorldReader& reader, const Generator& generator) {
        *chunks = restore_chunks(reader, generator, work, should_continue);
      },
      [kept = *self, chunks](const std::string& error) {
        if (!error.empty()) return kept->job.work_failed(error);
        kept->job.computed(std::move(*chunks));
      });
}

void RollbackService::report_previews(const Clocks& now) {
  for (Computing& c : computing_) {
    if (c.report_us == 0) c.report_us = now.steady_us + kFirstReportUs;
    if (now.steady_us < c.report_us || !c.preview->is_wanted->load()) continue;
    c.report_us = now.steady_us + kReportIntervalUs;
    c.reply(CommandAnswer::progress("preview " + c.preview->id() +
                                    " is being computed: " + c.preview->progress_text() +
                                    "; `rollback cancel " + c.preview->id() + "` ends it"));
  }
}

void RollbackService::report_player_change(Job& job, const Clocks& now) const {
  if (!job.player_change_of || job.job.state() != RestoreJob::State::applying) return;
  if (!job.has_reported_wait && !job.wait_text().empty()) {
    job.has_reported_wait = true;
    job.reply(CommandAnswer::progress(job.name + " " + job.wait_text()));
  }
  if (job.report_us == 0) {
    job.began_us = now.steady_us;
    job.report_us = now.steady_us + kReportIntervalUs;
  }
  if (now.steady_us < job.report_us) return;
  job.report_us = now.steady_us + kReportIntervalUs;
  job.reply(CommandAnswer::progress(
      job.name + " " + progress_text(job.job.progress(), now.steady_us - job.began_us)));
}

bool RollbackService::answer_if_ended(Job& job) {
  const RestoreJob::Progress& p = job.job.progress();
  const RestoreJob::State state = job.job.state();
  if (state == RestoreJob::State::applying) return false;
  const bool is_on_disk = world_.order().durable() >= p.last;
  if (!is_on_disk && world_.order().accepts_edits()) return false;  // the answer waits for the disk
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
  if (p.edits_refused > 0)
    text += "; " + counted(p.edits_refused, "part") + " left as they are: " + p.refusal;
  text += undo_hint;
  if (!is_on_disk)
    text += " (not all of it is on disk yet: what is not will be missing after a restart)";
  job.reply(CommandAnswer::last(text, state == RestoreJob::State::done && is_on_disk));
  if (job.player_change_of) player_changes_.erase(*job.player_change_of);
  return true;
}

void RollbackService::tick(const Clocks& now) {
  step_player_changes(now);
  std::vector<Waiting> ready;
  const bool is_closed = !world_.order().accepts_edits();
  std::erase_if(waiting_, [&](Waiting& w) {
    if (world_.order().durable() < w.needed && !is_closed) return false;
    ready.push_back(std::move(w));
    return true;
  });
  for (Waiting& w : ready) {
    if (world_.order().durable() >= w.needed) {
      w.begin();
    } else {
      refuse(w.reply, kNotNow);
    }
  }
  report_previews(now);
  const std::vector<std::shared_ptr<Job>> jobs(jobs_.begin(), jobs_.end());
  for (const auto& job : jobs) {
    step(*job, now);
    report_player_change(*job, now);
  }
  std::erase_if(jobs_, [this](const auto& job) { return answer_if_ended(*job); });
}

}  // namespace runstone
