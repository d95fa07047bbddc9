// RollbackService: carries out the commands for undo, redo and rollback. It keeps previews and
// jobs, has workers read the log, and lets each job write a slice per tick. If nobody but the
// author of the job is connected, it writes a slice whenever one is planned. A command gets one or
// more answers. The last answer is sent when the work is done and on disk. Threads: the world
// strand. It uses no clock, thread or socket.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/rollback/command_reply.hpp"
#include "server/rollback/player_action_search.hpp"
#include "server/rollback/restore_job.hpp"
#include "server/rollback/rollback_preview.hpp"
#include "server/rollback/selection.hpp"
#include "server/world/environment/world_config.hpp"

namespace runstone {

class RollbackService {
 public:
  /// The threads that read the log.
  class Workers {
   public:
    virtual ~Workers() = default;
    using Work = std::function<void(WorldReader& reader, const Generator& generator)>;
    /// Runs `work` on another thread, with a reader of its own, then `then` on the world strand. If
    /// no reader can be opened, `work` does not run, and `then` gets the reason. Otherwise it gets
    /// an empty string.
    virtual void run(Work work, std::function<void(std::string)> then) = 0;
  };

  /// All arguments must outlive the service.
  RollbackService(WorldServer& world, Workers& workers, RandomBytes random);
  ~RollbackService();
  RollbackService(const RollbackService&) = delete;
  RollbackService& operator=(const RollbackService&) = delete;

  /// Undoes or redoes the author's next action. An author has at most one of both under way. An action
  /// under way is ended first: it takes no more edits.
  void undo(AuthorId author, const Clocks& now, CommandReply reply) {
    change_player_actions(author, Cause::undo, now, std::move(reply));
  }
  void redo(AuthorId author, const Clocks& now, CommandReply reply) {
    change_player_actions(author, Cause::redo, now, std::move(reply));
  }

  /// Undoes one action of the author, which takes no more edits: all records of its client instance
  /// from `action` on, which is the sequence of its first edit. Others may be newer. Refuses while the
  /// author has an undo or redo under way.
  void undo_action(AuthorId author, ClientInstance instance, Sequence action, const Clocks& now,
                   CommandReply reply);

  /// Answers what a rollback of these edits would do, and keeps the preview under an id ("p1"). If
  /// that takes longer than a moment, answers with the id and the progress come before. Changes
  /// nothing. The functions are those of RollbackPreview::compute(). `own` is the ground of a
  /// player without the right `roll_back`. The filter must have its box. The earlier preview of
  /// this player is discarded.
  void preview(const SelectionFilter& filter, const Clocks& now, CommandReply reply,
               RollbackPreview::PlanViewer viewer = {}, RollbackPreview::Summary summarise = {},
               const std::optional<OwnGround>& own = std::nullopt);
  /// The previews and rollbacks that a caller may use. `own` is for players without the right
  /// `roll_back`: they see only their own, and their edit budget pays.
  enum class Scope : std::uint8_t { all, own };
  /// Returns the ground of a preview of the author, or null if the author has no such preview.
  const OwnGround* own_ground(const std::string& id, AuthorId author);
  /// Begins to carry out a preview. `author` gives the command; 0 is the server.
  void apply(const std::string& id, AuthorId author, CommandReply reply, Scope scope = Scope::all);
  /// Stops a rollback that is being applied, or discards a preview.
  void cancel(const std::string& id, CommandReply reply, AuthorId author = 0,
              Scope scope = Scope::all);
  /// Undoes a rollback. `id` is the sequence of its first edit, or the id of its preview.
  void undo_rollback(const std::string& id, AuthorId author, const Clocks& now, CommandReply reply,
                     Scope scope = Scope::all);
  /// Answers with previews, running jobs, and the rollbacks in the log.
  void list(CommandReply reply, AuthorId author = 0, Scope scope = Scope::all);

  /// Begins the work that waited for the disk, lets jobs write, and answers. Call it on every tick,
  /// when the log became durable, and when a worker has answered.
  void tick(const Clocks& now);
  /// Makes workers end their reads soon. Call it when the server stops.
  void stop();
  /// Returns the number of jobs that write or are about to.
  std::size_t running() const { return jobs_.size(); }
  /// Returns true if no job runs, none waits for the disk, and none is looked for in the log.
  bool is_idle() const { return jobs_.empty() && waiting_.empty() && player_changes_.empty(); }
  /// Returns true while a job, a search or a preview reads the log of the past.
  bool reads_log() const { return !is_idle() || !computing_.empty(); }

