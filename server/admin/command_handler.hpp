// CommandHandler: carries out the commands of console, control and clients (server/admin/command.hpp). It answers
// in lines, some at once, the last one when all is done. It belongs to the world strand; what reads the disk
// runs on the rollback desk's workers.
#pragma once
#include <functional>
#include <string>

#include "server/admin/command.hpp"
#include "server/rollback/rollback_service.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// Who gives a command.
struct CommandCaller {
  AuthorId author = 0;  // 0: console and control
  bool is_operator = false;
};

class CommandHandler {
 public:
  /// All must outlive the desk. `stop` asks the program to stop the server.
  CommandHandler(WorldServer& world, RollbackService& rollback, RollbackService::Workers& workers,
                 MaterialTable materials, std::string world_folder, std::function<void()> stop);

  /// Carries out one line. `reply` is called on the world strand, and must not call in.
  void run(const CommandCaller& caller, const std::string& line, const Clocks& now,
           CommandReply reply);

 private:
  void status(const CommandReply& reply) const;
  void players(const CommandReply& reply);
  void log(const LogCommand& command, const Clocks& now, const CommandReply& reply);
  void preview(const RollbackPreviewCommand& command, const Clocks& now, const CommandReply& reply);
  /// Finds the authors that a filter names, on a worker, then goes on with the filter; or refuses.
  void resolve(const CommandFilter& filter, const std::string& command, const CommandReply& reply,
               std::function<void(const SelectionFilter&)> go_on);

  WorldServer& world_;
  RollbackService& rollback_;
  RollbackService::Workers& workers_;
  MaterialTable materials_;
  const std::string world_folder_;  // previews are drawn there
  std::function<void()> stop_;
};

}  // namespace runstone
