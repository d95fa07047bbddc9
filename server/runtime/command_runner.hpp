// CommandRunner: carries out the commands of the console, the control socket and clients, and owns
// the services behind them: rollback, undo and redo. A server that has handed the world over keeps
// it, because workers may still answer. Commands are refused then. Threads: run(line, reply) may be
// called from any thread, everything else from the world strand.
#pragma once
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "server/admin/access_tokens.hpp"
#include "server/admin/command_call.hpp"
#include "server/rollback/rollback_service.hpp"
#include "server/runtime/world_readers.hpp"
#include "server/runtime/world_strand.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// Splits an answer for a client at its line breaks. A line that is longer than
/// kCommandLineBytesMax goes on in further lines, because no message has longer ones.
std::vector<std::string> answer_lines(const std::string& text);

class CommandRunner final : private RollbackService::Workers {
 public:
  /// `strand`, `world` and `readers` must outlive the object. `operators`: the keys of the players
  /// who may give every command.
  CommandRunner(WorldStrand& strand, WorldServer& world, WorldReaders& readers,
                std::set<PublicKey> operators, const std::string& world_folder,
                const OperatorActions& actions);

  /// Carries out a command of the console or the control socket. The replies come on the world
  /// strand.
  void run(const std::string& line, CommandReply reply);
  /// Carries out a client's command. Commands::answer() gets the replies, in a later
  /// task.
  void run(SessionId session, AuthorId author, const PublicKey& key, const std::string& text);

  // The commands of the operators' page. The first answer is one of the lines of page_desk.hpp, and
  // the replies come on the world strand. Call these on the world strand.
  /// Carries out a command as the owner of a token.
  void run(const AccessToken& token, const std::string& line, const CommandReply& reply);
  /// Answers with name, role and rights of the owner of a token.
  void describe(const AccessToken& token, const CommandReply& reply);
  /// Returns the rights for which the owner of a token may use the page now.
  RightSet rights_of(const AccessToken& token);

  void set_operators(std::set<PublicKey> operators) { operators_ = std::move(operators); }
  /// Takes over the announcements of the settings.
  void set_announcements(const std::vector<Announcement>& announcements) {
    services_.announcements.set_configured(announcements);
  }
  /// Lets the work go on that waits for the disk or for the next slice of a rollback. Call it on
  /// every tick, and when the log became durable or failed.
  void tick(const Clocks& now) {
    rollback_.tick(now);
    placing_.tick(now);
    services_.tick(now);
  }
  /// Returns false while rollbacks, undos, redos or placed builds are under way.
  bool is_idle() const { return rollback_.is_idle() && placing_.is_idle(); }
  /// Returns true while one of these jobs, or a preview of a rollback, reads the log of the past.
  bool reads_log() const { return rollback_.reads_log() || !placing_.is_idle(); }
  /// Makes jobs and workers end soon. Call it when the server stops.
  void stop() { rollback_.stop(); }

 private:
  void run(Work work, std::function<void(std::string)> then) override;
  CommandCaller caller_of(const AccessToken& token) const;

  WorldStrand& strand_;
  WorldServer& world_;
  WorldReaders& readers_;
  std::set<PublicKey> operators_;
  RollbackService rollback_;
  PlaceService placing_;
  CommandServices services_;
};

}  // namespace runstone