  /// Returns a function for workers, which returns false when the server stops. It may outlive the
  /// service.
  ShouldContinue should_continue() const {
    return [flag = should_continue_] { return flag->load(); };
  }

 private:
  struct Job;
  struct Waiting {
    Sequence needed = 0;
    std::function<void()> begin;
    CommandReply reply;
  };
  /// An undo or redo that waits until the edits of its author are ordered that were accepted before.
  struct PlayerChangeOrder {
    AuthorId author = 0;
    Cause cause = Cause::undo;
    std::vector<OperationId> before;
    CommandReply reply;
    bool has_ended_action = false;  // the action was found before, and was ended
  };
  /// A preview that a worker computes, and the caller who waits for it.
  struct Computing {
    std::shared_ptr<RollbackPreview> preview;
    CommandReply reply;
    TimeUs report_us = 0;  // steady clock, of the next answer about its progress; 0: not known yet
  };
  using SearchResult = StoreResult<PlayerActionSearch>;

  void change_player_actions(AuthorId author, Cause cause, const Clocks& now, CommandReply reply);
  /// Looks for the action as soon as the edits before are ordered and durable.
  void find_player_change(PlayerChangeOrder order, const Clocks& now);
  /// Begins the job of an undo or redo of one action.
  void start_action_job(AuthorId author, Cause cause, Sequence action, Selection&& selection,
                        CommandReply reply);
  void start_player_change(const PlayerChangeOrder& order, SearchResult& found, Sequence end);
  /// Begins the undos and redos whose edits before are ordered.
  void step_player_changes(const Clocks& now);
  void answer_preview(RollbackPreview& preview, const std::string& reader_error,
                      const CommandReply& reply);
  /// Returns the first edit of the rollback that `id` names, or 0 after it has refused the command.
  Sequence rollback_named(const std::string& id, AuthorId author, Scope scope,
                          const CommandReply& reply);
  /// Calls `begin` once everything ordered so far is durable. Refuses the command if the log cannot
  /// be written any more.
  void when_durable(const Clocks& now, const CommandReply& reply, std::function<void()> begin);
  Job& start_job(RestoreOrder order, std::string name, CommandReply reply);
  void step(Job& job, const Clocks& now);
  /// Has a worker plan the next chunks of the job, unless one does so already.
  void begin_work(Job& job);
  /// Answers the callers of previews that take long with the progress.
  void report_previews(const Clocks& now);
  /// Answers once that an undo or redo waits, and now and then how far it is.
  void report_player_change(Job& job, const Clocks& now) const;
  bool answer_if_ended(Job& job);
  /// Returns the reason why the author cannot have another undo or redo now.
  std::string busy_text(AuthorId author) const;
  RollbackPreview* find_preview(const std::string& id);
  /// Returns null also for a preview that is not in the scope of the author.
  RollbackPreview* find_preview(const std::string& id, AuthorId author, Scope scope);
  /// Discards previews of players without the right `roll_back`: an earlier one of the author, and
  /// the oldest ones beyond their number. Returns false if there is no room, because all other
  /// previews belong to players with the right.
  bool make_room_for_own(AuthorId author);
  void discard(std::uint64_t number);
  /// Returns true if a rollback that this player pays for, or the undo of one, is being applied.
  bool has_own_job(AuthorId author) const;
  ClientInstance new_instance();
  WorldServer& world_;
  Workers& workers_;
  RandomBytes random_;
  std::map<std::uint64_t, std::shared_ptr<RollbackPreview>> previews_;  // by number
  std::vector<Computing> computing_;
  std::list<std::shared_ptr<Job>> jobs_;
  std::vector<Waiting> waiting_;
  std::vector<PlayerChangeOrder> player_orders_;  // that wait for edits to be ordered
  std::set<AuthorId> player_changes_;             // authors with an undo or redo under way
  /// The client instance of every undo and redo of this run. Each author counts its own sequences
  /// in it. There is one for all, because an instance leaves a watermark in the world for good
  /// (OperationWatermarks).
  const ClientInstance player_instance_;
  const std::shared_ptr<std::atomic<bool>> should_continue_ =
      std::make_shared<std::atomic<bool>>(true);
  std::uint64_t next_preview_ = 1;
};

}  // namespace runstone
