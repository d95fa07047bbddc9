// RightsCommands: carries out the commands about roles, grants, restrictions and protected ground.
// WorldServer::change_rights() decides whether a change may be made; this class finds the players
// that a command means and answers.
// Thread: the world strand. Reads from the disk run on the workers.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/admin/command_caller.hpp"
#include "server/admin/known_players.hpp"
#include "server/admin/rights_command.hpp"
#include "server/rollback/rollback_service.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

class RightsCommands {
 public:
  /// Returns true if the server's settings name the key as an operator's.
  using IsOperator = std::function<bool(const PublicKey&)>;

  /// The references must outlive the object.
  RightsCommands(WorldServer& world, RollbackService::Workers& workers, IsOperator is_operator)
      : world_(world), workers_(workers), is_operator_(std::move(is_operator)) {}

  /// Carries out a command that the caller may give (why_not). `reply` is called on the world
  /// strand and must not call this object.
  void run(const CommandCaller& caller, const RightsCommand& command, const Clocks& now,
           const CommandReply& reply);
  /// Begins the work that waited for the disk. Call it when the log became durable or failed.
  void tick();

 private:
  /// One command under way.
  struct Call {
    CommandCaller caller;
    Clocks now;
    CommandReply reply;
  };
  using Players = std::shared_ptr<const KnownPlayers>;
  using Keys = std::vector<PublicKey>;  // one for each word that was looked up

  void carry_out(const ListRolesCommand& command, const Call& call);
  void carry_out(const SetRoleCommand& command, const Call& call);
  void carry_out(const RemoveRoleCommand& command, const Call& call);
  void carry_out(const DefaultRoleCommand& command, const Call& call);
  void carry_out(const GrantCommand& command, const Call& call);
  void carry_out(const RevokeCommand& command, const Call& call);
  void carry_out(const ListGrantsCommand& command, const Call& call);
  void carry_out(const RestrictCommand& command, const Call& call);
  void carry_out(const LiftCommand& command, const Call& call);
  void carry_out(const ListRestrictionsCommand& command, const Call& call);
  void carry_out(const KickCommand& command, const Call& call);
  void carry_out(const ProtectCommand& command, const Call& call);
  void carry_out(const BoxMembersCommand& command, const Call& call);
  void carry_out(const ClaimCommand& command, const Call& call);
  void carry_out(const UnprotectCommand& command, const Call& call);
  void carry_out(const ListBoxesCommand& command, const Call& call);
  void carry_out(const WhyCommand& command, const Call& call);
  void carry_out(const UndoRightsCommand& command, const Call& call);
  void carry_out(const CreateInviteCommand& command, const Call& call);
  void carry_out(const CancelInviteCommand& command, const Call& call);
  void carry_out(const ListInvitesCommand& command, const Call& call);
  void carry_out(const ListRefusalsCommand& command, const Call& call);
  void carry_out(const SetPasswordCommand& command, const Call& call);
  void carry_out(const ClearPasswordCommand& command, const Call& call);
  void carry_out(const ShowPasswordCommand& command, const Call& call);

  /// Looks up players on a worker. Calls `go_on` with what is known and with the key of each word,
  /// or refuses the command if a word means nobody or several players.
  void with_players(const Call& call, std::vector<std::string> words,
                    std::function<void(const Players&, const Keys&)> go_on);
  /// Orders a change. Answers with "text (record N)" and the number of sessions that it ended, or
  /// with why it was refused.
  void change(const Call& call, const RightsChange& change, const std::string& text);
  void restrict_subject(const RestrictCommand& command, const RestrictionSubject& subject,
                        const std::string& who, const Call& call);
  void lift_subject(const LiftCommand& command, const RestrictionSubject& subject,
                    const std::string& who, const Call& call);
  void answer_why(const WhyCommand& command, const PublicKey& key, const KnownPlayers& players,
                  const Call& call);
  /// Takes a record back, whose successors `records` has too.
  void undo_record(Sequence seq, const std::vector<RightsRecord>& records, const Call& call);

  struct Waiting {
    Sequence needed = 0;
    std::function<void()> begin;
    CommandReply reply;
  };

  WorldServer& world_;
  RollbackService::Workers& workers_;
  const IsOperator is_operator_;
  std::vector<Waiting> waiting_;
};

}  // namespace runstone
