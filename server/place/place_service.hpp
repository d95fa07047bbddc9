// PlaceService: places builds in the world for commands. It keeps the jobs, has workers cut the builds
// into edits, lets each job order a slice per tick, and answers with the progress. The last answer
// comes when everything is on disk.
// Threads: the world strand. It uses no clock, thread or socket.
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "server/place/place_job.hpp"
#include "server/rollback/command_reply.hpp"
#include "server/rollback/rollback_service.hpp"
#include "server/world/environment/world_config.hpp"

namespace runstone {

class PlaceService {
 public:
  /// Jobs that are under way at a time, of all authors. A further one is refused.
  static constexpr std::size_t kJobsMax = 4;

  /// All arguments must outlive the service.
  PlaceService(WorldServer& world, RollbackService& rollback, RollbackService::Workers& workers,
               RandomBytes random);
  ~PlaceService();
  PlaceService(const PlaceService&) = delete;
  PlaceService& operator=(const PlaceService&) = delete;

  /// Returns why place() would refuse this order now, as a sentence, or nullopt.
  std::optional<std::string> refusal(const PlaceOrder& order) const;
  /// Begins to place a build. Answers begin with `name`, such as `"Mill"`. The instance of the order
  /// is drawn here. Refuses if the author has a job under way, if there are too many, if the box of the
  /// build does not lie in the world, or if the server takes no edits.
  void place(PlaceOrder order, const std::string& name, const Clocks& now, CommandReply reply);
  /// Ends the author's job, and takes back what it has placed. The console (0) ends all jobs.
  void cancel(AuthorId author, const Clocks& now, CommandReply reply);

  /// Lets jobs order edits, and answers. Call it on every tick, when the log became durable, and when
  /// a worker has answered.
  void tick(const Clocks& now);
  bool is_idle() const { return jobs_.empty(); }

 private:
  struct Job;
  void step(const std::shared_ptr<Job>& job, const Clocks& now);
  void report(Job& job, const Clocks& now) const;
  bool answer_if_ended(Job& job, const Clocks& now);

  WorldServer& world_;
  RollbackService& rollback_;
  RollbackService::Workers& workers_;
  RandomBytes random_;
  std::list<std::shared_ptr<Job>> jobs_;
};

}  // namespace runstone
