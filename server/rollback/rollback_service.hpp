// RollbackService: where people ask for undo, redo and rollback. It keeps previews and jobs, has workers read the
// log, and lets each job write a slice per tick. Answers come as lines, some at once, the last one when the
// work is done and on disk. It belongs to the world strand and knows no clock, thread or socket.
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
#include "server/rollback/restore_job.hpp"
#include "server/rollback/restore_plan.hpp"
#include "server/rollback/selection.hpp"
#include "server/world/world_config.hpp"

namespace runstone {

class RollbackService {
 public:
  /// The threads that read the log.
  class Workers {
   public:
    virtual ~Workers() = default;
    using Work = std::function<void(WorldReader& reader, const Generator& generator)>;
    /// Runs `work` soon, elsewhere, with a reader of its own; then `then` on the world strand. The text is
    /// empty, or says why there was no reader, when `work` did not run.
    virtual void run(Work work, std::function<void(std::string)> then) = 0;
  };
  /// Sees the chunks of a preview, on a worker, one after another: now and restored.
  using Viewer = std::function<void(const RestorePlan&)>;
  /// Has seen them all: returns lines to be added to the answer about the preview of this id.
  using Seen = std::function<std::string(WorldReader& reader, const Generator& generator,
                                         const std::string& id)>;

  /// All must outlive the desk.
  RollbackService(WorldServer& world, Workers& workers, RandomBytes random);
  ~RollbackService();
  RollbackService(const RollbackService&) = delete;
  RollbackService& operator=(const RollbackService&) = delete;

  /// The author's next undo or redo. One at a time per author.
  void undo(AuthorId author, const Clocks& now, CommandReply reply) {
    change_player_actions(author, Cause::undo, now, std::move(reply));
  }
  void redo(AuthorId author, const Clocks& now, CommandReply reply) {
    change_player_actions(author, Cause::redo, now, std::move(reply));
  }

  /// Says what a rollback of these edits would do, and keeps it under an id ("p1"). Changes nothing. `see`, if any,
  /// gets each chunk that would change, then `seen` has its say, also on the worker.
  void preview(const SelectionFilter& filter, const Clocks& now, CommandReply reply,
               Viewer see = {}, Seen seen = {});
  /// Begins to carry out a preview. `author`: who asks; 0 the server.
  void apply(const std::string& id, AuthorId author, CommandReply reply);
  /// Stops a rollback that is being applied, or forgets a preview.
  void cancel(const std::string& id, CommandReply reply);
  /// Takes a rollback back: `id` is the sequence of its first edit, or that of its preview.
  void undo_rollback(const std::string& id, AuthorId author, const Clocks& now, CommandReply reply);
  /// Previews, running jobs, and the rollbacks in the log.
  void list(CommandReply reply);

  /// On every tick, and whenever the log became durable or a worker answered: begins what waited for the disk,
  /// lets jobs write, answers.
  void tick(const Clocks& now);
  /// Workers end soon what they read: the server stops.
  void stop();
  /// Jobs that write or are about to.
  std::size_t running() const { return jobs_.size(); }

 private:
  struct Preview;
  struct Job;
  struct Waiting {
    Sequence needed = 0;
    std::function<void()> begin;
    CommandReply reply;
  };
  void change_player_actions(AuthorId author, Cause cause, const Clocks& now, CommandReply reply);
  /// Calls `begin` once everything ordered by now is durable; refuses if that cannot be any more.
  void when_durable(const Clocks& now, const CommandReply& reply, std::function<void()> begin);
  Job& start_job(RestoreOrder order, std::string name, CommandReply reply);
  void step(Job& job, const Clocks& now);
  void tell_wait(Job& job) const;
  bool answer_if_ended(Job& job);
  /// Why the author cannot have another undo or redo now.
  std::string busy_text(AuthorId author) const;
  Preview* find_preview(const std::string& id);
  ClientInstance new_instance();
  /// For workers; may outlive the desk.
  GoesOn goes_on() const {
    return [flag = goes_on_] { return flag->load(); };
  }

  WorldServer& world_;
  Workers& workers_;
  RandomBytes random_;
  std::map<std::uint64_t, std::shared_ptr<Preview>> previews_;  // by number
  std::list<std::shared_ptr<Job>> jobs_;
  std::vector<Waiting> waiting_;
  std::set<AuthorId> player_changes_;  // authors with an undo or redo under way
  /// Of all undo and redo in this run, each author counting on by itself: an instance leaves a mark for good
  /// (OperationWatermarks).
  const ClientInstance own_instance_;
  const std::shared_ptr<std::atomic<bool>> goes_on_ = std::make_shared<std::atomic<bool>>(true);
  std::uint64_t next_preview_ = 1;
};

}  // namespace runstone
