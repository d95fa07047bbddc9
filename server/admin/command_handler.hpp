// CommandHandler: carries out the commands of console, control and clients
// (server/admin/command.hpp). It answers with lines of text; the last answer comes when everything
// is done. Thread: the world strand. Reads from the disk run on the workers.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "server/admin/command.hpp"
#include "server/admin/command_caller.hpp"
#include "server/admin/operator_actions.hpp"
#include "server/admin/rights_commands.hpp"
#include "server/rollback/rollback_service.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

class CommandHandler {
 public:
  /// The references must outlive the handler.
  CommandHandler(WorldServer& world, RollbackService& rollback, RollbackService::Workers& workers,
                 std::string world_folder, OperatorActions actions,
                 RightsCommands::IsOperator is_operator);

  /// Carries out one line. `reply` is called on the world strand and must not call this object.
  void run(const CommandCaller& caller, const std::string& line, const Clocks& now,
           CommandReply reply);
  /// Begins the work that waited for the disk. Call it when the log became durable or failed.
  void tick() { rights_.tick(); }

 private:
  /// Carries out a command of the program around the server. Returns false if it is another one.
  bool run_action(const Command& command, const CommandReply& reply);
  void help(const CommandCaller& caller, const CommandReply& reply) const;
  void status(const CommandReply& reply) const;
  void players(const CommandReply& reply);
  void hand_over(std::optional<SessionId> successor, const CommandReply& reply);
  void names(const CommandReply& reply) const;
  void say(const CommandCaller& caller, const std::string& text, const Clocks& now,
           const CommandReply& reply);
  void release_name(const std::string& name, const CommandReply& reply);
  void add_materials(const std::string& file, const Clocks& now, const CommandReply& reply);
  void log(const LogCommand& command, const Clocks& now, const CommandReply& reply);
  void preview(const CommandCaller& caller, const RollbackPreviewCommand& command,
               const Clocks& now, const CommandReply& reply);
  /// Looks up the authors that a filter names, on a worker. Calls `go_on` with the result, or
  /// rejects the command if a name is unknown or ambiguous.
  void resolve(const CommandFilter& filter, const std::string& command, const CommandReply& reply,
               std::function<void(const SelectionFilter&)> go_on);

  WorldServer& world_;
  RollbackService& rollback_;
  RollbackService::Workers& workers_;
  RightsCommands rights_;
  const std::string world_folder_;  // for the pictures of previews
  const OperatorActions actions_;
};

}  // namespace runstone
